"""What one asperity adds to a sum over a surface, and the cumulant function of the sum."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev
from scipy.special import erfc

from analytic.arrays import Array, Complex

_SMALL = 0.5  # exponents below it take a series
_NEAR = 0.1
_TERMS = 18
_CONTACTS = 1e3  # beyond, the last digits of one of them are worth more than the last of the sum
_MOST, _AT_MOST = 2000, 8000  # nodes of many and of few contacts, beyond which values are gathered
_FAR, _STEPS = 8.0, 60
_RARE = 1e-3, 1e-19  # expected number of asperities that add more
_MANY = 40.0  # contacts, of which the transform has died before it tells values in a bin apart
_BIN, _IN_BIN = 0.25, 10  # range of the logarithms of values in a bin, and points of one
_HALF_WIDTH = 12.0  # of the smooth cut, in its own widths: erfc(6) is no more than 1e-17


@dataclass(frozen=True, eq=False)
class OneAsperity:
    """The law of what one of N independent asperities adds, as values with probabilities.

    Parameters
    ----------
    values : ndarray
        What asperities add at the nodes of a rule over their heights and radii, shape (m,).
    probabilities : ndarray
        Of the nodes, shape (m,); what is left of 1 adds nothing.
    number : float
        Asperities on a surface, or their mean number.
    poisson : bool
        Whether their number is a Poisson variable.
    """

    values: Array
    probabilities: Array
    number: float
    poisson: bool

    @classmethod
    def of(cls, values: Array, probabilities: Array, number: float, poisson: bool) -> "OneAsperity":
        """Of those nodes that add something."""
        counts = (values != 0) & (probabilities > 0)
        found = cls(values[counts], probabilities[counts], number, poisson)
        most = _MOST if found.contacts > _MANY else _AT_MOST
        return found._fewer() if found.values.size > most and found.least == 0 else found

    def _fewer(self) -> "OneAsperity":
        """The same moments at Chebyshev's points of narrow bins of the values that hold more nodes."""
        place = np.floor(np.log(self.values) / _BIN).astype(np.int64)
        bins, which, size = np.unique(place, return_inverse=True, return_counts=True)
        full = size > _IN_BIN
        own, low = ~full[which], np.exp(bins[full] * _BIN)
        width = low * math.expm1(_BIN)
        of = (np.cumsum(full) - 1)[which[~own]]
        inside = 2 * (self.values[~own] - low[of]) / width[of] - 1
        nodes = chebyshev.chebpts1(_IN_BIN)
        shares = chebyshev.chebvander(inside, _IN_BIN - 1) @ np.linalg.inv(
            chebyshev.chebvander(nodes, _IN_BIN - 1)
        )
        at = (of[:, None] * _IN_BIN + np.arange(_IN_BIN)).ravel()
        moved = np.bincount(at, (self.probabilities[~own, None] * shares).ravel(), low.size * _IN_BIN)
        values = (low[:, None] + width[:, None] * (1 + nodes) / 2).ravel()
        return replace(
            self,
            values=np.append(self.values[own], values),
            probabilities=np.append(self.probabilities[own], moved),
        )

    @cached_property
    def share(self) -> float:
        """Probability that an asperity touches."""
        return min(float(self.probabilities.sum()), 1.0)

    @cached_property
    def contacts(self) -> float:
        """Expected number of contacts of a surface."""
        return self.number * self.share

    @cached_property
    def least(self) -> float:
        """The least value of the sum."""
        least = float(self.values.min(initial=0.0))
        return 0.0 if least >= 0 else -math.inf if self.poisson else self.number * least

    @cached_property
    def mean(self) -> float:
        """Of the sum."""
        return self.number * float(self.probabilities @ self.values)

    @cached_property
    def variance(self) -> float:
        """Of the sum."""
        one = self.mean / self.number
        square = float(self.probabilities @ self.values**2)
        if self.poisson:
            return self.number * square
        spread = float(self.probabilities @ (self.values - one) ** 2)
        return self.number * (spread + (1 - self.share) * one * one)

    @cached_property
    def std(self) -> float:
        """Standard deviation of the sum."""
        return math.sqrt(self.variance)

    @cached_property
    def skewness(self) -> float:
        """Of the sum."""
        if self.variance == 0:
            return 0.0
        one = 0.0 if self.poisson else self.mean / self.number
        third = float(self.probabilities @ (self.values - one) ** 3) - (1 - self.share) * one**3
        return self.number * third / self.std**3

    @cached_property
    def nothing(self) -> float:
        """Logarithm of the probability that no asperity touches."""
        if self.poisson:
            return -self.contacts
        with np.errstate(divide="ignore"):
            return float(self.number * np.log1p(-self.share))

    @cached_property
    def few_up_to(self) -> float:
        """Sums below hold so few contacts that their law is not found by its transform."""
        if self.nothing > -_MANY:
            return np.inf
        theta = -1 / self.std
        for _ in range(_STEPS):
            size, mean, _ = self.tilted(theta)
            if self.nothing - size > -_MANY:
                break
            theta *= 1.3
        return mean

    @cached_property
    def usual(self) -> tuple[float, float]:
        """What surfaces without a rare asperity stay below; and what next to no asperity exceeds."""
        order = np.argsort(self.values)
        beyond = max(self.number, 1 / self.share) * np.cumsum(self.probabilities[order][::-1])[::-1]
        rare, rarest = (float(self.values[order][beyond > share].max(initial=0.0)) for share in _RARE)
        usual = replace(self, probabilities=np.where(self.values <= rare, self.probabilities, 0.0))
        return usual.mean + _FAR * usual.std + rare, rarest

    def without(self, limit: float) -> tuple["OneAsperity", float]:
        """The asperities but those that alone add more, and the logarithm of the share without those.

        A sum up to the limit has none of them. They fade out up to twice the limit, so that the transform
        of what is left falls as fast as before.
        """
        kept = erfc(_HALF_WIDTH * (self.values / limit - 1.5)) / 2
        lost = float(self.probabilities @ (1 - kept))
        if self.poisson:
            return replace(self, probabilities=self.probabilities * kept), -self.number * lost
        with np.errstate(divide="ignore"):
            rest = float(np.log1p(-lost))
        few = replace(self, probabilities=self.probabilities * (kept / (1 - lost)))
        return few, self.number * rest

    def counting(self, theta: float, share: float) -> "OneAsperity":
        """Without the nodes of which surfaces tilted by theta have none, but for a share."""
        weights = self.number * self.probabilities * np.exp(theta * self.values)
        counts = np.abs(weights) > share * max(1.0, float(weights.sum())) / max(weights.size, 1)
        return replace(self, values=self.values[counts], probabilities=self.probabilities[counts])

    def decay(self, x: float) -> float:
        """How fast the logarithm of the probability to add more than a value falls, on the way to x."""
        far, half = (float(self.probabilities[self.values > at].sum()) for at in (x, x / 2))
        if half <= far:
            return 0.0 if far > 0 else math.inf
        return math.log(half / far) / (x / 2) if far > 0 else math.inf

    def tilted(self, theta: float) -> tuple[float, float, float]:
        """The cumulant function at a real argument, and its first and second derivative."""
        weights = self.probabilities * np.exp(theta * self.values)
        more = float(self.probabilities @ np.expm1(theta * self.values))
        first, second = float(weights @ self.values), float(weights @ self.values**2)
        n = self.number
        if self.poisson:
            return n * more, n * first, n * second
        if 1 + more < _SMALL and self.share == 1:  # nothing stands beside what has become small
            growth = theta * self.values
            most = float(growth.max())
            weights = self.probabilities * np.exp(growth - most)
            first, second = (float(weights @ self.values**k / weights.sum()) for k in (1, 2))
            size = float(np.log(weights.sum())) + most
            return n * size, n * first, n * (second - first * first)
        if 1 + more <= 0:
            return math.nan, math.nan, math.nan
        first, second = first / (1 + more), second / (1 + more)
        return n * float(np.log1p(more)), n * first, n * (second - first * first)

    def cumulants(self, theta: float, starts: Array, offsets: Array) -> Complex:
        """Logarithm of the mean of exp(z (S - mean)), accurate for any number.

        At z = theta + i t, where t are the sums of starts and offsets: shape (starts, offsets).
        """
        t, x = np.add.outer(starts, offsets), self.values
        contacts = self.number * float(self.probabilities @ np.exp(theta * x))
        if not self.poisson:
            contacts /= 1 + float(self.probabilities @ np.expm1(theta * x))
        if contacts < _CONTACTS and np.abs(x).max(initial=0.0) * starts[0] > _SMALL:
            rest = self._by_products(theta, starts, offsets)
        else:
            rest = np.stack([self._beyond_linear(theta, row) for row in t])
        if self.poisson:
            return np.asarray(self.number * rest)
        linear = (theta + 1j * t) * (self.mean / self.number)
        return np.asarray(self.number * (rest + _log_beyond_linear(rest + linear)))

    def _by_products(self, theta: float, starts: Array, offsets: Array) -> Complex:
        """As `_beyond_linear`, from fewer exponentials: the last digits of 1 are lost."""
        x, growth = self.values, theta * self.values
        first, further = (np.exp(1j * np.multiply.outer(t, x)) for t in (starts, offsets))
        tilted = self.probabilities * np.exp(growth)
        linear = tilted.sum() - self.probabilities @ (np.expm1(growth) - growth)
        t = np.add.outer(starts, offsets)
        return np.asarray((first * tilted) @ further.T - linear - 1j * t * (self.probabilities @ x))

    def _beyond_linear(self, theta: float, t: Array) -> Complex:
        """Mean of ``exp(z X) - 1 - z X``, without a loss where all z X are small."""
        x, p = self.values, self.probabilities
        phase, growth = np.multiply.outer(t, x), theta * x
        if max(np.abs(phase).max(initial=0.0), np.abs(growth).max(initial=0.0)) > _SMALL:
            tilted = p * np.exp(growth)
            real = -2 * np.sin(phase / 2) ** 2 @ tilted + p @ (np.expm1(growth) - growth)
            return np.asarray(real + 1j * (np.sin(phase) @ tilted - t * (p @ x)))
        z, total = growth + 1j * phase, np.ones(phase.shape, dtype=np.complex128)
        for k in range(_TERMS, 2, -1):
            total = 1 + total * z / k
        return np.asarray((total * z * z / 2) @ p)


def _log_beyond_linear(q: Complex) -> Complex:
    """``log(1 + q) - q``, without a loss where q is small; NumPy's complex log1p has one."""
    size = np.abs(q)
    near = np.where(size < _NEAR, q, 0.0)
    series = np.zeros_like(q)
    for k in range(_TERMS, 1, -1):
        series = (-1) ** (k + 1) / k + near * series
    log = np.log1p(2 * q.real + size**2) / 2 + 1j * np.arctan2(q.imag, 1 + q.real)
    return np.asarray(np.where(size < _NEAR, series * q * q, log - q))
