"""Sums over independent asperities on lattices: their transform is a power of that of one asperity.

One asperity adds a value X, the sum S over N of them has the transform ``(1 + q)^N``, or ``exp(N q)`` where
their number is a Poisson variable, with ``q(z) = E exp(-z X) - 1``. One FFT gives it on a lattice; a positive
real part of z damps the sums beyond its end (Grübel and Hermesmeier, ASTIN Bulletin 29 (1999) 197).
Surfaces on which no asperity touches, or one, are counted apart, by the distribution of X itself.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.arrays import Array, Complex

_ROUNDING = 5e-12  # of a probability of sums
_DAMPED = 20.0  # logarithm of the damping over a period, which is twice as long as what is read
_STENCIL = range(-3, 4)  # lattice points that share a value and keep its moments up to the sixth
_MARGIN = 16  # lattice points below the lowest sum
_REACH = 9.0  # standard deviations that hold all but 1e-18
_RARE = 1e-2, 1e-9  # asperities on a surface that add more than usual ones; that add less than next to all
_WIDER = 32.0 ** np.arange(-2, 4)  # lattices than the narrowest
_RESOLVED = 5.0  # lattice points in a standard deviation of the usual sums
_SINGLE = 1e-9, 1e-12  # width of a single value, over the median and over itself
_SMOOTH = 1e4  # mean over standard deviation of sums that damping would blow up
_FEW = 1e-25  # surfaces that one asperity alone touches, below which a lattice may be too coarse for them
_OWN = 2  # lattice points to one that the distribution of one asperity has of its own
_HOLDS = 1.02  # length of a lattice that holds a sum, with its margin
_DIED = 45.0  # logarithm of a transform of sums
_NEVER = 1e3  # a logarithm of what is 0


@dataclass(frozen=True, eq=False)
class OneAsperity:
    """What one of the asperities of a surface adds.

    Parameters
    ----------
    low, high, probabilities : ndarray
        Asperities that touch, spread evenly between two values each, their middles increasing; shape (m,).
    mean, variance : float
        Of the sum over a surface.
    number : float
        Asperities on a surface, or their mean number.
    poisson : bool
        Whether their number is a Poisson variable.
    """

    low: Array
    high: Array
    probabilities: Array
    mean: float
    variance: float
    number: float
    poisson: bool

    @property
    def share(self) -> float:
        """Probability that an asperity touches."""
        return min(float(self.probabilities.sum()), 1.0)

    @property
    def rounding(self) -> float:
        """Of probabilities of sums: it grows as the mean in standard deviations."""
        return _ROUNDING * float(np.clip(np.sqrt(self.number * self.share), 1.0, _SMOOTH))

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
        median = np.interp(self.share / 2, np.cumsum(self.probabilities), np.abs(self.low + self.high) / 2)
        width = np.maximum(self.high - self.low, _SINGLE[0] * median + _SINGLE[1] * np.abs(self.high))
        left = np.where(self.high == self.low, self.low - width, self.low)
        density, places = self.probabilities / width, np.concatenate([left, left + width])
        order = np.argsort(places)
        slopes = np.cumsum(np.concatenate([density, -density])[order], dtype=np.longdouble)[:-1]
        places = places[order]
        return places, np.append(0.0, np.cumsum(slopes * np.diff(places))).astype(np.float64)

    def with_few(self, x: Array, upto: Array) -> Array:
        """Add surfaces that no asperity touches, or one, to the shares with sums up to x."""
        own = np.interp(x, *self.distribution, left=0.0, right=self.share)
        return np.asarray(upto + self.alone * own + self.none * (x >= 0))

    @cached_property
    def usual(self) -> tuple[float, float, float]:
        """Mean and standard deviation of sums without rare large values, and the largest value in them."""
        x, p = (self.low + self.high) / 2, self.probabilities
        rarer = self.number * np.cumsum(p[::-1])[::-1]
        kept = rarer > min(_RARE[0], rarer[0] / 2)
        mean = float((p * x)[kept].sum())
        variance = float((p * x**2)[kept].sum()) - (0.0 if self.poisson else mean**2)
        return self.number * mean, float(np.sqrt(self.number * max(variance, 0.0))), float(x[kept][-1])

    @cached_property
    def lowest(self) -> float:
        """A sum that next to no surface stays below: by all values, or by the negative ones alone."""
        x, p, n = np.minimum(self.low, 0.0), self.probabilities, self.number
        usual, rarest = x[np.minimum(np.searchsorted(np.cumsum(p), np.array(_RARE) / n), x.size - 1)].tolist()
        negative = n * (p * x).sum() - _REACH * np.sqrt(n * (p * x**2).sum())
        mean, std, _ = self.usual
        return float(max(mean - _REACH * std, negative) + 2 * (_REACH * usual + rarest))

    def widths(self, points: int) -> list[float]:
        """Lengths above the lowest sum that lattices cover, increasing."""
        mean, std, largest = self.usual
        width = mean + _REACH * std + max(largest, 0.0) - self.lowest
        if self.alone < _FEW:
            least, most = width, max(width, points * std / _RESOLVED)
        else:
            least, most = -self.lowest if self.lowest < 0 else width, np.inf
        return [w for w in width * _WIDER if least <= w <= most]


def on_lattice(one: OneAsperity, width: float, points: int) -> tuple[Array, Array]:
    """Return sums above the lowest one, and the share of surfaces with two contacts or more up to each.

    Values beyond the width are left out: no sum that is read has them.
    """
    step, size = width / points, 2 * points
    first = float(np.floor(one.lowest / step)) - _MARGIN
    smooth = one.mean > _SMOOTH * one.usual[1]
    k, damping = np.arange(size), 0.0 if smooth else _DAMPED / size
    signed = np.where(k < 3 * points // 2, k, k - size)
    f, lost = _stencil(one, step, size)
    centre = float((f * signed).sum())
    f[[1, -1]] -= centre / 2, -centre / 2  # apart from what scatters: it takes digits where N is large
    f[0] = 0.0
    f[0] = -f.sum() - lost  # so that many small values lose no digits
    f[1:] *= np.exp(-damping * signed[1:])
    scatter = np.fft.rfft(f)
    z = damping + 2j * np.pi / size * k[: scatter.size]
    q = scatter - centre * np.sinh(z)
    log = scatter - centre * (np.sinh(z) - z) - (0.0 if one.poisson else q - _log1p(q))
    log = one.number * log + z * (first - one.number * centre)
    if smooth:  # no more comes, whatever a stencil makes of high frequencies
        log[np.argmax(log.real < log.real[0] - _DIED) :] = -np.inf
    spectrum = np.exp(log)
    if one.alone:
        spectrum -= (one.none + one.alone * (q + one.share)) * np.exp(z * first)
    p = np.fft.irfft(spectrum, size)[:points] * np.exp(damping * k[:points])
    upto = np.cumsum(p) - p / 2
    return np.asarray((first + k[:points]) * step), np.asarray(upto)


def _stencil(one: OneAsperity, step: float, size: int) -> tuple[Array, float]:
    """Probabilities of values at the points of a lattice, by Lagrange's weights, and of those beyond it."""
    places, p = (one.low + one.high) / (2 * step), one.probabilities
    kept = (places < size / 2) & (places > -size / 4)
    lost, places, p, f = float(p[~kept].sum()), places[kept], p[kept], np.zeros(size)
    near = np.rint(places)
    off, at = places - near, near.astype(np.int64)
    for i in _STENCIL:
        weights = p.copy()
        for j in _STENCIL:
            if j != i:
                weights *= (off - j) / (i - j)
        f += np.bincount((at + i) % size, weights, size)
    return f, lost


