"""Heights at which a penetration reaches a bound that varies with height: yielding, lift-off.

Asperities of height s are penetrated by s - h. What begins at the penetration ``bound(s)`` has begun where
``s - h >= bound(s)``: on one side of a height if the bound is the same for all, on several intervals if
it falls faster than heights rise, as that of yielding does where the modulus falls.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.gradings import Grading, Homogeneous
from analytic.resolution import marks, resolved_breaks

__all__ = ["Bound", "Crossings", "crossings_of"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Bound = Callable[[Array], Array]
Excess = Callable[[Array, Array], Array]  # penetration beyond the bound, of heights and separations

_STEP, _POINTS = 0.5, np.linspace(0, 1, 33)  # heights at which a bound is looked at, between its breaks
_GOLDEN, _SECTIONS = (math.sqrt(5) - 1) / 2, 45
_SECANTS, _NEAR = 12, 64  # how many at most; spacings of floating-point numbers, more than rounding errors


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
    begins: NDArray[np.bool_]


def crossings_of(bound: Bound, grading: Grading, separations: Array, low: float, high: float) -> Crossings:
    """All crossings between two heights, each to the last bit.

    Parameters
    ----------
    bound : callable
        Penetration at which something begins, of the heights; infinite where it never does. Under one
        modulus for all it must be constant, or rise by less than the height.
    grading : Grading
        The bound has its kinks and jumps where this has them.
    separations : ndarray
        Reduced separations h, shape (k,).
    low, high : float
        Range of reduced heights.

    Returns
    -------
    Crossings
        If nothing holds at `low`, the first of each separation begins.

    Raises
    ------
    ValueError
        If the grading is noisy: not resolved by 4096 pieces.
    """
    h = np.asarray(separations, dtype=np.float64)
    if not low < high:
        return Crossings(np.empty(0, np.int64), np.empty(0), np.empty(0, np.bool_))
    starts = _stretches(bound, grading, low, high)
    ends = np.append(np.nextafter(starts[1:], -np.inf), high)

    def excess(s: Array, level: Array) -> Array:
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            return np.asarray(s - level - bound(s))

    at_start, at_end = excess(starts, h[:, None]) >= 0, excess(ends, h[:, None]) >= 0
    inner, stretch = np.nonzero(at_start != at_end)
    found = _halved(excess, h[inner], starts[stretch], ends[stretch])
    jump, before = np.nonzero(at_end[:, :-1] != at_start[:, 1:])
    separation, height = np.append(inner, jump), np.append(found, starts[before + 1])
    begins = np.append(at_end[inner, stretch], at_start[jump, before + 1])
    order = np.lexsort((height, separation))
    return Crossings(separation[order], height[order], begins[order])


def _stretches(bound: Bound, grading: Grading, low: float, high: float) -> Array:
    """Where stretches begin on which ``s - bound(s)`` only rises, or only falls."""
    if isinstance(grading, Homogeneous):
        return np.array([low])
    breaks = [b for b in resolved_breaks(grading, low, high) if low < b < high]
    starts = np.unique([low, *breaks, *marks(low, high, _STEP)])
    ends = np.append(starts[1:], high)
    s = starts[:, None] + (ends - starts)[:, None] * _POINTS
    s[:, -1] = np.nextafter(ends, -np.inf)

    def curve(x: Array) -> Array:  # the arctangent rises with it, also where the bound is infinite
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            return np.arctan(x - bound(x))

    rises = np.diff(curve(s), axis=1) >= 0
    piece, turn = np.nonzero(rises[:, :-1] != rises[:, 1:])
    across = np.flatnonzero((rises[:-1, -1] != rises[1:, 0]) & ~np.isin(ends[:-1], breaks))
    turns = _turns(
        curve,
        np.append(s[piece, turn], s[across, -2]),
        np.append(s[piece, turn + 2], s[across + 1, 1]),
        np.append(rises[piece, turn], rises[across, -1]),
    )
    behind = np.nextafter(breaks, np.inf)  # at a jump the modulus may still be that below it
    return np.unique([low, *breaks, *behind, *turns[(low < turns) & (turns < high)]])


def _turns(curve: Callable[[Array], Array], left: Array, right: Array, peak: NDArray[np.bool_]) -> Array:
    """Highest or lowest points, by golden section."""
    if not left.size:
        return left
    sign = np.where(peak, 1.0, -1.0)
    for _ in range(_SECTIONS):
        a, b = right - _GOLDEN * (right - left), left + _GOLDEN * (right - left)
        first = sign * curve(a) > sign * curve(b)
        left, right = np.where(first, left, a), np.where(first, b, right)
    return np.asarray((left + right) / 2)


def _halved(excess: Excess, h: Array, left: Array, right: Array) -> Array:
    """First height at which the excess has the sign that it has at `right`, by halving down to neighbours.

    Signs are asked for only next to where secants meet: what is left of that or right of it is known.
    """
    behind = excess(right, h) >= 0
    low, high = _around(excess, h, left, right, behind)
    while True:
        middle = left + (right - left) / 2
        inner = (middle > left) & (middle < right)
        if not inner.any():
            return right
        same = middle >= high
        asked = np.flatnonzero(inner & (low < middle) & (middle < high))
        if asked.size:
            same[asked] = (excess(middle[asked], h[asked]) >= 0) == behind[asked]
        right, left = np.where(inner & same, middle, right), np.where(inner & ~same, middle, left)


def _around(
    excess: Excess, h: Array, left: Array, right: Array, behind: NDArray[np.bool_]
) -> tuple[Array, Array]:
    """Two heights next to where secants meet, or the ends given where the sign does not change in between."""
    before, x = left, right
    of_before, of_x = excess(before, h), excess(x, h)
    room = _NEAR * np.spacing(np.maximum(np.maximum(np.abs(left), np.abs(right)), np.abs(h)))
    for _ in range(_SECANTS):
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            found = x - of_x * ((x - before) / (of_x - of_before))
        stay = np.where(np.isfinite(of_x), x, (left + right) / 2)  # there already, or where nothing begins
        before, x = x, np.clip(np.where(np.isfinite(found), found, stay), left, right)
        if np.all(np.abs(x - before) < room):
            break
        of_before, of_x = of_x, excess(x, h)
    low, high = x - room, x + room
    sure = (left < low) & (high < right)
    sure &= ((excess(low, h) >= 0) != behind) & ((excess(high, h) >= 0) == behind)
    return np.where(sure, low, left), np.where(sure, high, right)
