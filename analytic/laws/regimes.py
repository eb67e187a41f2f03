"""Which piece of a contact law holds at which heights: its regimes, as elastic, elastoplastic, plastic.

Asperities of height s are penetrated by s - h. What begins at the penetration ``bound(s)``, as yielding or
lift-off, has begun where ``s - h >= bound(s)``: on one side of a height if the bound is the same for all, on
several intervals if it falls faster than heights rise, as that of yielding does where the modulus falls.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, Ints, Marks
from analytic.elementary import halved
from analytic.gradings import Grading, Homogeneous
from analytic.laws.law import ContactLaw, piece_of
from analytic.resolution import marks, resolved_breaks

Bound = Callable[[Array, Ints], Array]  # of heights, and of which separation
Excess = Callable[[Array, Ints], Array]  # penetration beyond the bound, of the same

_STEP, _POINTS = 0.5, np.linspace(0, 1, 33)  # heights at which a bound is looked at, between its breaks
_GOLDEN, _SECTIONS = (math.sqrt(5) - 1) / 2, 45
_SECANTS, _NEAR = 12, 64  # how many at most; spacings of floating-point numbers, more than rounding errors
_SAME = 8  # spacings of floating-point numbers between heights that are not told apart


@dataclass(frozen=True)
class Regimes:
    """Intervals of heights on each of which one piece of the law holds, at several separations.

    Those of one separation follow each other, upwards, from the lowest height in contact on; neighbours
    have different pieces. All arrays have the shape (intervals,).

    Parameters
    ----------
    separation : ndarray of int
        Which of the separations, not decreasing.
    low, high : ndarray
        Reduced heights ``low <= s < high``.
    piece : ndarray of int
        Number of the piece.
    """

    separation: Ints
    low: Array
    high: Array
    piece: Ints


def regimes_of(law: ContactLaw, grading: Grading, separations: ArrayLike, low: float, high: float) -> Regimes:
    """The regimes of asperities in contact, with ends to the last bit of ``s - h >= limit(e(s))``.

    Ends within 8 spacings of floating-point numbers of a separation, of a break of the grading, or of each
    other, are one.

    Parameters
    ----------
    law : ContactLaw
        In reduced units; of one radius, or of several (`ContactLaw.with_radii`), which separations have in
        turn.
    grading : Grading
        E*(s)/E*.
    separations : array_like
        Reduced separations, shape (k,).
    low, high : float
        Range of reduced heights.

    Returns
    -------
    Regimes
        From the separation, or `low`, up to `high`; nothing for separations above that.
    """
    h = np.asarray(separations, dtype=np.float64)
    count, kinks = len(law.limits(np.ones(law.radii))), [()] * law.radii
    found = [crossings_of(limit_of(law, grading, j), grading, h, low, high, kinks) for j in range(count)]
    empty = np.empty(0, np.int64)
    index = np.concatenate([empty, *(c.separation for c in found)])
    anchors = np.append(h, grading.breaks)
    height = merged_heights(np.concatenate([np.empty(0), *(c.height for c in found)]), h[index], anchors)
    step = np.concatenate([empty, *(np.where(c.begins, 1, -1) for c in found)])

    touching = np.flatnonzero(h < high)
    start = np.maximum(h[touching], low)
    first = piece_of(law.of_some(touching), start - h[touching], grading(start))
    index, step = np.concatenate([touching, index]), np.concatenate([first, step])
    height = np.concatenate([start, np.maximum(height, np.maximum(h, low)[index[touching.size :]])])
    return _intervals(index, height, step, high)


def limit_of(law: ContactLaw, grading: Grading, j: int) -> Bound:
    """Penetration at which piece j + 1 begins, of the height and of which separation."""
    return lambda s, which: np.asarray(law.of_some(which).limits(grading(s))[j])


def _intervals(index: Ints, height: Array, step: Ints, high: float) -> Regimes:
    """Intervals from the heights where the number of the piece changes by a step, first from 0."""
    order = np.lexsort((height, index))
    index, low, step = index[order], height[order], step[order]
    piece = np.cumsum(step) - np.append(0, np.cumsum(step))[np.searchsorted(index, index)]
    held = low < _ends(index, low, high)
    index, low, piece = index[held], low[held], piece[held]
    new = np.append(True, (np.diff(index) > 0) | (np.diff(piece) != 0))[: index.size]
    index, low, piece = index[new], low[new], piece[new]
    return Regimes(index, low, _ends(index, low, high), piece)


def _ends(index: Ints, low: Array, high: float) -> Array:
    """Where the next interval of the same separation begins, or the range ends."""
    last = np.append(np.diff(index) > 0, True)
    return np.where(last, high, np.append(low[1:], high))[: index.size]


def merged_heights(heights: Array, separations: Array, anchors: Array) -> Array:
    """Heights, each replaced by the anchor, or the lowest height, that it cannot be told from.

    They were found from ``s - h``, so the last digit of their separations counts too.
    """
    if not heights.size:
        return heights
    near = _SAME * np.spacing(np.maximum(np.abs(heights), np.abs(separations)))
    order = np.argsort(heights)
    first = np.append(True, np.diff(heights[order]) > np.maximum(near[order][1:], near[order][:-1]))
    together = np.empty_like(heights)
    together[order] = heights[order][np.maximum.accumulate(np.where(first, np.arange(first.size), 0))]
    anchors = np.sort(anchors)
    after = np.searchsorted(anchors, heights)
    for candidate in (np.maximum(after - 1, 0), np.minimum(after, anchors.size - 1)):
        anchor = anchors[candidate]
        together = np.where(np.abs(anchor - heights) <= near, anchor, together)
    return together


@dataclass(frozen=True)
class Crossings:
    """Heights where ``s - h >= bound(s)`` begins or ends to hold, for several h.

    Parameters
    ----------
    separation : ndarray
        Which of the separations h, shape (crossings,), not decreasing.
    height : ndarray
        First of the heights behind the crossing, shape (crossings,), increasing for each separation.
    begins : ndarray
        Whether it holds from there on, or holds no longer; shape (crossings,).
    """

    separation: Ints
    height: Array
    begins: Marks


def crossings_of(
    bound: Bound,
    grading: Grading,
    separations: Array,
    low: float,
    high: float,
    kinks: Sequence[Sequence[float]] = ((),),
) -> Crossings:
    """All crossings between two heights, each to the last bit; if nothing holds at `low`, the first begins.

    `bound` gives the penetration at which something begins, of the heights, and of the numbers of their
    separations in an array that broadcasts with them; infinite where it never does. Under one modulus for all
    it must be constant, or rise by less than the height. It has its kinks and jumps where the grading has
    them, and further `kinks`, of each of the bounds that separations have in turn. A grading that is not
    resolved by 4096 pieces is a ValueError.
    """
    h = np.asarray(separations, dtype=np.float64)
    if not low < high:
        return Crossings(np.empty(0, np.int64), np.empty(0), np.empty(0, np.bool_))
    starts = _stretches(bound, grading, low, high, kinks)
    ends = np.append(np.nextafter(starts[:, 1:], -np.inf), np.full((len(starts), 1), high), axis=1)
    ends = np.where(starts < high, ends, high)

    def excess(s: Array, which: Ints) -> Array:
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            return np.asarray(s - h[which] - bound(s, which))

    every = np.arange(h.size)[:, None]
    if len(starts) > 1:
        turn = every[:, 0] % len(starts)
        starts, ends = starts[turn], ends[turn]
    at_start, at_end = excess(starts, every) >= 0, excess(ends, every) >= 0
    inner, stretch = np.nonzero(at_start != at_end)
    starts, ends = (np.broadcast_to(x, at_start.shape) for x in (starts, ends))
    found = _met(excess, inner, np.abs(h)[inner], starts[inner, stretch], ends[inner, stretch])
    jump, before = np.nonzero(at_end[:, :-1] != at_start[:, 1:])
    separation, height = np.append(inner, jump), np.append(found, starts[jump, before + 1])
    begins = np.append(at_end[inner, stretch], at_start[jump, before + 1])
    order = np.lexsort((height, separation))
    return Crossings(separation[order], height[order], begins[order])


def _stretches(
    bound: Bound, grading: Grading, low: float, high: float, kinks: Sequence[Sequence[float]]
) -> Array:
    """Where stretches begin on which ``s - bound(s)`` only rises, or only falls: a row for each bound.

    Rows with fewer of them than others end with `high`.
    """
    if isinstance(grading, Homogeneous):
        return np.full((len(kinks), 1), low)
    resolved = [b for b in resolved_breaks(grading, low, high) if low < b < high]
    breaks = _rows([[*resolved, *(b for b in own if low < b < high)] for own in kinks], high)
    regular = [low, *marks(low, high, _STEP)]
    starts = _rows([[*row, *regular] for row in breaks.tolist()], high)
    ends = np.append(starts[:, 1:], np.full((len(starts), 1), high), axis=1)
    s = starts[..., None] + (ends - starts)[..., None] * _POINTS
    s[..., -1] = np.maximum(np.nextafter(ends, -np.inf), starts)

    def curve(x: Array, which: Ints) -> Array:  # the arctangent rises with it, also where it is infinite
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            return np.arctan(x - bound(x, which))

    rises = np.diff(curve(s, np.arange(len(s))[:, None, None]), axis=2) >= 0
    row, piece, turn = np.nonzero(rises[..., :-1] != rises[..., 1:])
    at_break = np.stack([np.isin(own, marked) for own, marked in zip(ends[:, :-1], breaks, strict=True)])
    other, across = np.nonzero((rises[:, :-1, -1] != rises[:, 1:, 0]) & ~at_break)
    row_of = np.append(row, other)
    turns = _turns(
        partial(curve, which=row_of),
        np.append(s[row, piece, turn], s[other, across, -2]),
        np.append(s[row, piece, turn + 2], s[other, across + 1, 1]),
        np.append(rises[row, piece, turn], rises[other, across, -1]),
    )
    behind = np.nextafter(breaks, np.inf)  # at a jump the modulus may still be that below it
    found = [[low, *b, *c] for b, c in zip(breaks.tolist(), behind.tolist(), strict=True)]
    for k, x in zip(row_of.tolist(), turns.tolist(), strict=True):
        found[k].append(x if low < x < high else low)
    return _rows(found, high)


def _rows(heights: Sequence[Sequence[float]], high: float) -> Array:
    """Those below `high` in increasing order, each once; a row for each list, as long as the longest."""
    rows = [np.unique([x for x in row if x < high]) for row in heights]
    result = np.full((len(rows), max(row.size for row in rows)), high)
    for k, row in enumerate(rows):
        result[k, : row.size] = row
    return result


def _turns(curve: Callable[[Array], Array], left: Array, right: Array, peak: Marks) -> Array:
    """Highest or lowest points, by golden section."""
    if not left.size:
        return left
    sign = np.where(peak, 1.0, -1.0)
    for _ in range(_SECTIONS):
        a, b = right - _GOLDEN * (right - left), left + _GOLDEN * (right - left)
        first = sign * curve(a) > sign * curve(b)
        left, right = np.where(first, left, a), np.where(first, b, right)
    return np.asarray((left + right) / 2)


def _met(excess: Excess, which: Ints, unit: Array, left: Array, right: Array) -> Array:
    """First height at which the excess has the sign that it has at `right`, next to where secants meet."""
    behind = excess(right, which) >= 0
    ends = _around(excess, which, unit, left, right, behind)
    return halved(lambda s: (excess(s, which) >= 0) == behind, *ends)


def _around(
    excess: Excess, which: Ints, unit: Array, left: Array, right: Array, behind: Marks
) -> tuple[Array, Array]:
    """Two heights next to where secants meet, or the ends given where the sign does not change in between."""
    before, x = left, right
    of_before, of_x = excess(before, which), excess(x, which)
    room = _NEAR * np.spacing(np.maximum(np.maximum(np.abs(left), np.abs(right)), unit))
    for _ in range(_SECANTS):
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            found = x - of_x * ((x - before) / (of_x - of_before))
        stay = np.where(np.isfinite(of_x), x, (left + right) / 2)  # there already, or where nothing begins
        before, x = x, np.clip(np.where(np.isfinite(found), found, stay), left, right)
        if np.all(np.abs(x - before) < room):
            break
        of_before, of_x = of_x, excess(x, which)
    low, high = x - room, x + room
    sure = (left < low) & (high < right)
    sure &= ((excess(low, which) >= 0) != behind) & ((excess(high, which) >= 0) == behind)
    return np.where(sure, low, left), np.where(sure, high, right)
