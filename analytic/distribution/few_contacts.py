"""Sums of few contacts, whose density has cusps: the recursion of Panjer, for a continuous law.

With f the density of what one asperity adds, g that of the sum and p0 the probability that an asperity does
not touch, the derivative of the logarithm of the transform gives (Panjer, ASTIN Bulletin 12 (1981) 22) ::

    x g(x) = N [P(S = 0) x f(x) + int_0^x y f(y) g(x - y) dy]                           Poisson
    p0 x g(x) = N P(S = 0) x f(x) + int_0^x [(N + 1) y - x] f(y) g(x - y) dy            fixed N

which is solved panel by panel, upwards. Terms are positive, or nearly so: tails have as many digits as the
middle. Of few asperities, all of which may touch, the laws of 1, 2, ... N contacts are convolved one by one.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import gammaln

from analytic.arrays import Array
from analytic.distribution.contour import Values
from analytic.distribution.panels import POWER, Panels

_ONE_BY_ONE = 64


@dataclass(frozen=True, eq=False)
class FewContacts:
    """The law of the sum up to some argument.

    Parameters
    ----------
    one : ndarray
        Density in w of what one asperity adds, at the points of the panels.
    share : float
        Probability that an asperity touches.
    number : float
        Asperities on a surface, or their mean number.
    poisson : bool
        Whether their number is a Poisson variable.
    top : float
        The largest argument.
    panels : Panels
        From 0 to there.
    tilt : float
        Densities are held times ``exp(tilt x)``, for which the recursion is the same: so they hardly fall.
    """

    one: Array
    share: float
    number: float
    poisson: bool
    top: float
    panels: Panels
    tilt: float

    @cached_property
    def nothing(self) -> float:
        """P(S = 0)."""
        if self.poisson:
            return float(np.exp(-self.number * self.share))
        return float(np.exp(self.number * np.log1p(-self.share))) if self.share < 1 else 0.0

    @cached_property
    def density(self) -> Array:
        """In w, at the points, tilted."""
        if not self.poisson and self.number <= _ONE_BY_ONE and self.number % 1 == 0:
            return self._one_by_one
        f, nodes = self._tilted.ravel(), self.panels.nodes
        none = 1.0 if self.poisson else 1 - self.share
        weights = (self.number, 0.0) if self.poisson else (self.number + 1, -1.0)
        matrix = np.eye(f.size) - self.panels.convolution(self._tilted, *weights) / none
        free, g = self.number * self.nothing / none * f, np.empty_like(f)
        for k in range(0, f.size, nodes):
            own = slice(k, k + nodes)
            g[own] = np.linalg.solve(matrix[own, own], free[own] - matrix[own, :k] @ g[:k])
        return g.reshape(self.one.shape)

    @property
    def _tilted(self) -> Array:
        return np.asarray(self.one / self._damping(self.panels.w))

    @property
    def _one_by_one(self) -> Array:
        n, of = int(self.number), self._tilted.ravel()
        further = self.panels.convolution(self._tilted, 0.0, 1.0) if n > 1 else np.empty((0, 0))
        total = np.zeros_like(of)
        for k in range(1, n + 1):
            ways = np.exp(gammaln(n + 1) - gammaln(k + 1) - gammaln(n - k + 1))
            total += ways * (1 - self.share) ** (n - k) * of
            of = further @ of if k < n else of
        return total.reshape(self.one.shape)

    def __call__(self, x: Array) -> Values:
        """The law at arguments between 0 and the top."""
        w, panels, g = (x / self.top) ** (1 / POWER), self.panels, self.density
        masses = panels.integrals(g * self._damping(panels.w))
        below, above = np.append(0.0, np.cumsum(masses)), np.append(np.cumsum(masses[::-1])[::-1], 0.0)
        which = np.clip(np.searchsorted(panels.edges, w, side="right") - 1, 0, masses.size - 1)
        cdf = self.nothing + below[which] + panels.integral_within(g, self._damping, w, up=False)
        sf = above[which + 1] + panels.integral_within(g, self._damping, w, up=True)
        return Values(cdf, sf, panels.at(g, w) * self._damping(w) / (POWER * w ** (POWER - 1) * self.top))

    def _damping(self, w: Array) -> Array:
        return np.asarray(np.exp(-self.tilt * self.top * w**POWER))
