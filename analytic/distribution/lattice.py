"""Sums over independent asperities on lattices: their transform is a power of that of one asperity.

One asperity adds a value X, the sum S over N of them has the transform ``(1 + q)^N``, or ``exp(N q)`` where
their number is a Poisson variable, with ``q(z) = E exp(-z X) - 1``. One FFT gives it on a lattice; a positive
real part of z damps the sums beyond its end (Grübel and Hermesmeier, ASTIN Bulletin 29 (1999) 197).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.arrays import Array, Complex

ROUNDING = 1e-12  # of probabilities of one contact: damping multiplies the last digit of 1
_PERIOD, _DAMPED = 4, 28.0  # length of a lattice over what is read of it; logarithm of the damping over it
_STENCIL = range(-3, 4)  # lattice points that share a value and keep its moments up to the sixth
_MARGIN = 16  # lattice points read below the lowest sum, and filled beyond the last that is read
_NOTHING = 1e-100  # less than any sum but 0
_FEW = 1e-25  # probability of no contact above which sums of none and of one are taken apart
_REACH = 9.0  # standard deviations that hold all but 1e-18
_RARE = 1e-3, 1e-9  # asperities on a surface that add more, or less, than usual ones; than next to all
_WIDER, _NARROWER, _LEVELS = 8, (256, 16), 6
_SMOOTH, _DIED = 1e3, 45.0  # mean over standard deviation of sums without steps; logarithm of their transform
_RESOLVED = 5.0  # lattice points in a standard deviation of the usual sums
_NEVER = 1e3  # a logarithm of what is 0
_PLAIN = 8  # lattice points to the median of the values, of which half are resolved


@dataclass(frozen=True, eq=False)
class OneAsperity:
    """What one of the asperities of a surface adds, as values with probabilities.

    Parameters
    ----------
    values, probabilities : ndarray
        Of asperities that touch, values increasing, shape (m,).
    places, upto : ndarray
        Values, and the share of asperities that touch and add no more.
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
    def ends(self) -> tuple[float, float]:
        """Least and greatest sum there is."""
        least, greatest = (float(self.values[0]), float(self.values[-1])) if self.values.size else (0.0, 0.0)
        if self.share < 1 - ROUNDING:
            least, greatest = min(least, 0.0), max(greatest, 0.0)
        most = np.inf if self.poisson else self.number
        low, high = (end * most if end else 0.0 for end in (least, greatest))
        return (0.0 if self.poisson and least >= 0 else low), (high if self.bounded else np.inf)

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
        rest = 0.0 if self.poisson else 1 - self.share
        return self.number * (self.none if self.poisson else rest ** (self.number - 1))

    @property
    def rounding(self) -> float:
        """Of probabilities of sums: it grows as the mean in standard deviations."""
        return ROUNDING * max(1.0, float(np.sqrt(self.number * self.share)))

    @property
    def few(self) -> bool:
        """Whether surfaces with no contact or one count."""
        return self.none > _FEW or self.alone > _FEW

    @cached_property
    def usual(self) -> tuple[float, float, float]:
        """Mean and standard deviation of sums without rare large values, and the largest value in them."""
        rarer = self.number * np.cumsum(self.probabilities[::-1])[::-1]
        kept = rarer > min(_RARE[0], rarer[0] / 2)
        x, p = self.values[kept], self.probabilities[kept]
        mean = float(p @ x)
        variance = float(p @ x**2) - (0.0 if self.poisson else mean**2)
        return self.number * mean, float(np.sqrt(self.number * max(variance, 0.0))), float(x[-1])

    @cached_property
    def median(self) -> float:
        """What half of the asperities that touch add."""
        return float(np.interp(self.share / 2, self.upto, self.places))

    def below(self, x: Array) -> tuple[Array, Array]:
        """Shares of asperities that touch and add no more than some values, and that add more."""
        if self.stepped:
            upto = np.append(0.0, self.upto)[np.searchsorted(self.places, x, "right")]
        else:
            upto = np.interp(x, self.places, self.upto, left=0.0, right=self.share)
        return upto, self.share - upto

    @cached_property
    def _integrals(self) -> Array:
        """Integral of those shares up to each place: of the values, which have the mean to more digits."""
        p, j = self.probabilities, np.searchsorted(self.values, self.places, "right") - 1
        return np.asarray(self.places * np.cumsum(p)[j] - np.cumsum(p * self.values)[j])

    def integral(self, x: Array) -> Array:
        """Integral of those shares up to some values."""
        j = np.clip(np.searchsorted(self.places, x) - 1, 0, self.places.size - 1)
        step = x - self.places[j]
        within = step * (self.upto[j] + self.below(x)[0]) / 2
        return np.where(step > 0, self._integrals[j] + within, 0.0)

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


