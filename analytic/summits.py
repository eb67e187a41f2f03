"""What differs by the radii of summits: one for all, drawn together with the height, or measured with it.

Where radii are random, sums over a surface, means as well as those of products, are integrals over the
curvature, in the root of which they are smooth: the heights at which a contact changes its law depend on the
radius alone. So there are some radii, each with a rule over the heights of its own; all are found at once.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from analytic.arrays import Array, Ints
from analytic.curvature import MEAN_CURVATURE, RandomCurvature, WeightedHeights
from analytic.gradings import Grading
from analytic.height_rule import HeightRule
from analytic.heights import Gaussian, HeightLaw
from analytic.law_rule import ends_of
from analytic.laws.branch import Branch
from analytic.laws.pieces import Jumps, cuts_of_each, jumps_met
from analytic.measured_summits import MeasuredHeights, MeasuredRadii
from analytic.quadrature import SPANS, WIDEST, above_neighbours, gauss_legendre, rooted
from analytic.resolution import resolved_breaks

Branches = tuple[Branch, ...]
Ends = tuple[float, float]

_HIGHEST = 1e-280  # share of heights above the highest separation that is looked at
_NODES, _AS_WIDE = 64, 0.6  # points for curvatures, if their density bends over so many heights
_NARROW, _PER_NARROW, _PER_PIECE = 0.25, 10, 32  # heights of a narrow piece, points of one and of a wider one
_TOGETHER = 3.0  # separations of so wide a range have the same radii
_RAREST = 1e-18  # share of the touching heights above which curvatures are left out
_KEPT = 4_000_000  # points of rules over heights and radii


@dataclass(frozen=True)
class Radii:
    """Radii of a rule over the curvature, the last of them that of all flatter summits if there is a bound.

    Parameters
    ----------
    law : RandomCurvature
        Of the radii.
    curvatures, weights : ndarray
        Points of the rule, and their weights; shape (radii,).
    """

    law: RandomCurvature
    curvatures: Array
    weights: Array

    @classmethod
    def over(cls, law: RandomCurvature, highest: float) -> "Radii":
        """Of summits as high as touch at this separation."""
        top = float(law.heights.isf(np.array(_RAREST), highest))
        first = np.sqrt(MEAN_CURVATURE / law.largest)
        last = max(np.sqrt(law.steepest(top)), first)
        x, w = gauss_legendre(int(np.ceil(_NODES * max(1.0, _AS_WIDE / law.narrowest))))
        roots = first + (last - first) * x
        curvatures, weights = roots**2, 2 * roots * (last - first) * w
        if first > 0:
            curvatures, weights = np.append(curvatures, first**2), np.append(weights, 1.0)
        return cls(law, curvatures, weights)

    @property
    def ratios(self) -> Array:
        """Over the radius of the surface."""
        return MEAN_CURVATURE / self.curvatures

    def density(self, s: Array, which: Ints) -> Array:
        """Density of the heights of summits of some of the radii, with their weights."""
        own = np.empty(s.shape)
        bound = (which == self.curvatures.size - 1) & np.isfinite(self.law.largest)
        own[bound] = self.law.cdf(self.curvatures[-1], s[bound]) * self.law.heights.pdf(s[bound])
        own[~bound] = self.law.with_height(self.curvatures[which[~bound]], s[~bound])
        return np.asarray(self.weights[which] * own)


def rule_of_radii(
    separations: Array, grading: Grading, law: RandomCurvature, branches: Iterable[Branch]
) -> HeightRule:
    """Rule over heights and radii for these separations, in any order, and for sums on these branches."""
    h, radii = np.unique(separations), Radii.over(law, float(np.max(separations)))
    cuts, which = _cuts_of_laws(h, grading, radii, tuple(branches))
    return _rule(h, grading, radii, tuple(branches), cuts, which % radii.ratios.size)


def rules_of_radii(
    separations: Array, grading: Grading, law: RandomCurvature, branches: Iterable[Branch]
) -> list[HeightRule]:
    """One rule for each of these separations; where contacts change their laws is found for all together."""
    h, radii, branches = separations, Radii.over(law, float(np.max(separations))), tuple(branches)
    cuts, which = _cuts_of_laws(h, grading, radii, branches)
    number = radii.ratios.size
    order = np.argsort(which, kind="stable")
    of = np.searchsorted(which[order], number * np.arange(h.size + 1))
    parts = [order[of[k] : of[k + 1]] for k in range(h.size)]
    return [
        _rule(h[k : k + 1], grading, radii, branches, cuts[part], which[part] - number * k)
        for k, part in enumerate(parts)
    ]


def _cuts_of_laws(h: Array, grading: Grading, radii: Radii, branches: Branches) -> tuple[Array, Ints]:
    """Cuts of the law of each radius at each separation, which has the radii in turn."""
    heights, at = radii.law.heights, np.repeat(h, radii.ratios.size)
    lowest = _lowest(np.unique(h), branches)
    ends = [ends_of(heights, each, grading) for each in (lowest, np.unique(h)[-1:])]
    low, high = min(start for start, _ in ends), max(top for _, top in ends)
    found = [(np.empty(0), np.empty(0, np.int64))]
    if low < high:
        found += [cuts_of_each(own.with_radii(radii.ratios), grading, at, low, high) for own in branches]
    cuts, which = (np.concatenate(part) for part in zip(*found, strict=True))
    return cuts, which


def _lowest(h: Array, branches: Branches) -> Array:
    """Separations, and where asperities stick that have touched before; increasing."""
    return np.unique([*h, *(branch.lowest(float(h[0])) for branch in branches)])


def _rule(
    h: Array,
    grading: Grading,
    radii: Radii,
    branches: Branches,
    cuts: Array,
    of_radius: Ints,
) -> HeightRule:
    """Rule over heights and radii, cut where the laws of these radii change."""
    law, lowest = radii.law, _lowest(h, branches)
    below, (start, top) = float(law.heights.cdf(lowest[0])), ends_of(law.heights, lowest, grading)
    if not start < top:
        return HeightRule(np.empty(0), np.empty(0), below, np.empty(0))
    widest = min(SPANS * law.narrowest, WIDEST)
    regular = np.linspace(start, top, int(np.ceil((top - start) / widest)) + 1)
    breaks = resolved_breaks(grading, start, top)
    common, number = np.concatenate([regular, breaks, lowest, above_neighbours(lowest)]), radii.ratios.size
    cuts = np.append(cuts, np.tile(common, number))
    of_radius = np.append(of_radius, np.repeat(np.arange(number), common.size))
    left, right, of = _pieces(cuts, of_radius, start, top)
    wide, found = right - left > _NARROW, []
    for some, points in ((wide, _PER_PIECE), (~wide, _PER_NARROW)):
        found.append((*rooted(left[some], right[some], lowest, points), np.repeat(of[some], points)))
    s, weights, of = (np.concatenate(part) for part in zip(*found, strict=True))
    return HeightRule(s, weights * radii.density(s, of), below, radii.ratios[of])


def _pieces(cuts: Array, which: Ints, start: float, top: float) -> tuple[Array, Array, Ints]:
    """Ends of the pieces between the cuts of each radius, and the number of the radius."""
    inside = (cuts >= start) & (cuts <= top)
    cuts, which = cuts[inside], which[inside]
    order = np.lexsort((cuts, which))
    cuts, which = cuts[order], which[order]
    held = np.flatnonzero((np.diff(which) == 0) & (np.diff(cuts) > 0))
    return cuts[held], cuts[held + 1], which[held]


@dataclass(frozen=True)
class Summits:
    """Heights and radii of the summits of a surface: of one radius, unless a kind says otherwise.

    Parameters
    ----------
    heights : HeightLaw
        Law of the reduced heights.
    """

    heights: HeightLaw

    @property
    def powers(self) -> bool:
        """Whether the mean of a power of approach and radius is an integral over heights alone."""
        return True

    @property
    def listed(self) -> bool:
        """Whether there is a list of them, so that means change summit by summit."""
        return isinstance(self.heights, MeasuredHeights)

    @property
    def unbounded(self) -> bool:
        """Whether the fourth power of the radius has no mean."""
        return False

    @property
    def together(self) -> int:
        """How many separations share a rule: other laws leave out what the lowest one hardly needs."""
        return 8 if isinstance(self.heights, Gaussian) else 1

    @property
    def highest(self) -> float:
        """Where probabilities underflow, or the highest of listed heights."""
        return float(self.heights.isf(np.array(_HIGHEST), 0.0))

    def weighted(self, power: float) -> HeightLaw:  # noqa: ARG002 - of one radius
        """The heights, each with the mean of this power of its radius over that of the surface."""
        return self.heights

    def rule(self, h: Array, grading: Grading, branches: Branches | None = None) -> HeightRule:
        """Heights and radii for sums on these branches, rough without any; None: of powers of both."""
        if branches is None:
            return HeightRule.over(h, grading, self.heights)
        key = (branches, h.tobytes())  # of one model, every quantity and statistic of which asks again
        if key not in self._rules:
            self._keep({key: self._new_rule(h, grading, branches)})
        return self._rules[key]

    def prepare(self, h: Array, grading: Grading, branches: Branches) -> None:
        """Have the rules that are asked for next, each for one of these separations."""

    def _keep(self, rules: dict[tuple[Branches, bytes], HeightRule]) -> None:
        while sum(kept.heights.size for kept in self._rules.values()) > _KEPT:
            self._rules.pop(next(iter(self._rules)))
        self._rules.update(rules)

    def _new_rule(self, h: Array, grading: Grading, branches: Branches) -> HeightRule:
        return HeightRule.over(h, grading, self.heights, branches=branches)

    @cached_property
    def _rules(self) -> dict[tuple[Branches, bytes], HeightRule]:
        return {}

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is kept, which is large: other processes compute their own."""
        return {name: value for name, value in vars(self).items() if name != "_rules"}

    def jumps(self, branch: Branch, grading: Grading, h: Array, ends: Ends) -> Iterator[Jumps]:
        """Summits of heights between two that jump at separations, as `jumps_met`."""
        return jumps_met(branch, grading, lambda s, _: self.heights.pdf(s), h, ends)


