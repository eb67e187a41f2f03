"""Where to cut between two separations, so that drawing a surface costs the least.

A cell takes time to begin, and each of its asperities the more, the more moments are needed. How many
depends on how far the cell is from the root of the nearest law of contact: cells as wide as their
distance to the next separation below need about fifteen, cells half as wide ten. So cells grow
geometrically from a separation upwards, and how fast, and to how many, is chosen for each gap.
"""

from bisect import bisect_left
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from analytic import HeightLaw
from analytic.arrays import Array, Ints

DIGITS = 11.4  # that moments must give for values to the last digit: of a law, or of the sum of a surface
SURE = 400  # so many expected contacts are never fewer than half
_GROWTHS = (2.0, 1.8, 1.6, 1.5, 1.45, 1.4, 1.3, 1.2)  # with 2 each cell is as wide as it may be
_MORE = 8  # cells than the fewest possible
_ROUNDING = 1e-9  # of the width of a cell
_FAR, _NARROWER = 2.0, 0.75  # spans from a root of the laws of contact, and what is left of one nearer by
_TIE = 1e-9  # share of a price that is no difference

# Prices, in asperities that give ten moments; found when the loops took eight numbers at a time. They
# take four now, and `runs/bench/prices.py` finds cells cheaper and many moments dearer, by up to a half.
# Other prices would make other cells, and so other draws.
_CELL, _TWO_MORE, _FIVE_MORE, _ROOT, _FIVE_ROOTS_MORE = 250.0, 0.1, 0.25, 0.3, 0.2


def _widest(law: HeightLaw, a: float, distance: float) -> float:
    """How wide the law of heights lets a cell above `a` be: less, where a law of contact bends as well."""
    width = law.span(a)
    if distance < _FAR * width:
        width *= _NARROWER
    for end in law.singular:
        width = min(width, a - end if end < a else (end - a) / 2)
    return width


def spaced(law: HeightLaw, n: int, begins: Array, breaks: Array, marks: Array) -> Array:
    """Return marks, and cells where contacts begin or change their law such that drawing costs the least."""
    low = marks[:-1]
    k = np.searchsorted(begins, low)
    root = begins[np.minimum(k, len(begins) - 1)] == low
    before = low - np.concatenate([[-np.inf], begins])[k]
    some = root | (np.isin(low, breaks) & np.isfinite(before))
    gaps = Gaps(low[some], marks[1:][some], before[some], root[some])
    return np.unique(np.concatenate([marks, cuts(law, n, gaps)]))


def refined(law: HeightLaw, begins: Array, marks: Array) -> Array:
    """Edges from mark to mark, each cell as wide as the law and the contacts that begin below let it be."""
    lows, edges = [-np.inf, *begins.tolist()], marks[:1].tolist()
    for mark in marks[1:].tolist():
        while (a := edges[-1]) < mark:
            distance, room = a - lows[bisect_left(lows, a) - 1], mark - a
            widest = min(distance, _widest(law, a, distance))
            if room <= widest * (1 + _ROUNDING):
                edges.append(mark)
            else:
                edges.append(a + (widest if room >= 2 * widest else room / 2))
    return np.array(edges)


@dataclass(frozen=True)
class Gaps:
    """Heights from separations, or from breaks of the contact law, to the next ones: one an array element."""

    low: Array  # where each begins
    high: Array  # and ends
    before: Array  # distance from `low` to the separation below, infinite if there is none
    root: NDArray[np.bool_]  # whether contacts begin at `low`

    @property
    def fewest(self) -> Ints:
        """Cells that each takes if they are as wide as they may be."""
        halvings = np.log2(self.high - self.low) - np.log2(self.before)
        return np.asarray(1 + np.ceil(np.maximum(halvings, 0.0) - 1e-9), dtype=np.int64)

    def take(self, which: NDArray[np.bool_]) -> "Gaps":
        """Return some of them."""
        return Gaps(self.low[which], self.high[which], self.before[which], self.root[which])


@dataclass(frozen=True)
class _Cells:
    """Cells that might be: starts, widths, distances to the root below, shares of heights above both ends."""

    start: Array
    width: Array
    distance: Array
    above: Array
    beyond: Array

    @property
    def allowed(self) -> NDArray[np.bool_]:
        """Whether they are no wider than their distance to the next separation below."""
        return np.asarray(self.width <= self.distance * (1 + 1e-9))


def cuts(law: HeightLaw, n: int, gaps: Gaps) -> Array:
    """Return where to cut the gaps, for surfaces of `n` asperities; none asks for the fewest cells.

    No cell is wider than its distance to the nearest separation below.
    """
    found, fewest = [np.empty(0)], gaps.fewest
    for number in np.unique(fewest).tolist():
        some = gaps.take(fewest == number)
        if number == 1:
            some = some.take(_worth_cutting(law, n, some))
        found.append(_cut(law, n, some, number))
    return np.concatenate(found)


def _worth_cutting(law: HeightLaw, n: int, gaps: Gaps) -> NDArray[np.bool_]:
    """Whether two cells might cost less than one, if an asperity in them cost the least there is: 1."""
    above, beyond = law.sf(gaps.low), law.sf(gaps.high)
    whole = _Cells(gaps.low, gaps.high - gaps.low, gaps.before, above, beyond)
    two = 2 * _CELL + n * (above - beyond)
    return np.asarray(_prices(law, n, whole, gaps.root) > two * (1 - _TIE))


