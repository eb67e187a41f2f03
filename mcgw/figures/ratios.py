"""Means over separation and load, their ratios at equal separation and equal load, and mean moduli."""

from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic import mean_modulus
from analytic.arrays import Array
from mcgw.figures.against_theory import ENOUGH
from mcgw.figures.compared import Compared, Key
from mcgw.figures.data import GAMMA, Estimate, Panel, Points, Series, ratio_of_sums
from mcgw.scene.section import SceneError

POWERS = {"number": 0.0, "area": 1.0, "load": 1.5}


@dataclass(frozen=True)
class Mean:
    """A product of means over others, such as area per load.

    Parameters
    ----------
    above, below : tuple of str
        Names of the quantities.
    relative : bool, optional
        Whether it is divided by that of the reference.
    at_load : bool, optional
        Whether separations are those of the reference, and the load is the same.
    factor : float, optional
        What it is multiplied by.
    """

    above: tuple[str, ...]
    below: tuple[str, ...] = ()
    relative: bool = False
    at_load: bool = False
    factor: float = 1.0

    def exact(self, f: Compared, key: Key, h: Array) -> Array:
        """By theory."""
        above, below = self._factors(f, key, h, f.theory)
        return np.asarray(self.factor * np.prod(above, axis=0) / np.prod(below, axis=0))

    def drawn(self, f: Compared, key: Key, h: Array) -> Estimate:
        """By Monte Carlo."""
        mean, stderr = ratio_of_sums(*self._factors(f, key, h, f.values))
        return self.factor * mean, self.factor * stderr

    def _factors(self, f: Compared, key: Key, h: Array, of: Any) -> tuple[list[Array], list[Array]]:
        """Numerator and denominator; `of` takes a label, a quantity and separations."""
        there = f.at_load_of_reference(key, h) if self.at_load else h
        above, below = ([of(key, name, there) for name in names] for names in (self.above, self.below))
        if self.relative:
            above += [of(f.reference, name, h) for name in self.below]
            below += [of(f.reference, name, h) for name in self.above]
        return above, below


@dataclass(frozen=True)
class Modulus:
    """Mean of E*(s)/E* over the contacts, weighted by one of `POWERS`."""

    weight: Any

    def exact(self, f: Compared, key: Key, h: Array) -> Array:
        """By theory."""
        return mean_modulus(h, f.of(key).modulus, heights=f.scene.heights, weight=self.weight)

    def drawn(self, f: Compared, key: Key, h: Array) -> Estimate:
        """Over the contacts of the listed surfaces."""
        modulus, power = f.of(key).modulus, POWERS[self.weight]
        above, below = np.zeros((2, len(f.listed), len(h)))
        for i, s in enumerate(f.listed):
            for k, separation in enumerate(h):
                touching = s[s > separation]
                e = modulus(touching)
                weights = (touching - separation) ** power * (e if self.weight == "load" else 1.0)
                above[i, k], below[i, k] = np.sum(weights * e), np.sum(weights)
        return ratio_of_sums([above], [below])


Measure = Mean | Modulus


def of_reference(f: Compared, symbol: str) -> str:
    """Label a ratio to the reference."""
    return rf"${symbol}_\mathrm{{{'hom' if f.swept else 'ref'}}}$"


def over_separation(f: Compared, label: str, what: Measure, key: str = "", n_surfaces: int = 0) -> Series:
    """Return what is measured on a scene, by default that of the label, over the separation.

    Points are where so many surfaces (default: all) have enough contacts for an error; there are none if a
    modulus is not positive at all separations of what is measured.
    """
    key, n, points = key or label, n_surfaces or f.scene.n_surfaces, None
    known = (f.theory(key, "contacts", f.h) * n >= ENOUGH) & (n > 1)
    with suppress(SceneError):
        if known.any():
            (mean, stderr), exact = what.drawn(f, key, f.h), what.exact(f, key, f.h)
            points = Points(f.h[known], mean[known], stderr[known], exact[known])
    return Series(label, f.line, what.exact(f, key, f.line), points)


def over_gamma(
    f: Compared, title: str, ylabel: str, what: Measure, line: Array, gammas: Array, at: Array
) -> Panel:
    """Draw a ratio to the reference over gamma: a line for each separation."""
    mean, stderr = np.array([what.drawn(f, float(gamma), at) for gamma in gammas]).transpose(1, 2, 0)
    curves, truth = (
        np.array([what.exact(f, float(gamma), at) for gamma in some]).T for some in (line, gammas)
    )
    series = tuple(
        Series(f"d/σ = {h:g}", line, curves[k], Points(gammas, mean[k], stderr[k], truth[k]))
        for k, h in enumerate(at)
    )
    return Panel(title, GAMMA, ylabel, series, level=1.0)
