"""The separations at which sums over many surfaces have a given value: one search for all of them."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic import Quantity, quantity_of
from analytic.arrays import Array, Ints
from analytic.roots import sign_changes
from mcgw.ensemble.separation import Summits, asperity_terms
from mcgw.scene.scene import Scene

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
