"""Where to cut between two separations, so that drawing a surface costs the least.

A cell takes time to begin, and each of its asperities the more, the more moments are needed. How many
depends on how far the cell is from the root of the nearest law of contact: cells as wide as their
distance to the next separation below need about fifteen, cells half as wide ten. So cells grow
geometrically from a separation upwards, and how fast, and to how many, is chosen for each gap.
"""

import math
from bisect import bisect_left
from collections.abc import Sequence
from typing import Any

import numpy as np

from analytic import HeightLaw, bends
from analytic.arrays import Array, Ints
from mcgw.machine.process import kept
from mcgw.sampling.stretches import begins_and_breaks
from mcgw.scene.scene import Scene

DIGITS = 11.4  # that moments must give for values to the last digit: of a law, or of the sum of a surface
SURE = 400  # so many expected contacts are never fewer than half
_GROWTHS = (2.0, 1.8, 1.6, 1.5, 1.45, 1.4, 1.3, 1.2)  # with 2 each cell is as wide as it may be
_MORE = 8  # cells than the fewest possible
_ROUNDING = 1e-9  # of the width of a cell
_FAR, _NARROWER = 2.0, 0.75  # spans from a root of the laws of contact, and what is left of one nearer by
_TIE = 1e-9  # share of a price that is no difference
_RARE = 0.1  # asperities a surface that may be expected beyond the cells, on either side
_CLOSEST = 2.0**-40  # of a cell to an end of the support that is a broken power

# Prices, in asperities that give ten moments; found when the loops took eight numbers at a time. They
# take four now, and `runs/bench/prices.py` finds cells cheaper and many moments dearer, by up to a half.
# Other prices would make other cells, and so other draws.
_CELL, _TWO_MORE, _FIVE_MORE, _ROOT, _FIVE_ROOTS_MORE = 250.0, 0.1, 0.25, 0.3, 0.2


def edges_before_grading(scene: Scene, given: Sequence[float] = (), *, split: bool = True) -> Array:
    """Return the edges of the cells of `mesh_of` before those of a grading with kinks; none: no cell."""
    law = scene.heights
    low, high = _range(law, _RARE / scene.n_asperities)
    low = max(low, scene.lowest)
    if not low < high:
        return np.empty(0)
    begins, breaks = np.array(scene.all_separations), np.empty(0)
    if not scene.hertzian:
        begins, breaks = begins_and_breaks(scene, low, high)
    marks = np.unique([low, *begins, *breaks, *bends(scene.modulus, low, high), *law.breaks, *given, high])
    marks = marks[(low <= marks) & (marks <= high)]
    if len(given):
        return refined(law, begins, marks)
    asked = (part.tobytes() for part in (begins, breaks, marks))
    return spaced(law, scene.n_asperities if split else 0, *asked)  # whatever the grading


@kept
def _range(law: HeightLaw, share: float) -> tuple[float, float]:
    """Where the cells lie: at most this share of all heights on either side of them.

    Rounded to a sixteenth, so that it does not hang on the last digit of an inverse distribution.
    """
    rare = np.array(min(share, 0.5))
    bottom, top = float(law.ppf(rare)), float(law.isf(rare))
    low, high = np.floor(16 * bottom) / 16, np.ceil(16 * top) / 16
    if low <= law.support[0]:
        low = law.support[0]
        if low in law.singular:
            low += _power_of_two_below(bottom - low)
    if high >= law.support[1]:
        high = law.support[1]
        if high in law.singular:
            high -= _power_of_two_below(high - top)
    return float(low), float(high)


def _power_of_two_below(distance: float) -> float:
    """Round down; far enough from the end that heights next to it are still told apart."""
    return 2.0 ** math.floor(math.log2(max(distance, _CLOSEST)))


@kept
def spaced(law: HeightLaw, n: int, *asked: bytes) -> Array:
    """Return edges between marks such that drawing costs the least, for surfaces of `n` asperities.

    Asked are heights where contacts begin, where they change their law, and marks; no asperities ask for
    the fewest cells.
    """
    begins, breaks, marks = (np.frombuffer(part) for part in asked)
    low = marks[:-1]
    k = np.searchsorted(begins, low)
    root = begins[np.minimum(k, len(begins) - 1)] == low
    before = low - np.concatenate([[-np.inf], begins])[k]
    gaps = np.stack([low, marks[1:], before, root])[:, root | (np.isin(low, breaks) & np.isfinite(before))]
    halvings = np.log2(gaps[1] - gaps[0]) - np.log2(gaps[2])
    fewest = 1 + np.ceil(np.maximum(halvings, 0.0) - 1e-9).astype(np.int64)
    found = [marks]
    for number in np.unique(fewest).tolist():
        some = gaps[:, fewest == number]
        if number == 1:  # might two cells cost less, if an asperity in them cost the least there is: 1?
            low, high, before, root = some
            above, beyond = law.sf(low), law.sf(high)
            two = 2 * _CELL + n * (above - beyond)
            some = some[
                :, _prices(law, n, root > 0, low, high - low, before, above, beyond) > two * (1 - _TIE)
            ]
        found.append(_cut(law, n, some, number))
    return refined(law, begins, np.unique(np.concatenate(found)))


