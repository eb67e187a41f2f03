"""Exact distribution of a sum over the asperities of a finite surface."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import gammaincinv, ndtri

from analytic.arrays import Array, Marks
from analytic.distribution.derived import Law
from analytic.distribution.independent_sums import (
    MOST,
    FewContacts,
    Line,
    Values,
    bounded,
    by_contour,
    saddle,
)
from analytic.distribution.touching import Touching

_MANY = -40.0  # logarithm of the probability of no contact, below which the transform has died away
_MIDDLE = 4.0  # standard deviations around the mean that one line serves
_LONG = 60.0  # of them, in which the largest asperity must stay for that
_SAFE = 3.0  # times what two computations differ by: their errors may have one sign
_TAIL = 1e-4  # a share of the surfaces
_STEPS = 60
_REACH = 8.0  # of a step, over the value or the standard deviation: a law is flat between two jumps
_CLOSE = 1e-13
_LOST = 0.5 + 1e-6  # a probability farther from a half is none
_DIGIT = 1e-15  # that rounding leaves
_SHARES = np.array([1e-9, 1e-6, 0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999, 1 - 1e-6, 1 - 1e-9])


@dataclass(frozen=True, eq=False, repr=False)
class Distribution(Law):
    """Exact distribution of one quantity over all surfaces, with the methods of `scipy.stats`.

    Arguments are in the unit of the quantity and have any shape. The smaller one of `cdf` and `sf` is
    accurate relative to itself. Where a surface may have no contact at all, the value 0 has the probability
    `atom`.

    Parameters
    ----------
    touching : Touching
        Contribution of one asperity.
    unit : float
        Unit of the values of `touching`.

    Examples
    --------
    >>> import analytic
    >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
    >>> law = analytic.Model(surface).distribution("load", 2.0)
    >>> low, high = law.interval(0.95)
    >>> round(float(low / law.mean()), 3), round(float(high / law.mean()), 3)
    (0.418, 1.776)
    """

    touching: Touching
    unit: float

    @property
    def atom(self) -> float:
        """P(S = 0), the probability that no asperity touches."""
        return float(np.exp(self.touching.one.nothing))

    def mean(self) -> float:
        """Mean over surfaces."""
        return self.unit * self.touching.one.mean

    def var(self) -> float:
        """Variance over surfaces."""
        return self.unit**2 * self.touching.one.variance

    def pdf(self, x: ArrayLike) -> Array:
        """Density of all values but 0, which has the probability `atom`."""
        return self._at(x, "pdf") / self.unit

    def _tail(self, y: ArrayLike, *, upper: bool) -> Array:
        return self._at(y, "sf" if upper else "cdf")

    @property
    def error(self) -> float:
        """Error bound of `cdf`, estimated by a second computation with other nodes."""
        x = self.ppf(_SHARES) / self.unit
        own = self._values(x)
        apart = np.abs(own.cdf - self._again(x).cdf) + np.abs(own.cdf + own.sf - 1)
        return max(_SAFE * float(apart.max()), self.touching.step / 2, _DIGIT)

    def error_at(self, x: ArrayLike) -> Array:
        """As `Law.error_at`."""
        reduced = np.asarray(x, dtype=np.float64) / self.unit
        own, other = self._values(reduced.ravel()), self._again(reduced.ravel())
        with np.errstate(divide="ignore", invalid="ignore"):
            apart = np.where(own.cdf < own.sf, other.cdf / own.cdf, other.sf / own.sf) - 1
            step = self.touching.step / 2 / np.minimum(own.cdf, own.sf)
        apart = np.abs(apart) + np.abs(own.cdf + own.sf - 1)  # all of few contacts grow by one share
        return np.asarray(np.fmax(_SAFE * apart, step + _DIGIT).reshape(reduced.shape)[()])

    @cached_property
    def _again(self) -> Callable[[Array], Values]:
        return _Evaluation(self.touching, finer=True)

    @cached_property
    def _values(self) -> Callable[[Array], Values]:
        return _Evaluation(self.touching)

    def _at(self, x: ArrayLike, name: str) -> Array:
        reduced = np.asarray(x, dtype=np.float64) / self.unit
        flat = np.ravel(reduced)
        found = np.full(flat.shape, np.nan)
        known = np.isfinite(flat)
        if known.any():
            found[known] = getattr(self._values(flat[known]), name)
        found[flat == np.inf], found[flat == -np.inf] = float(name == "cdf"), float(name == "sf")
        return found.reshape(reduced.shape)[()]

    def _quantile(self, q: ArrayLike, *, upper: bool) -> Array:
        q = np.asarray(q, dtype=np.float64)
        flat = np.ravel(q)
        found = np.full(flat.shape, np.nan)
        share = 1 - flat if upper else flat
        inside = (flat > 0) & (flat < 1)
        least = self.touching.one.least
        found[share == 0], found[share == 1] = least, np.inf
        beyond = self._beyond_zero[int(upper)]
        none = inside & (flat >= beyond - self.atom * (not upper)) & (flat <= beyond + self.atom * upper)
        found[none] = 0.0
        asked = inside & ~none
        if asked.any():
            found[asked] = self._solve(flat[asked], upper=upper)
        return (found * self.unit).reshape(q.shape)[()]

    @cached_property
    def _beyond_zero(self) -> tuple[float, float]:
        """P(S <= 0) and P(S > 0); nan where 0 has no probability of its own."""
        if self.touching.one.least == 0:
            return self.atom, float(-np.expm1(self.touching.one.nothing))
        at = self._values(np.zeros(1))
        return (float(at.cdf[0]), float(at.sf[0])) if self.atom > 0 else (np.nan, np.nan)

    def _solve(self, q: Array, *, upper: bool) -> Array:
        """By Newton on the logarithm of the smaller tail, kept between ends."""
        from_above = upper ^ (q > 0.5)
        tail = np.where(q > 0.5, 1 - q, q)
        x, one = self._start(tail, from_above), self.touching.one
        low = np.full(x.shape, one.least)
        high, left = np.full(x.shape, np.inf), np.arange(x.size)
        for _ in range(_STEPS):
            at = self._values(x[left])
            reached = np.where(from_above[left], at.sf, at.cdf)
            with np.errstate(all="ignore"):
                more = np.log(reached / tail[left]) * np.where(from_above[left], 1.0, -1.0)
                step = more * reached / at.pdf
                low[left] = np.where(more > 0, x[left], low[left])
                high[left] = np.where(more < 0, x[left], high[left])
                new, far = x[left] + step, np.maximum(np.abs(x[left]), one.std)
                middle = np.where(np.isfinite(high[left]), (low[left] + high[left]) / 2, x[left] + far)
                middle = np.where(np.isfinite(middle), middle, x[left] - far)
            good = (new >= low[left]) & (new <= high[left]) & (np.abs(step) <= _REACH * far)
            new = np.where(good, new, middle)
            size = np.minimum(np.abs(new), one.std + np.abs(new - one.mean))
            done = np.abs(new - x[left]) <= np.maximum(_CLOSE * size, 2 * np.spacing(np.abs(new)))
            x[left] = new
            left = left[~(done | (more == 0))]
            if not left.size:
                break
        return x

    def _start(self, tail: Array, from_above: Marks) -> Array:
        """Of a gamma law with the same mean, variance and skewness."""
        one = self.touching.one
        skewness = float(np.clip(one.skewness, 1e-3, 50.0))
        shape = 4 / skewness**2
        with np.errstate(all="ignore"):
            gamma = gammaincinv(shape, np.where(from_above, 1 - tail, tail))
            by_gamma = one.mean + one.std * (gamma - shape) / np.sqrt(shape)
            normal = one.mean + one.std * ndtri(tail) * np.where(from_above, -1, 1)
        x = np.where(np.isfinite(by_gamma), by_gamma, normal)
        return np.where(x > 0, x, one.mean * 1e-3) if one.least == 0 else x


class _Evaluation:
    """The law at any arguments, each by the way that suits it."""

    def __init__(self, touching: Touching, *, finer: bool = False) -> None:
        self._touching, self._finer = touching, finer
        self.one = touching.finer() if finer else touching.one
        self._most = MOST * 2 if finer else MOST
        self._kept: dict[tuple[int, bool], FewContacts] = {}

    def __call__(self, x: Array) -> Values:
        """At arguments in any order."""
        with np.errstate(all="ignore"):  # far out things overflow that count for nothing
            return self._found(x)

    def _found(self, x: Array) -> Values:
        order = np.argsort(x, kind="stable")
        sorted_x = x[order]
        found = np.empty((3, x.size))
        for mask, law in self._ways(sorted_x):
            part = law(sorted_x[mask])
            found[:, mask] = part.cdf, part.sf, part.pdf
        back = np.empty((3, x.size))
        back[:, order] = found
        return Values(*back)

    def _ways(self, x: Array) -> list[tuple[Marks, Callable[[Array], Values]]]:
        one = self.one
        positive = one.least == 0
        all_touch = one.number * one.values.min(initial=np.inf) if one.nothing == -np.inf else 0.0
        nothing = x < all_touch if positive else np.zeros(x.shape, dtype=bool)
        at_zero = (x == 0) & positive if one.values.size else ~nothing
        rest = ~(nothing | at_zero)
        atom = np.exp(one.nothing)
        ways: list[tuple[Marks, Callable[[Array], Values]]] = [
            (nothing, lambda y: Values(0 * y, 0 * y + 1, 0 * y)),
            (at_zero, lambda y: Values(0 * y + atom, 0 * y - np.expm1(one.nothing), 0 * y)),
        ]
        few = np.zeros(x.shape, dtype=bool)
        if rest.any() and (one.nothing > _MANY or x[rest][0] < one.mean - _MIDDLE * one.std):
            few = rest & (x <= self.one.few_up_to) & self._touching.rises
        usual = x < one.mean + _MIDDLE * one.std
        ways += [
            (part, partial(self._by_few, self._few(float(x[part][-1]))))
            for part in (few & usual, few & ~usual)
            if part.any()
        ]
        rest &= ~few
        middle = rest & (np.abs(x - one.mean) < _MIDDLE * one.std) & self._short
        ways += [(middle, self._middle), (rest & ~middle, self._far)]
        return [(mask, law) for mask, law in ways if mask.any()]

    def _middle(self, x: Array) -> Values:
        """By one line for all; by others where so little lies beyond that its digits would be lost."""
        found = self._central(x)
        rare = (np.minimum(found.cdf, found.sf) < _TAIL) & (self.one.nothing <= _MANY)
        if rare.any():
            _replace(found, rare, self._far(x[rare]))
        return found

    def _far(self, x: Array) -> Values:
        """By lines through saddle points; by one not shifted where heavy tails both ways leave none."""
        found, one = by_contour(self.one, x, self._most), self.one
        lost = ~(np.abs(found.cdf - 0.5) < _LOST) | (one.least < 0 and not self._short)
        if not lost.any():
            return found
        room = 2 * max(_MIDDLE * one.std, float(np.abs(x[lost] - one.mean).max()))
        _replace(found, lost, Line(one, 0.0, one.std, room, self._most)(x[lost]))
        return found

    def _by_few(self, law: FewContacts, x: Array) -> Values:
        """Where it does not reach on to the largest sums, what lies above is what is left of 1."""
        found = law(x)
        return replace(found, sf=1 - found.cdf) if np.isfinite(self.one.few_up_to) else found

    def _few(self, x: float) -> FewContacts:
        """Up to x at least, and where the transform takes over no farther."""
        if np.isfinite(self.one.few_up_to):
            usual, doublings, far = self.one.few_up_to, 0, self.one.few_up_to
        else:
            usual, rarest = self.one.usual
            far = max(usual, x)
            doublings = int(np.ceil(np.log2((far + rarest) / usual)))
        rare = x > self.one.mean + _MIDDLE * self.one.std
        if (doublings, rare) not in self._kept:
            tilt = min(saddle(bounded(self.one, far)[0], far)[0], self.one.decay(far)) if rare else 0.0
            law = self._touching.few(usual, doublings, tilt, coarse=self._finer)
            if tilt and not np.isfinite(self.one.few_up_to) and not law.missing < _TAIL:
                law = replace(law, tilt=0.0)  # panels do not follow what is tilted so much
            self._kept[doublings, rare] = law
        return self._kept[doublings, rare]

    @cached_property
    def _short(self) -> bool:
        return self._central.widest < _LONG * self._central.spread

    @cached_property
    def _central(self) -> Line:
        spread = self.one.std
        return Line(self.one, 0.0, spread, 2 * _MIDDLE * spread, self._most)


def _replace(found: Values, where: Marks, by: Values) -> None:
    for name in ("cdf", "sf", "pdf"):
        getattr(found, name)[where] = getattr(by, name)
