"""Gauss rules on pieces of the heights, which of them count under a law, and how wide they are.

Contacts begin and end with powers of the distance, whole or broken, and next to a height where others began.
So places on a piece go as the fourth power of the variable at both ends, in which Gauss-Legendre converges.
On a piece the density of the law is one smooth curve: it is at most six spans of the law wide, ends at every
break, and shrinks towards ends where the density is a broken power. The normal law is entire: its pieces have
one width. Means and variances underflow with its density, beyond h = 37.
"""

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import cache

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.gradings import Grading
from analytic.heights import Gaussian, HeightLaw
from analytic.measured_summits import MeasuredHeights

NODES = 64  # of a piece
SPANS = 6.0  # of a law in it: a density that changes by a factor of 50 over a piece needs some 30 nodes
WIDEST = 4.0  # piece, on which they resolve the normal density as far down as s = -40
REACH = 13.0  # no lower or rarer normal height counts: 2e-37 of the density, times a modulus up to exp(3|s|)
POWER = 4  # of the modulus in the kurtosis
_GROWTH = 8.0  # of the pieces away from a singular end
_TINY = 1e-14  # distance from such an end, below which heights are not told apart
_STEP = 2e-3  # of differences: where the mean has 12 digits, those of the slope are off by 1e-9 of the mean
_NOTHING = -76.0  # logarithm of a density over its largest value, that counts in no sum: looked for at
_OUTWARDS = np.sort(np.concatenate([[0.0], np.geomspace(1e-3, 1e12, 200), np.geomspace(0.1, 1e3, 200)]))
_UP_TO_END = 1 - np.append(np.geomspace(1, 1e-12, 200), 0.0)  # distances, here shares of a bounded range
_LOST = 40.0  # logarithm of the weight lost outside: 4e-18 of its largest value
_FARTHER, _MOST_STEPS = 1.1, 1000  # an end is looked for so many times as far, up to 1e38 times
_ALONG = np.sort(np.append(np.linspace(0, 1, 65), np.geomspace(1e-4, 1, 65)[:-1]))
_RARE = 1e-37  # a share that no sampler draws
_SUMS = ((4, 0.0), (3, 0.0), (2, 0.0), (1, 3.0))  # powers of the modulus and of the approach in moments
_GRID = 16  # the upper end is rounded up to one over this


@cache
def gauss_legendre(nodes: int) -> tuple[Array, Array]:
    """Points and weights, read-only."""
    x, w = leggauss(nodes)
    x, w = (1 + x) / 2, w / w.sum()
    x.flags.writeable = w.flags.writeable = False
    return x, w


@cache
def towards_both_ends(nodes: int) -> tuple[Array, Array]:
    """Places and weights from 0 to 1, of a function that may have broken powers of the distance from both."""
    x, w = gauss_legendre(nodes)
    return x**4 * (35 - 84 * x + 70 * x**2 - 20 * x**3), 140 * w * (x * (1 - x)) ** 3


def panelled(edges: Array) -> tuple[Array, Array]:
    """Points and weights, (64 m, n), of Gauss rules between edges that increase along the first axis."""
    x, w = gauss_legendre(NODES)
    width = np.diff(edges, axis=0)
    some = width.any(axis=1)  # pieces that have a width in a column
    width = width[some][:, None]
    points = edges[:-1][some][:, None] + width * x[:, None]
    return points.reshape(-1, edges.shape[1]), (width * w[:, None]).reshape(-1, edges.shape[1])


def in_pieces(left: Array, right: Array, nodes: int = NODES) -> tuple[Array, Array]:
    """Points, all inside their piece, and weights of `towards_both_ends` on k pieces, shape (k nodes,)."""
    place, weight = towards_both_ends(nodes)
    left, width = left[:, None], (right - left)[:, None]
    last = np.nextafter(left + width, left)
    near_left = np.minimum(left + width * place, last)
    near_right = np.maximum(np.minimum(right[:, None] - width * place[::-1], last), left)
    return np.where(place < 0.5, near_left, near_right).ravel(), (width * weight).ravel()


