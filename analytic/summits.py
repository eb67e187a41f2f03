"""Summits of random curvature: rules over height and radius, and the separations of given means."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from analytic.curvature import RandomCurvature
from analytic.height_rule import HeightRule

__all__ = ["separations_of_means", "with_radii"]

Array = NDArray[np.float64]

_WIDEST = 20.0  # distance of a separation from that of one radius


def with_radii(rule: HeightRule, curvature: RandomCurvature) -> HeightRule:
    """Spread a rule over heights to heights and radii of summits.

    Exact for sums, their products and third powers where one summit adds a power of its radius, up to 1;
    fourth powers of the radius have a mean only if it is bounded.
    """
    ratio, probability = curvature.rule(rule.heights)
    heights = np.broadcast_to(rule.heights, ratio.shape)
    return HeightRule(heights.ravel(), (rule.probabilities * probability).ravel(), rule.below, ratio.ravel())


def separations_of_means(mean: Callable[[float], Array], starts: Array, values: Array, name: str) -> Array:
    """Find the separations of given means, looking around those of one radius.

    Parameters
    ----------
    mean : callable
        Takes a separation to the mean, which falls.
    starts, values : ndarray
        Where to begin, and what is looked for; of one shape.
    name : str
        Of the quantity, for the message.

    Raises
    ------
    ValueError
        If a value is not reached.
    """
    from scipy.optimize import brentq  # imports half of SciPy, which few separations are asked for

    found = []
    for middle, value in zip(starts.ravel().tolist(), values.ravel().tolist(), strict=True):

        def excess(h: float, value: float = value) -> float:
            with np.errstate(divide="ignore"):
                return float(np.fmax(np.log(mean(h) / value), -100.0))

        width = 0.25
        while not excess(middle - width) > 0 > excess(middle + width):
            width *= 2
            if width > _WIDEST:
                raise ValueError(f"{name}: {value:g} is not reached; give another value")
        found.append(brentq(excess, middle - width, middle + width, xtol=1e-13, rtol=1e-14))
    return np.array(found, dtype=np.float64).reshape(values.shape)
