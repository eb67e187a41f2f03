"""Given the load (or area, ...), the separation; and comparisons at equal load."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from analytic.contact import mean
from analytic.gradings import Grading, Homogeneous
from analytic.integrals import fn
from analytic.quantities import QUANTITIES
from analytic.surface import Surface

__all__ = ["ratio_at_equal_load", "separation_at"]

Array = NDArray[np.float64]

_RANGE = (-40.0, 1000.0)


def separation_at(surface: Surface, quantity: str, value: ArrayLike, grading: Grading | None = None) -> Array:
    """Separation at which a mean has a given value.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    quantity : {"load", "area", "stiffness", "contacts", "conductance"}
        What is known.
    value : array_like
        Its values, in its SI unit, any shape.
    grading : Grading, optional
        E*(s)/E*; left out: homogeneous.

    Returns
    -------
    ndarray
        Reduced separations d/sigma; the largest one where a strongly negative modulus makes several.

    Raises
    ------
    ValueError
        If a value is not positive or not reached between h = -40 and 1000.
    """
    q = QUANTITIES[quantity]
    chosen = grading if q.modulus else None
    target = np.asarray(value, dtype=np.float64)
    per_surface = surface.n_asperities * q.scale(surface)
    if not np.all(np.isfinite(target) & (target > 0)):
        raise ValueError(f"{quantity} = {value!r}: give finite values > 0 {q.unit}")
    roots = [_root(q.exponent, float(np.log(t / per_surface)), chosen, quantity) for t in target.ravel()]
    return np.array(roots).reshape(target.shape)


def _root(n: float, log_target: float, grading: Grading | None, quantity: str) -> float:
    """Largest h with ``log F*_n(h) = log_target``."""
    grid = np.concatenate([np.linspace(_RANGE[0], 10, 251), np.geomspace(10.5, _RANGE[1], 60)])
    high_enough = np.flatnonzero(fn(n, grid, grading, log=True) >= log_target)
    if not high_enough.size or high_enough[-1] == len(grid) - 1:
        raise ValueError(
            f"{quantity}: not reached between h = {_RANGE[0]:g} and {_RANGE[1]:g}; give another value"
        )
    last = high_enough[-1]
    bracket: tuple[Any, Any] = (grid[last], grid[last + 1])
    root = brentq(lambda h: float(fn(n, h, grading, log=True)) - log_target, *bracket, xtol=1e-14, rtol=1e-14)
    return float(root)


def ratio_at_equal_load(quantity: str, h: ArrayLike, grading: Grading) -> Array:
    """A mean of the graded surface relative to the homogeneous one under the same load.

    Parameters
    ----------
    quantity : {"area", "stiffness", "contacts", "conductance"}
        What to compare.
    h : array_like
        Reduced separations of the homogeneous surface, which set the load.
    grading : Grading
        E*(s)/E*.

    Returns
    -------
    ndarray
        ``F*_n(h2)/F_n(h)`` with h2 from ``F*_{3/2}(h2) = F_{3/2}(h)``, in the shape of `h`.

    Examples
    --------
    Stiffer tips conduct *less* at a given load, the opposite of the paper's conclusion:

    >>> import analytic
    >>> float(analytic.ratio_at_equal_load("conductance", 2.0, analytic.Exponential(2.0)).round(3))
    0.548
    """
    unit = Surface(1.0, 1.0, 1.0, 1.0, 1.0)
    h = np.asarray(h, dtype=np.float64)
    other = separation_at(unit, "load", mean(unit, "load", h, Homogeneous()), grading)
    return mean(unit, quantity, other, grading) / mean(unit, quantity, h)
