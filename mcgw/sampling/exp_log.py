"""Exponential, logarithm and normal numbers for compiled loops, in plain arithmetic.

The C library has several versions of each and takes the one that suits the processor; a number that is
drawn may not hang on which. Those for arrays are in `analytic.elementary`.
"""

import math
from typing import Any

import numpy as np

from analytic.elementary import MIDDLE, NEAR, OUT, PLAIN, TAYLOR
from mcgw.machine.compiling import njit
from mcgw.sampling.lanes import bits, fused, number

_LOG2_HIGH, _LOG2_LOW = 0.693147180369123816490, 1.90821492927058770002e-10  # the first has 33 bits
_HALF = math.sqrt(0.5)
_TAYLOR = np.array(TAYLOR)
_LAST_DIGIT = 1.5 * 2.0**52  # added to a whole number, this leaves it in the last bits
_MIDDLE, _NEAR, _OUT = (np.array(table) for table in (MIDDLE, NEAR, OUT))  # compiled as constants


@njit(cache=True)
def exp_minus(y: Any) -> Any:
    """``exp(-y)`` for y from 0 to 700."""
    k = np.floor(y * (1 / (_LOG2_HIGH + _LOG2_LOW)) + 0.5)
    r = (y - k * _LOG2_HIGH) - k * _LOG2_LOW
    e = 1.0
    for j in range(14, 0, -1):
        e = 1.0 - e * r / j
    return math.ldexp(e, -int(k))


@njit(cache=True)
def log(x: Any) -> Any:
    """Natural logarithm of a positive number."""
    m, k = math.frexp(x)
    if m < _HALF:
        m, k = 2.0 * m, k - 1
    f = m - 1.0
    s = f / (2.0 + f)
    z = s * s
    series = 0.0
    for j in range(11, 0, -1):
        series = (series + 2.0 / (2 * j + 1)) * z
    return k * _LOG2_HIGH + (f - (s * (f - series) - k * _LOG2_LOW))


@njit(cache=True)
def log_one_minus(p: Any) -> Any:
    """``log(1 - p)`` for p < 1, accurate for small `p`: the error of ``1 - p`` drops out (W. Kahan)."""
    q = 1.0 - p
    return -p if q == 1.0 else log(q) * (p / (1.0 - q))


@njit(inline="always")
def _ratio(table: Any, x: Any) -> Any:
    """Two polynomials of degree 7, the highest power first."""
    above, below = table[0, 0], table[1, 0]
    for j in range(1, 8):
        above = above * x + table[0, j]
        below = below * x + table[1, j]
    return above / below


@njit(cache=True)
def make_normal(x: Any) -> None:
    """Turn uniforms between -1 and 1 into standard normal numbers, in place: `analytic.elementary.ndtri`.

    Parameters
    ----------
    x : ndarray
        Shape (n, m).
    """
    middle = np.empty(x.shape[1])
    for row in x:
        for i in range(row.size):  # right for most, and the same steps for all: four at a time
            q = 0.5 * row[i]
            middle[i] = q * _ratio(_MIDDLE, 0.180625 - q * q)
        for i in range(row.size):
            q = 0.5 * row[i]
            if abs(q) > 0.425:
                r = np.sqrt(-log(0.5 - abs(q)))
                far = _ratio(_NEAR, r - 1.6) if r <= 5.0 else _ratio(_OUT, r - 5.0)
                middle[i] = math.copysign(far, q)
        row[:] = middle


@njit(cache=True)
def weigh_exponentials(x: Any, weights: Any, result: Any) -> Any:
    """Weighted sums of exponentials, as `analytic.elementary.exp` has them.

    Parameters
    ----------
    x, weights : ndarray
        Shape (n, m) and (m,).
    result : ndarray
        Where the sums are written, shape (n,).

    Returns
    -------
    bool
        Whether they are right: not if a number is beyond `analytic.elementary.PLAIN`.
    """
    x, e, plain = x.reshape(x.size), np.empty(x.size), True
    for j in range(x.size):  # all of them at first: of twenty the processor would wait for each sum
        plain &= abs(x[j]) < PLAIN
        k = np.rint(x[j] * (1 / (_LOG2_HIGH + _LOG2_LOW)))
        r = (x[j] - k * _LOG2_HIGH) - k * _LOG2_LOW
        value = r * _TAYLOR[0] + _TAYLOR[1]
        for c in range(2, 14):
            value = value * r + _TAYLOR[c]
        e[j] = value * number((bits(k + _LAST_DIGIT) + 1023) << 52)
    for i in range(result.size):
        total = 0.0
        for j in range(weights.size):
            total = fused(e[i * weights.size + j], weights[j], total)
        result[i] = total
    return plain
