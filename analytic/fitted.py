"""A slow smooth function as Chebyshev series on given intervals: evaluated once, then quick everywhere."""

from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from analytic.piecewise import PiecewiseSeries

__all__ = ["fitted"]

Array = NDArray[np.float64]

_NOISE = 3e-16


def fitted(function: Callable[[Array], Array], edges: Array, terms: int) -> PiecewiseSeries:
    """Interpolate at the Chebyshev points of every interval.

    Parameters
    ----------
    function : callable
        Takes an array, shape (n,), to its values.
    edges : ndarray
        Ends of the intervals, increasing.
    terms : int
        Of each series.

    Returns
    -------
    PiecewiseSeries
        To the last digits where the function has no feature much narrower than its interval.
    """
    nodes = chebyshev.chebpts1(terms)
    places = edges[:-1, None] + np.diff(edges)[:, None] * (1 + nodes) / 2
    values = function(places.ravel()).reshape(places.shape)
    basis = chebyshev.chebvander(nodes, terms - 1) * (2 / terms)  # orthogonal over these points
    basis[:, 0] /= 2
    return PiecewiseSeries(edges.tolist(), [_without_noise(c) for c in values @ basis])


def _without_noise(c: Array) -> list[float]:
    """Coefficients up to the last that is more than rounding: at the ends of an interval they add up."""
    size = np.flatnonzero(np.abs(c) > _NOISE * np.abs(c).max(initial=0.0))
    return c[: size[-1] + 1].tolist() if size.size else [0.0]
