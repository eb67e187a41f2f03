"""Where to cut between two separations, so that drawing a surface costs the least.

A cell takes time to begin, and each of its asperities the more, the more moments are needed. How many
depends on how far the cell is from the root of the nearest law of contact: cells as wide as their
distance to the next separation below need about fifteen, cells half as wide ten. So cells grow
geometrically from a separation upwards, and how fast, and to how many, is chosen for each gap.
"""

import math
from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from analytic import HeightLaw

__all__ = ["SURE", "Gap", "cuts", "price"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

SURE = 400  # so many expected contacts are never fewer than half
_DIGITS = 11.4  # that the moments must give, of a law or of the sum of a surface
_GROWTHS = (2.0, 1.8, 1.6, 1.5, 1.45, 1.4, 1.3, 1.2)  # with 2 each cell is as wide as it may be
_MORE = 8  # cells than the fewest possible

# Prices, in asperities that give ten moments; found when the loops took eight numbers at a time. They
# take four now, and `runs/bench/prices.py` finds cells cheaper and many moments dearer, by up to a half.
# Other prices would make other cells, and so other draws.
_CELL, _TWO_MORE, _FIVE_MORE, _ROOT, _FIVE_ROOTS_MORE = 250.0, 0.1, 0.25, 0.3, 0.2


class Gap(NamedTuple):
    """Heights from a separation, or from a break of the contact law, to the next one.

    Attributes
    ----------
    low, high : float
        Its ends.
    before : float
        Distance from `low` to the separation below, infinite if there is none.
    root : bool
        Whether contacts begin at `low`.
    """

    low: float
    high: float
    before: float
    root: bool = True

    @property
    def fewest(self) -> int:
        """Cells that it takes if each is as wide as it may be."""
        return 1 + math.ceil(max(math.log2(self.high - self.low) - math.log2(self.before), 0.0) - 1e-9)


def cuts(law: HeightLaw, n: int, gaps: Sequence[Gap]) -> list[Array]:
    """Cut gaps into cells.

    Parameters
    ----------
    law : HeightLaw
        Of the heights.
    n : int
        Asperities of a surface; none asks for the fewest cells.
    gaps : sequence of Gap
        What to cut.

    Returns
    -------
    list of ndarray
        Edges from `low` to `high` of each gap, those that need as many cells together. No cell is wider than
        its distance to the nearest separation below.
    """
    alike: dict[int, list[Gap]] = {}
    for gap in gaps:
        alike.setdefault(gap.fewest, []).append(gap)
    return [edges for fewest, some in alike.items() for edges in _cut(law, n, some, _ladders(fewest))]


def _cut(law: HeightLaw, n: int, gaps: list[Gap], upper: Array) -> list[Array]:
    """Cut gaps, each by the cheapest of the ladders: arrays are (gaps, ladders, cells)."""
    low, high, before, root = (np.array(part)[:, None, None] for part in zip(*gaps, strict=True))
    length = high - low
    width = np.diff(upper, axis=1, prepend=0.0)
    first = np.where(root, before / length, upper - width + before / length)
    distance = np.where(root & (upper > width), upper - width, first)
    allowed = (width <= distance * (1 + 1e-9)).all(axis=2)
    prices = np.where(allowed, _prices(law, n, low, length, upper, distance, root), np.inf)
    cheapest = np.argmax(prices <= prices.min(axis=1, keepdims=True) * (1 + 1e-9), axis=1)
    found = []  # the first one of the cheapest: rounding breaks no tie
    for gap, best in zip(gaps, cheapest.tolist(), strict=True):
        inner = upper[best][width[best] > 0][:-1]
        found.append(np.concatenate([[gap.low], gap.low + (gap.high - gap.low) * inner, [gap.high]]))
    return found


@cache
def _ladders(fewest: int) -> Array:
    """Upper edges of the cells of a gap of length 1: each row a choice, unused cells first and empty."""
    most = fewest + _MORE
    rows = []
    for growth in _GROWTHS:
        rungs = np.cumprod([1.0, *[1 / growth] * (most - 1)])[::-1]  # the same bits on every processor
        for parts in range(fewest, most + 1):
            rows.append(np.where(np.arange(most) >= most - parts, rungs, 0.0))
    return np.array(rows)


def _prices(
    law: HeightLaw, n: int, low: Array, length: Array, upper: Array, distance: Array, root: NDArray[np.bool_]
) -> Array:
    """What the asperities of a surface cost for each choice of cells."""
    width = np.diff(upper, axis=1, prepend=0.0)
    edges, used = low + length * np.insert(upper, 0, 0.0, axis=1), width > 0
    beyond = law.above(edges)
    start, above = edges[..., :-1], beyond[..., :-1]
    expected = n * np.where(used, above - beyond[..., 1:], 0.0)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        bend = np.nan_to_num(np.abs(law.log_ratio(start, length * width)), nan=np.inf)
        # Of a surface's sum, rather than of the law, where so many touch that it is sure to be large.
        reach = length * (np.where(np.isfinite(distance), distance, 0.0) + width)
        part = np.where(n * above > SURE, expected / (n * above) * np.sqrt(reach), 1.0)
        digits = _DIGITS + np.log10(part)
        plain = digits / _rate(np.minimum(1 + 2 * distance / width, 2 / bend))
        rooted = 1 + digits / _rate(2 / bend)
    first = used & (upper == width) & root
    each = price(plain, np.where(first, rooted, 0.0))
    return np.asarray((np.where(used, _CELL + expected * each, 0.0)).sum(axis=2))


def price(plain: Array | Ints, rooted: Array | Ints) -> Array:
    """What an asperity costs that gives so many moments: 1 for ten plain ones."""
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
