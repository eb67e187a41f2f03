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

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.curvature_given_height import CurvatureGivenHeight
from analytic.nayak import Nayak, tables_of

MEAN_CURVATURE = 8 / math.sqrt(3 * math.pi)  # of the summits, over sqrt(m4/3)
_DIVERGES = 4.0  # power of the radius that has no mean: the density of g begins as its cube
_BLOCK = 1024  # numbers whose rules are summed at a time


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

    def pdf(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability density of the curvature at given heights, broadcast."""
        return self._broadcast(lambda a, x: CurvatureGivenHeight(self.alpha, x).pdf(a), g, s)

    def with_height(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability density of reduced heights and curvatures together, broadcast."""
        found = self._broadcast(lambda a, x: CurvatureGivenHeight(self.alpha, x).with_height(a), g, s)
        return self.heights.std * found

    def cdf(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability of a smaller curvature, to full relative accuracy."""
        return self._broadcast(lambda a, x: CurvatureGivenHeight(self.alpha, x).between(0 * a, a), g, s)

    def sf(self, g: ArrayLike, s: ArrayLike) -> Array:
        """Return the probability of a larger curvature, to full relative accuracy."""
        return self._broadcast(lambda a, x: CurvatureGivenHeight(self.alpha, x).sf(a), g, s)

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
        return self._broadcast(
            lambda a, x: a**power * CurvatureGivenHeight(self.alpha, x).mean_inverse(power, flattest),
            MEAN_CURVATURE,
            s,
        )

    def summits(self, rng: np.random.Generator, n: int) -> tuple[Array, Array]:
        """Draw reduced heights and radius ratios of `n` summits together (`analytic.Nayak.summits`)."""
        s, g = self.heights.summits(rng, n)
        return s, self.ratio(g)

    def _over_rms(self, s: ArrayLike) -> Array:
        """Heights over sqrt(m0), no farther out than there are any."""
        edges = tables_of(float(self.alpha)).edges
        return np.clip(self.heights.over_rms(s), edges[0], edges[-1])

    def _broadcast(self, function: Callable[[Array, Array], Array], first: ArrayLike, s: ArrayLike) -> Array:
        a, x = np.broadcast_arrays(np.asarray(first, dtype=np.float64), self._over_rms(s))
        result, flat, heights = np.empty(a.size), a.ravel(), x.ravel()
        for k in range(0, a.size, _BLOCK):
            i = slice(k, k + _BLOCK)
            result[i] = function(flat[i], heights[i])
        return result.reshape(a.shape)