def _cut(law: HeightLaw, n: int, gaps: Gaps, fewest: int) -> Array:
    """Cut gaps that need so many cells: arrays are (gaps, growths, cells), the highest cell first."""
    low, high, before = (part[:, None, None] for part in (gaps.low, gaps.high, gaps.before))
    root = gaps.root[:, None, None]
    length, rungs = high - low, _rungs(fewest + _MORE)
    heights = low + length * rungs
    above, least = law.sf(heights), law.sf(low)
    upper = _Cells(
        start=heights[..., 1:],
        width=length * -np.diff(rungs),
        distance=length * rungs[:, 1:] + np.where(root, 0.0, before),
        above=above[..., 1:],
        beyond=above[..., :-1],
    )
    lowest = _Cells(low, length * rungs[:, fewest - 1 :], before, least, above[..., fewest - 1 :])
    uppers = np.cumsum(np.where(upper.allowed, _prices(law, n, upper, np.False_), np.inf), axis=2)
    uppers = np.concatenate([np.zeros((*uppers.shape[:2], 1)), uppers], axis=2)[..., fewest - 1 :]
    prices = uppers + np.where(lowest.allowed, _prices(law, n, lowest, root), np.inf)
    prices = prices.reshape(len(prices), len(_GROWTHS) * (_MORE + 1))
    cheapest = np.argmax(prices <= prices.min(axis=1, keepdims=True, initial=np.inf) * (1 + _TIE), axis=1)
    growth, more = np.divmod(cheapest, _MORE + 1)  # the first one of the cheapest: rounding breaks no tie
    chosen = heights[np.arange(len(prices)), growth]
    return np.asarray(chosen[:, 1:][np.arange(1, fewest + _MORE) < (fewest + more)[:, None]])


@cache
def _rungs(most: int) -> Array:
    """Upper edges of so many cells in a gap of length 1 for each growth, the highest first."""
    return np.array([np.cumprod([1.0, *[1 / growth] * (most - 1)]) for growth in _GROWTHS])


def _prices(law: HeightLaw, n: int, cells: _Cells, root: NDArray[np.bool_] | np.bool_) -> Array:
    """Return what the asperities of a surface cost in each cell; contacts begin where it starts, or not."""
    plain, rooted = _orders(law, n, cells, root)
    return np.asarray(_CELL + n * (cells.above - cells.beyond) * price(plain, rooted))


def _orders(law: HeightLaw, n: int, cells: _Cells, root: NDArray[np.bool_] | np.bool_) -> tuple[Array, Array]:
    """How many T_j and R_j each cell should need: no whole numbers."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        bend = np.nan_to_num(np.abs(law.log_ratio(cells.start, cells.width)), nan=np.inf)
        # Of a surface's sum, rather than of the law, where so many touch that it is sure to be large.
        touching, expected = n * cells.above, n * (cells.above - cells.beyond)
        reach = np.where(np.isfinite(cells.distance), cells.distance, 0.0) + cells.width
        share = np.log10(np.where(touching > SURE, expected / touching * np.sqrt(reach), 1.0))
        plain = (DIGITS + share) / _rate(np.minimum(1 + 2 * cells.distance / cells.width, 2 / bend))
        rooted = np.where(root, 1 + (DIGITS + share) / _rate(2 / bend), 0.0)
    return plain, rooted


def expected_orders(law: HeightLaw, n: int, begins: Array, edges: Array) -> tuple[Ints, Ints]:
    """Return about how many T_j and R_j each cell will need, before any law is resolved on it.

    Contacts begin at `begins`, cells at `edges`, which increase.
    """
    low, above = edges[:-1], law.sf(edges)
    k = np.searchsorted(begins, low)
    before = low - np.concatenate([[-np.inf], begins])[k]
    root = np.append(begins, np.inf)[k] == low
    cells = _Cells(low, np.diff(edges), before, above[:-1], above[1:])
    plain, rooted = (np.maximum(np.ceil(x), 0.0) for x in _orders(law, n, cells, root))
    return np.maximum(plain, 1.0).astype(np.int64), rooted.astype(np.int64)


def price(plain: Array | Ints, rooted: Array | Ints) -> Array:
    """Return what an asperity costs that gives so many moments: 1 for ten plain ones."""
    roots = np.where(rooted > 0, _ROOT + _FIVE_ROOTS_MORE * _steps(rooted - 6), 0.0)
    more = np.where(plain > 12, _FIVE_MORE * _steps(plain - 10), _TWO_MORE * (plain > 10))
    return np.asarray(1 + more + roots)


def _rate(z: Array) -> Array:
    """Digits that a Chebyshev series gains a term, with the nearest singularity at -z."""
    z = np.clip(z, 1.05, 1e6)
    return np.asarray(np.log10(z + np.sqrt(z * z - 1)))


def _steps(moments: Array | Ints) -> Array:
    """How many times five."""
    return np.asarray(np.ceil(np.clip(moments, 0, 100) / 5))
