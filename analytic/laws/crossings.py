"""Heights at which a penetration reaches a bound that varies with height: yielding, lift-off.

Asperities of height s are penetrated by s - h. What begins at the penetration ``bound(s)`` has begun where
``s - h >= bound(s)``: on one side of a height if the bound is the same for all, on several intervals if
it falls faster than heights rise, as that of yielding does where the modulus falls.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from analytic.gradings import Custom, Grading, Homogeneous
from analytic.piecewise import PiecewiseSeries
from analytic.series import resolved

__all__ = ["Bound", "Crossings", "crossings_of"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Bound = Callable[[Array], Array]


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
        Penetration at which something begins, of the heights; infinite where it never does.
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

    def holds(s: Array, level: Array) -> NDArray[np.bool_]:
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            return np.asarray(s - level >= bound(s))

    at_start, at_end = holds(starts, h[:, None]), holds(ends, h[:, None])
    inner, stretch = np.nonzero(at_start != at_end)
    found = _halved(holds, h[inner], starts[stretch], ends[stretch])
    jump, before = np.nonzero(at_end[:, :-1] != at_start[:, 1:])
    separation, height = np.append(inner, jump), np.append(found, starts[before + 1])
    begins = np.append(at_end[inner, stretch], at_start[jump, before + 1])
    order = np.lexsort((height, separation))
    return Crossings(separation[order], height[order], begins[order])


def _stretches(bound: Bound, grading: Grading, low: float, high: float) -> Array:
    """Where stretches begin on which ``s - bound(s)`` only rises, or only falls."""
    if isinstance(grading, Homogeneous):
        return np.array([low])

    def bent(s: Array) -> Array:  # the arctangent rises with it and is smooth where the bound is infinite
        return np.arctan(s - bound(s))

    curve = resolved(Custom(bent, grading.breaks), low, high)
    slopes = [chebyshev.chebder([*c, 0.0]).tolist() for c in curve.coefficients]
    turns = PiecewiseSeries(curve.edges, slopes).zeros
    return np.unique([low, *curve.edges[:-1], *(s for s in turns if low < s < high)])


def _halved(holds: Callable[[Array, Array], NDArray[np.bool_]], h: Array, left: Array, right: Array) -> Array:
    """First height at which it is as at `right`, by halving down to neighbouring numbers."""
    behind = holds(right, h)
    while True:
        middle = left + (right - left) / 2
        inner = (middle > left) & (middle < right)
        if not inner.any():
            return right
        same = holds(middle, h) == behind
        right, left = np.where(inner & same, middle, right), np.where(inner & ~same, middle, left)