def refined(law: HeightLaw, begins: Array, marks: Array) -> Array:
    """Edges from mark to mark, each cell as wide as the law and the contacts that begin below let it be."""
    lows, edges = [-np.inf, *begins.tolist()], marks[:1].tolist()
    for mark in marks[1:].tolist():
        while (a := edges[-1]) < mark:
            distance, room, widest = a - lows[bisect_left(lows, a) - 1], mark - a, law.span(a)
            if distance < _FAR * widest:  # where a law of contact bends as well
                widest *= _NARROWER
            for end in law.singular:
                widest = min(widest, a - end if end < a else (end - a) / 2)
            widest = min(distance, widest)
            if room <= widest * (1 + _ROUNDING):
                edges.append(mark)
            else:
                edges.append(a + (widest if room >= 2 * widest else room / 2))
    return np.array(edges)


def _cut(law: HeightLaw, n: int, gaps: Array, fewest: int) -> Array:
    """Cut gaps that need so many cells: arrays are (gaps, growths, cells), the highest cell first.

    Gaps have the rows low, high, distance from `low` to the separation below, infinite if there is none, and
    whether contacts begin at `low`.
    """
    low, high, before, root = gaps[:, :, None, None]
    length, steps = high - low, np.arange(fewest + _MORE)
    rungs = np.array([np.cumprod(np.where(steps, 1 / growth, 1.0)) for growth in _GROWTHS])
    heights = low + length * rungs
    above, least = law.sf(heights), law.sf(low)
    distance = length * rungs[:, 1:] + np.where(root > 0, 0.0, before)
    ends = heights[..., 1:], length * -np.diff(rungs), distance, above[..., 1:], above[..., :-1]
    upper = np.insert(_prices(law, n, np.False_, *ends), 0, 0.0, axis=2)
    lowest = low, length * rungs[:, fewest - 1 :], before, least, above[..., fewest - 1 :]
    prices = np.cumsum(upper, axis=2)[..., fewest - 1 :] + _prices(law, n, root > 0, *lowest)
    prices = prices.reshape(len(prices), len(_GROWTHS) * (_MORE + 1))
    cheapest = np.argmax(prices <= prices.min(axis=1, keepdims=True, initial=np.inf) * (1 + _TIE), axis=1)
    growth, more = np.divmod(cheapest, _MORE + 1)  # the first one of the cheapest: rounding breaks no tie
    chosen = heights[np.arange(len(prices)), growth]
    return np.asarray(chosen[:, 1:][np.arange(1, fewest + _MORE) < (fewest + more)[:, None]])


def _prices(law: HeightLaw, n: int, root: Any, *cells: Array) -> Array:
    """Return what the asperities of a surface cost in each of some `cells`, as `_orders` has them.

    Infinite where a cell is wider than its distance to the nearest separation below.
    """
    _, width, distance, above, beyond = cells
    prices = _CELL + n * (above - beyond) * price(*_orders(law, n, root, *cells))
    return np.where(width <= distance * (1 + 1e-9), prices, np.inf)


def _orders(
    law: HeightLaw,
    n: int,
    root: Any,
    start: Array,
    width: Array,
    distance: Array,
    above: Array,
    beyond: Array,
) -> tuple[Array, Array]:
    """How many T_j and R_j each cell should need: no whole numbers; contacts begin where it starts, or not.

    Of cells the distance to the root below, and the shares of heights above both ends.
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        bend = np.nan_to_num(np.abs(law.log_ratio(start, width)), nan=np.inf)
        # Of a surface's sum, rather than of the law, where so many touch that it is sure to be large.
        touching, expected = n * above, n * (above - beyond)
        reach = np.where(np.isfinite(distance), distance, 0.0) + width
        digits = DIGITS + np.log10(np.where(touching > SURE, expected / touching * np.sqrt(reach), 1.0))
        # A series gains these digits a term, with the nearest singularity of its variable at -z.
        z = [np.clip(z, 1.05, 1e6) for z in (np.minimum(1 + 2 * distance / width, 2 / bend), 2 / bend)]
        plain, rooted = (digits / np.log10(z + np.sqrt(z * z - 1)) for z in z)
    return plain, np.where(root, 1 + rooted, 0.0)


def expected_orders(law: HeightLaw, n: int, begins: Array, edges: Array) -> tuple[Ints, Ints]:
    """Return about how many T_j and R_j each cell will need, before any law is resolved on it.

    Contacts begin at `begins`, cells at `edges`, which increase.
    """
    low, above = edges[:-1], law.sf(edges)
    k = np.searchsorted(begins, low)
    before = low - np.concatenate([[-np.inf], begins])[k]
    root = np.append(begins, np.inf)[k] == low
    orders = _orders(law, n, root, low, np.diff(edges), before, above[:-1], above[1:])
    plain, rooted = (np.maximum(np.ceil(x), 0.0) for x in orders)
    return np.maximum(plain, 1.0).astype(np.int64), rooted.astype(np.int64)


def price(plain: Array | Ints, rooted: Array | Ints) -> Array:
    """Return what an asperity costs that gives so many moments: 1 for ten plain ones."""
    fives, root_fives = (np.ceil(np.clip(more, 0, 100) / 5) for more in (plain - 10, rooted - 6))
    roots = np.where(rooted > 0, _ROOT + _FIVE_ROOTS_MORE * root_fives, 0.0)
    return np.asarray(1 + np.where(plain > 12, _FIVE_MORE * fives, _TWO_MORE * (plain > 10)) + roots)
