"""Density, radius and spread of the summits by three methods, with their errors; and roughness."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.special import ndtr, stdtrit

from analytic import SpectralMoments
from analytic.arrays import Array
from mcgw.formats.table import Column, Table
from mcgw.maps.hidden_caps import unhidden
from mcgw.maps.summit_sums import SUMS, SummitSums
from mcgw.maps.waves import Uncertain, Waves, uncertain

Pairs = list[tuple[float, float]]

SUMMITS = ("eta", "radius", "sigma")
METHODS = {
    "moments": "spectral moments (Nayak, McCool)",
    "summits": "summits counted",
    "caps": "counted summits, corrected for hidden ones",
}
_UNSURE = 0.25  # share of a correction that is uncertain, measured for hidden caps and summits between pixels
_ORDER = 3  # losses scale as the pixel squared: one pixel loses a third of the difference between two and one
_FLAT = 0.5  # share of the median curvature


@dataclass(frozen=True, slots=True)
class Roughness:
    """Roughness parameters of heights (ISO 25178-2 for maps, ISO 21920-2 for profiles).

    Parameters
    ----------
    a : float
        Arithmetic mean deviation, Sa or Pa, m.
    q : float
        Root mean square deviation, Sq or Pq, m.
    sk, ku : float
        Skewness and kurtosis, Ssk and Sku or Psk and Pku.
    """

    a: float
    q: float
    sk: float
    ku: float

    @classmethod
    def of(cls, a: float, *central: float) -> Self:
        """From the mean deviation, and the central moments of second, third and fourth order."""
        q = math.sqrt(central[0])
        return cls(a, q, *(m / q**k if q else 0.0 for k, m in enumerate(central[1:], 3)))

    @property
    def means(self) -> tuple[float, ...]:
        """Return what `of` takes: means over the heights, which add up over areas."""
        return self.a, self.q**2, self.sk * self.q**3, self.ku * self.q**4

    def text(self, kind: str) -> str:
        """Return the parameters in words, named as for a map ("S") or a profile ("P")."""
        return f"{kind}a = {self.a:.4g} m, {kind}q = {self.q:.4g} m, {kind}sk = {self.sk:.2f}"


def roughness_of(heights: Array) -> Roughness:
    """Roughness of an array of any shape without missing points, m."""
    z = heights - heights.mean()
    square = z * z
    return Roughness.of(*(float(x.mean()) for x in (np.abs(z), square, square * z, square * square)))


@dataclass(frozen=True)
class Estimate:
    """Density, radius and spread of the summits by one method.

    Parameters
    ----------
    eta, radius, sigma : Uncertain
        Value, standard error, and both ends of the interval of 95 %: 1/m^2, m, m.
    """

    eta: Uncertain
    radius: Uncertain
    sigma: Uncertain

    @property
    def overlap(self) -> float:
        """``eta R sigma``."""
        return self.eta.value * self.radius.value * self.sigma.value

    @classmethod
    def of(cls, pairs: Pairs, waves: Waves) -> Self:
        """From values and errors over sub-areas, and the errors of few long waves."""
        spreads = (waves.spreads[name] for name in SUMMITS)
        return cls(*(uncertain(*pair, spread) for pair, spread in zip(pairs, spreads, strict=True)))


def estimates_table(estimates: Mapping[str, Estimate]) -> Table:
    """Estimates by all methods, with standard errors."""
    found = list(estimates.values())
    columns = [Column("method", [METHODS[name] for name in estimates], "by")]
    for name, words, unit in (("eta", "eta", "1/m^2"), ("radius", "R", "m"), ("sigma", "sigma", "m")):
        told = [getattr(e, name) for e in found]
        errors = [x.error for x in told]
        columns.append(Column(name, [x.value for x in told], words, unit, ".4g"))
        columns.append(Column(f"{name}_stderr", errors, unit=unit, form=".1g", between=" +- "))
    return Table((*columns, Column("overlap", [e.overlap for e in found], "eta R sigma", form=".3g")))


def jackknife(statistic: Callable[..., Array], *counted: SummitSums) -> Pairs:
    """Values, and errors by leaving out one sub-area after the other, of all that was `counted` on them.

    They are standard errors widened as Student's t asks for so few sub-areas: two of them hold 95 %.
    """
    used = counted[0].used
    n = len(used)
    values = statistic(*counted)
    without = np.array([statistic(*(c.without(part) for c in counted)) for part in used])
    errors = np.sqrt((n - 1) / n * ((without - without.mean(axis=0)) ** 2).sum(axis=0))
    errors *= stdtrit(n - 1, ndtr(2.0)) / 2
    return list(zip(values.tolist(), errors.tolist(), strict=True))


def mean_squares(counted: SummitSums) -> dict[str, float]:
    """Means over the map, by the names of `mcgw.maps.summit_sums.SUMS`."""
    sums = counted.sums.sum(axis=1)
    return dict(zip(SUMS[1:], (sums[1:] / sums[0]).tolist(), strict=True))


def moments_of(counted: SummitSums) -> SpectralMoments:
    """Moments, averaged over both axes."""
    m = mean_squares(counted)
    return SpectralMoments(m["z2"] - m["z"] ** 2, (m["slope_x"] + m["slope_y"]) / 2, m["bend"])


def skewness_of(counted: SummitSums) -> float:
    """Skewness of the heights of all points."""
    z, z2, z3 = (mean_squares(counted)[key] for key in ("z", "z2", "z3"))
    return float((z3 - 3 * z * z2 + 2 * z**3) / (z2 - z * z) ** 1.5)


def by_moments(counted: SummitSums) -> dict[str, tuple[float, float]]:
    """m0, m2, m4, alpha, the summits of an isotropic Gaussian surface that has these, and the skewness."""
    names = ("m0", "m2", "m4", "alpha", *SUMMITS)

    def found(t: SummitSums) -> Array:
        m = moments_of(t)
        return np.array([*(getattr(m, name) for name in names), skewness_of(t)])

    return dict(zip((*names, "skewness"), jackknife(found, counted), strict=True))


def by_summits(fine: SummitSums, coarse: SummitSums) -> Pairs:
    """Summits as they were counted over every point, and those that lie between pixels.

    A grid shows too few summits, too blunt: at eight pixels to the shortest wave it loses 1 to 3 %. What
    every second point loses over that, by three, is added (Richardson).
    """

    def found(fine: SummitSums, coarse: SummitSums) -> Array:
        values = _counted(fine)
        values += (values - _counted(coarse)) / _ORDER
        values[1] = 1 / values[1]
        return values

    pairs = zip(jackknife(found, fine, coarse), found(fine, fine), strict=True)
    return [_also(pair, pair[0] - float(plain)) for pair, plain in pairs]


def _counted(t: SummitSums) -> Array:
    """Density, mean curvature and standard deviation of heights, as counted."""
    return np.array([t.heights.size / t.area, t.curvatures.mean(), t.heights.std(ddof=1)])


def _also(pair: tuple[float, float], correction: float) -> tuple[float, float]:
    """Add a share of the correction to the error."""
    return pair[0], float(np.hypot(pair[1], _UNSURE * correction))


def by_caps(counted: SummitSums, blur: float) -> Pairs | None:
    """Independent caps of one radius, those under taller ones added; None if they would not look like this.

    All caps have one radius, which is the median: a few summits next to a valley do not.

    Parameters
    ----------
    counted : SummitSums
        Of the map.
    blur : float
        Distance from a valley that a summit needs to be seen, m.
    """

    def found(t: SummitSums, blur: float) -> Array:
        median = np.median(t.curvatures)
        caps = t.heights[t.curvatures > _FLAT * median]  # lower ones are ripples in the valleys
        all_caps = unhidden(caps.size / t.area, float(1 / median), float(caps.std(ddof=1)), blur)
        return np.full(3, np.nan) if all_caps is None else np.array([all_caps[0], 1 / median, all_caps[1]])

    pairs, sharp = jackknife(lambda t: found(t, blur), counted), found(counted, 0.0)
    if not np.all(np.isfinite(pairs)):  # what blur shows, a sharp map shows too
        return None
    eta, radius, sigma = pairs
    mean_radius = 1 / float(counted.curvatures.mean())
    return [
        _also(eta, eta[0] - float(sharp[0])),
        (radius[0], float(np.hypot(radius[1], mean_radius - radius[0]))),
        _also(sigma, sigma[0] - float(sharp[2])),
    ]