def _log1p(q: Complex) -> Complex:
    """``log(1 + q)``, of which NumPy's loses digits where q is small."""
    with np.errstate(divide="ignore"):
        size = np.maximum(np.log1p(2 * q.real + np.abs(q) ** 2) / 2, -_NEVER)
    return np.asarray(size + 1j * np.arctan2(q.imag, 1 + q.real))


def shares_at(one: OneAsperity, x: Array, points: int) -> Array:
    """Return the shares of surfaces with sums up to x, by the narrowest lattice that holds them."""
    for width in one.widths(points) if one.low.size else []:
        if one.lowest + width > x.max():
            if one.alone > _FEW and x.max() > one.lowest:  # what is beyond the largest does not count
                width = min(width, _HOLDS * float(x.max() - one.lowest))
            return one.with_few(x, np.interp(x, *on_lattice(one, width, points), left=0.0))
    return np.where((x >= 0) | bool(one.low.size), 1.0, 0.0)


def shares(one: OneAsperity, points: int) -> tuple[Array, Array]:
    """Return sums and the shares of surfaces up to them, by ever wider lattices; a jump is a sum twice."""
    if not one.low.size:
        return np.zeros(2), np.array([0.0, 1.0])
    own = one.distribution[0]
    x, upto = np.zeros(0), np.zeros(0)
    for width in one.widths(points):
        lattice, p = on_lattice(one, width, points)
        new = np.union1d(lattice, own[:: max(1, _OWN * own.size // points)])
        new = new[(new > max(lattice[0], x[-1] if x.size else -np.inf)) & (new <= lattice[-1])]
        x, upto = np.append(x, new), np.append(upto, one.with_few(new, np.interp(new, lattice, p)))
        if upto[-1] > 1 - one.rounding:
            break
    if one.low.min() >= 0:  # sums below 0 are there for interpolation
        x, upto = np.append(0.0, x[x > 0]), np.append(one.none, upto[x > 0])
    at = int(np.searchsorted(x, 0.0))
    x, upto = np.insert(x, at, 0.0), np.insert(upto, at, max(upto[at] - one.none, 0.0))
    upto = np.maximum.accumulate(np.clip(upto, one.rounding, 1 - one.rounding))
    kept = np.flatnonzero((upto > one.rounding) & (upto < 1 - one.rounding))
    kept = kept if kept.size else np.array([np.argmax(upto >= 0.5)])
    table = slice(max(kept[0] - 1, 0), kept[-1] + 2)
    return x[table], upto[table]
