"""Density, radius and spread of the summits by three methods, with their errors; and roughness."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple, Self

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.optimize import brentq
from scipy.special import ndtr, stdtrit

from analytic.arrays import Array
from mcgw.formats.table import Column, Table
from mcgw.maps.summit_sums import Summits
from mcgw.maps.waves import Uncertain, Waves, uncertain

SUMMITS = ("eta", "radius", "sigma")
METHODS = {
    "moments": "spectral moments (Nayak, McCool)",
    "summits": "summits counted",
    "caps": "counted summits, corrected for hidden ones",
}
_UNSURE = 0.25  # share of a correction that is uncertain, measured for hidden caps and summits between pixels
CROWDED = 0.05  # eta R sigma, from which one summit in six is hidden: the asperities are no longer apart
_REACH = 9.0
_X, _W = leggauss(200)  # heights over their reach, by the rule of Gauss and Legendre


class Roughness(NamedTuple):
    """Roughness parameters of heights (ISO 25178-2 for maps, ISO 21920-2 for profiles)."""

    a: float  # arithmetic mean deviation, Sa or Pa, m
    q: float  # root mean square deviation, Sq or Pq, m
    sk: float  # skewness, Ssk or Psk
    ku: float  # kurtosis, Sku or Pku

    def text(self, kind: str) -> str:
        """Return the parameters in words, named as for a map ("S") or a profile ("P")."""
        return f"{kind}a = {self.a:.4g} m, {kind}q = {self.q:.4g} m, {kind}sk = {self.sk:.2f}"


def roughness_of(heights: Array) -> Roughness:
    """Roughness of an array of any shape without missing points, not flat, m."""
    z = heights - heights.mean()
    mean = float(np.abs(z).mean())
    square = z * z
    q = math.sqrt(square.mean())
    return Roughness(mean, q, float((square * z).mean()) / q**3, float((square * square).mean()) / q**4)


@dataclass(frozen=True)
class Estimate:
    """Density (1/m^2), radius (m) and spread (m) of the summits by one method, each with its error."""

    eta: Uncertain
    radius: Uncertain
    sigma: Uncertain

    @property
    def overlap(self) -> float:
        """``eta R sigma``."""
        return self.eta.value * self.radius.value * self.sigma.value

    @classmethod
    def of(cls, pairs: Iterable[tuple[float, float]], waves: Waves) -> Self:
        """From values and errors over sub-areas, and the errors of few long waves."""
        both = zip(pairs, SUMMITS, strict=True)
        return cls(*(uncertain(float(x), float(error), waves.spreads[of]) for (x, error), of in both))


def estimates_table(estimates: Mapping[str, Estimate]) -> Table:
    """Estimates by all methods, with standard errors."""
    found = list(estimates.values())
    columns = [Column("method", [METHODS[name] for name in estimates], "by")]
    for name, words, unit in (("eta", "eta", "1/m^2"), ("radius", "R", "m"), ("sigma", "sigma", "m")):
        values, errors, *_ = zip(*(getattr(e, name) for e in found), strict=True)
        columns.append(Column(name, values, words, unit, ".4g"))
        columns.append(Column(f"{name}_stderr", errors, unit=unit, form=".1g", between=" +- "))
    return Table((*columns, Column("overlap", [e.overlap for e in found], "eta R sigma", form=".3g")))


def jackknife(statistic: Callable[..., Array], *counted: Summits) -> Array:
    """Values, and errors by leaving out one sub-area after the other, of all that was `counted` on them.

    A row for each number. Errors are standard errors widened as Student's t asks for so few sub-areas: two of
    them hold 95 %.
    """
    used = np.flatnonzero(counted[0].sums[0]).tolist()
    n = len(used)
    without = np.array([statistic(*(c.without(part) for c in counted)) for part in used])
    errors = np.sqrt((n - 1) / n * ((without - without.mean(axis=0)) ** 2).sum(axis=0))
    return np.column_stack([statistic(*counted), errors * stdtrit(n - 1, ndtr(2.0)) / 2])


def by_moments(counted: Summits) -> dict[str, tuple[float, float]]:
    """m0, m2, m4, alpha, the summits of an isotropic Gaussian surface that has these, and the skewness."""
    names = ("m0", "m2", "m4", "alpha", *SUMMITS)

    def found(t: Summits) -> Array:
        moments, m = t.moments, t.mean_squares
        third = m["z3"] - 3 * m["z"] * m["z2"] + 2 * m["z"] ** 3
        return np.array([*(getattr(moments, name) for name in names), third / moments.m0**1.5])

    return dict(zip((*names, "skewness"), map(tuple, jackknife(found, counted).tolist()), strict=True))


def by_summits(fine: Summits, coarse: Summits) -> Array:
    """Summits as they were counted over every point, and those that lie between pixels.

    A grid shows too few summits, too blunt: at eight pixels to the shortest wave it loses 1 to 3 %. What
    every second point loses over that, by three, is added (Richardson): losses go as the pixel squared.
    """

    def counted(t: Summits) -> Array:
        return np.array([t.heights.size / t.area, t.bends.mean(), t.heights.std(ddof=1)])

    def found(fine: Summits, coarse: Summits) -> Array:
        values = counted(fine)
        eta, curvature, sigma = values + (values - counted(coarse)) / 3
        return np.array([eta, 1 / curvature, sigma])

    pairs = jackknife(found, fine, coarse)
    pairs[:, 1] = np.hypot(pairs[:, 1], _UNSURE * (pairs[:, 0] - found(fine, fine)))
    return pairs


def by_caps(counted: Summits, blur: float) -> Array | None:
    """Independent caps of one radius, those under taller ones added; None if they would not look like this.

    All caps have one radius, which is the median: a few summits next to a valley do not. A summit is seen at
    a distance `blur`, m, from a valley.
    """

    def found(t: Summits, blur: float) -> Array:
        median = np.median(t.bends)
        caps = t.heights[t.bends > 0.5 * median]  # flatter ones are ripples in the valleys
        all_caps = _unhidden(caps.size / t.area, float(1 / median), float(caps.std(ddof=1)), blur)
        return np.full(3, np.nan) if all_caps is None else np.array([all_caps[0], 1 / median, all_caps[1]])

    pairs = jackknife(lambda t: found(t, blur), counted)
    if not np.isfinite(pairs).all():  # what blur shows, a sharp map shows too
        return None
    doubts = _UNSURE * (pairs[:, 0] - found(counted, 0.0))
    doubts[1] = 1 / counted.bends.mean() - pairs[1, 0]
    pairs[:, 1] = np.hypot(pairs[:, 1], doubts)
    return pairs


# --- independent caps that hide under taller ones ---
#
# A cap of height z is hidden where an asperity at a distance r has z_j - r^2/(2R) > z. It cannot be told from
# the slope of its neighbour where the valley between them is nearer to its summit than the blur p of the map:
# where z_j - (r^2 - 2 r p)/(2R) > z. Of a Poisson field the number of such neighbours is Poisson distributed,
# so the share of visible summits of that height is the exponential of minus its mean.


class Visible(NamedTuple):
    """Of the summits that no taller neighbour hides."""

    share: float  # of all summits
    mean: float  # of their reduced heights; 0, and so is std, if none is visible
    std: float


@lru_cache(maxsize=64)
def _taller_neighbours(blur: float) -> Array:
    """Mean number of neighbours that hide each height, over ``4 pi eta R sigma``."""
    reach = blur + math.sqrt(blur**2 + 2 * _REACH)  # beyond, nobody is tall enough
    r, w = reach * (1 + _X) / 2, reach * _W / 2
    return np.asarray(ndtr(-(_REACH * _X[:, None] + r * r - 2 * r * blur)) @ (w * r))


def visible(overlap: float, blur: float = 0.0) -> Visible:
    """Statistics of the visible summits of Gaussian heights, by quadrature over heights and distances.

    The `overlap` is ``eta R sigma``; the `blur`, over ``sqrt(2 R sigma)``, is the distance p from a valley.
    """
    s = _REACH * _X
    hidden = np.exp(-s * s / 2 - 4 * math.pi * overlap * _taller_neighbours(blur))
    p = _REACH * _W * hidden / math.sqrt(2 * math.pi)
    share = float(p.sum())
    if share == 0:
        return Visible(0.0, 0.0, 0.0)
    mean = float(p @ s) / share
    return Visible(share, mean, math.sqrt(float(p @ (s - mean) ** 2) / share))


def _unhidden(eta: float, radius: float, sigma: float, blur: float) -> tuple[float, float] | None:
    """Density and standard deviation of all summits from those of the visible ones, SI units.

    None if no field of independent caps shows so many, or all have one height.
    """
    if not sigma > 0:
        return None
    reduced = blur / math.sqrt(2 * radius * sigma)

    def misfit(overlap: float) -> float:
        seen = visible(overlap, reduced)
        return overlap * seen.share * seen.std - eta * radius * sigma

    grid = np.geomspace(1e-9, 10.0, 60)
    above = [x for x in grid if misfit(float(x)) > 0]
    if not above:
        return None
    seen = visible(brentq(misfit, 0.0, float(above[0]), xtol=1e-15), reduced)
    return eta / seen.share, sigma / seen.std
