"""The separations at which sums over given heights have a given value, of one surface or of many.

Of one surface sums may rise and fall; of many, one search is for all whose sums fall.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from analytic import Hertz, Quantity, quantity_of
from analytic.arrays import Array, Ints
from analytic.laws import Branch
from analytic.roots import root, sign_changes
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
        branch = loading if ratios is None else loading.with_radii(ratios)
        found = list(branch.terms(names, h, s, modulus))
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
            return root(lambda h: float(excess(h)), low + _FINE, low)
    return None


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
        """Return the largest separation from `start` on at which a sum has a value or jumps past it; or None.

        None, too, where a modulus is negative there. Each piece of the law rises with the penetration. From
        one piece to the next, and where it begins, a contact may jump, up or down: so the sum need not be
        monotone, and may pass a value without having it; the sum there is beyond the value.

        Parameters
        ----------
        q : Quantity
            Load or area.
        target : float
            Over its scale.
        start : float
            Reduced separation.
        """
        low = max(start, self.softest)
        if not self.s.size or self.s[0] <= low:
            return None
        return self._within(q, target, low, float(self.s[0]))

    def _within(self, q: Quantity, target: float, low: float, high: float) -> float | None:
        """As above between two separations, at the higher one of which the sum is less than the value."""
        at_low, most, smooth = self._between(q, low, high)
        if most < target:
            return None
        if smooth:
            return root(lambda h: float(np.sum(self._terms([q.name], h))) - target, high, low)
        middle = low + (high - low) / 2
        if not low < middle < high:
            return low if at_low >= target else None
        found = self._within(q, target, middle, high)
        return self._within(q, target, low, middle) if found is None else found

    def _between(self, q: Quantity, low: float, high: float) -> tuple[float, float, bool]:
        """Return the sum at `low`, its bound up to `high`, and whether each contact keeps its piece.

        Each contact is at most what it is at `low`, or where one of its pieces ends.
        """
        (terms,) = self._terms([q.name], low)
        s, e, at_low = self.s[: terms.size], self.modulus[: terms.size], float(np.sum(terms))
        branch = self._branch(slice(terms.size))
        first, last = (branch.pieces(np.full_like(s, h), s - h, e) for h in (high, low))
        none = np.zeros(1)
        if self.scene.ways.loading.value(q.base, 0, none, none, np.ones(1))[0]:  # contacts begin with a jump
            terms = np.where(first < 0, np.maximum(terms, 0.0), terms)
        else:
            first = np.maximum(first, 0)
        changed = np.flatnonzero(first < last)
        if not changed.size:
            return at_low, at_low, True
        weight = np.ones_like(s) if self.ratios is None else self.ratios[: s.size] ** q.radius
        for j, limit in enumerate(self._branch(changed).law.limits(e[changed])):
            ends = (first[changed] <= j) & (j < last[changed])
            here, limit = changed[ends], limit[ends]
            at_end = self._branch(here).value(q.base, j, s[here] - limit, limit, e[here])
            terms[here] = np.maximum(terms[here], weight[here] * at_end)
        return at_low, float(np.sum(terms)), False

    def _branch(self, which: slice | Ints) -> Branch:
        """Return that of some asperities, each by the law of its own radius."""
        loading = self.scene.ways.loading
        return loading if self.ratios is None else loading.with_radii(self.ratios[which])

    def _terms(self, names: Sequence[str], h: float) -> Array:
        """Return what the asperities above a separation add, which come first: (quantities, asperities)."""
        n = int(np.searchsorted(-self.s, -h))
        ratios = None if self.ratios is None else self.ratios[:n]
        return asperity_terms(self.scene, names, h, self.s[:n], self.modulus[:n], ratios)

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
        names = list(names)
        totals = np.sum(self._terms(names, h), axis=1).tolist()
        return {
            name: quantity_of(name).scale(self.scene.surface) * x
            for name, x in zip(names, totals, strict=True)
        }


_CLOSE = 1e-14  # relative excess of a sum, which is its rounding error
_ROUNDING = 1e-9  # of a law that goes on smoothly


@dataclass(frozen=True, eq=False)
class ManySurfaces:
    """Asperities of many surfaces of a scene, surface by surface.

    Parameters
    ----------
    scene : Scene
        Whose grading and contact law they have.
    counts : ndarray of int
        Asperities of each surface, shape (surfaces,).
    s : ndarray
        Reduced heights, shape (asperities,).
    ratios : ndarray or None
        Radii over that of the surface, where summits have their own.
    """

    scene: Scene
    counts: Ints
    s: Array
    ratios: Array | None

    @cached_property
    def modulus(self) -> Array:
        """E*(s)/E* of each asperity."""
        return np.asarray(self.scene.modulus(self.s))

    @cached_property
    def owner(self) -> Ints:
        """Number of the surface of each asperity."""
        return np.repeat(np.arange(self.counts.size), self.counts)

    def surface(self, number: int) -> Summits:
        """Return the asperities of one of them."""
        end = int(np.sum(self.counts[: number + 1]))
        its = slice(end - int(self.counts[number]), end)
        return Summits.of(self.scene, self.s[its], None if self.ratios is None else self.ratios[its])

    def above(self, h: float) -> "ManySurfaces":
        """Return the same surfaces, of which only the asperities above a separation are looked at."""
        high = self.s > h
        counts = np.bincount(self.owner[high], minlength=self.counts.size)
        return ManySurfaces(
            self.scene, counts, self.s[high], None if self.ratios is None else self.ratios[high]
        )

    def separations(self, q: Quantity, value: float, lowest: float, about: float) -> Array:
        """Separation of each surface at which a sum has a value, or jumps past it; shape (surfaces,).

        nan where it lies below the lowest separation or an asperity of negative modulus, or where the sum may
        rise with the separation.

        Parameters
        ----------
        q : Quantity
            Load or area.
        value : float
            Positive, SI.
        lowest : float
            Reduced separation above which all asperities are listed.
        about : float
            What most are near, on either side within its distance from the lowest one.
        """
        found, target = np.full(self.counts.size, np.nan), value / q.scale(self.scene.surface)
        if not (self.s.size and self._falls(q)):
            return found
        high, low = np.full((2, self.counts.size), [[-np.inf], [lowest]])
        np.maximum.at(high, self.owner, self.s)
        soft = self.modulus < 0
        np.maximum.at(low, self.owner[soft], self.s[soft])  # below these sums may rise
        root = 1 / max(q.exponent, 1.0)

        def excess(h: Array, which: Ints) -> Array:
            """Of the sum's root, in which it is nearly linear, over the target's."""
            return np.asarray((self._total(q, h, which) / target) ** root - 1)

        sound = np.flatnonzero(high > low)
        at_low = excess(low[sound], sound)
        sound, at_low = sound[at_low >= 0], at_low[at_low >= 0]
        near = np.minimum(high, 2 * about - lowest)[sound]
        at_high = excess(near, sound)
        near, at_high = np.where(at_high < 0, [near, at_high], [high[sound], np.full(sound.size, -1.0)])
        found[sound] = sign_changes(
            lambda h, which: excess(h, sound[which]),
            near,
            low[sound],
            np.ones(sound.size),
            at_ends=(at_high, at_low),
            close=_CLOSE,
        )
        return found

    def sums(self, names: Iterable[str], h: Array) -> dict[str, Array]:
        """Quantities of each surface at its separation, SI, shape (surfaces,)."""
        names = list(names)
        terms = asperity_terms(
            self.scene, names, np.repeat(h, self.counts), self.s, self.modulus, self.ratios
        )
        return {
            name: quantity_of(name).scale(self.scene.surface) * self._added(each, self.counts)
            for name, each in zip(names, terms, strict=True)
        }

    def _total(self, q: Quantity, h: Array, which: Ints) -> Array:
        """Return the sums of some surfaces at separations of theirs, over the scale."""
        mine: slice | Ints = slice(None)
        if which.size < self.counts.size:
            chosen = np.zeros(self.counts.size, dtype=bool)
            chosen[which] = True
            mine = np.flatnonzero(chosen[self.owner])
        counts, ratios = self.counts[which], None if self.ratios is None else self.ratios[mine]
        at = np.repeat(h, counts)
        (terms,) = asperity_terms(self.scene, [q.name], at, self.s[mine], self.modulus[mine], ratios)
        return self._added(terms, counts)

    def _added(self, terms: Array, counts: Ints) -> Array:
        """Return the sums of the terms of each surface."""
        total, some = np.zeros(counts.size), counts > 0
        if some.any():
            total[some] = np.add.reduceat(terms, (np.cumsum(counts) - counts)[some])
        return total

    def _falls(self, q: Quantity) -> bool:
        """Whether what an asperity of modulus >= 0 adds never falls as it is pressed."""
        branch, e = self.scene.ways.loading, np.maximum(self.modulus, np.finfo(float).tiny)
        branch = branch if self.ratios is None else branch.with_radii(self.ratios)
        zero = np.zeros_like(e)
        if np.any(branch.of_root(q.base, 0, zero, e) < 0):
            return False
        for j, limit in enumerate(branch.law.limits(e)):
            y = np.sqrt(limit)
            with np.errstate(all="ignore"):  # without a modulus nothing yields, at no limit
                before, after = (branch.of_root(q.base, piece, y, e) for piece in (j, j + 1))
            if np.any(after < before * (1 - _ROUNDING)):
                return False
        return True
