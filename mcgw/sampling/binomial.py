"""Binomial numbers, one for each surface of a block.

Transformed rejection with a squeeze: BTRS of W. Hörmann, "The generation of binomial random variates",
J. Stat. Comput. Simul. 46 (1993) 101. Two attempts in three need a comparison, the others the ratio of two
probabilities. Below a mean of 28 the distribution is inverted. All this runs over the vector unit, for the
surfaces that are still without a number; only a few far from the mean are gone through one by one.

How probable a number is, against the most probable one: C. Loader's "Fast and accurate computation
of binomial probabilities" (2000): a binomial number is off its mean by so many standard deviations and no
more, so no large logarithms are taken from each other. Near the mean there are series.

A thread's workspace is one array of six parts, 64 words each, one for each of 64 surfaces::

    part        while numbers are proposed and rejected        while the distribution is inverted
    (first)     result                                         result
    TRIALS      numbers of trials                              numbers of trials
    _SURFACE    surface that is pending
    _PENDING    its number of trials
    _PROPOSED   the number proposed                            _LEFT: of the uniform
    _WEIGHT     what its probability is compared with          _PROBABILITY: of the result so far
"""

import math
from typing import Any

import numpy as np
from numba import uint64

from mcgw.machine.compiling import njit
from mcgw.sampling.exp_log import exp_minus, log, log_one_minus
from mcgw.sampling.philox import COUNTS, two_wide

SURFACES = 64  # at a time, whoever asks for more of them
TRIALS, _SURFACE, _PENDING, _PROPOSED, _WEIGHT, WORDS = (SURFACES * part for part in range(1, 7))
_LEFT, _PROBABILITY = _PROPOSED, _WEIGHT
_VECTOR = 8  # numbers that the vector unit takes at a time

_SMALL = 28.0  # mean, below which inversion is as fast; the rejection is proven from 10 on
_NOTHING = 1e-18  # a probability that no uniform can show; every q^n with so small a mean is larger
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


@njit(inline="always")
def _stirling(k: Any) -> Any:
    """Logarithm of ``k! / (sqrt(2 pi k) (k/e)^k)`` for k >= 16."""
    r = 1.0 / k
    x = r * r
    return (1 / 12 - (1 / 360 - (1 / 1260 - (1 / 1680 - x * (1 / 1188)) * x) * x) * x) * r


@njit(inline="always")
def _deviance(k: Any, d: Any) -> Any:
    """``k log(k/m) + m - k`` with m = k - d, and whether m is near enough for the series."""
    v = d / (k + (k - d))
    x = v * v
    series = 0.0
    for j in range(14, -1, -1):
        series = series * x + 1 / (2 * j + 3)
    return d * v + 2.0 * k * v * x * series, abs(v) <= _NEAR


@njit(inline="always")
def _shortfall(n: Any, p: Any, k: Any) -> Any:
    """Logarithm of ``sqrt(n / (2 pi k (n - k)))`` over the probability of k, and whether the series serve."""
    d = k - n * p
    (hit, near), (miss, near_too) = _deviance(k, d), _deviance(n - k, -d)
    return _stirling(k) + _stirling(n - k) + hit + miss, near & near_too & (k >= _LOWEST) & (n - k >= _LOWEST)


@njit(inline="always")
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


@njit(inline="always")
def ratio_over_mode(n: Any, p: Any, k: Any) -> Any:
    """Probability of k over that of the most probable number, and whether the series serve."""
    mode = np.floor((n + 1.0) * p)
    (most, known), (here, known_too) = _shortfall(n, p, mode), _shortfall(n, p, k)
    ratio = _power(min(here - most, _FAR)) * np.sqrt(mode * (n - mode) / (k * (n - k)))
    return ratio, known & known_too


@njit()
def _shortfall_anywhere(n: Any, p: Any, k: Any) -> Any:
    """As `_shortfall`, with 1/(2 pi) in place of a number of zero."""
    total = 0.0
    for number, d in ((k, k - n * p), (n - k, n * p - k)):
        total += _stirling(number) if number >= _LOWEST else _ERRORS[int(number)]
        value, near = _deviance(number, d)
        total += value if near else (number * log(number / (number - d)) if number else 0.0) - d
    return total


