"""Sums of many independent terms: their law from its transform, on a line through the saddle point.

With K the cumulant function of the sum S and ``z = theta + i t``, for theta > 0 ::

    P(S > x) = 1/pi  Re int_0^inf exp(K(z) - z x)/z dt

Where K'(theta) = x the integrand is largest at t = 0 and nothing cancels, so that tails have as many digits
as the middle. The midpoint rule of step 2 pi/T gives, exactly, the sum over all whole k of ``(-1)^k
exp(k theta T) P(S > x + k T)``: those below 0 are known, where nothing of S is lower than x - T, and those
above 0 vanish. So one formula holds for theta of both signs, and for 0, where it is that of Gil-Pelaez.

Whatever alone adds more than x is not in a sum up to x of what is never negative. It is counted by itself
("one big jump"), and what is left has a cumulant function everywhere, whatever the law of the heights.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.arrays import Array, Complex
from analytic.distribution.one_asperity import OneAsperity

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
    def _transform(self) -> tuple[Complex, Complex]:
        """Points of the line, and there the transform of the sum less its mean, over that on the axis.

        Without what the surfaces have that touch nowhere, and with a smooth end: a kernel, many moments of
        which vanish, then stands in for the jumps of a law.
        """
        step, one = 2 * np.pi / self.period, self._counting
        parts: list[Array] = []
        found: list[Complex] = []
        for first in range(0, self.most, _BLOCK):
            t = np.asarray(step * (np.arange(first, first + _BLOCK) + 0.5))
            parts.append(t)
            found.append(np.exp(one.cumulants(self.theta, t) - self._size))
            if one.nothing > _NEVER:
                found[-1] -= np.exp(one.nothing - one.mean * (self.theta + 1j * t) - self._size)
            if np.abs(found[-1][-1]) < _DIED:
                break
        t, transform = np.concatenate(parts), np.concatenate(found)
        if np.abs(transform[-1]) >= _DIED:
            transform *= np.exp(-_CUT[0] * (t / t[-1]) ** _CUT[1])
        return np.asarray(self.theta + 1j * t), transform

    @cached_property
    def _size(self) -> float:
        """Logarithm of the transform on the axis."""
        return float(self._counting.cumulants(self.theta, np.zeros(1))[0].real)

    def __call__(self, x: Array) -> Values:
        """The law at arguments within the room."""
        z, transform = self._transform
        apart = x - self._counting.mean
        terms = transform * np.exp(-np.multiply.outer(apart, z - self.theta))
        height = np.exp(self._size - self.theta * apart) * (2 / self.period)
        above, density = height * (terms / z).real.sum(axis=1), height * terms.real.sum(axis=1)
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