def ends_of(
    law: HeightLaw, separations: Array, grading: Grading, power: float = POWER, exponent: float = 0.0
) -> tuple[float, float]:
    """Range of the rule: from the lowest separation, or height there is, to where nothing is left."""
    low, high = max(float(separations[0]), law.support[0]), law.support[1]
    if not low < high:
        return low, high
    first, last = np.clip(np.maximum(separations[[0, -1]], 0.0), low, high).tolist()

    def reach(start: float, limit: float) -> float:
        """Return the height beyond which nothing is left, up or down to a limit."""
        if start == limit:
            return limit
        way, room = (1 if limit > start else -1), abs(limit - start)
        away = np.union1d(_OUTWARDS[room > _OUTWARDS], room * _UP_TO_END) if room < np.inf else _OUTWARDS
        density = law.log_pdf(start + way * away)
        counts = np.flatnonzero(density > density[density < np.inf].max(initial=-np.inf) + _NOTHING)
        end = far = float(away[min(counts.max(initial=-1) + 1, away.size - 1)])
        for _ in range(_MOST_STEPS):
            s = start + way * far * _ALONG
            with np.errstate(divide="ignore"):
                modulus = power * np.log(np.abs(grading(s)))
                weight = law.log_pdf(s) + modulus + exponent * np.log1p(np.abs(s - low))
            enough = far == room or not weight[-1] > weight.max() - _LOST
            if modulus.max() > steepest and not (enough and far == end):
                break
            if enough:
                return limit if far == room else start + way * far
            far = min(_FARTHER * far, room)
        raise ValueError(
            f"grading: up to s = {start + way * far:.4g} E*(s)/E* increases too steeply, or the tail of the "
            "heights is too heavy, for a mean and a variance in double precision; let the grading level off"
        )

    steepest = 700.0 - 25.0 * power  # leaves room for the power of the approach
    return reach(first, low), reach(last, high)


def regular_edges(law: HeightLaw, start: float, top: float) -> list[float]:
    """Return ends of pieces from `start` to `top`, as wide as the density lets each piece be."""
    if isinstance(law, Gaussian):
        return [start, *WIDEST * np.arange(np.floor(start / WIDEST) + 1, np.ceil(top / WIDEST)), top]
    edges = [start]
    for mark in [*(b for b in law.breaks if start < b < top), top]:
        while (a := edges[-1]) < mark:
            step = min(SPANS * law.span(a), max(WIDEST, abs(a)))
            for end in law.singular:
                widest = (_GROWTH - 1) * (a - end) if end <= a else (1 - 1 / _GROWTH) * (end - a)
                step = min(step, max(widest, _TINY * max(1.0, abs(a))))
            edges.append(min(a + step, mark))
    return edges


def extent(grading: Grading, heights: HeightLaw, separations: Sequence[float]) -> tuple[float, float]:
    """Return the lowest and highest height that may touch, or count in a moment, at some separations.

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
        second but one in 1e37.

    Examples
    --------
    >>> from analytic import Custom, Gaussian
    >>> low, high = extent(Custom(np.tanh), Gaussian(), [0.0, 4.0])
    >>> low, 13 < high < 15
    (0.0, True)
    """
    h = np.unique(np.asarray(separations, dtype=np.float64))
    low = max(float(h[0]), float(heights.ppf(np.array(_RARE))), heights.support[0])
    high = max(float(heights.isf(np.array(_RARE), start)) for start in (-math.inf, h[-1]))
    for power, exponent in () if isinstance(heights, MeasuredHeights) else _SUMS:
        with suppress(ValueError):  # its message is for those who ask for this moment
            ends = ends_of(heights, h, grading, power, exponent)
            low, high = min(low, max(ends[0], float(h[0]))), max(high, ends[1])
            break
    high = min(math.ceil(_GRID * high) / _GRID, heights.support[1])
    return (low, high) if low < high else (low, low + 1.0)


def fall_of(mean: Callable[[Array], Array], h: ArrayLike) -> Array:
    """How fast a mean falls with the separation, by differences of the fourth order; in the shape of `h`."""
    h = np.asarray(h, dtype=np.float64)
    step = _STEP / (1 + np.abs(h))
    lower2, lower, upper, upper2 = mean(h + np.multiply.outer([-2, -1, 1, 2], step))
    return np.asarray((8 * (lower - upper) - (lower2 - upper2)) / (12 * step))
