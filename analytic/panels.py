"""Integrals over one range of heights, between a separation or a cut and the next cut, for many separations.

With s = h + v^2 the integrand is ``2 v^(2n+1)`` times a smooth function of v. For half-integer n the whole of
it is smooth and Gauss-Legendre converges exponentially. For other n ranges that begin at the separation take
the power as the weight of a Gauss-Jacobi rule; later ones reach at most 16 times as far from it in v as they
begin, where the power is smooth again.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.special import roots_jacobi

from analytic.gauss_legendre import gauss_legendre
from analytic.gradings import Grading, Homogeneous
from analytic.magnitude import over_unit

__all__ = ["panels"]

Array = NDArray[np.float64]

_NODES = 64
_RATIO = 256.0  # of the approaches s - h at the ends of a range, for powers that are no half-integers


def panels(n: float, h: Array, grading: Grading, unit: Array, low: Array, high: Array) -> Array:
    """``int (s-h)^n g phi / phi(max(h, 0))`` over s from `low` to `high`, in units of g.

    Parameters
    ----------
    n : float
        Power of the approach, not negative.
    h : ndarray
        Reduced separations, a sorted column, shape (k, 1).
    grading : Grading
        g.
    unit : ndarray
        Logarithm of its unit, like `h`.
    low, high : ndarray
        Reduced heights ``h <= low < high``, like `h`.

    Returns
    -------
    ndarray
        Shape (k, 1).
    """
    if (2 * n) % 1 == 0:
        return _panel(n, h, grading, unit, low, high)
    result = np.zeros_like(h)
    while (left := np.flatnonzero(low < high)).size:
        first = (low == h)[left, 0]
        stop = np.where(low == h, high, np.minimum(high, h + _RATIO * (low - h)))
        stop = np.where(stop > low, stop, high)  # steps lost in rounding
        for i in (left[first], left[~first]):
            if i.size:
                result[i] += _panel(n, h[i], grading, unit[i], low[i], stop[i])
        low = stop
    return result


def _panel(n: float, h: Array, grading: Grading, unit: Array, low: Array, high: Array) -> Array:
    """The same with one rule, for ranges that all begin at the separation or all do not."""
    power = 2 * n + 1
    above = np.maximum(h, 0.0)
    start = np.sqrt(low - h)
    width = np.sqrt(high - h) - start
    later = bool(start.any())
    if later:
        x, w = gauss_legendre(_NODES)
        v = start + width * x
        approach = v * v
    else:  # the panel begins at the separation: v^(2n+1) goes into the weights
        x, w = _with_power(power)
        approach = (width * width) * (x * x)
    beyond = approach + (h - above) if h[0, 0] < 0 else approach  # s - above, without cancellation
    terms = beyond * -0.5
    terms -= above
    terms *= beyond
    np.exp(terms, out=terms)
    if not isinstance(grading, Homogeneous):
        terms *= over_unit(grading, beyond + above, unit)
    if not later:
        return np.asarray((terms @ (2 * w))[:, None] * width ** (power + 1))
    if power % 1:
        terms *= v**power
    else:
        for _ in range(int(power)):  # products are ten times faster than a power
            terms *= v
    return np.asarray((terms @ (2 * w))[:, None] * width)


@cache
def _with_power(power: float) -> tuple[Array, Array]:
    """Points on [0, 1], and weights that contain ``x^power``."""
    if power % 1 == 0:
        x, w = gauss_legendre(_NODES)
        return x, w * x ** int(power)
    x, w = roots_jacobi(_NODES, 0.0, power)
    return (1 + x) / 2, w / 2 ** (power + 1)
