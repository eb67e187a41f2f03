"""How probable a binomial number is, against the most probable one.

By C. Loader's "Fast and accurate computation of binomial probabilities" (2000): a binomial number is off its
mean by so many standard deviations and no more, so no large logarithms are taken from each other. Near the
mean there are series, which run over the vector unit.
"""

import math
from typing import Any

import numpy as np

from mcgw.machine.compiling import njit
from mcgw.sampling.exp_log import log

_ZERO = 0.5 / math.pi  # stands for 0 in Stirling's formula, which makes it exact
# Logarithms of k! / (sqrt(2 pi k) (k/e)^k) for k = 0 ... 15, rounded from 40 digits.
_ERRORS = np.array(
    [
        0.0, 0.08106146679532726, 0.0413406959554093, 0.02767792568499834, 0.020790672103765093,
        0.016644691189821193, 0.013876128823070748, 0.01189670994589177, 0.010411265261972096,
        0.009255462182712733, 0.00833056343336287, 0.007573675487951841, 0.00694284010720953,
        0.006408994188004207, 0.0059513701127588475, 0.005554733551962801,
    ]
)  # fmt: skip
_NEAR, _LOWEST = 1 / 3, 16.0  # where series serve: for the deviance, and for Stirling's formula
_FAR = 40.0  # exponent from which on no uniform can show a probability


@njit(inline="always", error_model="numpy")
def _stirling(k: Any) -> Any:
    """Logarithm of ``k! / (sqrt(2 pi k) (k/e)^k)`` for k >= 16."""
    r = 1.0 / k
    x = r * r
    return (1 / 12 - (1 / 360 - (1 / 1260 - (1 / 1680 - x * (1 / 1188)) * x) * x) * x) * r


@njit(inline="always", error_model="numpy")
def _deviance(k: Any, d: Any) -> Any:
    """``k log(k/m) + m - k`` with m = k - d, and whether m is near enough for the series."""
    v = d / (k + (k - d))
    x = v * v
    series = 0.0
    for j in range(14, -1, -1):
        series = series * x + 1 / (2 * j + 3)
    return d * v + 2.0 * k * v * x * series, abs(v) <= _NEAR


@njit(inline="always", error_model="numpy")
def _shortfall(n: Any, p: Any, k: Any) -> Any:
    """Logarithm of ``sqrt(n / (2 pi k (n - k)))`` over the probability of k, and whether the series serve."""
    d = k - n * p
    (hit, near), (miss, near_too) = _deviance(k, d), _deviance(n - k, -d)
    return _stirling(k) + _stirling(n - k) + hit + miss, near & near_too & (k >= _LOWEST) & (n - k >= _LOWEST)


@njit(inline="always", error_model="numpy")
def _power(y: Any) -> Any:
    """``exp(-y)`` for y up to 40, without a branch."""
    x = y * (1 / 512)
    e = 0.0
    for j in range(10, 0, -1):
        e = (1.0 - e) * x * (1 / j)
    e = 1.0 - e
    for _ in range(9):
        e *= e
    return e


@njit(inline="always", error_model="numpy")
def ratio_over_mode(n: Any, p: Any, k: Any) -> Any:
    """Probability of k over that of the most probable number, and whether the series serve."""
    mode = np.floor((n + 1.0) * p)
    (most, known), (here, known_too) = _shortfall(n, p, mode), _shortfall(n, p, k)
    ratio = _power(min(here - most, _FAR)) * np.sqrt(mode * (n - mode) / (k * (n - k)))
    return ratio, known & known_too


@njit(error_model="numpy")
def _shortfall_anywhere(n: Any, p: Any, k: Any) -> Any:
    """As `_shortfall`, with 1/(2 pi) in place of a number of zero."""
    total = 0.0
    for number, d in ((k, k - n * p), (n - k, n * p - k)):
        total += _stirling(number) if number >= _LOWEST else _ERRORS[int(number)]
        value, near = _deviance(number, d)
        total += value if near else (number * log(number / (number - d)) if number else 0.0) - d
    return total


@njit(error_model="numpy")
def below_ratio(w: Any, n: Any, p: Any, k: Any) -> Any:
    """Whether w is no more than the probability of k over that of the most probable number, for any k."""
    if not 0 <= k <= n:
        return False
    mode = np.floor((n + 1.0) * p)
    root = max(k, _ZERO) * max(n - k, _ZERO) / (mode * (n - mode))
    return 0.5 * log(w * w * root) <= _shortfall_anywhere(n, p, mode) - _shortfall_anywhere(n, p, k)
