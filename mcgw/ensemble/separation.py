"""The separation at which a sum over given heights has a given value."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

__all__ = ["LOWEST", "crossing", "separation_on"]

Array = NDArray[np.float64]

_ENOUGH = 1e-14  # relative excess of load where Newton's steps are rounding errors
_FINE = 1 / 64  # step of the search where a negative modulus makes the sum rise and fall
LOWEST = -40.0  # separation where searches end


def separation_on(heights: Array, modulus: Array, exponent: float, target: float, start: float) -> float:
    """Separation h at which ``sum modulus (s - h)_+^exponent`` over given heights is `target`.

    The root of order `exponent` of that sum is a norm of the approaches, so convex and decreasing
    in h: Newton's steps on it run up to the solution from below and never pass it.

    Parameters
    ----------
    heights, modulus : ndarray
        Reduced heights in falling order, and E*(s)/E* >= 0 of each; shape (n,).
    exponent : float
        At least 1.
    target : float
        Positive.
    start : float
        A separation where the sum is at least `target`.

    Returns
    -------
    float
        Reduced separation.
    """
    rising, h = -heights, start  # as searchsorted wants it
    while True:
        n = int(np.searchsorted(rising, -h))
        d = heights[:n] - h
        forces = modulus[:n] * d ** (exponent - 1)
        total = float(forces @ d)
        if total <= target * (1 + _ENOUGH):
            return h
        step = total / float(forces.sum()) * (1 - (target / total) ** (1 / exponent))
        if h + step <= h:
            return h
        h += step


def crossing(excess: Callable[[float], float], high: float) -> float | None:
    """Largest root below `high`, where the function is negative; None down to the end of theory's range."""
    for low in np.arange(high - _FINE, LOWEST, -_FINE).tolist():
        if excess(low) >= 0:
            return float(brentq(excess, low, low + _FINE, xtol=1e-15, rtol=1e-14))
    return None