@dataclass(frozen=True)
class _RandomRadii(Summits):
    """Summits whose radii are random, given their heights."""

    curvature: RandomCurvature

    @property
    def unbounded(self) -> bool:
        return bool(np.isinf(self.curvature.largest))

    def weighted(self, power: float) -> HeightLaw:
        return WeightedHeights(self.heights, partial(self.curvature.mean, power)) if power else self.heights

    def rule(self, h: Array, grading: Grading, branches: Branches | None = None) -> HeightRule:
        rule = super().rule(h, grading, branches)
        return self._spread(rule) if branches is None else rule

    def _new_rule(self, h: Array, grading: Grading, branches: Branches) -> HeightRule:
        return rule_of_radii(h, grading, self.curvature, branches)

    def prepare(self, h: Array, grading: Grading, branches: Branches) -> None:
        new = np.array([x for x in np.unique(h) if (branches, x.tobytes()) not in self._rules])
        for part in np.split(new, np.flatnonzero(np.diff(new // _TOGETHER)) + 1):
            if part.size > 1:
                rules = rules_of_radii(part, grading, self.curvature, branches)
                self._keep({(branches, x.tobytes()): rule for x, rule in zip(part, rules, strict=True)})

    def _spread(self, rule: HeightRule) -> HeightRule:
        """A rule over heights, spread to heights and radii.

        Exact for sums, their products and third powers where one summit adds a power of its radius, up to 1;
        fourth powers of the radius have a mean only if it is bounded.
        """
        ratio, share = self.curvature.rule(rule.heights)
        heights = np.broadcast_to(rule.heights, ratio.shape)
        return HeightRule(heights.ravel(), (rule.probabilities * share).ravel(), rule.below, ratio.ravel())

    def jumps(self, branch: Branch, grading: Grading, h: Array, ends: Ends) -> Iterator[Jumps]:
        radii = Radii.over(self.curvature, float(h.max()))
        number, own = radii.ratios.size, branch.with_radii(radii.ratios)

        def density(s: Array, which: Ints) -> Array:
            return radii.density(s, which % number)

        for found in jumps_met(own, grading, density, np.repeat(h, number), ends):
            which, ratios = found.separation // number, radii.ratios[found.separation % number]
            yield replace(found, separation=which, ratios=ratios)


@dataclass(frozen=True)
class _ListedSummits(Summits):
    """The summits of a list, each as probable as another; a separation seldom meets one that jumps."""

    radii: MeasuredRadii | None = None

    @property
    def powers(self) -> bool:
        return self.radii is None

    def rule(self, h: Array, grading: Grading, branches: Branches | None = None) -> HeightRule:
        if self.radii is None:
            return super().rule(h, grading, branches)
        lowest = float(h.min())
        lowest = min([lowest, *(branch.lowest(lowest) for branch in branches or ())])
        s, ratios = np.array(self.radii.heights.heights), np.array(self.radii.ratios)
        touching = s > lowest
        number = int(touching.sum())
        return HeightRule(s[touching], np.full(number, 1 / s.size), 1 - number / s.size, ratios[touching])

    def jumps(self, *_: Any) -> Iterator[Jumps]:
        return iter(())


def summits_of(heights: HeightLaw, radii: RandomCurvature | MeasuredRadii | None) -> Summits:
    """Kind of the summits of these heights and radii."""
    if isinstance(radii, RandomCurvature):
        return _RandomRadii(heights, radii)
    if isinstance(heights, MeasuredHeights):
        return _ListedSummits(heights, radii)
    return Summits(heights)
