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
from analytic.distribution.distribution import NOTHING

_ROUNDING = 1e-12  # of probabilities of one contact: damping multiplies the last digit of 1
_PERIOD, _DAMPED = 4, 28.0  # length of a lattice over what is read of it; logarithm of the damping over it
_STENCIL = range(-3, 4)  # lattice points that share a value and keep its moments up to the sixth
_MARGIN = 16  # lattice points read below the lowest sum, and filled beyond the last that is read
_FEW = 1e-25  # probability of no contact above which sums of none and of one count
_REACH = 9.0  # standard deviations that hold all but 1e-18
_RARE = 1e-3, 1e-9  # asperities on a surface that add more, or less, than usual ones; than next to all
_WIDER, _NARROWER, _LEVELS = 8, (256, 16), 6
_SMOOTH, _DIED = 1e3, 45.0  # mean over standard deviation of sums without steps; logarithm of their transform
_RESOLVED = 5.0  # lattice points in a standard deviation of the usual sums
_NEVER = 1e3  # a logarithm of what is 0
_PLAIN = 8  # lattice points to the median of the values, of which half are resolved


@dataclass(frozen=True, eq=False)
class OneAsperity:
    """What one of the asperities of a surface adds: as values with probabilities, and as a distribution.

    Parameters
    ----------
    values, probabilities : ndarray
        Of asperities that touch, values increasing, shape (m,).
    places, upto : ndarray
        Values, and the share of asperities that touch and add no more: linear in between, or stepped.
    mean, variance : float
        Of the sum over a surface.
    number : float
        Asperities on a surface, or their mean number.
    poisson : bool
        Whether their number is a Poisson variable.
    stepped, bounded : bool
        Whether there are no values in between, and none above.
    """

    values: Array
    probabilities: Array
    places: Array
    upto: Array
    mean: float
    variance: float
    number: float
    poisson: bool
    stepped: bool
    bounded: bool

    @property
    def share(self) -> float:
        """Probability that an asperity touches."""
        return min(float(self.probabilities.sum()), 1.0)

    @property
    def ends(self) -> tuple[float, float]:
        """Least and greatest sum there is."""
        least, greatest = (float(self.values[0]), float(self.values[-1])) if self.values.size else (0.0, 0.0)
        if self.share < 1 - _ROUNDING:
            least, greatest = min(least, 0.0), max(greatest, 0.0)
        most = np.inf if self.poisson else self.number
        low, high = (end * most if end else 0.0 for end in (least, greatest))
        return (0.0 if self.poisson and least >= 0 else low), (high if self.bounded else np.inf)

    @cached_property
    def none(self) -> float:
        """Probability that no asperity of a surface touches."""
        return float(np.exp(-self.number * self.share) if self.poisson else (1 - self.share) ** self.number)

    @cached_property
    def alone(self) -> float:
        """Expected number of asperities that touch alone on their surface, over the share."""
        if self.poisson:
            return self.number * self.none
        return self.number * float((1 - self.share) ** (self.number - 1))

    @property
    def rounding(self) -> float:
        """Of probabilities of sums: it grows as the mean in standard deviations."""
        return _ROUNDING * max(1.0, float(np.sqrt(self.number * self.share)))

    @property
    def few(self) -> bool:
        """Whether surfaces with no contact or one count."""
        return max(self.none, self.alone) > _FEW

    @cached_property
    def usual(self) -> tuple[float, float, float]:
        """Mean and standard deviation of sums without rare large values, and the largest value in them."""
        x, p = self.values, self.probabilities
        rarer = self.number * np.cumsum(p[::-1])[::-1]
        kept = rarer > min(_RARE[0], rarer[0] / 2)
        mean = float(p[kept] @ x[kept])
        variance = float(p[kept] @ x[kept] ** 2) - (0.0 if self.poisson else mean**2)
        return self.number * mean, float(np.sqrt(self.number * max(variance, 0.0))), float(x[kept][-1])

    @property
    def median(self) -> float:
        """What half of the asperities that touch add, without its sign."""
        return abs(float(np.interp(self.share / 2, self.upto, self.places)))

    def below(self, x: Array) -> Array:
        """Share of asperities that touch and add no more than some values."""
        if self.stepped:
            return np.append(0.0, self.upto)[np.searchsorted(self.places, x, "right")]
        return np.interp(x, self.places, self.upto, left=0.0, right=self.share)

    def integral(self, x: Array) -> Array:
        """Integral of those shares up to some values."""
        steps = np.diff(self.places) * (self.upto[1:] + self.upto[:-1]) / 2
        j = np.clip(np.searchsorted(self.places, x) - 1, 0, self.places.size - 1)
        step = np.maximum(x - self.places[j], 0.0)
        return np.append(0.0, np.cumsum(steps))[j] + step * (self.upto[j] + self.below(x)) / 2

    def with_few(self, x: Array, below: Array, above: Array) -> tuple[Array, Array]:
        """Shares up to and above some sums, with those of surfaces that no asperity touches, or one."""
        own = self.below(x)
        below = below + self.alone * own + self.none * (x >= 0)
        return below, above + self.alone * (self.share - own) + self.none * (x < 0)

    @cached_property
    def lowest(self) -> float:
        """A sum that next to no surface stays below."""
        at = np.searchsorted(np.cumsum(self.probabilities), np.array(_RARE) / self.number)
        usual, rarest = (min(float(x), 0.0) for x in self.values[np.minimum(at, self.values.size - 1)])
        if self.few:
            contacts = self.number * self.share
            return rarest + usual * float(contacts + _REACH * np.sqrt(contacts) + _REACH)
        mean, std, _ = self.usual
        return max(mean - _REACH * std + rarest, -np.inf if rarest < 0 else 0.0)

    def widths(self, points: int) -> list[float]:
        """Lengths above the lowest sum that lattices cover, increasing."""
        mean, std, largest = self.usual
        width = mean + _REACH * std + max(largest, 0.0) - self.lowest
        found = [width * _WIDER**k for k in range(_LEVELS)]
        if not self.few:
            finest = std / _RESOLVED / (1 + _DAMPED * abs(mean) / width) ** (1 / 6)
            return [w for w in found if w <= max(width, points * finest)]
        narrower = [width / k for k in (_NARROWER if self.lowest >= 0 else (*_NARROWER, 2))]
        return [*(w for w in narrower if w > max(2 * abs(self.values[0]), -self.lowest)), *found]


