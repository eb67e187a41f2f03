"""Sums of independent terms: of many by the transform, of few by a recursion.

Of many: their law from its transform, on a line through the saddle point.

With K the cumulant function of the sum S and ``z = theta + i t``, for theta > 0 ::

    P(S > x) = 1/pi  Re int_0^inf exp(K(z) - z x)/z dt

Where K'(theta) = x the integrand is largest at t = 0 and nothing cancels, so that tails have as many digits
as the middle. The midpoint rule of step 2 pi/T gives, exactly, the sum over all whole k of ``(-1)^k
exp(k theta T) P(S > x + k T)``: those below 0 are known, where nothing of S is lower than x - T, and those
above 0 vanish. So one formula holds for theta of both signs, and for 0, where it is that of Gil-Pelaez.

Whatever alone adds more than x is not in a sum up to x of what is never negative. It is counted by itself
("one big jump"), and what is left has a cumulant function everywhere, whatever the law of the heights.

Of few contacts, whose density has cusps: the recursion of Panjer, for a continuous law.

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

from analytic.arrays import Array, Complex
from analytic.distribution.one_asperity import OneAsperity
from analytic.distribution.panels import POWER, Panels

_ONE_BY_ONE = 64
_NOTHING = 1e-17
_DIED = 1e-16
_NEVER = -40.0  # logarithm of a probability that is left out
_BLOCK = 24  # points of the line that are taken at a time
MOST = 1 << 12
_CUT = 36.0, 8  # the transform that has not died away is faded out by exp(-36 (t/last)^8)
_ROOM = 12.0  # standard deviations of the tilted sum between x and its images
_TOGETHER = 3.0  # of them, over which arguments share a line
_STEPS = 60


@dataclass(frozen=True, slots=True)
class Values:
    """Of a law at some arguments; the smaller one of cdf and sf to its own relative precision."""

    cdf: Array
    sf: Array
    pdf: Array


@dataclass(frozen=True, eq=False)
class Line:
    """A line in the plane of z, with the transform on it.

    Parameters
    ----------
    one : OneAsperity
        What each adds.
    theta, spread : float
        Where the line crosses the real axis, and the standard deviation of the sum tilted by it.
    room : float
        Range of the arguments.
    most : int, optional
        Points, if the transform has not died away before.
    """

    one: OneAsperity
    theta: float
    spread: float
    room: float
    most: int = MOST

    @cached_property
    def _counting(self) -> OneAsperity:
        return self.one.counting(self.theta, _NOTHING)

    @cached_property
    def widest(self) -> float:
        """Largest value that counts."""
        return max(float(self._counting.values.max(initial=0.0)), 0.0)

    @cached_property
    def period(self) -> float:
        """T."""
        return self.widest + _ROOM * self.spread + self.room

    @cached_property
    def _offsets(self) -> Array:
        """Points of a block, from its first."""
        return np.asarray(2 * np.pi / self.period * np.arange(_BLOCK))

    @cached_property
    def _transform(self) -> tuple[Array, Complex]:
        """First points of the blocks of t, and at all points the transform of the sum less its mean.

        Over that on the axis, shape (blocks, points of one). Without what the surfaces have that touch
        nowhere, and with a smooth end: a kernel, many moments of which vanish, then stands in for the jumps
        of a law.
        """
        one, found = self._counting, np.empty((0, _BLOCK), dtype=np.complex128)
        starts: Array = np.asarray(2 * np.pi / self.period * np.arange(0.5, self.most, _BLOCK))
        while len(found) < starts.size:
            few = starts[len(found) : 2 * len(found) + 1]
            t = few[:, None] + self._offsets
            more = np.exp(one.cumulants(self.theta, few, self._offsets) - self._size)
            if one.nothing > _NEVER:
                more -= np.exp(one.nothing - one.mean * (self.theta + 1j * t) - self._size)
            found, died = np.concatenate([found, more]), np.abs(more[:, -1]) < _DIED
            if died.any():
                found = found[: len(found) - more.shape[0] + int(np.argmax(died)) + 1]
                return np.asarray(starts[: len(found)]), np.asarray(found)
        t = starts[:, None] + self._offsets
        return starts, np.asarray(found * np.exp(-_CUT[0] * (t / t[-1, -1]) ** _CUT[1]))

    @cached_property
    def _size(self) -> float:
        """Logarithm of the transform on the axis."""
        return float(self._counting.cumulants(self.theta, np.zeros(1), np.zeros(1)).item().real)

    def __call__(self, x: Array) -> Values:
        """The law at arguments within the room."""
        starts, transform = self._transform
        apart = x - self._counting.mean
        turned, within = (np.exp(-1j * np.multiply.outer(apart, t)) for t in (starts, self._offsets))
        height = np.exp(self._size - self.theta * apart) * (2 / self.period)
        above, density = (
            height * ((turned @ terms) * within).real.sum(axis=1)
            for terms in (transform / (self.theta + 1j * (starts[:, None] + self._offsets)), transform)
        )
        image, atom = np.exp(-abs(self.theta) * self.period), 0.0
        if (nothing := self._counting.nothing) > _NEVER:
            atom = float(np.exp(nothing))
        less, more = (1.0, image) if self.theta >= 0 else (image, 1.0)
        less, more = ((1 - atom) * share / (1 + image) for share in (less, more))
        return Values(less - above + atom * (x >= 0), above + more + atom * (x < 0), density)


def saddle(one: OneAsperity, x: float) -> tuple[float, float]:
    """Where the derivative of the cumulant function is x, roughly, and the standard deviation there."""
    theta, low, high, spread = 0.0, -np.inf, np.inf, one.std
    for _ in range(_STEPS):
        _, mean, variance = one.tilted(theta)
        if not (np.isfinite(mean) and np.isfinite(variance) and variance > 0):
            high, theta = theta, (max(low, 0.0) + theta) / 2
            continue
        spread = float(np.sqrt(variance))
        if abs(mean - x) < 0.1 * spread:
            break
        low, high = (theta, high) if mean < x else (low, theta)
        step = float(np.clip((x - mean) / variance, -4 / spread, 4 / spread))
        theta = theta + step if low < theta + step < high else (low + high) / 2
    return theta, spread


def by_contour(one: OneAsperity, x: Array, most: int = MOST) -> Values:
    """The law of the sum of all asperities, at increasing arguments."""
    parts, i = [], 0
    while i < x.size:
        _, spread = saddle(bounded(one, x[i])[0], x[i])
        stop = max(int(np.searchsorted(x, x[i] + _TOGETHER * spread, side="right")), i + 1)
        parts.append(_on_one_line(one, x[i:stop], most))
        i = stop
    return Values(*(np.concatenate([getattr(part, name) for part in parts]) for name in ("cdf", "sf", "pdf")))


def bounded(one: OneAsperity, x: float) -> tuple[OneAsperity, float]:
    """The asperities that can be in a sum up to x, and the logarithm of the probability of no others."""
    if x <= 0 or one.least < 0 or one.values.max(initial=0.0) <= x:
        return one, 0.0
    return one.without(x)


def _on_one_line(one: OneAsperity, x: Array, most: int) -> Values:
    kept, none_else = bounded(one, float(x[-1]))
    theta, spread = saddle(kept, float(x[0] + x[-1]) / 2)
    found, share = Line(kept, theta, spread, float(x[-1] - x[0]), most)(x), np.exp(none_else)
    return Values(share * found.cdf, share * found.sf - np.expm1(none_else), share * found.pdf)


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

    @cached_property
    def _masses(self) -> Array:
        return self.panels.integrals(self.density * self._damping(self.panels.w))

    @property
    def missing(self) -> float:
        """How far all probabilities up to the top are from 1."""
        return float(np.abs(self.nothing + self._masses.sum() - 1))

    def __call__(self, x: Array) -> Values:
        """The law at arguments between 0 and the top."""
        w, panels, g, masses = (x / self.top) ** (1 / POWER), self.panels, self.density, self._masses
        below, above = np.append(0.0, np.cumsum(masses)), np.append(np.cumsum(masses[::-1])[::-1], 0.0)
        which = np.clip(np.searchsorted(panels.edges, w, side="right") - 1, 0, masses.size - 1)
        cdf = self.nothing + below[which] + panels.integral_within(g, self._damping, w, up=False)
        sf = above[which + 1] + panels.integral_within(g, self._damping, w, up=True)
        return Values(cdf, sf, panels.at(g, w) * self._damping(w) / (POWER * w ** (POWER - 1) * self.top))

    def _damping(self, w: Array) -> Array:
        return np.asarray(np.exp(-self.tilt * self.top * w**POWER))
