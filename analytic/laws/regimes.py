"""Intervals of heights on which one piece of a contact law holds, and where its bounds turn."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array, Ints, Marks
from analytic.gradings import Grading
from analytic.resolution import marks, resolved_breaks
from analytic.roots import sign_changes

_STEP, _POINTS = 0.5, np.linspace(0, 1, 33)  # heights at which a bound is looked at, between its breaks
_ABOUT = 2.0**-14  # heights on either side that tell whether a bound comes nearer
_ROUGHLY = 2.0**24  # spacings of heights to which its turn is found: it hardly moves there


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


def stretches(
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

    def rise(x: Array, n: Ints) -> Array:
        around = np.diff(curve(x + _ABOUT * np.array([[-1], [1]]), which[n]), axis=-2)
        return np.asarray(around[bound[n], 0, np.arange(n.size)])

    return np.unique([*ends, *sign_changes(rise, s[i], s[i + 2], np.full(i.size, _ROUGHLY))])
