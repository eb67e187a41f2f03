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
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.nayak import WIDE, Nayak
from analytic.quadrature import SPANS, WIDEST, gauss_legendre, panelled

MEAN_CURVATURE = 8 / math.sqrt(3 * math.pi)  # of the summits, over sqrt(m4/3)
_BLOCK = 1024  # numbers whose rules are summed at a time


@dataclass(frozen=True)
class RandomCurvature:
    """Radius ratios c = R_i/R of summits, where R is the inverse of their mean curvature.

    Everything takes reduced heights s as those of `analytic.Nayak`, and curvatures g, which broadcast; c is
    2.60588/g.

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

    @property
    def narrowest(self) -> float:
        """Range of reduced heights over which the density at one curvature hardly bends."""
        return self.heights.width / self.heights.std / 2

    def rule(self, highest: float, low: float, high: float) -> tuple[Array, Array, Array]:
        """Return curvatures and weights of summits as high as touch, and ends of pieces of their heights."""
        top = float(self.heights.isf(np.array(1e-18), highest))
        first = np.sqrt(MEAN_CURVATURE / self.largest)
        last = max(float(np.sqrt(self.highest(0.0, top))), first)
        x, w = gauss_legendre(int(np.ceil(64 * max(1.0, 0.6 / self.narrowest))))  # more where densities bend
        roots = first + (last - first) * x
        curvatures, weights = roots**2, 2 * roots * (last - first) * w
        if first > 0:  # that of all flatter summits
            curvatures, weights = np.append(curvatures, first**2), np.append(weights, 1.0)
        pieces = int(np.ceil((high - low) / min(SPANS * self.narrowest, WIDEST)))
        return curvatures, weights, np.linspace(low, high, pieces + 1)

    def density(self, s: Array, g: Array) -> Array:
        """Return the density of the heights `s` of summits of curvatures `g` of a rule, shape (n,)."""
        own, bound = np.empty(s.shape), g <= MEAN_CURVATURE / self.largest * (1 + 1e-12)
        own[bound] = self.cdf(g[bound], s[bound]) * self.heights.pdf(s[bound])
        own[~bound] = self.with_height(g[~bound], s[~bound])
        return own

    def pdf(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability density of the curvature at given heights."""
        g, x = np.asarray(g, dtype=np.float64), self._over_rms(s)
        return np.asarray(g**3 * np.exp(self._logarithm(g, x) - self.heights.log_density(x)))

    def with_height(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability density of reduced heights and curvatures together."""
        g = np.asarray(g, dtype=np.float64)
        return np.asarray(self.heights.std * (g**3 * np.exp(self._logarithm(g, self._over_rms(s)))))

    def elasticity(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return ``d log(pdf)/d log(g)``."""
        g, (mu, v) = np.asarray(g, dtype=np.float64), self._peak(self._over_rms(s))
        z = (math.sqrt(1 + v) * g - mu / math.sqrt(1 + v)) / math.sqrt(v)
        rate = math.sqrt(2 / math.pi) / scipy.special.erfcx(z * math.sqrt(0.5))  # of the normal tail
        return np.asarray(3 + g * g - g * math.sqrt((1 + v) / v) * rate)

    def highest(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return curvatures of which there are 1e-20 times as many as of `g`, or as of the usual one."""
        mu, v = self._peak(self._over_rms(s))
        return np.asarray(mu + np.hypot(np.maximum(np.asarray(g) - mu, 0.0), (WIDE + 0.5) * math.sqrt(v)))

    def cdf(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability of a smaller curvature, to full relative accuracy."""
        return self._between(0.0, g, s)

    def sf(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability of a larger curvature, to full relative accuracy."""
        return self._between(g, self.highest(g, s), s)

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
        if not 0 <= power < (4 if math.isinf(self.largest) else math.inf):  # the density begins as a cube
            raise ValueError(
                f"power = {power!r}: give one from 0 to below 4 (radii have no mean of the fourth power, "
                "unless largest bounds them)"
            )
        flattest = MEAN_CURVATURE / self.largest
        steeper = self._between(flattest, self.highest(flattest, s), s, power)
        flatter = self.largest**power * self.cdf(flattest, s) if flattest else 0.0
        return np.asarray(MEAN_CURVATURE**power * steeper + flatter)

    def summits(self, rng: np.random.Generator, n: int) -> tuple[Array, Array]:
        """Draw reduced heights and radius ratios of `n` summits together (`analytic.Nayak.summits`)."""
        s, g = self.heights.summits(rng, n)
        return s, self.ratio(g)

    def _over_rms(self, s: ArrayLike) -> Array:
        """Heights over sqrt(m0), no farther out than there are any."""
        edges = self.heights.edges
        return np.clip(self.heights.over_rms(s), edges[0], edges[-1])

    def _peak(self, x: Array) -> tuple[Array, float]:
        """Mean and variance of the mean curvature, as mu and v above."""
        return math.sqrt(2) * self.heights.rho * x, 2 * self.heights.width**2

    def _logarithm(self, g: Array, x: Array) -> Array:
        """Of the density of heights and curvatures together, over the cube of the curvature."""
        mu, v = self._peak(x)
        z = (mu / math.sqrt(1 + v) - math.sqrt(1 + v) * g) / math.sqrt(v)
        over = (g * g - mu * mu / (1 + v) - x**2) / 2
        return np.asarray(scipy.special.log_ndtr(z) + over - math.log(2 * math.pi / 3 * (1 + v)) / 2)

    def _between(self, low: ArrayLike, high: ArrayLike, s: ArrayLike, power: float = 0.0) -> Array:
        """Mean of ``g^-power`` of curvatures between two, and of 0 of others."""
        several = np.broadcast_arrays(low, high, np.asarray(s, dtype=np.float64))
        found = np.empty(several[0].size)
        for k in range(0, found.size, _BLOCK):
            a, b, some = (each.ravel()[k : k + _BLOCK] for each in several)
            x = self._over_rms(some)
            mu, v = self._peak(x)
            turn, width = mu / (1 + v), WIDE * math.sqrt(v / (1 + v))
            ends = [a, turn - width, turn + width, mu - WIDE * math.sqrt(v), self.highest(0.0, some), b]
            root, w = panelled(np.sqrt(np.sort(np.clip(ends, a, b), axis=0)))  # powers of it are whole
            density = np.exp(self._logarithm(root * root, x) - self.heights.log_density(x))
            found[k : k + _BLOCK] = (w * 2 * root ** (7 - 2 * power) * density).sum(axis=0)
        return found.reshape(several[0].shape)
