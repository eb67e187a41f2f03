"""Exponential and logarithm of single numbers for compiled loops, in plain arithmetic.

The C library has several versions of each and takes the one that suits the processor; a number that is
drawn may not hang on which. Those for arrays are in `analytic.elementary`.
"""

import math
from typing import Any

import numpy as np

from mcgw.compiling import njit

__all__ = ["exp_minus", "log", "log_one_minus"]

_LOG2_HIGH, _LOG2_LOW = 0.693147180369123816490, 1.90821492927058770002e-10  # the first has 33 bits
_HALF = math.sqrt(0.5)


@njit(nogil=True, cache=True, error_model="numpy")
def exp_minus(y: Any) -> Any:
    """``exp(-y)`` for y from 0 to 700."""
    k = np.floor(y * (1 / (_LOG2_HIGH + _LOG2_LOW)) + 0.5)
    r = (y - k * _LOG2_HIGH) - k * _LOG2_LOW
    e = 1.0
    for j in range(14, 0, -1):
        e = 1.0 - e * r / j
    return math.ldexp(e, -int(k))


@njit(nogil=True, cache=True, error_model="numpy")
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


@njit(nogil=True, cache=True, error_model="numpy")
def log_one_minus(p: Any) -> Any:
    """``log(1 - p)`` for p < 1, accurate for small `p`: the error of ``1 - p`` drops out (W. Kahan)."""
    q = 1.0 - p
    return -p if q == 1.0 else log(q) * (p / (1.0 - q))
