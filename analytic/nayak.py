"""Heights of the summits of an isotropic Gaussian surface (P. R. Nayak 1971, J. Lubr. Technol. 93, 398).

With heights x over sqrt(m0), ``rho^2 = 3/(2 alpha)`` and tau the mean curvature of a summit over
sqrt(m4/3), the curvatures have a density that is free of alpha, and the height of a summit of given
curvature is normal ::

    p(tau) = sqrt(3)/(2 sqrt(pi)) (tau^2 - 2 + 2 exp(-tau^2/2)) exp(-tau^2/4),  tau > 0
    x | tau ~ N(rho tau/sqrt(2), 1 - rho^2)

Density and probabilities are integrals over tau of positive terms, in which nothing cancels, unlike in
Nayak's closed form far down. They are taken once for each alpha, and their logarithms
held as Chebyshev series.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.heights import HeightLaw
from analytic.piecewise import PiecewiseSeries, fitted
from analytic.quadrature import panelled
from analytic.surface import LEAST_ALPHA, SUMMIT_SPREAD

_TERMS = 24
WIDE = 9.5  # standard deviations, beyond which a normal density is 1e-20 of its largest value
_LARGEST = 13.5  # curvature tau: exp(-tau^2/4) is 1e-20
_FAR = 40.0  # standard deviations: beyond, densities underflow
_STEPS = (0.0, 0.7, 1.4, 2.2, 3.2, 4.5, 6.5, 9.5, 14.0, 20.0, 28.0, _FAR)
_LEAST, _MOST = 1.501, 1e12


@dataclass(frozen=True)
class Nayak(HeightLaw):
    """Distribution of the summit heights of an isotropic Gaussian surface.

    Parameters
    ----------
    alpha : float
        Nayak's bandwidth ``m0 m4/m2^2``. The limit of large values is the Gaussian law; at 1.5 all waves
        of the surface have one length, and a height has one curvature: that limit is left out.

    Raises
    ------
    ValueError
        If alpha is not a finite number > 1.5.

    Examples
    --------
    >>> round(float(Nayak(5.0).sf(np.array(0.0))), 6)
    0.498232
    """

    alpha: float

    def __post_init__(self) -> None:
        if not _LEAST <= self.alpha <= _MOST:
            raise ValueError(
                f"alpha = {self.alpha!r}: give a number from {_LEAST:g} to {_MOST:g} (isotropic surfaces "
                "have more than 1.5; the law becomes Gaussian for large alpha)"
            )

    @property
    def rho(self) -> float:
        """Correlation of the height of any point with its mean curvature."""
        return math.sqrt(LEAST_ALPHA / self.alpha)

    @property
    def width(self) -> float:
        """Deviation of the heights of summits of one curvature, over sqrt(m0)."""
        return math.sqrt((self.alpha - LEAST_ALPHA) / self.alpha)

    @property
    def edges(self) -> Array:
        """Heights over sqrt(m0) between which everything is smooth: graded by either deviation, with 0."""
        steps = np.array(_STEPS)
        return np.unique([*(-self.width * steps), *(self.width * steps), *steps[steps > self.width]])

    def log_density(self, x: Array) -> Array:
        """Return the logarithm of the density at heights over sqrt(m0), as density over these."""
        return _series(self, 0)(x)

    @property
    def mean(self) -> float:
        """Mean height of the summits above the mean plane of the surface, over sqrt(m0)."""
        return 4 / math.sqrt(math.pi * self.alpha)

    @property
    def std(self) -> float:
        """Standard deviation of the heights of the summits, over sqrt(m0)."""
        return math.sqrt(1 - SUMMIT_SPREAD / self.alpha)

    def over_rms(self, s: ArrayLike) -> Array:
        """Convert reduced heights to heights above the mean plane of the surface, over sqrt(m0)."""
        return np.asarray(self.mean + self.std * np.asarray(s, dtype=np.float64))

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Draw heights together with their curvatures."""
        return self.summits(rng, n)[0]

    def summits(self, rng: np.random.Generator, n: int) -> tuple[Array, Array]:
        """Return the reduced heights, and geometric mean curvatures over sqrt(m4/3), of `n` summits.

        Points of a surface are summits if both principal curvatures are positive, and count by their
        product: 57.7 % of the points that are drawn are accepted.
        """
        mean, product = np.empty(0), np.empty(0)
        while mean.size < n:
            more = int(1.8 * (n - mean.size)) + 16
            square, u = 2 * rng.chisquare(3, more), rng.random(more)
            both = square - rng.chisquare(2, more)
            accepted = u * square < both
            mean, product = np.append(mean, square[accepted]), np.append(product, both[accepted])
        x = self.rho / math.sqrt(2) * np.sqrt(mean[:n]) + self.width * rng.standard_normal(n)
        return np.asarray((x - self.mean) / self.std), np.sqrt(product[:n])

    def log_pdf(self, s: Array) -> Array:
        """Return the logarithm of Nayak's density, in reduced heights."""
        return np.asarray(math.log(self.std) + self.log_density(self.over_rms(s)))

    def cdf(self, s: Array) -> Array:
        """Return the integral of the density from below."""
        return np.exp(_series(self, -1)(self.over_rms(s)))

    def sf(self, s: Array) -> Array:
        """Return the integral of the density from above."""
        return np.exp(_series(self, 1)(self.over_rms(s)))


@lru_cache(maxsize=192)
def _series(law: Nayak, way: int) -> PiecewiseSeries:
    """Series of the logarithm of the density (0), or of the share of the summits above (1) or below (-1)."""
    rho, width = law.rho, law.width

    def logarithm(x: Array) -> Array:
        """Of the integral of ``2 (q - 1 + exp(-q)) exp(exponent)``, q = tau^2/2, over u = tau/sqrt(v)."""
        y = x / width
        a = rho * y  # where a factor has its peak
        inner = [a - WIDE, a + np.hypot(np.minimum(a, 0.0), WIDE)]
        most = np.hypot(_LARGEST / math.sqrt(2), np.maximum(x, 0.0) / rho) / width
        u, w = panelled(np.sort(np.clip([0 * x, *inner, most], 0, most), axis=0))
        if way:
            exponent = scipy.special.log_ndtr(way * (rho * u - y)) - (width * u) ** 2 / 2
            factor = np.asarray(math.log(width * math.sqrt(3 / (2 * math.pi))))
        else:
            exponent = -((u - rho * y) ** 2) / 2
            factor = math.log(math.sqrt(3) / (2 * math.pi)) - x * x / 2
        largest = exponent.max(axis=0)
        q = (width * u) ** 2
        summits = q * q * scipy.special.hyp1f1(1, 3, -q)  # 2 (q - 1 + exp(-q)), where nothing cancels
        sums = (w * summits * np.exp(exponent - largest)).sum(axis=0)
        return np.asarray(np.log(sums) + largest + factor)

    return fitted(logarithm, law.edges, _TERMS)
