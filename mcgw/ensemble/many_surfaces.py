"""The separations at which sums over many surfaces have a given value: one search for all of them."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic import Quantity, quantity_of
from analytic.arrays import Array, Ints, Marks
from analytic.laws.branch import terms_of
from mcgw.scene.scene import Scene

_CLOSE = 1e-14  # relative excess of a sum, which is its rounding error
_LAST_DIGITS = 2 * np.finfo(float).eps
_MOST = 200  # steps; one that only halves 40 sigma takes 60
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

    def separations(self, q: Quantity, value: float, lowest: float, about: float) -> Array:
        """Separation of each surface at which a sum has a value, or jumps past it; shape (surfaces,).

        nan where it lies below the lowest separation, or where the sum may rise with the separation.

        Parameters
        ----------
        q : Quantity
            Load or area.
        value : float
            Positive, SI.
        lowest : float
            Reduced separation above which all asperities are listed.
        about : float
            Where the search begins.
        """
        found, target = np.full(self.counts.size, np.nan), value / q.scale(self.scene.surface)
        if not (self.s.size and self._falls(q)):
            return found
        high = np.full(self.counts.size, -np.inf)
        np.maximum.at(high, self.owner, self.s)
        softest = np.zeros(self.counts.size)
        np.minimum.at(softest, self.owner, self.modulus)
        root = 1 / max(q.exponent, 1.0)

        def excess(h: Array, which: Ints) -> Array:
            """Of the sum's root, in which it is nearly linear, over the target's."""
            return np.asarray((self._total(q, h, which) / target) ** root - 1)

        sound = np.flatnonzero((high > lowest) & (softest >= 0))
        low = np.full(sound.size, lowest)
        at_low = excess(low, sound)
        reached = at_low >= 0
        sound, low, at_low = sound[reached], low[reached], at_low[reached]
        found[sound] = _falling_roots(
            lambda h, which: excess(h, sound[which]), low, at_low, high[sound], about
        )
        return found

    def sums(self, names: Iterable[str], h: Array) -> dict[str, Array]:
        """Quantities of each surface at its separation, SI, shape (surfaces,)."""
        names = list(names)
        terms = self._terms(names, h, slice(None))
        return {
            name: quantity_of(name).scale(self.scene.surface) * self._added(each, self.counts)
            for name, each in zip(names, terms, strict=True)
        }

    def _total(self, q: Quantity, h: Array, which: Ints) -> Array:
        """Sums of some surfaces at separations of theirs, over the scale."""
        mine: slice | Ints = slice(None)
        if which.size < self.counts.size:
            chosen = np.zeros(self.counts.size, dtype=bool)
            chosen[which] = True
            mine = np.flatnonzero(chosen[self.owner])
        (terms,) = self._terms([q.name], h, mine, which)
        return self._added(terms, self.counts[which])

    def _terms(self, names: list[str], h: Array, mine: slice | Ints, which: Ints | None = None) -> Array:
        """What asperities add at the separations of their surfaces, shape (names, asperities)."""
        counts = self.counts if which is None else self.counts[which]
        s, e = self.s[mine], self.modulus[mine]
        at, ways = np.repeat(h, counts), self.scene.ways
        if self.scene.hertzian:
            above, found = np.maximum(s - at, 0.0), []
            for q in map(quantity_of, names):
                powers = above**q.exponent if q.exponent else (above > 0) * 1.0
                found.append(e * powers if q.modulus else powers)
        else:
            branch = ways.loading if self.ratios is None else ways.loading.with_radii(self.ratios[mine])
            found = list(terms_of(names, branch, at, s, e))
        if self.ratios is not None:
            found = [
                self.ratios[mine] ** quantity_of(x).radius * y for x, y in zip(names, found, strict=True)
            ]
        return np.asarray(found)

    def _added(self, terms: Array, counts: Ints) -> Array:
        """Sums of the terms of each surface."""
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


def _falling_roots(
    excess: Callable[[Array, Ints], Array], low: Array, at_low: Array, high: Array, about: float
) -> Array:
    """Roots of falling functions between `low`, where they are `at_low` >= 0, and `high`, where they are < 0.

    By Chandrupatla's rule: inverse quadratic steps where they are safe, else halves (1997, Adv. Eng. Softw.
    28, 145). Where a function jumps past 0 the root is the lower side.
    """
    found, active = low.copy(), np.arange(low.size)
    a, fa, b, fb = low, at_low, high, np.full(low.size, -1.0)
    c, fc = b, fb
    step = np.clip((about - a) / (b - a), 0.05, 0.95)
    for _ in range(_MOST):
        new = a + step * (b - a)
        f = excess(new, active)
        same = (f >= 0) == (fa >= 0)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = new, f
        close, narrow = np.abs(fa) <= _CLOSE, np.abs(b - a) <= _LAST_DIGITS * np.maximum(1, np.abs(a))
        found[active] = np.where(close, a, np.where(fa >= 0, a, b))
        more = ~(close | narrow)
        if not more.any():
            return found
        active = active[more]
        a, fa, b, fb, c, fc = (x[more] for x in (a, fa, b, fb, c, fc))
        step = _next_step(a, fa, b, fb, c, fc)
    return found


def _next_step(a: Array, fa: Array, b: Array, fb: Array, c: Array, fc: Array) -> Array:
    """Share of the way from a to b at which the function is looked at next."""
    with np.errstate(all="ignore"):
        place, value = (a - b) / (c - b), (fa - fb) / (fc - fb)
        safe: Marks = (value**2 < place) & ((1 - value) ** 2 < 1 - place)
        inverse = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        least = np.minimum(_LAST_DIGITS / 2 * np.maximum(1, np.abs(a)) / np.abs(b - a), 0.5)
    return np.clip(np.where(safe, inverse, 0.5), least, 1 - least)
