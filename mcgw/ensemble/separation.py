"""The separation at which a sum over given heights has a given value, under Hertz's law and any other."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.optimize import brentq

from analytic import Hertz, Quantity, quantity_of
from analytic.arrays import Array, Ints
from analytic.laws import Branch, Ways, term_of
from mcgw.scene.scene import Scene

_ENOUGH = 1e-14  # relative excess of load where Newton's steps are rounding errors
_FINE, _AT_ONCE = 1 / 64, 16  # step of the search where sums may rise and fall, and steps at a time
LOWEST = -40.0  # separation where searches end
_STEP = 0.5  # by which the search for a start goes down, where the margin was not enough
_LAST_DIGITS = 4 * np.finfo(float).eps


def separation_on(heights: Array, modulus: Array, exponent: float, target: float, start: float) -> float:
    """Separation h at which ``sum modulus (s - h)_+^exponent`` over given heights is `target`.

    The root of order `exponent` of that sum is a norm of the approaches, so convex and decreasing
    in h: Newton's steps on it run up to the solution from below and never pass it.

    Parameters
    ----------
    heights, modulus : ndarray
        Reduced heights in falling order, and E*(s)/E* >= 0 of each; shape (n,).
    exponent : float
        At least 1.
    target : float
        Positive.
    start : float
        A separation where the sum is at least `target`.

    Returns
    -------
    float
        Reduced separation.
    """
    rising, h = -heights, start  # as searchsorted wants it
    while True:
        n = int(np.searchsorted(rising, -h))
        d = heights[:n] - h
        forces = modulus[:n] * d ** (exponent - 1)
        total = float(forces @ d)
        if total <= target * (1 + _ENOUGH):
            return h
        step = total / float(forces.sum()) * (1 - (target / total) ** (1 / exponent))
        if h + step <= h:
            return h
        h += step


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
            return float(brentq(lambda h: float(excess(h)), low, low + _FINE, xtol=1e-15, rtol=1e-14))
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
        """What each of the first `n` adds."""
        s, e = self.heights[:n], self.modulus[:n]
        if self.ratios is None:
            return term_of(self.quantity, self.branch, h, s, e)
        ways = Ways(self.branch.law, None, self.branch.conductance)
        return ways.term(self.quantity, h, s, e, self.ratios[:n])

    def _pieces(self, h: float, n: int) -> Ints:
        s, e = self.heights[:n], self.modulus[:n]
        return self._branch(slice(n)).pieces(np.full(n, h), s - h, e)

    def _branch(self, which: slice | Ints) -> Branch:
        """That of some asperities, each by the law of its own radius."""
        if self.ratios is None:
            return self.branch
        return self.branch.with_radii(self.ratios[which])

    def _weight(self, which: Ints) -> Array | float:
        """What a load or an area is worth by the radius."""
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

    def above(self, h: float) -> "Summits":
        """The first of them, that rise above a separation."""
        n = int(np.searchsorted(-self.s, -h))
        first = Summits(self.scene, self.s[:n], None if self.ratios is None else self.ratios[:n])
        first.__dict__["modulus"] = self.modulus[:n]
        return first

    def largest_separation(self, q: Quantity, target: float, start: float) -> float | None:
        """The solution among separations from `start` on at which no modulus is negative, or None.

        These are all summits above `start`. Above the highest one of negative modulus Hertz's sum falls with
        the separation: so there is no larger solution.
        """
        if not self._by_powers:
            e = self.modulus
            start = float(self.s[e < 0].max(initial=start))
            return LawSum(q.base, self.scene.ways.loading, self.s, e, self.ratios).largest_separation(
                target, start
            )
        weights = self._weights(q)
        start = float(self.s[weights < 0].max(initial=start))
        if self._power_sum(q, weights, start) < target:
            return None
        return separation_on(self.s, weights, q.exponent, target, start)

    def separation_anywhere(self, q: Quantity, target: float, start: float) -> float | None:
        """The largest solution on all heights of a surface; None if there is none."""
        if not self._by_powers:
            return self._going_down(q, target, start)
        weights = self._weights(q)
        negative = self.s[weights < 0]
        if negative.size:
            found = self.largest_separation(q, target, -np.inf)
            if found is not None or self.scene.negative == "error":
                return found
            power_sum = np.vectorize(lambda h: self._power_sum(q, weights, h), otypes=[float])
            return crossing(lambda h: power_sum(h) - target, float(negative.max()))
        while self._power_sum(q, weights, start) < target:
            start -= _STEP
        return separation_on(self.s, weights, q.exponent, target, start)

    def nominal(self, value: float, sunk: float, lowest: float) -> float | None:
        """Largest separation above `lowest` that is the `value` when lowered by `sunk` (1/N) times the load.

        None if there is none.
        """
        high = max(float(self.s.max(initial=value)), value)
        load = np.vectorize(lambda h: self.sums(("load",), h)["load"], otypes=[float])
        return crossing(lambda h: value - h + sunk * load(h), high, lowest)

    def sums(self, names: Iterable[str], h: float) -> dict[str, float]:
        """Quantities at one separation, SI."""
        touching, found = self.above(h), {}
        s, modulus = touching.s, touching.modulus
        for name in names:
            q = quantity_of(name)
            if self.scene.hertzian:
                terms = touching._weights(q) * (s - h) ** q.exponent
            else:
                terms = self.scene.ways.term(name, h, s, modulus, touching.ratios)
            found[name] = q.scale(self.scene.surface) * float(np.sum(terms))
        return found

    def _going_down(self, q: Quantity, target: float, start: float) -> float | None:
        """As `separation_anywhere` under any law, step by step."""
        softest = float(self.s[self.modulus < 0].max(initial=LOWEST))
        while start > softest:
            start = max(start - _STEP, softest)
            if (found := self.above(start).largest_separation(q, target, start)) is not None:
                return found
        return None

    @property
    def _by_powers(self) -> bool:
        """Whether load and area are sums of powers of the approaches."""
        return type(self.scene.law) is Hertz

    def _weights(self, q: Quantity) -> Array:
        modulus = self.modulus if q.modulus else np.ones_like(self.s)
        return modulus if self.ratios is None else modulus * self.ratios**q.radius

    def _power_sum(self, q: Quantity, weights: Array, h: float) -> float:
        touching = self.s > h
        return float(np.sum(weights[touching] * (self.s[touching] - h) ** q.exponent))
