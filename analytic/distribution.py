"""Distributions over surfaces, with the methods of `scipy.stats`: of sums over independent asperities.

One asperity adds a value X, the sum S over N of them has the transform ``(1 + q)^N``, or ``exp(N q)`` where
their number is a Poisson variable, with ``q(z) = E exp(-z X) - 1``. One FFT gives it on a lattice; a positive
real part of z damps the sums beyond its end (Grübel and Hermesmeier, ASTIN Bulletin 29 (1999) 197).
Surfaces on which no asperity touches, or one, are counted apart, by the distribution of X itself.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import log1p  # NumPy's loses digits of small complex numbers

from analytic.arrays import Array, hold

_NARROW = 1e-9  # of the table: cells that have no density to be told
_FAR = 1e100  # beyond all sums
_SAFE = 8.0  # times what two computations differ by: their errors may have one sign
_USUAL = 5e-7  # what two computations may have in common, by a grid of 630 laws
_NOTHING = 1e-50  # less than any value but 0
_EPSILON = 2.0**-53  # what 1 less a share has of digits
_ROUNDING = 5e-12  # of a probability of sums, times the root of the number of contacts
_DAMPED = 20.0  # logarithm of the damping over a period, which is twice as long as what is read
_LAST_DIGIT = 1e-15  # of the asperities that touch: if fewer are beyond a lattice, damping only takes digits
_STENCIL = range(-3, 4)  # lattice points that share a value and keep its moments up to the sixth
_MARGIN = 16  # lattice points below the lowest sum
_REACH = 9.0  # standard deviations that hold all but 1e-18
_RARE, _NEVER = 1e-2, 1e-9  # asperities on a surface that add more than usual ones, and that pull more
_RESOLVED = 1 / 12  # of the standard deviation of usual sums: a step of the lattice, unless of surfaces that
_FEW = 1e-25  # or more expected asperities touch alone; they have a lattice narrower than of usual sums, too
_WIDER = 32.0 ** np.arange(-1, 4)
_SINGLE = 1e-9  # width of a single value, over itself and the median
_OWN = 2  # lattice points to one that the distribution of one asperity has of its own


@dataclass(frozen=True, eq=False, repr=False)
class Law:
    """Distribution of a value over surfaces, as a table; arguments have any shape.

    Shares are linear between the points of the table, of which the first and the last are those that lattices
    resolve. Beyond them the share is a bound, that at the last point, and quantiles are nan.

    Parameters
    ----------
    x : ndarray
        Values, increasing; twice where one has a probability of its own.
    upto : ndarray
        Shares of the surfaces up to each.
    ends : (float, float)
        Values that none is below, or above.
    again : callable
        Computes the law once more, by other lattices and other cells of the heights.
    moments : (float, float), optional
        Mean and variance over surfaces; default: those of the table.
    """

    x: Array
    upto: Array
    ends: tuple[float, float]
    again: Callable[[], Any]
    moments: tuple[float, float] | None = None

    def __repr__(self) -> str:
        """One line: all that it holds would fill pages."""
        return f"{type(self).__name__}(mean={self.mean():.4g}, std={self.std():.4g})"

    def mean(self) -> float:
        """Return the mean over surfaces."""
        return self._mean_var[0]

    def var(self) -> float:
        """Return the variance over surfaces."""
        return self._mean_var[1]

    @cached_property
    def _mean_var(self) -> tuple[float, float]:
        if self.moments is not None:
            return self.moments
        p, middle = np.diff(self.upto), (self.x[1:] + self.x[:-1]) / 2
        mean = float(p @ middle / p.sum())
        return mean, float(p @ (middle - mean) ** 2)

    def std(self) -> float:
        """Return the standard deviation over surfaces."""
        return float(np.sqrt(self.var()))

    def cdf(self, y: ArrayLike) -> Array:
        """Return P(Y <= y)."""
        y = np.asarray(y, dtype=np.float64)
        outside = [np.isnan(y), y < self.ends[0], y >= self.ends[1]]
        return np.select(outside, [np.nan, 0.0, 1.0], np.interp(y, self.x, self.upto))[()]

    def sf(self, y: ArrayLike) -> Array:
        """Return P(Y > y)."""
        return 1 - self.cdf(y)

    def ppf(self, q: ArrayLike) -> Array:
        """Return the smallest value y with P(Y <= y) >= q; nan beyond what lattices resolve."""
        q = np.asarray(q, dtype=np.float64)
        found = np.interp(q, self.upto, self.x, left=np.nan, right=np.nan)
        return np.select([q == 0, q == 1], self.ends, found)[()]

    def isf(self, q: ArrayLike) -> Array:
        """Return the smallest value y with P(Y > y) <= q; nan beyond what lattices resolve."""
        return self.ppf(1 - np.where(np.asarray(q) > 0, np.maximum(q, _EPSILON), q))

    def median(self) -> float:
        """Return the median over surfaces: half of them lie below it."""
        return float(self.ppf(0.5))

    def interval(self, confidence: ArrayLike) -> tuple[Array, Array]:
        """Return the ends of the range with equal shares of the surfaces below and above."""
        out = (1 - np.asarray(confidence, dtype=np.float64)) / 2
        return self.ppf(out), self.isf(out)

    def rvs(self, size: int | tuple[int, ...] | None = None, random_state: Any = None) -> Array:
        """Draw random values, by inversion."""
        return self.ppf(np.random.default_rng(random_state).random(size))

    def pdf(self, y: ArrayLike) -> Array:
        """Return the density of all values but those with a probability of their own."""
        widths = np.diff(self.x)
        wide = widths > _NARROW * (self.x[-1] - self.x[0])
        middle, density = self.x[:-1][wide] + widths[wide] / 2, np.diff(self.upto)[wide] / widths[wide]
        return np.asarray(np.interp(np.asarray(y, dtype=np.float64), middle, density, left=0, right=0))[()]

    @property
    def atom(self) -> float:
        """Probability that no asperity touches."""
        return float(self.cdf(0.0) - self.cdf(-_NOTHING))

    @cached_property
    def error(self) -> float:
        """Error bound of `cdf`, from the second computation."""
        again, x = self.again(), np.append(self.x, (self.x[1:] + self.x[:-1]) / 2)
        return float(_SAFE * np.abs(self.cdf(x) - again.cdf(x)).max() + _USUAL)

    def mapped(self, forward: Callable[[Any], Any], *, falls: bool = False) -> "Law":
        """Return the law of a function that rises, or falls, with the value."""
        way = -1 if falls else 1
        ends = np.array([float(forward(end)) for end in np.clip(self.ends, -_FAR, _FAR).tolist()])
        ends[np.abs(ends) > np.sqrt(_FAR)] *= np.inf
        return replace(
            self,
            x=forward(self.x)[::way],
            upto=1 - self.upto[::-1] if falls else self.upto,
            moments=None,
            ends=tuple(ends[::way].tolist()),
            again=lambda: self.again().mapped(forward, falls=falls),
        )


class Counted(Law):
    """Distribution of a number of asperities, with the functions of one of `scipy.stats`."""

    def __init__(self, of_number: Any) -> None:
        """Take its functions; `pdf` is the probability of a number."""
        functions = {name: getattr(of_number, name) for name in ("cdf", "sf", "ppf", "isf", "mean", "var")}
        hold(self, **functions, pdf=of_number.pmf, error=1e-14)


@dataclass(frozen=True, eq=False)
class OneAsperity:
    """What one of the asperities of a surface adds.

    Parameters
    ----------
    low, high, probabilities : ndarray
        Asperities that touch, spread evenly between two values each, their middles increasing; shape (m,).
    number : float
        Asperities on a surface, or their mean number.
    poisson : bool
        Whether their number is a Poisson variable.
    """

    low: Array
    high: Array
    probabilities: Array
    number: float
    poisson: bool

    @cached_property
    def middle(self) -> Array:
        """Middles of the values."""
        return (self.low + self.high) / 2

    @cached_property
    def share(self) -> float:
        """Probability that an asperity touches."""
        return min(float(self.probabilities.sum()), 1.0)

    @cached_property
    def none(self) -> float:
        """Probability that no asperity of a surface touches."""
        return float(np.exp(-self.number * self.share) if self.poisson else (1 - self.share) ** self.number)

    @cached_property
    def alone(self) -> float:
        """Expected number of asperities that touch alone on their surface, over the share."""
        others = self.none if self.poisson else (1 - self.share) ** (self.number - 1)
        return self.number * float(others)

    @cached_property
    def distribution(self) -> tuple[Array, Array]:
        """Values, and the share of asperities that touch and add no more: linear in between."""
        median = np.interp(self.share / 2, np.cumsum(self.probabilities), np.abs(self.middle))
        width = np.maximum(self.high - self.low, _SINGLE * (median + np.abs(self.high)))
        density, places = self.probabilities / width, np.concatenate([self.high - width, self.high])
        order = np.argsort(places)
        slopes = np.cumsum(np.concatenate([density, -density])[order], dtype=np.longdouble)[:-1]
        places = places[order]
        return places, np.append(0.0, np.cumsum(slopes * np.diff(places))).astype(np.float64)

    @cached_property
    def span(self) -> tuple[float, float, float]:
        """Lowest sum, highest one of surfaces without rare large values, longest step of a lattice."""
        x, p, n = self.middle, self.probabilities, self.number
        rarer = n * np.cumsum(p[::-1])[::-1]
        usual, pull = np.where(rarer > min(_RARE, rarer[0] / 2), x, 0.0), np.minimum(x, 0.0)
        means, squares = ((p * np.stack([usual, pull]) ** k).sum(axis=1) for k in (1, 2))
        spread = np.sqrt(n * np.maximum(squares - (0.0 if self.poisson else means**2), 0.0))
        deepest = pull[min(int(np.searchsorted(n * np.cumsum(p), _NEVER)), x.size - 1)]
        low = (n * means - _REACH * spread).max() + 2 * deepest
        high = n * means[0] + _REACH * spread[0] + max(usual.max(), 0.0)
        return float(low), float(high), np.inf if self.alone > _FEW else _RESOLVED * float(spread[0])


def on_lattice(one: OneAsperity, x: Array, low: float, high: float, points: int) -> Array:
    """Return the shares of surfaces in contact with sums up to x, which lie between two.

    Values beyond are left out: no sum that is read has them.
    """
    step, size = (high - low) / points, 2 * points
    first, k = np.floor(low / step) - _MARGIN, np.arange(size)
    signed = np.where(k < 3 * points // 2, k, k - size)
    places, p, f = one.middle / step, one.probabilities, np.zeros(size)
    kept = (places < points + 2 * _MARGIN) & (places > -points / 2)
    near, p, lost = np.rint(places[kept]), p[kept], float(p[~kept].sum())
    undamped = np.isfinite(one.span[2]) and lost <= _LAST_DIGIT * one.share
    damping = 0.0 if undamped else _DAMPED / size
    off, at = places[kept] - near, near.astype(np.int64)
    for i in _STENCIL:  # by Lagrange's weights
        weights = np.prod([(off - j) / (i - j) for j in _STENCIL if j != i], axis=0)
        f += np.bincount((at + i) % size, p * weights, size)
    centre = float((f * signed).sum())
    f[[1, -1]] -= centre / 2, -centre / 2  # apart from what scatters: it takes digits where N is large
    f[0] = 0.0
    f[0] = -f.sum() - lost  # so that many small values lose no digits
    scatter, z = np.fft.rfft(f * np.exp(-damping * signed)), damping + 2j * np.pi / size * k[: points + 1]
    q = scatter - centre * np.sinh(z)
    log = q + centre * z - (0.0 if one.poisson else q - log1p(q))
    spectrum = np.exp(one.number * log + z * (first - one.number * centre))
    if one.alone:
        spectrum -= (one.none + one.alone * (q + one.share)) * np.exp(z * first)
    read = k[: points + 2 * _MARGIN]
    p = np.fft.irfft(spectrum, size)[read] * np.exp(damping * read)
    several = np.interp(x, (first + read) * step, np.cumsum(p) - p / 2, left=0.0)
    return np.asarray(several + one.alone * np.interp(x, *one.distribution, left=0.0, right=one.share))


def shares_at(one: OneAsperity, x: Array, points: int) -> Array:
    """Return the shares of surfaces with sums up to x, by a lattice that ends with the largest of them.

    Of many contacts it has usual sums, and ends where it would not resolve them: the share is then a bound.
    """
    if not one.low.size:
        return np.where(x >= 0, 1.0, 0.0)
    low, usual, step = one.span
    if x.max() <= low:
        return np.where((x >= 0) & (x >= low), 1.0, 0.0)
    high = float(np.clip(x.max(), low if np.isinf(step) else usual, max(usual, low + points * step)))
    return on_lattice(one, x, low, high, points) + one.none * (x >= 0)


def shares(one: OneAsperity, points: int) -> tuple[Array, Array]:
    """Return sums and the shares of surfaces up to them, by ever wider lattices; a jump is a sum twice."""
    if not one.low.size:
        return np.zeros(2), np.array([0.0, 1.0])
    rounding = _ROUNDING * max(math.sqrt(one.number * one.share), 1.0)  # grows as the mean over the deviation
    own, x, upto, (low, usual, step) = one.distribution[0], np.zeros(0), np.zeros(0), one.span
    begin, least = low, -low if np.isinf(step) else usual - low
    for end in [low + w for w in (usual - low) * _WIDER if least <= w <= max(points * step, usual - low)]:
        new = np.union1d(np.linspace(low, end, points), own[:: max(1, _OWN * own.size // points)])
        new = np.union1d(new[(new > begin) & (new <= end)], [0.0] if begin <= 0 else [])
        x, upto, begin = np.append(x, new), np.append(upto, on_lattice(one, new, low, end, points)), end
        if upto[-1] > 1 - one.none - rounding:
            break
    at, upto = int(np.searchsorted(x, 0.0)), np.maximum.accumulate(upto)
    if one.low.min() >= 0:  # no rounding beside the surfaces that nothing touches
        upto[: at + 1] = 0.0
    x, upto = np.insert(x, at, 0.0), np.insert(upto, at, upto[at])
    upto[at + 1 :] += one.none
    upto = np.clip(upto, rounding, 1 - rounding)
    first, last = np.searchsorted(upto, upto[0], "right"), np.searchsorted(upto, upto[-1])
    return x[max(first - 1, 0) : last + 1], upto[max(first - 1, 0) : last + 1]
