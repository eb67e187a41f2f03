"""The separations at which sums over given heights have a given value, of many surfaces at once.

Surfaces approach from above, and the largest separation counts. Of most laws what an asperity adds never
falls as it is pressed: then there is one root. Else the sum may rise and fall, and jump where contacts go on
to the next piece of their law; so the search goes down in steps over which a bound says that the value is not
reached, or no contact changes its piece.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from analytic import Quantity, quantity_of
from analytic.arrays import Array, Ints, Marks
from analytic.laws import Branch
from analytic.roots import sign_changes
from mcgw.scene.scene import Scene

Excess = Callable[[Array, Ints], Array]  # of separations, and of the numbers of the surfaces that have them
_FINE = 1 / 64  # step of the search where moduli may be negative
LOWEST = -40.0  # separation where searches end
_CLOSE = 1e-14  # relative excess of a sum, which is its rounding error
_NOWHERE = -1e3  # height in place of an asperity


def crossing(excess: Excess, high: Array, lowest: float = LOWEST) -> Array:
    """Return the largest arguments up to `high` where functions are not negative, shape (functions,).

    Of arguments and the numbers of the functions, shape (m,); nan where there is none, down to the lowest.
    """
    found, top, left = np.full(high.size, np.nan), high, np.flatnonzero(np.isfinite(high))
    at = high
    while left.size:
        reached = excess(at[left], left) >= 0  # at once by a last digit
        k = left[reached]
        found[k] = sign_changes(_of_some(excess, k), top[k], at[k], np.ones(k.size))
        left = left[~reached & (at[left] > lowest)]
        top, at = at, np.maximum(at - _FINE, lowest)
    return found


def _of_some(excess: Excess, which: Ints) -> Excess:
    """Return functions of which only some are asked."""
    return lambda h, k: excess(h, which[k])


@dataclass(frozen=True, eq=False)
class Asperities:
    """Asperities of some surfaces of a scene, arrays of shape (surfaces, most of a surface)."""

    scene: Scene  # whose grading and contact law they have
    s: Array  # reduced heights in descending order; `_NOWHERE` after the last
    modulus: Array  # E*(s)/E* of each; 1 there
    ratios: Array | None = None  # radii over that of the surface, where summits have their own

    @classmethod
    def of(cls, scene: Scene, counts: Ints, s: Array, ratios: Array | None = None) -> "Asperities":
        """Return those of surfaces listed one after the other, of which their numbers of asperities tell."""
        inside = np.arange(max(counts.max(initial=0), 1)) < counts[:, None]

        def rows(values: Array, none: float) -> Array:
            found = np.full(inside.shape, none)
            found[inside] = values
            return found

        tables = [rows(s, _NOWHERE), rows(np.asarray(scene.modulus(s)), 1.0)]
        tables += [] if ratios is None else [rows(ratios, 1.0)]
        order = np.argsort(-tables[0], axis=1)
        return cls(scene, *(np.take_along_axis(each, order, axis=1) for each in tables))

    def some(self, which: Ints | slice, most: int | None = None) -> "Asperities":
        """Return some of the surfaces, or the highest asperities of them, so many at most."""
        ratios = None if self.ratios is None else self.ratios[which, :most]
        return Asperities(self.scene, self.s[which, :most], self.modulus[which, :most], ratios)

    def above(self, h: Array) -> "Asperities":
        """Return the same surfaces with all asperities above their separations, and perhaps more."""
        return self.some(slice(None), max(int((self.s > h[:, None]).sum(axis=1).max(initial=0)), 1))

    @property
    def highest(self) -> Array:
        """Height of the highest asperity of each surface."""
        return self.s[:, 0]

    @property
    def softest(self) -> Array:
        """Height of the highest one of negative modulus on each surface, below which sums may rise."""
        return np.asarray(np.where(self.modulus < 0, self.s, -np.inf).max(axis=1))

    @property
    def branch(self) -> Branch:
        """That of all, each by the law of its own radius."""
        return self.scene.ways.loading.with_radii(self.ratios)

    def terms(self, names: Sequence[str], h: Array) -> Array:
        """Return what asperities add to quantities over their scales: (quantities, surfaces, asperities)."""
        if not self.scene.hertzian:
            return self.branch.terms(names, h[:, None], self.s, self.modulus)
        quantities, above = [quantity_of(name) for name in names], np.maximum(self.s - h[:, None], 0.0)
        powers = (above**q.exponent if q.exponent else (above > 0) * 1.0 for q in quantities)
        found = [self.modulus * y if q.modulus else y for q, y in zip(quantities, powers, strict=True)]
        if self.ratios is not None:
            found = [self.ratios**q.radius * y for q, y in zip(quantities, found, strict=True)]
        return np.asarray(found)

    def sums(self, names: Sequence[str], h: Array) -> dict[str, Array]:
        """Quantities of each surface at its separation, SI, shape (surfaces,)."""
        scales = (quantity_of(name).scale(self.scene.surface) for name in names)
        found = zip(names, scales, self.above(h).terms(names, h), strict=True)
        return {name: scale * each.sum(axis=-1) for name, scale, each in found}

    def separations(
        self, q: Quantity, value: float, lowest: float, about: float | None = None, sunk: float | None = None
    ) -> Array:
        """Return the largest separation at which a sum of each surface has a value, or jumps past it.

        All asperities above the `lowest` separation are listed; most separations are near `about`, on either
        side within its distance from the lowest one. At a nominal separation, d/sigma, `sunk` is by how much
        each newton lowers it. It is nan below the lowest separation, or, unless the scene allows such
        contacts, below an asperity of negative modulus.
        """
        if sunk is not None:
            load, high = quantity_of("load"), np.maximum(self.highest, value)
            unit = sunk * load.scale(self.scene.surface)
            return crossing(lambda h, k: value - h + unit * self._total(load, h, k), high, lowest)
        goal, near = value / q.scale(self.scene.surface), lowest if about is None else 2 * about - lowest
        found = self._first(q, goal, np.maximum(lowest, self.softest), near)
        if self.scene.negative == "allow":
            pressed = np.where(np.isnan(found), self.softest, -np.inf)
            found = np.fmax(found, crossing(lambda h, k: self._total(q, h, k) - goal, pressed, lowest))
        return found

    def _first(self, q: Quantity, goal: float, low: Array, near: float) -> Array:
        """Return where sums over their scale reach a goal above `low`; most are not far from `near`."""
        on, found, power = self.above(low), np.full(low.size, np.nan), 1 / max(q.exponent, 1.0)
        high = on.highest.copy()
        falls = on.branch.falls(q.base, on.modulus) is None  # as a surface is lifted
        width = high - np.where(near < high, near, low)

        def excess(total: Array) -> Array:
            """Of the sum's root, in which it is nearly linear, over the value's."""
            return np.asarray(np.sign(total) * np.abs(total / goal) ** power - 1)

        def excess_at(h: Array, which: Ints) -> Array:
            return excess(on._total(q, h, which))

        over, passed = np.full(low.size, -1.0), np.zeros(low.size, dtype=bool)
        active = np.flatnonzero(high > low)
        while active.size:
            top, some = high[active], on.some(active)
            below = np.nextafter(top, -np.inf)
            at = np.maximum(np.minimum(top - width[active], below), low[active])
            total, most, smooth = some._bounds(q, at, top, falls)
            here, thin = excess(total), at == below
            free = (most < goal) | (thin & (total < goal))
            found[active[~free & thin]] = at[~free & thin]
            reached = ~free & ~thin & smooth
            k = active[reached]
            found[k] = sign_changes(
                _of_some(excess_at, k),
                top[reached], at[reached], np.ones(k.size), at_ends=(over[k], here[reached]), close=_CLOSE,
            )  # fmt: skip
            width[active] *= np.where(~free, 0.5, np.inf if falls else 1.0 + passed[active])
            passed[active], high[active] = free, np.where(free, at, top)
            over[active] = np.where(free, here, over[active])
            active = active[np.isnan(found[active]) & (high[active] > low[active])]
        return found

    def _total(self, q: Quantity, h: Array, which: Ints) -> Array:
        """Return a sum of some surfaces at their separations, over the scale."""
        return np.asarray(self.some(which).terms([q.name], h)[0].sum(axis=-1))

    def _bounds(self, q: Quantity, low: Array, high: Array, falls: bool) -> tuple[Array, Array, Marks]:
        """Return sums at `low`, their bounds up to `high`, and where the sum there is the bound and falls.

        Each piece of the law rises with the penetration. From one piece to the next, and where it begins, a
        contact may jump, up or down: each is at most what it is at `low`, or where one of its pieces ends.
        """
        (terms,) = self.terms([q.name], low)
        total = terms.sum(axis=-1)
        if falls:
            return total, total, np.ones(low.size, dtype=bool)
        s, e, branch, none = self.s, self.modulus, self.branch, np.zeros(1)
        first, last = (branch.pieces(h[:, None], s - h[:, None], e) for h in (high, low))
        if self.scene.ways.loading.value(q.base, 0, none, none, np.ones(1))[0]:  # contacts begin with a jump
            terms = np.where(first < 0, np.maximum(terms, 0.0), terms)
        else:
            first = np.maximum(first, 0)
        smooth = np.all(first >= last, axis=-1)
        for j, limit in enumerate(() if smooth.all() else branch.limits(e)):
            ends = (first <= j) & (j < last)
            there = limit[ends]
            weight = 1.0 if self.ratios is None else self.ratios[ends] ** q.radius
            at_end = branch.of_some(ends).value(q.base, j, s[ends] - there, there, e[ends])
            terms[ends] = np.maximum(terms[ends], weight * at_end)
        return total, np.where(smooth, total, terms.sum(axis=-1)), smooth
