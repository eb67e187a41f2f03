"""Means over separation and load, their ratios at equal separation and load, mean moduli, and scatter."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic import mean_modulus
from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.figures.compared import Compared, Key
from mcgw.figures.panels import GAMMA, Panel, Series
from mcgw.scene.scene import Scene
from mcgw.scene.section import SceneError
from mcgw.statistics.comparison import Points

Estimate = tuple[Array, Array]  # means and their standard errors
POWERS = {"number": 0.0, "area": 1.0, "load": 1.5}
ENOUGH = 20  # contacts in the ensemble; with fewer a mean is far from Gaussian
_ROUNDING = 1e-14  # of a ratio of sums that are the same: no residual is given in units of it


def ratio_of_sums(above: Sequence[Array], below: Sequence[Array]) -> Estimate:
    """Take a product of means over the same surfaces over another, with its error by the delta method.

    Parameters
    ----------
    above, below : sequence of ndarray
        Sums of each surface, shape (surfaces, ...), of the factors of numerator and denominator.

    Returns
    -------
    (ndarray, ndarray)
        Value and standard error, of shape (...); nan where there is nothing. An error of the last digits
        alone is 0.
    """
    signed = [*((1, x) for x in above), *((-1, x) for x in below)]
    with np.errstate(invalid="ignore", divide="ignore"):
        value = np.prod([x.mean(axis=0) ** float(sign) for sign, x in signed], axis=0)
        influence = np.sum([sign * x / x.mean(axis=0) for sign, x in signed], axis=0)
        relative = influence.std(axis=0, ddof=1) / np.sqrt(len(influence))
    return value, np.abs(value) * np.where(relative <= _ROUNDING, 0.0, relative)


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


def spread(
    label: str, scene: Scene, name: str, line: Array, drawn: Ensemble | None, fewest: float = ENOUGH
) -> Series:
    """Return the exact standard deviation over the mean of a quantity, and that of what was drawn.

    Points have standard errors by the exact law of one surface, to first order: half of std's, that of the
    mean, and both together. There are none at separations with fewer contacts in the ensemble.
    """
    exact = _std_over_mean(scene.theory.cumulants(name, line))
    if drawn is None:
        return Series(label, line, exact)
    h = drawn.separations
    known = (scene.theory.mean("contacts", h) * drawn.n_surfaces >= fewest) & (drawn.std(name) > 0)
    if not known.any():
        return Series(label, line, exact)
    law = scene.theory.cumulants(name, h[known])
    there = _std_over_mean(law)
    relative = np.sqrt((law.excess_kurtosis + 2) / 4 + there**2 - law.skewness * there)
    seen = drawn.std(name)[known] / np.abs(drawn.mean(name)[known])
    return Series(label, line, exact, Points(h[known], seen, there * relative / drawn.n_surfaces**0.5, there))


def _std_over_mean(law: Any) -> Array:
    with np.errstate(divide="ignore", invalid="ignore"):  # nan where nothing touches
        return np.asarray(np.sqrt(law.variance) / np.abs(law.mean))
