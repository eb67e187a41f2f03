"""Confidence intervals of means over surfaces, from the exact distribution that a scene has.

What fluctuates from ensemble to ensemble is a sum over independent asperities, whose relative spread and
skewness theory gives. So the ratio of a mean to its exact value follows, closely, a gamma distribution of
that spread and skewness, shifted (Pearson's type III); over many contacts, the Gaussian one. Its quantiles
turned round are the interval: it needs no second surface, and it ends where values can. Where contacts are
few and the exact law of the ratio is quickly known, its own quantiles are turned round. The number of
contacts is binomial or Poisson, and its interval exact (Clopper and Pearson 1934, Garwood 1936).

Which confidence interval a quantity of an ensemble has.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import betainccinv, betaincinv, gammainccinv, gammaincinv, ndtri

from analytic import SEPARATIONS, Hertz, MeasuredHeights, quantity_of
from analytic.arrays import Array
from mcgw.ensemble.results import Held
from mcgw.formats.table import Column
from mcgw.scene.scene import Scene

CONFIDENCE = 0.95
FEWEST = 10.0  # effective contacts in the whole ensemble, below which there is no interval
MANY = 30.0  # below it a sum of nearly equal terms is still discrete: half of the tails is left for that
TOO_FEW = "too few contacts"
_RARE = 1e-10  # share of the asperities in contact below which their number is Poisson's to ten digits
_GAUSSIAN = 1e-5  # skewness below which the distribution is Gaussian to ten digits
_MOST_OF_BAND = 100  # separations, at which laws may take six times as long
_NOTHING = 1e-280  # a mean below it has lost its variance to underflow


@dataclass(frozen=True)
class Spread:
    """How one surface differs from the mean one, arrays of shape (separations,)."""

    relative: Array  # standard deviation over the mean; infinite where the mean is 0
    skewness: Array  # of the ratio to the mean; 0 where nothing fluctuates

    def effective(self, n_surfaces: float | Array) -> Array:
        """Effective number of contacts in so many surfaces: that of equal contacts as uncertain, or as skew.

        The smaller of the shapes of two gamma distributions: that of this relative spread, and that of this
        skewness.
        """
        with np.errstate(divide="ignore"):
            return np.asarray(n_surfaces * np.minimum(self.relative**-2.0, 4 * self.skewness**-2.0))

    def ratio(self, n_surfaces: float | Array, level: float = CONFIDENCE) -> tuple[Array, Array]:
        """Range of the mean of so many surfaces over the exact mean; nan where there are too few contacts.

        Where only the skewness is too large, as that of a number of contacts which hardly ever fails to be
        that of all asperities, the range is Chebyshev's, if that is below a half: it always holds.
        """
        contacts, error = self.effective(n_surfaces), self.relative / np.sqrt(n_surfaces)
        usual, tail = contacts >= FEWEST, (1 - level) / np.where(contacts < MANY, 4, 2)
        skewness = np.where(usual, self.skewness, 0.0) / np.sqrt(n_surfaces)
        low, high = pearson3_quantile(tail, skewness), -pearson3_quantile(tail, -skewness)
        most = chebyshev(level)
        error = np.where(usual | (most * error < 0.5), error, np.nan)
        return 1 + error * np.where(usual, low, -most), 1 + error * np.where(usual, high, most)

    def reach(self, n_surfaces: float | Array) -> Array:
        """How far the interval of the mean reaches, over the mean; nan where there are too few contacts."""
        low, high = self.ratio(n_surfaces)
        return np.asarray(np.maximum(1 / low - 1, 1 - 1 / high))


def pearson3_quantile(share: Array | float, skewness: Array) -> Array:
    """Quantile of the gamma distribution of this skewness, shifted and scaled to mean 0 and variance 1.

    As ``scipy.stats.pearson3.ppf``, whose import takes half a second that `mcgw show` need not wait.
    """
    gaussian = np.abs(skewness) < _GAUSSIAN
    shape = 4 / np.where(gaussian, 1.0, skewness) ** 2
    quantile = np.where(skewness > 0, gammaincinv(shape, share), gammainccinv(shape, share))
    return np.where(gaussian, ndtri(share), np.sign(skewness) * (quantile - shape) / np.sqrt(shape))


def chebyshev(level: float = CONFIDENCE) -> float:
    """Return the standard deviations within which any distribution has at least this share."""
    return float(1 / np.sqrt(1 - level))


def spread_of(scene: Scene, quantity: str) -> Spread:
    """Exact spread of a quantity over the surfaces of a scene, at its separations."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # far up, where next to none touch
        found = scene.theory.cumulants(quantity, scene.separations)
        relative = np.sqrt(found.variance) / np.abs(found.mean)
    relative = np.where(np.abs(found.mean) < _NOTHING, np.inf, relative)
    return Spread(relative, np.where(found.variance > 0, np.sign(found.mean) * found.skewness, 0.0))


