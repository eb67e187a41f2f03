"""Single checks of statistical convergence, each with the probability of its result if all is right.

They take surfaces along the principal axes of the exact correlation of all that is asked. Sums of one surface
at several separations share their asperities. Turned to these axes they are uncorrelated, of mean 0 and
variance 1, with known third and fourth cumulants: a test needs no more.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import polygamma, psi
from scipy.stats import binom, chi2, kstest, norm, t as student

from analytic import quantity_of
from analytic.arrays import Array
from mcgw.scene.scene import Scene
from mcgw.statistics.verdict import Check, bounded_theory

_TOUCHING = 100  # asperities expected in contact, so that a single surface is nearly Gaussian
_INDEPENDENT = 1e-6  # least variance of a combination: below it columns are nearly equal


@dataclass(frozen=True)
class PrincipalComponents:
    """Axes and the exact distribution along them."""

    columns: tuple[tuple[str, int], ...]  # quantity and number of the separation of what is combined
    mean: Array  # exact, of each column
    std: Array
    axes: Array  # shape (columns, axes)
    skewness: Array  # exact third cumulant along each axis
    kurtosis: Array  # exact fourth cumulant along each axis

    @classmethod
    def of(cls, scene: Scene, quantities: tuple[str, ...] = ()) -> "PrincipalComponents":
        """Return the axes of a scene: of those separations where single surfaces are nearly Gaussian.

        Of all its quantities, unless some are named; and of those combinations in which means over so many
        surfaces do not show how accurate values are.
        """
        n, h, quantities = scene.n_asperities, np.array(scene.separations), quantities or scene.quantities
        parts = bounded_theory(scene, scene.n_surfaces).fluctuations(quantities, h)
        variance = parts.moment(2)
        share = np.concatenate([scene.theory.mean(_adding(scene, name), h) / n for name in quantities])
        touching = n * np.minimum(share, 1 - share + (scene.count == "poisson"))
        chosen = np.flatnonzero((touching > _TOUCHING) & (variance > 0))
        unit = np.sqrt(variance[chosen])
        parts = parts.take(chosen, unit)
        axes = parts.whitening(_INDEPENDENT)
        along = parts.turned(axes)
        third = along.moment(3) / np.sqrt(n)
        fourth = (along.moment(4) - 3 * (scene.count == "fixed")) / n
        good = np.abs(fourth) < 0.5  # of a combination, over surfaces
        columns = tuple((quantities[c // len(h)], c % len(h)) for c in chosen.tolist())
        scale = np.array([quantity_of(name).scale(scene.surface) for name, _ in columns])
        std = np.sqrt(n) * scale * unit
        return cls(columns, np.sqrt(n) * std * parts.mean, std, axes[:, good], third[good], fourth[good])

    def turn(self, sums: Mapping[str, NDArray[Any]]) -> Array:
        """Every surface along the axes, shape (surfaces, axes)."""
        if not self.columns:
            return np.empty((len(next(iter(sums.values()))), 0))
        values = np.stack([sums[name][:, k] for name, k in self.columns], axis=1).astype(np.float64)
        return np.asarray((values - self.mean) / self.std @ self.axes)


def _adding(scene: Scene, name: str) -> str:
    """Name the count of the asperities that add to a quantity."""
    q = quantity_of(name)
    if q.base == "yielded":
        return "yielded"
    return "contacts_unloading" if q.unloading and not scene.law.elastic else "contacts"


@dataclass(frozen=True)
class Slope:
    """A power law of the error."""

    against: str  # what is varied
    sizes: Array
    errors: Array  # relative, at each size
    stderr: Array  # relative uncertainty of each
    value: float  # exponent
    uncertainty: float  # its standard error

    @property
    def check(self) -> Check:
        """Whether the exponent is -1/2."""
        p = float(2 * norm.sf(abs(self.value + 0.5) / self.uncertainty))
        seen = f"{self.value:.4f} +- {1.96 * self.uncertainty:.4f} (95 %), expected -0.5"
        return Check(f"slope of the error in {self.against}", seen, p)


def slope(against: str, rows: Iterable[tuple[float, Array, float]]) -> list[Slope]:
    """Exponent of the root mean square error, if there are two sizes, each with its own independent errors.

    By weighted least squares on logarithms, whose mean and variance are those of a chi-square: rows are a
    size, the squared errors there, and the excess kurtosis of one error.
    """
    if len(rows := list(rows)) < 2:
        return []
    sizes, squares, excess = zip(*rows, strict=True)
    degrees = np.array([x.size / (1 + k / 2) for x, k in zip(squares, excess, strict=True)])
    bias = psi(degrees / 2) - np.log(degrees / 2)
    y = (np.log([x.mean() for x in squares]) - bias) / 2
    weight = 2 / np.sqrt(polygamma(1, degrees / 2))
    (value, _), covariance = np.polyfit(np.log(sizes), y, 1, w=weight, cov="unscaled")
    size = np.array(sizes)
    return [Slope(against, size, np.exp(y), 1 / weight, float(value), float(covariance[0, 0] ** 0.5))]


def worst(name: str, p: Array, seen: Callable[[int], str]) -> Check:
    """Return the least probability of several, which counts as often as there are (Bonferroni)."""
    k = int(np.argmin(p))
    return Check(name, seen(k), min(1.0, p.size * float(p[k])))


def variances(exact: PrincipalComponents, y: Array) -> Check:
    """Variance along each axis: a scaled chi-square with the exact kurtosis."""
    degrees = len(y) * 2 / (2 + exact.kurtosis)
    ratio = (y**2).mean(axis=0)
    p = 2 * np.minimum(chi2.cdf(degrees * ratio, degrees), chi2.sf(degrees * ratio, degrees))
    return worst("variance", p, lambda k: f"measured/exact = {ratio[k]:.4f} at worst of {p.size} axes")


def covariances(y: Array) -> Check:
    """All products of two axes at once: zero in the mean, with unit variance but for O(1/N)."""
    d = y.shape[1]
    pairs = np.triu_indices(d, 1)
    spread = np.sqrt(((y**2).T @ (y**2) / len(y))[pairs])  # measured: 1 + the joint fourth cumulant
    z = (y.T @ y / np.sqrt(len(y)))[pairs] / spread
    seen = f"chi-square {z @ z:.1f} for {z.size} pairs of quantities and separations"
    return Check("covariance across separations", seen, float(chi2.sf(z @ z, z.size)) if z.size else 1.0)


def skewness(exact: PrincipalComponents, y: Array) -> Check:
    """Third cumulant along each axis, by the Hermite polynomial whose mean it is."""
    values = y**3 - 3 * y
    z = (values.mean(axis=0) - exact.skewness) / (values.std(axis=0) / np.sqrt(len(y)))

    def seen(k: int) -> str:
        return f"z = {z[k]:+z.2f} at worst of {z.size} axes, exact skewness {exact.skewness[k]:.3f}"

    return worst("skewness", 2 * norm.sf(np.abs(z)), seen)


def coverage(groups: Array, level: float = 0.95) -> Check:
    """Count the Student intervals that cover the mean: `groups` has shape (seeds, surfaces, axes)."""
    m = groups.shape[1]
    half = student.ppf((1 + level) / 2, m - 1) * groups.std(axis=1, ddof=1) / np.sqrt(m)
    covered, tried = int((np.abs(groups.mean(axis=1)) <= half).sum()), half.size
    p = 2 * min(binom.cdf(covered, tried, level), binom.sf(covered - 1, tried, level))
    seen = f"{covered} of {tried} intervals of {level:.0%} ({covered / tried:.1%})"
    return Check("coverage of the intervals", seen, min(1.0, float(p)))


def scores(groups: Array) -> tuple[Check, Array]:
    """Means of the seeds in exact standard errors: standard normal numbers."""
    z = (groups.mean(axis=1) * np.sqrt(groups.shape[1])).ravel()
    test = kstest(z, "norm")
    seen = f"{z.size} of them, KS distance {test.statistic:.3f}"
    return Check("distribution of z-scores", seen, float(test.pvalue)), z


def independence(groups: Array) -> Check:
    """Products of each surface with later ones, over lags of 1 to 64 surfaces and all axes."""
    seeds, m, d = groups.shape
    z = []
    for lag in (k for k in (1, 2, 4, 8, 16, 32, 64) if k < m):
        products = groups[:, lag:] * groups[:, :-lag]
        z.append(products.sum(axis=(0, 1)) / np.sqrt(seeds * (m - lag)))
    total, degrees = float(np.sum(np.square(z))), len(z) * d
    seen = f"chi-square {total:.1f} for {degrees} lags and axes"
    return Check("independence of surfaces", seen, float(chi2.sf(total, degrees)))


def along_axes(exact: PrincipalComponents, groups: Array) -> tuple[list[Check], Array]:
    """Make all checks of surfaces along the axes, shape (seeds, surfaces, axes); and their z-scores."""
    y = groups.reshape(-1, groups.shape[2])
    score, z = scores(groups)
    moments = [variances(exact, y), covariances(y), skewness(exact, y)]
    return [score, coverage(groups), *moments, independence(groups)], z
