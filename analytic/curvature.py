"""Radii of the summits of an isotropic Gaussian surface, given their heights.

With the height x over sqrt(m0) and curvatures over sqrt(m4/3): mean curvature tau, geometric mean g, mu =
sqrt(2) rho x and v = 2 (1 - rho^2) of `analytic.nayak`, ::

    tau | x   ~ (tau^2 - 2 + 2 exp(-tau^2/2)) N(tau; mu, v),   tau > 0
    g^2 | tau ~ w exp(w/2),   0 < w < tau^2

in whose product the integral over tau is closed ::

    g | x ~ g^3 exp(g^2/2) P(T > g),   T normal of mean mu/(1 + v) and variance v/(1 + v)

The radius of a summit is that of the sphere of its geometric mean curvature (Greenwood 2006, Wear 261, 191).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import erfcx, log_ndtr

from analytic.arrays import Array
from analytic.nayak import Nayak, NayakTables, tables_of
from analytic.quadrature import gauss_legendre, panelled

MEAN_CURVATURE = 8 / math.sqrt(3 * math.pi)  # of the summits, over sqrt(m4/3)
_DIVERGES = 4.0  # power of the radius that has no mean: the density of g begins as its cube
_BLOCK = 1024  # numbers whose rules are summed at a time
_NODES, _AS_WIDE = 64, 0.6  # points for curvatures, if their density bends over so many heights
_RAREST = 1e-18  # share of the touching heights above which curvatures are left out
_SAME = 1e-12  # relative rounding of the curvature of a bound
_WIDE = 9.5  # standard deviations, beyond which a normal density is 1e-20 of its largest value


@dataclass(frozen=True, eq=False)
class CurvatureGivenHeight:
    """Law of g, the geometric mean curvature over sqrt(m4/3), of summits at heights x over sqrt(m0).

    Parameters
    ----------
    alpha : float
        Nayak's bandwidth.
    x : ndarray
        Heights, shape (n,).
    """

    alpha: float
    x: Array

    @property
    def _tables(self) -> NayakTables:
        return tables_of(float(self.alpha))

    @property
    def _v(self) -> float:
        return 2 * self._tables.width**2

    @cached_property
    def _mu(self) -> Array:
        return np.asarray(math.sqrt(2) * self._tables.rho * self.x)

    def _logarithm(self, g: Array) -> Array:
        """Of the density of the height and of a curvature `g` together, over the cube of `g`."""
        v, mu = self._v, self._mu
        z = (mu / math.sqrt(1 + v) - math.sqrt(1 + v) * g) / math.sqrt(v)
        over = (g * g - mu * mu / (1 + v) - self.x**2) / 2
        return np.asarray(log_ndtr(z) + over - math.log(2 * math.pi / 3 * (1 + v)) / 2)

    def _parts(self, g: Array) -> Array:
        """Density of `g` over its cube."""
        return np.exp(self._logarithm(g) - self._tables.log_density(self.x))

    def edges(self, low: Array, high: Array) -> Array:
        """Return ends of pieces on which the law is smooth, between two curvatures at each height: (6, n)."""
        v, mu = self._v, self._mu
        turn, width = mu / (1 + v), _WIDE * math.sqrt(v / (1 + v))
        peak = mu - _WIDE * math.sqrt(v), self.highest(0 * mu)
        return np.sort(np.clip([low, turn - width, turn + width, *peak, high], low, high), axis=0)

    def highest(self, g: Array) -> Array:
        """Curvature of which there are 1e-20 times as many as of `g`, or as of the most frequent one."""
        above = np.maximum(g - self._mu, 0.0)
        return np.asarray(self._mu + np.hypot(above, (_WIDE + 0.5) * math.sqrt(self._v)))

    def pdf(self, g: Array) -> Array:
        """Probability density at `g`, shape (n,)."""
        return g**3 * self._parts(g)

    def with_height(self, g: Array) -> Array:
        """Probability density of the height and of a curvature `g` together, shape (n,)."""
        return np.asarray(g**3 * np.exp(self._logarithm(g)))

    def elasticity(self, g: Array) -> Array:
        """``d log(density)/d log(g)``."""
        v = self._v
        z = (math.sqrt(1 + v) * g - self._mu / math.sqrt(1 + v)) / math.sqrt(v)
        rate = math.sqrt(2 / math.pi) / erfcx(z * math.sqrt(0.5))  # of the normal tail
        return np.asarray(3 + g * g - g * math.sqrt((1 + v) / v) * rate)

    def between(self, low: Array, high: Array) -> Array:
        """Probability of a curvature between two."""
        g, w = panelled(self.edges(low, high))
        return np.asarray((w * self.pdf(g)).sum(axis=0))

    def sf(self, low: Array) -> Array:
        """Probability of a larger curvature."""
        return self.between(low, np.maximum(self.highest(low), low))

    def mean_inverse(self, power: float, flattest: float) -> Array:
        """Mean of ``max(g, flattest)^-power``."""
        low = np.full_like(self.x, flattest)
        high = np.maximum(self.highest(low), low)
        y, w = panelled(np.sqrt(self.edges(low, high)))  # of the root all powers that are asked for are whole
        rest = (w * 2 * y ** (7 - 2 * power) * self._parts(y * y)).sum(axis=0)
        return np.asarray(rest if flattest == 0 else rest + flattest**-power * self.between(0 * low, low))


@dataclass(frozen=True)
class RandomCurvature:
    """Radius ratios c = R_i/R of summits, where R is the inverse of their mean curvature.

    Everything takes reduced heights s as those of `analytic.Nayak`, and curvatures g; c is 2.60588/g.

    Parameters
    ----------
    alpha : float
        Nayak's bandwidth, of the height law too.
    largest : float, optional
        Largest ratio: flatter summits count as having this one.

    Raises
    ------
    ValueError
        If alpha is not one of `analytic.Nayak`, or `largest` not positive.

    Examples
    --------
    >>> law = RandomCurvature(5.0)
    >>> law.mean(1, [0.0, 3.0]).round(4)
    array([1.3407, 0.8021])
    """

    alpha: float
    largest: float = math.inf

    def __post_init__(self) -> None:
        Nayak(self.alpha)
        if not self.largest > 0:
            raise ValueError(f"largest = {self.largest!r}: give a ratio of radii > 0, or inf for no bound")

    @property
    def heights(self) -> Nayak:
        """Distribution of the heights of the same summits."""
        return Nayak(self.alpha)

    def ratio(self, g: ArrayLike) -> Array:
        """Return the radius ratio of a curvature."""
        with np.errstate(divide="ignore"):
            return np.minimum(MEAN_CURVATURE / np.asarray(g, dtype=np.float64), self.largest)

    def steepest(self, s: float) -> float:
        """Return the curvature above which there is next to no summit as low as `s`."""
        x = self.heights.over_rms([s])
        return float(CurvatureGivenHeight(self.alpha, x).highest(0 * x)[0])

    @property
    def narrowest(self) -> float:
        """Range of reduced heights over which the density at one curvature hardly bends."""
        return tables_of(float(self.alpha)).width / self.heights.std / 2

    def rule(self, highest: float) -> tuple[Array, Array]:
        """Return curvatures, and weights, of summits as high as touch at this separation.

        If there is a bound, the last one is that of all flatter summits.
        """
        top = float(self.heights.isf(np.array(_RAREST), highest))
        first = np.sqrt(MEAN_CURVATURE / self.largest)
        last = max(np.sqrt(self.steepest(top)), first)
        x, w = gauss_legendre(int(np.ceil(_NODES * max(1.0, _AS_WIDE / self.narrowest))))
        roots = first + (last - first) * x
        curvatures, weights = roots**2, 2 * roots * (last - first) * w
        if first > 0:
            curvatures, weights = np.append(curvatures, first**2), np.append(weights, 1.0)
        return curvatures, weights

    def density(self, s: Array, g: Array) -> Array:
        """Return the density of the heights `s` of summits of curvatures `g` of a rule, shape (n,)."""
        own, bound = np.empty(s.shape), g <= MEAN_CURVATURE / self.largest * (1 + _SAME)
        own[bound] = self.cdf(g[bound], s[bound]) * self.heights.pdf(s[bound])
        own[~bound] = self.with_height(g[~bound], s[~bound])
        return own

    def pdf(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability density of the curvature at given heights, broadcast."""
        return self._given_height(CurvatureGivenHeight.pdf, g, s)

    def with_height(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability density of reduced heights and curvatures together, broadcast."""
        return self.heights.std * self._given_height(CurvatureGivenHeight.with_height, g, s)

    def cdf(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability of a smaller curvature, to full relative accuracy."""
        return self._given_height(lambda law, a: law.between(0 * a, a), g, s)

    def sf(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability of a larger curvature, to full relative accuracy."""
        return self._given_height(CurvatureGivenHeight.sf, g, s)

    def mean(self, power: float, s: ArrayLike) -> Array:
        """Return the mean of a power of the radius ratio at given heights, in their shape.

        Parameters
        ----------
        power : float
            A multiple of 1/2.
        s : array_like
            Reduced heights.

        Raises
        ------
        ValueError
            If the power is negative or no such multiple; or 4 or more, of which there is no mean unless
            `largest` is finite.
        """
        if (2 * power) % 1:
            raise ValueError(f"power = {power!r}: give a multiple of 1/2")
        if not 0 <= power < (_DIVERGES if math.isinf(self.largest) else math.inf):
            raise ValueError(
                f"power = {power!r}: give one from 0 to below 4 (radii have no mean of the fourth power, "
                "unless largest bounds them)"
            )
        flattest = MEAN_CURVATURE / self.largest
        return self._given_height(
            lambda law, a: a**power * law.mean_inverse(power, flattest), MEAN_CURVATURE, s
        )

    def summits(self, rng: np.random.Generator, n: int) -> tuple[Array, Array]:
        """Draw reduced heights and radius ratios of `n` summits together (`analytic.Nayak.summits`)."""
        s, g = self.heights.summits(rng, n)
        return s, self.ratio(g)

    def _given_height(
        self, function: Callable[[CurvatureGivenHeight, Array], Array], g: ArrayLike, s: ArrayLike
    ) -> Array:
        """Broadcast over curvatures and heights, these no farther out than there are any."""
        edges = tables_of(float(self.alpha)).edges
        heights = np.clip(self.heights.over_rms(s), edges[0], edges[-1])
        a, x = np.broadcast_arrays(np.asarray(g, dtype=np.float64), heights)
        parts = [slice(k, k + _BLOCK) for k in range(0, a.size, _BLOCK)]
        found = [function(CurvatureGivenHeight(self.alpha, x.ravel()[i]), a.ravel()[i]) for i in parts]
        return np.concatenate([np.empty(0), *found]).reshape(a.shape)
