"""Curvatures of the summits of given heights: integrals of positive terms over what `curvature` derives."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import erfcx, ndtr

from analytic.arrays import Array
from analytic.nayak import NayakTables, tables_of, upper_tail
from analytic.quadrature import panelled

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

    @cached_property
    def _whole(self) -> Array:
        """Integral of `_parts` over all g."""
        return self._tables.density(self.x) * math.sqrt(2 * math.pi / 3)

    def _parts(self, g: Array) -> Array:
        """``exp(g^2/2)`` times the integral over tau > g; far below over a factor that the height decides."""
        v, mu = self._v, self._mu
        x, a = g / math.sqrt(v), mu / math.sqrt(v)
        z = math.sqrt(1 + v) * x - a / math.sqrt(1 + v)
        tail = upper_tail(z) * np.exp(np.where(a < 0, x * (a - x / 2), -((x - a) ** 2) / 2))
        body = ndtr(-z) * np.exp(np.minimum(g * g - mu * mu / (1 + v), 0.0) / 2)
        return np.asarray(np.where(z > 0, tail, body) / math.sqrt(1 + v))

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
        return g**3 * self._parts(g) / self._whole

    def with_height(self, g: Array) -> Array:
        """Probability density of the height and of a curvature `g` together, shape (n,)."""
        return g**3 * self._parts(g) * self._tables.envelope(self.x) / math.sqrt(2 * math.pi / 3)

    def elasticity(self, g: Array) -> Array:
        """``d log(density)/d log(g)``."""
        v = self._v
        z = (math.sqrt(1 + v) * g - self._mu / math.sqrt(1 + v)) / math.sqrt(v)
        rate = math.sqrt(2 / math.pi) / erfcx(z * math.sqrt(0.5))  # of the normal tail
        return np.asarray(3 + g * g - g * math.sqrt((1 + v) / v) * rate)

    def between(self, low: Array, high: Array) -> Array:
        """Probability of a curvature between two."""
        g, w = panelled(self.edges(low, high))
        return np.asarray((w * g**3 * self._parts(g)).sum(axis=0) / self._whole)

    def sf(self, low: Array) -> Array:
        """Probability of a larger curvature."""
        return self.between(low, np.maximum(self.highest(low), low))

    def mean_inverse(self, power: float, flattest: float) -> Array:
        """Mean of ``max(g, flattest)^-power``."""
        low = np.full_like(self.x, flattest)
        high = np.maximum(self.highest(low), low)
        y, w = panelled(np.sqrt(self.edges(low, high)))  # of the root all powers that are asked for are whole
        rest = (w * 2 * y ** (7 - 2 * power) * self._parts(y * y)).sum(axis=0) / self._whole
        return np.asarray(rest if flattest == 0 else rest + flattest**-power * self.between(0 * low, low))
