"""Sums over independent asperities on lattices: their transform is a power of that of one asperity.

One asperity adds a value X, the sum S over N of them has the transform ``(1 + q)^N``, or ``exp(N q)`` where
their number is a Poisson variable, with ``q(z) = E exp(-z X) - 1``. One FFT gives it on a lattice; a positive
real part of z damps the sums beyond its end (Grübel and Hermesmeier, ASTIN Bulletin 29 (1999) 197).
Surfaces on which no asperity touches, or one, are counted apart, by the distribution of X itself.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import log1p  # NumPy's loses digits of small complex numbers

from analytic.arrays import Array

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

    @property
    def rounding(self) -> float:
        """Of probabilities of sums: it grows as the mean in standard deviations."""
        return _ROUNDING * max(float(np.sqrt(self.number * self.share)), 1.0)

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
    own, x, upto, (low, usual, step) = one.distribution[0], np.zeros(0), np.zeros(0), one.span
    begin, least = low, -low if np.isinf(step) else usual - low
    for end in [low + w for w in (usual - low) * _WIDER if least <= w <= max(points * step, usual - low)]:
        new = np.union1d(np.linspace(low, end, points), own[:: max(1, _OWN * own.size // points)])
        new = np.union1d(new[(new > begin) & (new <= end)], [0.0] if begin <= 0 else [])
        x, upto, begin = np.append(x, new), np.append(upto, on_lattice(one, new, low, end, points)), end
        if upto[-1] > 1 - one.none - one.rounding:
            break
    at, upto = int(np.searchsorted(x, 0.0)), np.maximum.accumulate(upto)
    if one.low.min() >= 0:  # no rounding beside the surfaces that nothing touches
        upto[: at + 1] = 0.0
    x, upto = np.insert(x, at, 0.0), np.insert(upto, at, upto[at])
    upto[at + 1 :] += one.none
    upto = np.clip(upto, one.rounding, 1 - one.rounding)
    first, last = np.searchsorted(upto, upto[0], "right"), np.searchsorted(upto, upto[-1])
    return x[max(first - 1, 0) : last + 1], upto[max(first - 1, 0) : last + 1]
