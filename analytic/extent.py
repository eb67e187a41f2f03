"""The heights that count in a simulation and in its theory: the range over which a grading is resolved."""

import math
from collections.abc import Sequence

import numpy as np

from analytic.arrays import Array
from analytic.gradings import Grading
from analytic.heights import HeightLaw
from analytic.law_rule import ends_of
from analytic.measured_summits import MeasuredHeights

_RARE = (1e-37, 1e-32, 1e-24)  # a share that no sampler draws; others where a law cannot tell
_SURE = 1e-16  # up to such a rare height a grading must have values
_SUMS = ((4, 0.0), (3, 0.0), (2, 0.0), (1, 3.0))  # powers of the modulus and of the approach in moments
_LARGEST = 1e300
_GRID = 16  # the upper end is rounded up to one over this


def extent(grading: Grading, heights: HeightLaw, separations: Sequence[float]) -> tuple[float, float]:
    """Lowest and highest height that may touch, or count in a moment, at some separations.

    Parameters
    ----------
    grading : Grading
        E*(s)/E*. Where it rises steeply, rarer heights count; it is not asked below the lowest separation.
    heights : HeightLaw
        Law of the reduced heights.
    separations : sequence of float
        Reduced separations.

    Returns
    -------
    (float, float)
        The first is the lowest separation, or a height that is never fallen below. No height is above the
        second but one in 1e37, or, where the grading has no values up there, one in 1e16.

    Examples
    --------
    >>> from analytic import Custom, Gaussian
    >>> low, high = extent(Custom(np.tanh), Gaussian(), [0.0, 4.0])
    >>> low, 13 < high < 15
    (0.0, True)
    """
    h = np.unique(np.asarray(separations, dtype=np.float64))
    end = heights.support[1]
    sure = min(max(_above(heights, _SURE, -math.inf), h[-1] + 1), end)
    bottom = max(float(heights.ppf(np.array(_RARE[0]))), heights.support[0])
    low = max(float(h[0]), bottom)
    high = max([sure, *(_above(heights, _RARE[0], start) for start in (-math.inf, h[-1]))])
    if not isinstance(heights, MeasuredHeights):
        ends = _of_moments(grading, heights, h)
        low, high = min(low, max(ends[0], float(h[0]))), max(high, ends[1])
    high = min(math.ceil(_GRID * high) / _GRID, end)
    return (low, _valued(grading, sure, high)) if low < high else (low, low + 1.0)


def _above(heights: HeightLaw, share: float, start: float) -> float:
    """Height at a share of those above `start`, or at the rarest one that the law can tell."""
    for rare in (share, *(r for r in _RARE if r > share)):
        with np.errstate(all="ignore"):
            found = float(heights.isf(np.array(rare), start))
        if math.isfinite(found):
            return found
    return -math.inf


def _of_moments(grading: Grading, heights: HeightLaw, h: Array) -> tuple[float, float]:
    """Range of the highest moments that there are in double precision."""
    for power, exponent in _SUMS:
        try:
            return ends_of(heights, h, grading, power, exponent)
        except ValueError:  # its message is for those who ask for this moment
            continue
    return math.inf, -math.inf


def _valued(grading: Grading, sure: float, high: float) -> float:
    """How far up to `high` the grading has values, and at least up to `sure`."""
    if not sure < high:
        return high
    far = np.unique([sure, high, *np.linspace(sure, min(high, sure + 64), 257), *np.geomspace(1, high, 64)])
    far = far[(sure <= far) & (far <= high)]
    if _has_values(grading, far):
        return high
    first = next((k for k in range(1, far.size) if not _has_values(grading, far[k : k + 1])), far.size)
    return float(far[first - 1])


def _has_values(grading: Grading, s: Array) -> bool:
    try:
        return bool(np.all(np.abs(grading(s)) < _LARGEST))
    except ValueError:
        return False
