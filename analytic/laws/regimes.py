"""Which piece of a contact law holds at which heights: its regimes, as elastic, elastoplastic, plastic.

Asperities of height s are penetrated by s - h. What begins at the penetration ``bound(s)``, as yielding or
lift-off, has begun where ``s - h >= bound(s)``: on one side of a height if the bound is the same for all, on
several intervals if it falls faster than heights rise, as that of yielding does where the modulus falls.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array, Ints, Marks
from analytic.gradings import Grading, Homogeneous
from analytic.resolution import marks, resolved_breaks
from analytic.roots import sign_changes

Bound = Callable[[Array, Ints], Array]  # of heights, and of which separation
Numbers = Callable[[Array, Ints], Ints]  # of the same

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


def regimes_between(
    crossed: Iterable[tuple[Ints, Array]],
    h: Array,
    start: Array,
    high: float,
    breaks: Sequence[float],
    numbers: Numbers,
) -> Regimes:
    """Return the regimes at separations h, from the lowest heights that may touch up to the highest.

    What holds between crossings tells a function of heights and of the numbers of separations, -1 without
    contact. Ends within 8 spacings of floating-point numbers of a separation, of where contact starts, of a
    break of the grading, or of each other, are one.
    """
    every, anchors = np.arange(h.size), np.unique([*start, *h, *breaks, high])
    ends = [(every, start), (every, np.full(h.size, high)), *crossed]
    which, edge = (np.concatenate(x) for x in zip(*ends, strict=True))
    nearest = anchors[np.searchsorted((anchors[1:] + anchors[:-1]) / 2, edge)]
    edge = np.where(np.abs(nearest - edge) <= _last_digits(edge, h[which]), nearest, edge)
    edge = np.maximum(edge, start[which])
    order = np.lexsort((edge, which))
    which, edge = which[order], edge[order]
    apart = np.append(True, (np.diff(which) > 0) | (np.diff(edge) > _last_digits(edge, h[which])[1:]))
    which, edge = which[apart[: which.size]], edge[apart[: which.size]]
    held = np.flatnonzero(which[1:] == which[:-1])
    which, begin, end = which[held], edge[held], edge[held + 1]
    piece = numbers(begin + (end - begin) / 2, which)
    goes_on = (which[1:] == which[:-1]) & (piece[1:] == piece[:-1])
    first, last = np.append(True, ~goes_on)[: which.size], np.append(~goes_on, True)[: which.size]
    contact = piece[first] >= 0
    return Regimes(which[first][contact], begin[first][contact], end[last][contact], piece[first][contact])


def crossings(
    bound: Bound, grading: Grading, h: Array, low: float, high: float, radii: int
) -> tuple[Ints, Array]:
    """Where ``s - h >= bound(s)`` begins or ends to hold: which separation, and the first height behind.

    A bound, infinite where that never does, is of heights and of the numbers of separations, which have as
    many radii in turn. Under one modulus for all it must be constant, or rise by less than the height. A
    grading that is not resolved by 4096 pieces is a ValueError.
    """
    if not low < high:
        return np.empty(0, np.int64), np.empty(0)

    def excess(s: Array, which: Ints) -> Array:
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            return np.asarray(s - h[which] - bound(s, which))

    s = _stretches(bound, grading, low, high, radii)
    beyond = excess(s, np.arange(h.size)[:, None]) >= 0
    which, i = np.nonzero(beyond[:, 1:] != beyond[:, :-1])
    return which, sign_changes(lambda x, k: excess(x, which[k]), s[i], s[i + 1], np.abs(h[which]))


def _last_digits(heights: Array, separations: Array) -> Array:
    """Distance up to which heights are not told apart: they were found from ``s - h``."""
    return np.asarray(_SAME * np.spacing(np.maximum(np.abs(heights), np.abs(separations))))


def _stretches(bound: Bound, grading: Grading, low: float, high: float, radii: int) -> Array:
    """Return increasing ends of stretches on each of which ``s - bound(s)`` only rises, or only falls."""
    if isinstance(grading, Homogeneous):
        return np.array([low, high])
    breaks = np.array(resolved_breaks(grading, low, high))
    sides = np.concatenate([np.nextafter(breaks, -np.inf), breaks, np.nextafter(breaks, np.inf)])
    ends = np.unique([low, *sides[(low < sides) & (sides < high)], *marks(low, high, _STEP), high])
    s = np.unique(ends[:-1, None] + np.diff(ends)[:, None] * _POINTS)

    def curve(x: Array, which: Ints) -> Array:  # the arctangent rises with it, also where it is infinite
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            return np.arctan(x - bound(x, which) + 0.0 * which)

    rises = np.diff(curve(s, np.arange(radii)[:, None])) >= 0
    which, i = np.nonzero(rises[:, :-1] != rises[:, 1:])
    left, right, peak = s[i], s[i + 2], rises[which, i]
    sign = np.where(peak, 1.0, -1.0)[:, None]
    for _ in range(_ROUNDS if which.size else 0):
        x = (left + right)[:, None] / 2 + (right - left)[:, None] / 2 * _CLOSER
        top = np.argmax(sign * curve(x, which[:, None]), axis=1)[:, None]
        left, right = (np.take_along_axis(x, np.clip(top + k, 0, 16), 1)[:, 0] for k in (-1, 1))
    return np.unique([*ends, *(left + right) / 2])
