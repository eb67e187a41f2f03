"""The separation at which a sum over given heights has a given value, where it may rise and fall."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from analytic import Hertz, Quantity, quantity_of
from analytic.arrays import Array, Ints
from analytic.laws import Branch, term_of
from analytic.laws.branch import terms_of
from analytic.roots import falling_root
from mcgw.scene.scene import Scene

_FINE, _AT_ONCE = 1 / 64, 16  # step of the search where sums may rise and fall, and steps at a time
LOWEST = -40.0  # separation where searches end
_STEP = 0.5  # by which the search for a start goes down, where the margin was not enough


def asperity_terms(
    scene: Scene, names: Sequence[str], h: float | Array, s: Array, modulus: Array, ratios: Array | None
) -> Array:
    """Return what asperities add to quantities, on loading, over the scale of each.

    Parameters
    ----------
    scene : Scene
        Whose contact law they have.
    names : sequence of str
        Of the quantities.
    h : float or ndarray
        Separation, or that of each.
    s, modulus : ndarray
        Reduced heights, and E*(s)/E* of each, shape (asperities,).
    ratios : ndarray or None
        Radii over that of the surface, where summits have their own.

    Returns
    -------
    ndarray
        Shape (quantities, asperities).
    """
    quantities = [quantity_of(name) for name in names]
    if scene.hertzian:
        above = np.maximum(s - h, 0.0)
        powers = (above**q.exponent if q.exponent else (above > 0) * 1.0 for q in quantities)
        found = [modulus * x if q.modulus else x for q, x in zip(quantities, powers, strict=True)]
    else:
        loading = scene.ways.loading
        found = list(
            terms_of(names, loading if ratios is None else loading.with_radii(ratios), h, s, modulus)
        )
    if ratios is not None:
        found = [ratios**q.radius * x for q, x in zip(quantities, found, strict=True)]
    return np.asarray(found)


def crossing(excess: Callable[[Any], Any], high: float, lowest: float = LOWEST) -> float | None:
    """Largest root up to `high`, where the function is not positive; None down to the end of the range.

    The function takes a separation or an array of them.
    """
    if excess(high) >= 0:  # by a last digit
        return high
    lows = np.arange(high - _FINE, lowest, -_FINE)
    for some in np.split(lows, range(_AT_ONCE, lows.size, _AT_ONCE)):
        beyond = some[np.asarray(excess(some)) >= 0]
        if beyond.size:
            low = float(beyond[0])
            return falling_root(lambda h: float(excess(h)), low, low + _FINE)
    return None


@dataclass(frozen=True, eq=False)
class LawSum:
    """A sum over given asperities as the separation falls.

    Each piece of the law rises with the penetration. From one piece to the next, and where it begins, a
    contact may jump, up or down: so the sum need not be monotone, and may pass a value without having it.

    Parameters
    ----------
    quantity : str
        Load or area.
    branch : Branch
        With the law in reduced units.
    heights, modulus : ndarray
        Reduced heights in falling order, and E*(s)/E* >= 0 of each; shape (n,).
    ratios : ndarray, optional
        Radius of each over that of the surface, where summits have their own.
    """

    quantity: str
    branch: Branch
    heights: Array
    modulus: Array
    ratios: Array | None = None

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
            return falling_root(lambda h: self._at(h) - value, low, high)
        middle = low + (high - low) / 2
        if not low < middle < high:
            return low if at_low >= value else None
        found = self._within(value, middle, high)
        return self._within(value, low, middle) if found is None else found

    def _between(self, low: float, high: float) -> tuple[float, float, bool]:
        """Return the sum at `low`, its bound up to `high`, and whether each contact keeps its piece.

        Each contact is at most what it is at `low`, or where one of its pieces ends.
        """
        n = self._touching(low)
        s, e, terms = self.heights[:n], self.modulus[:n], self._terms(low, n)
        at_low = float(np.sum(terms))
        first, last = self._pieces(high, n), self._pieces(low, n)
        if self._snaps:
            terms = np.where(first < 0, np.maximum(terms, 0.0), terms)
        else:  # a contact begins as nothing
            first = np.maximum(first, 0)
        changed = np.flatnonzero(first < last)
        if not changed.size:
            return at_low, at_low, True
        for j, limit in enumerate(self._branch(changed).law.limits(e[changed])):
            ends = (first[changed] <= j) & (j < last[changed])
            here, limit = changed[ends], limit[ends]
            at_end = self._branch(here).value(self.quantity, j, s[here] - limit, limit, e[here])
            terms[here] = np.maximum(terms[here], self._weight(here) * at_end)
        return at_low, float(np.sum(terms)), False

    @cached_property
    def _snaps(self) -> bool:
        """Whether contacts begin with a load or area of their own."""
        none = np.zeros(1)
        return bool(self.branch.value(self.quantity, 0, none, none, np.ones(1))[0] != 0)

    def _at(self, h: float) -> float:
        return float(np.sum(self._terms(h, self._touching(h))))

    def _touching(self, h: float) -> int:
        """How many rise above a separation: they come first."""
        return int(np.searchsorted(-self.heights, -h))

    def _terms(self, h: float, n: int) -> Array:
        """Return what each of the first `n` adds."""
        first = slice(n)
        terms = term_of(self.quantity, self._branch(first), h, self.heights[first], self.modulus[first])
        return self._weight(first) * terms

    def _pieces(self, h: float, n: int) -> Ints:
        s, e = self.heights[:n], self.modulus[:n]
        return self._branch(slice(n)).pieces(np.full(n, h), s - h, e)

    def _branch(self, which: slice | Ints) -> Branch:
        """Return that of some asperities, each by the law of its own radius."""
        if self.ratios is None:
            return self.branch
        return self.branch.with_radii(self.ratios[which])

    def _weight(self, which: slice | Ints) -> Array | float:
        """Return what a load or an area is worth by the radius."""
        return 1.0 if self.ratios is None else self.ratios[which] ** quantity_of(self.quantity).radius


@dataclass(frozen=True, eq=False)
class Summits:
    """Asperities of one surface of a scene.

    Parameters
    ----------
    scene : Scene
        Whose grading and contact law they have.
    s : ndarray
        Reduced heights in falling order.
    ratios : ndarray or None
        Radii over that of the surface, where summits have their own.
    """

    scene: Scene
    s: Array
    ratios: Array | None

    @cached_property
    def modulus(self) -> Array:
        """E*(s)/E* of each."""
        return np.asarray(self.scene.modulus(self.s))

    @classmethod
    def of(cls, scene: Scene, s: Array, ratios: Array | None) -> "Summits":
        """In falling order."""
        order = np.argsort(-s, kind="stable")
        return cls(scene, s[order], None if ratios is None else ratios[order])

    @cached_property
    def softest(self) -> float:
        """Height of the highest one of negative modulus; below it sums may rise with the separation."""
        return float(self.s[self.modulus < 0].max(initial=-np.inf))

    def largest_separation(self, q: Quantity, target: float, start: float) -> float | None:
        """Return the solution among separations from `start` on at which no modulus is negative, or None."""
        found = LawSum(q.base, self.scene.ways.loading, self.s, self.modulus, self.ratios)
        return found.largest_separation(target, max(start, self.softest))

    def separation_anywhere(self, q: Quantity, target: float, start: float) -> float | None:
        """Return the largest solution on all heights of a surface; None if there is none."""
        end = max(LOWEST, self.softest)
        while start > end:
            start = max(start - _STEP, end)
            if (found := self.largest_separation(q, target, start)) is not None:
                return found
        if (
            not np.isfinite(self.softest)
            or self.scene.negative == "error"
            or type(self.scene.law) is not Hertz
        ):
            return None
        value = target * q.scale(self.scene.surface)
        sums = np.vectorize(lambda h: self.sums([q.name], h)[q.name], otypes=[float])
        return crossing(lambda h: sums(h) - value, self.softest)

    def nominal(self, value: float, sunk: float, lowest: float) -> float | None:
        """Largest separation above `lowest` that is the `value` when lowered by `sunk` (1/N) times the load.

        None if there is none.
        """
        high = max(float(self.s.max(initial=value)), value)
        load = np.vectorize(lambda h: self.sums(("load",), h)["load"], otypes=[float])
        return crossing(lambda h: value - h + sunk * load(h), high, lowest)

    def sums(self, names: Iterable[str], h: float) -> dict[str, float]:
        """Quantities at one separation, SI."""
        names, n = list(names), int(np.searchsorted(-self.s, -h))
        ratios = None if self.ratios is None else self.ratios[:n]
        terms = asperity_terms(self.scene, names, h, self.s[:n], self.modulus[:n], ratios)
        scales = (quantity_of(name).scale(self.scene.surface) for name in names)
        return {name: scale * float(np.sum(x)) for name, scale, x in zip(names, scales, terms, strict=True)}
