"""The separation at which contacts under any law carry a given load, or have a given area."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from analytic.laws import LoadingBranch, term_of

__all__ = ["LawSum"]

Array = NDArray[np.float64]

_LAST_DIGITS = 4 * np.finfo(float).eps


@dataclass(frozen=True, eq=False)
class LawSum:
    """A sum over given asperities as the separation falls.

    Each piece of the law rises with the penetration. From one piece to the next, and where it begins, a
    contact may jump, up or down: so the sum need not be monotone, and may pass a value without having it.

    Parameters
    ----------
    quantity : str
        Load or area.
    branch : LoadingBranch
        With the law in reduced units.
    heights, modulus : ndarray
        Reduced heights in falling order, and E*(s)/E* >= 0 of each; shape (n,).
    """

    quantity: str
    branch: LoadingBranch
    heights: Array
    modulus: Array

    def largest_separation(self, value: float, start: float) -> float | None:
        """Largest separation from `start` on at which the sum is `value`, or jumps past it, or None.

        Where it jumps past, the sum there is beyond the value.
        """
        if not self.heights.size or self.heights[0] <= start:
            return None
        return self._within(value, start, float(self.heights[0]))

    def _within(self, value: float, low: float, high: float) -> float | None:
        """As above between two separations, at the higher one of which the sum is less than the value."""
        at_low, most, smooth = self._between(low, high)
        if most < value:
            return None
        if smooth:
            return float(brentq(lambda h: self._at(h) - value, low, high, xtol=1e-15, rtol=_LAST_DIGITS))
        middle = low + (high - low) / 2
        if not low < middle < high:
            return low if at_low >= value else None
        found = self._within(value, middle, high)
        return self._within(value, low, middle) if found is None else found

    def _between(self, low: float, high: float) -> tuple[float, float, bool]:
        """The sum at `low`, what it does not exceed up to `high`, and whether each contact keeps its piece.

        Each contact is at most what it is at `low`, or where one of its pieces ends.
        """
        s, e = self._touching(low)
        terms = term_of(self.quantity, self.branch, low, s, e)
        at_low = float(np.sum(terms))
        first, last = self._pieces(high, s, e), self._pieces(low, s, e)
        if self._snaps:
            terms = np.where(first < 0, np.maximum(terms, 0.0), terms)
        else:  # a contact begins as nothing
            first = np.maximum(first, 0)
        changed = np.flatnonzero(first < last)
        if not changed.size:
            return at_low, at_low, True
        for j, limit in enumerate(self.branch.law.limits(e[changed])):
            ends = (first[changed] <= j) & (j < last[changed])
            here, limit = changed[ends], limit[ends]
            at_end = self.branch.value(self.quantity, j, s[here] - limit, limit, e[here])
            terms[here] = np.maximum(terms[here], at_end)
        return at_low, float(np.sum(terms)), False

    @cached_property
    def _snaps(self) -> bool:
        """Whether contacts begin with a load or area of their own."""
        none = np.zeros(1)
        return bool(self.branch.value(self.quantity, 0, none, none, np.ones(1))[0] != 0)

    def _at(self, h: float) -> float:
        s, e = self._touching(h)
        return float(np.sum(term_of(self.quantity, self.branch, h, s, e)))

    def _touching(self, h: float) -> tuple[Array, Array]:
        n = int(np.searchsorted(-self.heights, -h))
        return self.heights[:n], self.modulus[:n]

    def _pieces(self, h: float, s: Array, e: Array) -> NDArray[np.int64]:
        return self.branch.pieces(np.full(s.shape, h), s - h, e)
