"""Which piece of a contact law holds at which heights: its regimes, as elastic, elastoplastic, plastic."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, Ints
from analytic.gradings import Grading
from analytic.laws.crossings import Bound, crossings_of
from analytic.laws.law import ContactLaw, piece_of

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

    @property
    def limits(self) -> Array:
        """All heights at which a piece begins above another one, increasing, without repetition."""
        inner = np.flatnonzero(np.diff(self.separation) == 0) + 1
        return np.unique(self.low[inner])


def regimes_of(law: ContactLaw, grading: Grading, separations: ArrayLike, low: float, high: float) -> Regimes:
    """The regimes of asperities in contact, with ends to the last bit of ``s - h >= limit(e(s))``.

    Ends within 8 spacings of floating-point numbers of a separation, of a break of the grading, or of each
    other, are one.

    Parameters
    ----------
    law : ContactLaw
        In reduced units; one, or one for each separation (`ContactLaw.with_radii`).
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
    count = len(law.limits(np.ones(h.shape)))
    kinks = [()] * (h.size if law.each else 1)
    found = [crossings_of(_limit(law, grading, j), grading, h, low, high, kinks) for j in range(count)]
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


def _limit(law: ContactLaw, grading: Grading, j: int) -> Bound:
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