def count_interval(
    contacts: Array, asperities: float, *, poisson: bool, level: float = CONFIDENCE
) -> tuple[Array, Array]:
    """Exact confidence interval of an expected number of contacts, among so many asperities.

    By Clopper and Pearson; if the number of asperities is a Poisson one, `asperities` is its mean, and the
    interval Garwood's. It covers with at least the probability `level`.
    """
    tail, k = (1 - level) / 2, np.asarray(contacts, dtype=np.float64)
    low = np.where(k > 0, gammaincinv(np.maximum(k, 1.0), tail), 0.0)
    high = gammainccinv(k + 1, tail)
    if poisson:
        return low, np.asarray(high)
    n, many = asperities, k + 1 > _RARE * asperities  # below, SciPy's inverse may fail
    low = np.where(many & (k > 0), n * betaincinv(np.maximum(k, 1.0), n - k + 1, tail), low)
    high = np.where(many, n * betainccinv(k + 1, np.maximum(n - k, 1.0), tail), high)
    return low, np.where(k < n, high, n)


def interval_columns(low: ArrayLike, high: ArrayLike, unit: str = "") -> tuple[Column, Column]:
    """Both ends of 95 % intervals in one cell of a table, or that there is none."""
    error = (np.asarray(high) - np.asarray(low)) / 4
    return (
        Column("low_95", np.asarray(low), "95 % interval", unit, missing=TOO_FEW, error=error),
        Column("high_95", np.asarray(high), unit=unit, between=" ... ", error=error),
    )


def interval_of(scene: Scene, sums: Held, name: str, level: float) -> tuple[Array, Array]:
    """Return the ends of the interval of a mean, as `Ensemble.interval` says."""
    mean, m = sums.mean_and_std(name)[0], sums.rows()
    if scene.as_measured:
        return mean, mean
    if name in SEPARATIONS:
        return _of_separation(scene, sums, name, level)
    if quantity_of(name).counts:
        contacts, asperities = np.rint(mean * m), float(scene.n_asperities) * m
        ends = count_interval(contacts, asperities, poisson=scene.count == "poisson", level=level)
        return ends[0] / m, ends[1] / m
    spread = spread_of(scene, name)
    low, high = spread.ratio(m, level)
    if laws_are_quick(scene) and scene.interaction is None and name not in scene.of_joint:
        rare = spread.effective(m) < MANY
        low[rare], high[rare] = _ratio_by_law(scene, name, np.array(scene.separations)[rare], m, level)
    ends = mean / high, mean / low  # of the sign of the mean
    return np.minimum(*ends), np.maximum(*ends)


def _ratio_by_law(scene: Scene, name: str, h: Array, n_surfaces: int, level: float) -> Array:
    """As `Spread.ratio`, by the exact law of the sum of all surfaces: where contacts are few."""
    together = replace(scene.theory, n_asperities=scene.n_asperities * n_surfaces)
    each, back = np.unique(h, return_inverse=True)
    laws = [together.distribution(name, x) for x in each.tolist()]
    ends = np.reshape([law.interval(level) for law in laws], (-1, 2)).T
    means = np.array([law.mean() for law in laws])
    known = (means > 0) & (ends > 0).all(axis=0)
    return np.asarray(np.where(known, ends, np.nan) / np.where(known, means, 1.0))[:, back]


def _of_separation(scene: Scene, sums: Held, name: str, level: float) -> tuple[Array, Array]:
    """Of the other separation, which differs from the scene's by a multiple of the load."""
    load = "load_unloading" if quantity_of(name).unloading else "load"
    low, high = interval_of(scene, sums, load, level)
    mean, here = (sums.mean_and_std(each)[0] for each in (load, name))
    separations = np.array(scene.separations)
    with np.errstate(divide="ignore", invalid="ignore"):
        sunk = (here - separations) / mean  # d/sigma for a newton; nan where nothing touches
    ends = separations + sunk * low, separations + sunk * high
    return np.fmin(*ends), np.fmax(*ends)


def laws_are_quick(scene: Scene) -> bool:
    """Whether a quantile of an exact law of the scene's surfaces takes milliseconds.

    Under laws other than Hertz's, with radii of their own and of lists of summits it takes seconds.
    """
    plain = type(scene.law) is Hertz and scene.summits is None
    return plain and not scene.as_measured


def exact_ends(scene: Scene, name: str, share: float) -> Array | None:
    """Return ends between which this share of all surfaces lies at each separation: (2, separations).

    None where no law is known, or where laws take a while: those of summits with radii of their own and of
    other contact laws take about six times as long as Hertz's, those of both, and of lists, much longer.
    """
    both = scene.summits is not None and type(scene.law) is not Hertz
    longer = not laws_are_quick(scene) and len(scene.separations) > _MOST_OF_BAND
    if both or longer or isinstance(scene.heights, MeasuredHeights):
        return None
    try:
        laws = [scene.theory.distribution(name, h) for h in scene.separations]
        return np.array([law.interval(share) for law in laws]).T
    except (KeyError, ValueError):
        return None