def masses(one: OneAsperity, width: float, points: int) -> tuple[Array, Array]:
    """Return points of a lattice above the lowest sum, and the probability of the sums at each.

    Where surfaces with no contact or one count, the sums are those of two and more. Values beyond the width
    are left out: no sum that is read has them.
    """
    size, step = _PERIOD * points, width / points
    first, k = np.floor(one.lowest / step) - _MARGIN, np.arange(size)
    damping = _DAMPED / size
    f, lost = _shared(one, step, points, size)
    f[0] = 0.0
    kept = f.sum()
    f *= np.exp(-damping * np.where(k < 3 * size // 4, k, k - size))
    f[0] = -kept - lost  # so that many small values lose no digits
    q = np.fft.rfft(f)
    z = damping + 2j * np.pi / size * k[: q.size]
    if one.few and not one.stepped and step < abs(one.median) / _PLAIN:
        q = (q + one.share) / (np.sinh(z / 2) / (z / 2)) ** 2 - one.share  # shared by two neighbours
    log = one.number * (q if one.poisson else _log1p(q)) + z * first
    if one.few:
        spectrum = np.exp(log) - (one.none + one.alone * (q + one.share)) * np.exp(z * first)
    else:  # the rule has the mean to more digits than the cells
        log -= z * ((one.mean - one.number * float(one.probabilities @ one.values)) / step)
        if one.mean > _SMOOTH * one.usual[1]:  # no more comes, whatever a stencil makes of high frequencies
            log[np.argmax(log.real < log.real[0] - _DIED) :] = -np.inf
        spectrum = np.exp(log)
    read = k[: points + _MARGIN]
    found = np.fft.irfft(spectrum, size)[read] * np.exp(damping * read)
    return (first + read) * step, np.asarray(found)


def _shared(one: OneAsperity, step: float, points: int, size: int) -> tuple[Array, float]:
    """Probabilities of values up to a width, shared among points of a lattice; and those of values beyond."""
    if one.few and not one.stepped:  # two neighbours share what the cells hold between them
        k = np.arange(np.floor(one.values[0] / step) - 1, points + _MARGIN)
        x = step * np.append(k[0] - 1, np.append(k, k[-1] + 1))
        shared = np.diff(one.integral(x), 2) / step
        f = np.bincount(k.astype(np.int64) % size, shared, size).astype(np.float64)
        return f, one.share - float(shared.sum())
    kept = one.values <= (points + _MARGIN) * step
    places, f = one.values[kept] / step, np.zeros(size)
    near = np.rint(places)
    off, at = places - near, near.astype(np.int64)
    for i in _STENCIL:  # Lagrange's weights
        weights = one.probabilities[kept].copy()
        for j in _STENCIL:
            if j != i:
                weights *= (off - j) / (i - j)
        f += np.bincount((at + i) % size, weights, size)
    return f, float(one.probabilities[~kept].sum())


def _log1p(q: Complex) -> Complex:
    """``log(1 + q)``, of which NumPy's loses digits where q is small."""
    with np.errstate(divide="ignore"):
        size = np.maximum(np.log1p(2 * q.real + np.abs(q) ** 2) / 2, -_NEVER)
    return np.asarray(size + 1j * np.arctan2(q.imag, 1 + q.real))


def shares(one: OneAsperity, points: int) -> tuple[Array, Array, Array]:
    """Return sums, and the shares of the surfaces up to and above them, from ever wider lattices."""
    if not one.values.size:
        return np.array([-_NOTHING, 0.0]), np.array([0.0, 1.0]), np.array([1.0, 0.0])
    rest = 1 - one.none - one.alone * one.share if one.few else 1.0
    lattices = []
    for width in one.widths(points):
        lattices.append(masses(one, width, points))
        x, p = lattices[-1]
        larger = one.number * float(one.below((x[-1] - x[0]) / 2)[1])
        if max(rest - p.sum(), larger) < one.rounding:
            break
    above = max(rest - float(lattices[-1][1].sum()), 0.0)
    parts = []
    for k in range(len(lattices))[::-1]:
        x, p = lattices[k]
        more, bend = above + np.cumsum(p[::-1])[::-1] - p / 2, np.gradient(p) / 12  # Euler-Maclaurin
        end = lattices[k - 1][0][-1] if k else -np.inf
        above = float(np.interp(end, x, more) - lattices[k - 1][1][-1] / 2)
        parts.append(np.stack([x, np.cumsum(p) - p / 2 - bend, more + bend])[:, x > end])
    x, below, more = np.concatenate(parts[::-1], axis=1)
    if one.few:
        zero = np.array([-_NOTHING, 0.0])
        own = one.places[:: max(1, one.places.size // points)]
        own = own[own < x[-1]]
        every = np.unique(np.concatenate([x, zero, own, np.nextafter(own, -np.inf) if one.stepped else zero]))
        below, more = np.interp(every, x, below), np.interp(every, x, more)
        x, (upto, above_one) = every, one.below(every)
        below = below + one.alone * upto + one.none * (x >= 0)
        more = more + one.alone * above_one + one.none * (x < 0)
    return resolved(x, below, more, one.rounding)


def share_at(one: OneAsperity, x: Array, points: int) -> tuple[Array, Array]:
    """Return the shares of surfaces up to some sums and above them, by one lattice that suits the largest."""
    width = next((w for w in one.widths(points) if one.lowest + w >= x.max()), None) if one.values.size else 0
    if width is None or not one.values.size:
        upto = np.where((x >= 0) | (width is None), 1.0, 0.0)
        return upto, 1 - upto
    at, p = masses(one, width, points)
    below = np.cumsum(p) - p / 2 - np.gradient(p) / 12  # Euler-Maclaurin
    k = np.clip(np.floor((x - at[0]) / (at[1] - at[0])), 0, at.size - 2).astype(np.int64)
    part = (x - at[k]) / (at[1] - at[0])
    upto = np.where(x >= at[0], below[k] + part * (p[k] + part * (p[k + 1] - p[k]) / 2), 0.0)
    if not one.few:
        return upto, 1 - upto
    own_upto, own_above = one.below(x)
    rest = 1 - one.none - one.alone * one.share - upto
    upto = upto + one.alone * own_upto + one.none * (x >= 0)
    return upto, rest + one.alone * own_above + one.none * (x < 0)


def resolved(x: Array, below: Array, above: Array, rounding: float) -> tuple[Array, Array, Array]:
    """Leave out of shares what rounding hides, so that they rise and fall and their sum is 1."""
    low = below < above
    below = np.maximum.accumulate(np.clip(np.where(low, below, 1 - above), 0, 1))
    above = np.minimum.accumulate(np.clip(np.where(low, 1 - below, above), 0, 1))
    kept = np.flatnonzero((below > rounding) & (above > rounding))
    kept = kept if kept.size else np.array([np.argmax(below >= above)])
    table = slice(max(kept[0] - 1, 0), kept[-1] + 2)
    return x[table], below[table], above[table]
