"""Which piece of a contact law holds at which heights: its regimes, as elastic, elastoplastic, plastic.

Asperities of height s are penetrated by s - h. What begins at the penetration ``bound(s)``, as yielding or
lift-off, has begun where ``s - h >= bound(s)``: on one side of a height if the bound is the same for all, on
several intervals if it falls faster than heights rise, as that of yielding does where the modulus falls.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic.arrays import Array, Ints, Marks
from analytic.gradings import Grading, Homogeneous
from analytic.resolution import marks, resolved_breaks
from analytic.roots import sign_changes

_STEP, _POINTS = 0.5, np.linspace(0, 1, 33)  # heights at which a bound is looked at, between its breaks
_CLOSER, _ROUNDS = np.linspace(-1, 1, 17), 8  # how often each extremum is looked at eight times as closely
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
    def goes_on(self) -> Marks:
        """Whether each goes on where the one before ends; shape (intervals + 1,), false at both ends."""
        on = (self.low[1:] <= self.high[:-1]) & (np.diff(self.separation) == 0)
        return np.concatenate([[False], on, [False]]) if self.low.size else np.zeros(1, dtype=bool)


def regimes_of(branch: Any, grading: Grading, h: Array, low: float, high: float) -> Regimes:
    """Return the regimes of a branch at separations h, which have its radii in turn, in a range of heights.

    Under one modulus for all, what a bound asks must rise with the height. Ends within 8 spacings of
    floating-point numbers of a separation, of where contact starts, of a break of the grading, or of each
    other, are one. A grading that is not resolved by 4096 pieces is a ValueError.
    """

    def beyond(s: Array, which: Ints) -> Array:
        """How far heights are beyond each bound, at separations by their numbers: shape (bounds, ...)."""
        some, x = branch.of_some(which), h[which]
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            e, deepest = grading(s), some.deepest(x, s - x)
            found = [deepest - limit for limit in some.limits(e)]
            if branch.unload_from is not None:
                found.append(some.left(x, s - x, e))
            return np.reshape(found, (len(found), *deepest.shape))

    every, start = np.arange(h.size), np.maximum(np.broadcast_to(branch.lowest(h), h.shape), low)
    s = np.array([low, high])
    if not isinstance(grading, Homogeneous):
        s = _stretches(beyond, grading, low, high, 1 if branch.ratios is None else branch.ratios.size)
    held = beyond(s, every[:, None]) >= 0
    bound, which, i = np.nonzero(held[..., 1:] != held[..., :-1])

    def excess(x: Array, n: Ints) -> Array:
        return np.asarray(beyond(x, which[n])[bound[n], np.arange(n.size)])

    edge = sign_changes(excess, s[i], s[i + 1], np.abs(h[which]))
    which, edge = np.concatenate([every, every, which]), np.concatenate([start, np.full(h.size, high), edge])
    anchors = np.unique([*start, *h, *grading.breaks, high])
    nearest = anchors[np.searchsorted((anchors[1:] + anchors[:-1]) / 2, edge)]
    same = _SAME * np.spacing(np.maximum(np.abs(edge), np.abs(h[which])))  # they were found from ``s - h``
    edge = np.maximum(np.where(np.abs(nearest - edge) <= same, nearest, edge), start[which])
    order = np.lexsort((edge, which))
    which, edge, same = which[order], edge[order], same[order]
    apart = (np.diff(which) > 0) | (np.diff(edge) > same[1:])
    which, edge = which[np.append(True, apart)], edge[np.append(True, apart)]
    inside = np.flatnonzero(which[1:] == which[:-1])
    which, begin, end = which[inside], edge[inside], edge[inside + 1]
    middle = begin + (end - begin) / 2
    piece = branch.of_some(which).pieces(h[which], middle - h[which], grading(middle))
    first = np.append(True, (np.diff(which) > 0) | (np.diff(piece) != 0))[: which.size]
    last, contact = np.roll(first, -1), piece[first] >= 0
    return Regimes(which[first][contact], begin[first][contact], end[last][contact], piece[first][contact])


def _stretches(
    beyond: Callable[[Array, Ints], Array], grading: Grading, low: float, high: float, radii: int
) -> Array:
    """Return increasing ends of stretches on each of which heights only go beyond bounds, or only back."""
    breaks = np.array(resolved_breaks(grading, low, high))
    sides = np.concatenate([np.nextafter(breaks, -np.inf), breaks, np.nextafter(breaks, np.inf)])
    ends = np.unique([low, *sides[(low < sides) & (sides < high)], *marks(low, high, _STEP), high])
    s = np.unique(ends[:-1, None] + np.diff(ends)[:, None] * _POINTS)

    def curve(x: Array, which: Ints) -> Array:  # the arctangent rises with it, also where it is infinite
        return np.arctan(beyond(x, which))

    rises = np.diff(curve(s, np.arange(radii)[:, None])) >= 0
    bound, which, i = np.nonzero(rises[..., :-1] != rises[..., 1:])
    left, right = s[i], s[i + 2]
    sign = np.where(rises[bound, which, i], 1.0, -1.0)[:, None]
    for _ in range(_ROUNDS if which.size else 0):
        x = (left + right)[:, None] / 2 + (right - left)[:, None] / 2 * _CLOSER
        values = sign * curve(x, which[:, None])[bound, np.arange(which.size)]
        top = np.argmax(values, axis=1)[:, None]
        left, right = (np.take_along_axis(x, np.clip(top + k, 0, 16), 1)[:, 0] for k in (-1, 1))
    return np.unique([*ends, *(left + right) / 2])