@dataclass(frozen=True, eq=False)
class Lattice:
    """The law of sums of two contacts and more, on a lattice above the lowest sum.

    Parameters
    ----------
    one : OneAsperity
        What is summed.
    width : float
        Length that it covers. Values beyond it are left out: no sum that is read has them.
    points : int
        On that length.
    """

    one: OneAsperity
    width: float
    points: int

    @cached_property
    def x(self) -> Array:
        """Its points."""
        return (self._first + np.arange(self.points + _MARGIN)) * self.width / self.points

    @property
    def _first(self) -> float:
        return float(np.floor(self.one.lowest * self.points / self.width)) - _MARGIN

    @cached_property
    def masses(self) -> Array:
        """Probability of the sums at each point."""
        one, step, size = self.one, self.width / self.points, _PERIOD * self.points
        k, damping, few = np.arange(size), _DAMPED / size, one.few and not one.stepped
        f, lost = self._between_neighbours(step, size) if few else self._by_stencil(step, size)
        f[0] = 0.0
        kept = f.sum()
        f *= np.exp(-damping * np.where(k < 3 * size // 4, k, k - size))
        f[0] = -kept - lost  # so that many small values lose no digits
        q = np.fft.rfft(f)
        z = damping + 2j * np.pi / size * k[: q.size]
        if few and _PLAIN * step < one.median:
            q = (q + one.share) / (np.sinh(z / 2) / (z / 2)) ** 2 - one.share
        log = one.number * (q if one.poisson else _log1p(q)) + z * self._first
        if not one.few:  # the rule has the mean to more digits than the values
            log -= z * ((one.mean - one.number * float(one.probabilities @ one.values)) / step)
            if (
                one.mean > _SMOOTH * one.usual[1]
            ):  # no more comes, whatever a stencil makes of high frequencies
                log[np.argmax(log.real < log.real[0] - _DIED) :] = -np.inf
        spectrum = np.exp(log)
        if one.few:
            spectrum -= (one.none + one.alone * (q + one.share)) * np.exp(z * self._first)
        read = k[: self.x.size]
        return np.asarray(np.fft.irfft(spectrum, size)[read] * np.exp(damping * read))

    def _between_neighbours(self, step: float, size: int) -> tuple[Array, float]:
        """Probabilities of values at the points, shared by two neighbours, and of those beyond its end."""
        k = np.arange(np.floor(self.one.values[0] / step) - 2, self.points + _MARGIN + 1)
        shared = np.diff(self.one.integral(step * k), 2) / step
        f = np.bincount(k[1:-1].astype(np.int64) % size, shared, size).astype(np.float64)
        return f, self.one.share - float(shared.sum())

    def _by_stencil(self, step: float, size: int) -> tuple[Array, float]:
        """The same by Lagrange's weights, which keep the moments of values much smaller than a step."""
        values, p = self.one.values, self.one.probabilities
        kept = values <= (self.points + _MARGIN) * step
        places, f = values[kept] / step, np.zeros(size)
        near = np.rint(places)
        off, at = places - near, near.astype(np.int64)
        for i in _STENCIL:
            weights = p[kept]
            for j in _STENCIL:
                if j != i:
                    weights *= (off - j) / (i - j)
            f += np.bincount((at + i) % size, weights, size)
        return f, float(p[~kept].sum())

    @cached_property
    def _upto(self) -> Array:
        """Shares of surfaces with two contacts and more up to each point, by Euler and Maclaurin."""
        return np.asarray(np.cumsum(self.masses) - self.masses / 2 - np.gradient(self.masses) / 12)

    @property
    def beyond(self) -> float:
        """Share of the surfaces with sums beyond its end, to its rounding."""
        rest = 1 - self.one.none - self.one.alone * self.one.share
        return max(rest - float(self._upto[-1]), 0.0)

    def shares(self, x: Array, beyond: float) -> tuple[Array, Array]:
        """Shares of surfaces with two contacts and more up to some sums that it covers, and above them.

        So many have sums `beyond` its end.
        """
        p, below = self.masses, self._upto
        above = np.cumsum(p[::-1])[::-1] - p / 2 + np.gradient(p) / 12
        above += beyond - above[-1]
        k = np.clip(np.searchsorted(self.x, x, "right") - 1, 0, self.x.size - 2)
        part = np.maximum((x - self.x[k]) * self.points / self.width, 0.0)
        bend = part * (part - 1) * (p[k + 1] - p[k]) / 2
        return below[k] + part * np.diff(below)[k] + bend, above[k] + part * np.diff(above)[k] - bend


def _log1p(q: Complex) -> Complex:
    """``log(1 + q)``, of which NumPy's loses digits where q is small."""
    with np.errstate(divide="ignore"):
        size = np.maximum(np.log1p(2 * q.real + np.abs(q) ** 2) / 2, -_NEVER)
    return np.asarray(size + 1j * np.arctan2(q.imag, 1 + q.real))


def shares_at(one: OneAsperity, x: Array, points: int) -> tuple[Array, Array]:
    """Return the shares of surfaces up to some sums and above them, by one lattice that suits the largest."""
    widths = one.widths(points) if one.values.size else []
    for width in widths:
        if one.lowest + width >= x.max():
            lattice = Lattice(one, width, points)
            return one.with_few(x, *lattice.shares(x, lattice.beyond))
    upto = np.where((x >= 0) | bool(widths), 1.0, 0.0)
    return upto, 1 - upto


def shares(one: OneAsperity, points: int) -> tuple[Array, Array, Array]:
    """Return sums, and the shares of the surfaces up to and above them, from ever wider lattices."""
    if not one.values.size:
        return np.array([-NOTHING, 0.0]), np.array([0.0, 1.0]), np.array([1.0, 0.0])
    starts, lattices = [min(one.ends[0], -NOTHING)], []
    for width in one.widths(points):
        lattices.append(Lattice(one, width, points))
        starts.append(float(lattices[-1].x[-1]))
        larger = one.number * (one.share - float(one.below(np.array(starts[-1] / 2))))
        if max(lattices[-1].beyond, larger) < one.rounding:
            break
    own = np.unique([-NOTHING, 0.0, *one.places[:: max(1, one.places.size // points)]])
    own = np.unique([*own, *np.nextafter(own, -np.inf)]) if one.stepped else own
    parts, beyond = [], lattices[-1].beyond
    for lattice, start in zip(lattices[::-1], starts[-2::-1], strict=True):
        x = np.union1d(lattice.x, own) if one.few else lattice.x
        x = x[(x >= start) & (x <= lattice.x[-1])]
        parts.append(np.stack([x, *lattice.shares(x, beyond)]))
        beyond = float(lattice.shares(np.array(start), beyond)[1])
    x, below, above = np.concatenate(parts[::-1], axis=1)
    below, above = np.where(x < one.ends[0], [[0.0], [1.0]], one.with_few(x, below, above))
    return resolved(x, below, above, one.rounding)


def resolved(x: Array, below: Array, above: Array, rounding: float) -> tuple[Array, Array, Array]:
    """Leave out of shares what rounding hides, so that they rise and fall and their sum is 1."""
    low = below < above
    below = np.maximum.accumulate(np.clip(np.where(low, below, 1 - above), 0, 1))
    above = np.minimum.accumulate(np.clip(np.where(low, 1 - below, above), 0, 1))
    kept = np.flatnonzero((below > rounding) & (above > rounding))
    kept = kept if kept.size else np.array([np.argmax(below >= above)])
    table = slice(max(kept[0] - 1, 0), kept[-1] + 2)
    return x[table], below[table], above[table]