@njit()
def below_ratio(w: Any, n: Any, p: Any, k: Any) -> Any:
    """Whether w is no more than the probability of k over that of the most probable number, for any k."""
    if not 0 <= k <= n:
        return False
    mode = np.floor((n + 1.0) * p)
    root = max(k, _ZERO) * max(n - k, _ZERO) / (mode * (n - mode))
    return 0.5 * log(w * w * root) <= _shortfall_anywhere(n, p, mode) - _shortfall_anywhere(n, p, k)


@njit(inline="always")
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


@njit()
def _propose(work: Any, m: Any, p: Any, seed: Any, first: Any, node: Any, attempt: Any) -> None:
    """Propose numbers; leave what is to be compared with their probability, -1 if they are sure."""
    for i in range(m):
        u, v = two_wide(seed, COUNTS, first + uint64(work[_SURFACE + i]), node, attempt)
        k, sure, w = _proposal(work[_PENDING + i], p, u, v)
        work[_PROPOSED + i] = k
        work[_WEIGHT + i] = -1.0 if sure else w


@njit()
def _judge(work: Any, m: Any, p: Any) -> None:
    """Turn weights to -1 where the proposed number is accepted, else to infinity."""
    for i in range(m):
        w = work[_WEIGHT + i]
        ratio, known = ratio_over_mode(work[_PENDING + i], p, work[_PROPOSED + i])
        work[_WEIGHT + i] = (-1.0 if w <= ratio else np.inf) if known else w
    for i in range(m):
        w = work[_WEIGHT + i]
        if 0.0 <= w < np.inf:
            below = below_ratio(w, work[_PENDING + i], p, work[_PROPOSED + i])
            work[_WEIGHT + i] = -1.0 if below else np.inf


@njit()
def _settle(work: Any, m: Any) -> Any:
    """Write down what is accepted, gather the others, and count them."""
    left = 0
    for i in range(m):  # without a branch: what is not accepted is overwritten in the end
        surface, n, k, w = work[_SURFACE + i], work[_PENDING + i], work[_PROPOSED + i], work[_WEIGHT + i]
        work[np.uint64(surface)] = k
        at = np.uint64(left)
        work[at + np.uint64(_SURFACE)], work[at + np.uint64(_PENDING)] = surface, n
        work[at + np.uint64(_PROPOSED)], work[at + np.uint64(_WEIGHT)] = k, w
        left += w != -1.0
    return left


@njit()
def _filled(work: Any, m: Any) -> Any:
    """Round up to full vectors, with copies of the first."""
    filled = (m + _VECTOR - 1) // _VECTOR * _VECTOR
    for i in range(m, filled):
        for part in (_SURFACE, _PENDING, _PROPOSED, _WEIGHT):
            work[part + i] = work[part]
    return filled


@njit()
def _reject(work: Any, left: Any, p: Any, seed: Any, first: Any, node: Any) -> None:
    """Propose numbers for the surfaces that are pending until all are accepted."""
    attempt = uint64(0)
    while left:
        _propose(work, _filled(work, left), p, seed, first, node, attempt)
        left = _settle(work, left)
        _judge(work, _filled(work, left), p)
        left = _settle(work, left)
        attempt += uint64(1)


@njit()
def _invert(work: Any, surfaces: Any, p: Any) -> None:
    """Smallest number with a distribution function of `_LEFT` at least, or beyond which nothing counts."""
    log_q, odds = log_one_minus(p), p / (1.0 - p)
    for i in range(surfaces):
        n = work[TRIALS + i]
        work[i] = 0.0
        work[_PROBABILITY + i] = exp_minus(-n * log_q) if n * p < _SMALL else 0.0
    going = True
    while going:
        going = False
        for i in range(surfaces):
            n, k, left, probability = work[TRIALS + i], work[i], work[_LEFT + i], work[_PROBABILITY + i]
            more = (left > probability) & (probability > _NOTHING) & (k < n)
            k = k + 1.0 if more else k
            work[i] = k
            work[_LEFT + i] = left - probability if more else left
            work[_PROBABILITY + i] = probability * ((n - k + 1.0) / k * odds) if more else probability
            going |= more


@njit(cache=True)
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
    left = 0
    for i in range(surfaces):
        n = work[TRIALS + i]
        if n * p >= _SMALL:
            work[_SURFACE + left], work[_PENDING + left] = i, n
            left += 1
    if left < surfaces:
        for i in range(surfaces):
            work[_LEFT + i] = two_wide(seed, COUNTS, first + uint64(i), node, uint64(0))[0] + 0.5
        _invert(work, surfaces, p)
    _reject(work, left, p, seed, first, node)
