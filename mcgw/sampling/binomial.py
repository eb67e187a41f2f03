"""Binomial numbers, one for each surface of a block.

Transformed rejection with a squeeze: BTRS of W. Hörmann, "The generation of binomial random variates",
J. Stat. Comput. Simul. 46 (1993) 101. Three attempts in four need a comparison and no logarithm, so the
first attempts of all surfaces run over the vector unit; only the others are gone through one by one.
Their probabilities are by C. Loader's "Fast and accurate computation of binomial probabilities" (2000):
no difference of large logarithms, whatever the number. Below a mean of twenty the distribution is inverted.
"""

import math
from typing import Any

import numpy as np
from numba import njit, uint64

from mcgw.sampling.philox import COUNTS, two_wide

__all__ = ["SURFACES", "TRIALS", "WORDS", "binomials"]

SURFACES = 64  # at a time
_UNIFORM, _WEIGHT, TRIALS, WORDS = 64, 128, 192, 256  # where the rest begins, and its end

_SMALL = 20.0  # mean, below which inversion is faster; the rejection is proven from 10 on
_NOTHING = 1e-18  # a probability that no uniform can show; every q^n with so small a mean is larger
_ZERO = 0.5 / math.pi  # stands for 0 in Stirling's formula, which makes it exact
_ERRORS = np.array(
    [0.0] + [math.lgamma(k + 1) + k - (k + 0.5) * math.log(k) + 0.5 * math.log(_ZERO) for k in range(1, 16)]
)


@njit(inline="always", error_model="numpy")
def _proposal(n: Any, p: Any, u: Any, v: Any) -> Any:
    """Proposed number, whether it is sure, and what is to be no more than its probability over the mode's."""
    mean = n * p
    sd = np.sqrt(mean * (1.0 - p))
    b = 1.15 + 2.53 * sd
    a = -0.0873 + 0.0248 * b + 0.01 * p
    end = 0.5 - abs(u)
    k = np.floor((2.0 * a / end + b) * u + (mean + 0.5))
    sure = (end >= 0.07) & (v <= 0.42 - 4.2 / b)
    return k, sure, (v + 0.5) * (2.83 + 5.1 / b) * sd / (a / (end * end) + b)


@njit(nogil=True, cache=True, error_model="numpy")
def _first_attempts(work: Any, surfaces: Any, p: Any, seed: Any, first: Any, node: Any) -> None:
    """Proposed numbers, their uniforms, and what is to be compared with their probability: -1 if sure."""
    for i in range(surfaces):
        u, v = two_wide(seed, COUNTS, first + uint64(i), node, uint64(0))
        k, sure, w = _proposal(work[TRIALS + i], p, u, v)
        work[i] = k
        work[_UNIFORM + i] = u
        work[_WEIGHT + i] = -1.0 if sure else w


@njit(nogil=True, cache=True, error_model="numpy")
def _stirling(k: Any) -> Any:
    """Logarithm of ``k! / (sqrt(2 pi max(k, 1/(2 pi))) (k/e)^k)``."""
    if k < 16:
        return _ERRORS[int(k)]
    x = 1.0 / (k * k)
    return (1 / 12 - (1 / 360 - (1 / 1260 - (1 / 1680 - x / 1188) * x) * x) * x) / k


@njit(nogil=True, cache=True, error_model="numpy")
def _deviance(k: Any, d: Any) -> Any:
    """``k log(k/m) + m - k`` with m = k - d."""
    v = d / (k + (k - d))
    if abs(v) > 0.1:
        return k * math.log(k / (k - d)) - d if k else -d
    x = v * v
    series = 1 / 3 + x * (
        1 / 5 + x * (1 / 7 + x * (1 / 9 + x * (1 / 11 + x * (1 / 13 + x * (1 / 15 + x / 17)))))
    )
    return d * v + 2.0 * k * v * x * series


@njit(nogil=True, cache=True, error_model="numpy")
def _shortfall(n: Any, p: Any, k: Any) -> Any:
    """Logarithm of ``sqrt(n / (2 pi k (n - k)))`` over the probability of k, but for what k is not in."""
    d = k - n * p
    return _stirling(k) + _stirling(n - k) + _deviance(k, d) + _deviance(n - k, -d)


@njit(nogil=True, cache=True, error_model="numpy")
def _accepted(n: Any, p: Any, k: Any, w: Any) -> Any:
    """Whether w is no more than the probability of k over that of the most probable number."""
    if not 0 <= k <= n:
        return False
    mode = np.floor((n + 1.0) * p)
    root = max(k, _ZERO) * max(n - k, _ZERO) / (mode * (n - mode))
    return 0.5 * math.log(w * w * root) <= _shortfall(n, p, mode) - _shortfall(n, p, k)


@njit(nogil=True, cache=True, error_model="numpy")
def _again(n: Any, p: Any, seed: Any, surface: Any, node: Any) -> Any:
    """Repeat the rejection from the second attempt on."""
    attempt = uint64(1)
    while True:
        u, v = two_wide(seed, COUNTS, surface, node, attempt)
        k, sure, w = _proposal(n, p, u, v)
        if sure or _accepted(n, p, k, w):
            return k
        attempt += uint64(1)


@njit(nogil=True, cache=True, error_model="numpy")
def _inverse(n: Any, p: Any, log_q: Any, u: Any) -> Any:
    """Smallest number with a distribution function of at least u, or beyond which nothing counts."""
    k, odds, left, probability = 0.0, p / (1.0 - p), u, math.exp(n * log_q)
    while left > probability > _NOTHING:
        left -= probability
        k += 1.0
        probability *= (n - k + 1.0) / k * odds
    return min(k, n)


@njit(nogil=True, cache=True, error_model="numpy")
def binomials(work: Any, surfaces: Any, p: Any, seed: Any, first: Any, node: Any) -> None:
    """Draw a binomial number for each of some surfaces.

    Parameters
    ----------
    work : ndarray
        WORDS words: whole numbers of trials, at most 2^53, from TRIALS on. Leaves the numbers in front.
    surfaces : int
        How many, at most SURFACES.
    p : float
        Probability, at most 1/2.
    seed : int
        The scene's.
    first : int
        Number of the first surface.
    node : int
        Which number of a surface: the draws are a pure function of seed, surface and node.
    """
    _first_attempts(work, surfaces, p, seed, first, node)
    log_q = math.log1p(-p)
    for i in range(surfaces):
        k, u, w, n = work[i], work[_UNIFORM + i], work[_WEIGHT + i], work[TRIALS + i]
        if n * p < _SMALL:
            work[i] = _inverse(n, p, log_q, u + 0.5)
        elif w >= 0 and not _accepted(n, p, k, w):
            work[i] = _again(n, p, seed, first + uint64(i), node)
