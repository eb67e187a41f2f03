"""What one asperity of a model adds to a sum: at the nodes of a rule, and as a density for few contacts."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from analytic.arrays import Array, Ints
from analytic.curvature import RandomCurvature
from analytic.distribution.independent_sums import FewContacts
from analytic.distribution.one_asperity import OneAsperity
from analytic.distribution.panels import POWER, panels
from analytic.height_rule import HeightRule
from analytic.quantities import quantity_of
from analytic.resolution import resolved_breaks
from analytic.summits import Radii

_NODES = 16
_PANELS, _MOST = ((15, 16), (25, 20)), 24  # by the expected contacts
_MARKS = 6
_STEPS, _LAST = 40, 2.0**-48
_LOOKED_AT = 129  # heights between two breaks at which values must rise
_CLOSE = 1e-9  # of the largest value: breaks are not told apart
_HIGHEST = 1e4
_TILT = 600.0  # exponent that does not overflow


@dataclass(frozen=True, eq=False)
class Asperity:
    """One asperity of a model, as the height that makes it add something; of one or more radii."""

    model: Any
    quantity: str
    h: float
    rule: HeightRule
    terms: Any

    @cached_property
    def _radii(self) -> Radii | None:
        summits = self.model.curvature
        return Radii.over(summits, self.h) if isinstance(summits, RandomCurvature) else None

    @property
    def radii(self) -> int:
        """How many radii there are."""
        return 1 if self._radii is None else self._radii.ratios.size

    @cached_property
    def breaks(self) -> tuple[float, ...]:
        """From the lowest height that touches to the highest; what is added is smooth in between."""
        low, high = max(self.h, self.model.heights.support[0]), self.model.heights.support[1]
        top = min(high, float(self.rule.heights.max(initial=low)))
        inner = [*resolved_breaks(self.model.grading, low, top), *self.model.heights.breaks]
        branch = self.model.ways.of(self.quantity)
        regimes = branch.regimes(self.model.grading, np.array([self.h]), low, top)
        inner += [*regimes.low.tolist(), *regimes.high.tolist()]
        start = float(regimes.low.min(initial=top))
        return (start, *sorted({s for s in inner if start < s < top}), high)

    def added(self, s: Array, which: Ints) -> Array:
        """What asperities of these heights and radii add."""
        ratios = None if self._radii is None else self._radii.ratios[which]
        return np.asarray(self.terms(replace(self.rule, heights=s, probabilities=0 * s, ratios=ratios)))

    def density(self, s: Array, which: Ints) -> Array:
        """Density of the heights of asperities of these radii, with the weights of the radii."""
        if self._radii is None:
            return np.asarray(self.model.heights.pdf(s))
        return self._radii.density(s, which)


@dataclass(frozen=True, eq=False)
class Touching:
    """One asperity, by rules over its heights and, for few contacts, by its density.

    Parameters
    ----------
    one : OneAsperity
        By a rule.
    finer : callable
        Gives it by one of more nodes.
    asperity : Asperity, optional
        Itself. Without it the law of few contacts is found by its transform, less accurately.
    step : float, optional
        Largest step of the distribution function, which the transform makes smooth.
    """

    one: OneAsperity
    finer: Callable[[], OneAsperity]
    asperity: Asperity | None
    step: float = 0.0

    @cached_property
    def rises(self) -> bool:
        """Whether what is added is positive and rises with the height, piece by piece."""
        return bool(self._pieces(float(self.one.values.max(initial=0.0))))

    def _pieces(self, top: float) -> list[tuple[float, float, float, float]]:
        """Heights between breaks, and what asperities of the first radius add at both ends; up to a value."""
        found: list[tuple[float, float, float, float]] = []
        if self.asperity is None:
            return found
        for low, high in pairwise(self._ends(self.asperity, top)):
            s = low + (high - low) * np.linspace(0, 1, _LOOKED_AT) ** 2
            s[0], s[-1] = np.nextafter(low, high), np.nextafter(high, low)  # jumps are between pieces
            added = self.asperity.added(s, np.zeros(s.size, dtype=np.int64))
            if np.any(np.diff(added) < 0) or added[0] < 0:
                return []
            if added[-1] > added[0]:
                found.append((float(s[0]), float(s[-1]), float(added[0]), float(added[-1])))
        return found

    @staticmethod
    def _ends(asperity: Asperity, top: float) -> tuple[float, ...]:
        """The breaks, the last of them where more than a value is added, if there are such heights."""
        *inner, last = asperity.breaks
        if np.isfinite(last):
            return asperity.breaks
        step = 1.0
        every = np.arange(asperity.radii)
        while step < _HIGHEST and np.any(asperity.added(np.full(every.size, inner[-1] + step), every) <= top):
            step *= 2
        return (*inner, inner[-1] + step)

    def few(self, usual: float, doublings: int, tilt: float, *, coarse: bool = False) -> FewContacts:
        """The law of a sum of few contacts, up to a usual value doubled so many times."""
        asperity, one, top = self.asperity, self.one, usual * 2.0**doublings
        assert asperity is not None
        pieces = self._pieces(top)
        number = next((panels for most, panels in _PANELS if one.contacts < most), _MOST)
        marks, nodes = _marks(pieces, top), _NODES
        if coarse:  # sums of three have kinks at which no panel ends
            number, nodes = (3 * number // 4 if marks else number - 2), nodes - 2
        on = panels(number, doublings, nodes, marks)
        x, density = on.x * top, np.zeros(on.x.shape)
        which = np.arange(asperity.radii)
        for low, high, least, most in pieces:
            inside = (x[:, 0] > least - _CLOSE * top) & (x[:, -1] < most + _CLOSE * top)
            if not inside.any():
                continue
            wanted = x[inside].ravel()
            of = np.repeat(which, wanted.size)
            s = _heights(asperity, np.tile(wanted, which.size), of, low, high)
            shape = (which.size, -1, on.nodes)
            slopes = on.derivative(s.reshape(shape), inside)
            density[inside] += (asperity.density(s, of).reshape(shape) * slopes).sum(axis=0)
        return FewContacts(density, one.share, one.number, one.poisson, top, on, min(tilt, _TILT / top))


def _marks(pieces: list[tuple[float, float, float, float]], top: float) -> tuple[float, ...]:
    """In w, where the density of one asperity jumps or those of some of them have kinks."""
    ends = {end for piece in pieces for end in piece[2:] if _CLOSE * top < end < top * (1 - _CLOSE)}
    sums = set(ends)
    while ends and len(sums) <= _MARKS:
        more = {a + b for a in ends for b in sums if a + b < top * (1 - _CLOSE)} | sums
        if len(more) == len(sums):
            break
        sums = more
    marks: list[float] = []
    for end in sorted(sums):
        if not marks or end > marks[-1] + _CLOSE * top:
            marks.append(end)
    return tuple(((np.array(marks) / top) ** (1 / POWER)).tolist())


def _heights(asperity: Asperity, x: Array, which: Ints, low: float, high: float) -> Array:
    """Where asperities of some radii add x, between two heights: secants that keep the root between them.

    Of the power of the added that is nearly linear at first touch (Anderson and Bjorck, BIT 13 (1973) 253).
    """
    power = 1 / quantity_of(asperity.quantity).exponent
    aim, found, left = x**power, np.full(x.shape, high), np.arange(x.size)

    def excess(s: Array) -> Array:
        return np.asarray(np.maximum(asperity.added(s, which[left]), 0.0) ** power - aim[left])

    a, b = np.full(x.shape, low), found
    at_a, at_b = excess(a), excess(b)
    going = at_b > 0
    for _ in range(_STEPS):
        a, b, at_a, at_b = (each[going] for each in (a, b, at_a, at_b))
        left = left[going]
        if not left.size:
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            step = at_b * (b - a) / (at_b - at_a)
            c = np.where((b - step - a) * step >= 0, b - step, (a + b) / 2)
            at_c = excess(c)
            same, less = np.sign(at_c) == np.sign(at_b), 1 - at_c / at_b
        found[left] = c
        going = np.abs(c - b) > _LAST * np.abs(c)
        a, at_a = np.where(same, a, b), np.where(same, at_a * np.where(less > 0, less, 0.5), at_b)
        b, at_b = c, at_c
    return found
