"""What differs by the radii of summits: one for all, drawn together with the height, or measured with it.

Where radii are random, sums over a surface, means as well as those of products, are integrals over the
curvature, in the root of which they are smooth: the heights at which a contact changes its law depend on the
radius alone. So there are some radii, each with a rule over the heights of its own.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from analytic.arrays import Array, Ints
from analytic.curvature import MEAN_CURVATURE, RandomCurvature
from analytic.gradings import Grading
from analytic.height_rule import HeightRule
from analytic.heights import HeightLaw
from analytic.law_rule import ends_of
from analytic.laws.branch import Branch
from analytic.measured_summits import MeasuredHeights, MeasuredRadii
from analytic.quadrature import SPANS, WIDEST, gauss_legendre, in_pieces
from analytic.resolution import resolved_breaks

Branches = tuple[Branch, ...]
Cuts = Callable[[Array], Array]  # of ratios of radii: heights, shape (cuts, radii)

_HIGHEST = 1e-300  # share of heights above the highest separation that is looked at
_NODES, _AS_WIDE = 64, 0.6  # points for curvatures, if their density bends over so many heights
_NARROW, _PER_NARROW, _PER_PIECE = 0.25, 16, 32  # heights of a narrow piece, points of one and of a wider one
_RAREST = 1e-18  # share of the touching heights above which curvatures are left out
_TOGETHER, _SHARED = 12, 1e-12  # separations that share a rule, and least share that touches at the last
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


def no_cuts(ratios: Array) -> Array:
    """Return no heights."""
    return np.empty((0, ratios.size))


def rule_of_radii(
    separations: Array,
    grading: Grading,
    law: RandomCurvature,
    branches: Branches,
    more: Cuts,
    **powers: float,
) -> HeightRule:
    """Rule over heights and radii for these separations, cut where the laws of the radii change."""
    h, radii = np.unique(separations), Radii.over(law, float(np.max(separations)))
    lowest = np.unique([*h, *(branch.lowest(float(h[0])) for branch in branches)])
    below, (start, top) = float(law.heights.cdf(lowest[0])), ends_of(law.heights, lowest, grading, **powers)
    if not start < top:
        return HeightRule(np.empty(0), np.empty(0), below, np.empty(0))
    widest = min(SPANS * law.narrowest, WIDEST)
    regular = np.linspace(start, top, int(np.ceil((top - start) / widest)) + 1)
    breaks, number = resolved_breaks(grading, start, top), radii.ratios.size
    common = np.concatenate([regular, breaks, lowest])
    every, own_cuts = np.arange(number), more(radii.ratios)
    cuts = [np.tile(common, number), own_cuts.ravel()]
    which = [np.repeat(every, common.size), np.tile(every, len(own_cuts))]
    for branch in branches:  # at each separation, which has the radii in turn
        own = branch.with_radii(radii.ratios)
        found = own.regimes(grading, np.repeat(h, number), start, top)
        cuts += [found.low, found.high]
        which += [found.separation % number] * 2
    left, right, of = _pieces(np.concatenate(cuts), np.concatenate(which), start, top)
    wide, parts = right - left > _NARROW, []
    for some, points in ((wide, _PER_PIECE), (~wide, _PER_NARROW)):
        parts.append((*in_pieces(left[some], right[some], points), np.repeat(of[some], points)))
    s, weights, of = (np.concatenate(part) for part in zip(*parts, strict=True))
    return HeightRule(s, weights * radii.density(s, of), below, radii.ratios[of])


def _pieces(cuts: Array, which: Ints, start: float, top: float) -> tuple[Array, Array, Ints]:
    """Return the ends of the pieces between the cuts of each radius, and the number of the radius."""
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
    def listed(self) -> bool:
        """Whether there is a list of them, so that means change summit by summit."""
        return isinstance(self.heights, MeasuredHeights)

    @property
    def unbounded(self) -> bool:
        """Whether the fourth power of the radius has no mean."""
        return False

    def together(self, h: Array) -> list[Ints]:
        """Return which separations share a rule: it leaves out what the lowest of them hardly needs."""
        parts, order = [], np.argsort(h)
        touching = self.heights.sf(h[order])
        while order.size:
            near = np.count_nonzero(touching >= _SHARED * touching[0])
            few = 1 if self.listed else min(near, _TOGETHER)
            parts.append(order[:few])
            order, touching = order[few:], touching[few:]
        return parts

    @property
    def highest(self) -> float:
        """Where probabilities underflow, or the highest of listed heights."""
        return float(self.heights.isf(np.array(_HIGHEST), 0.0))

    def rule(
        self, h: Array, grading: Grading, branches: Branches = (), cuts: Cuts | None = None, **powers: float
    ) -> HeightRule:
        """Heights and radii for sums on these branches; `cuts` gives ends of pieces besides.

        `powers` are the highest of modulus and approach that are summed, as of `analytic.law_rule.ends_of`.
        """
        if cuts is not None:
            return self._new_rule(h, grading, branches, cuts)
        key = (branches, h.tobytes(), *powers.values())  # every quantity and statistic of a model asks again
        if key not in self._rules:
            while sum(kept.heights.size for kept in self._rules.values()) > _KEPT:
                self._rules.pop(next(iter(self._rules)))
            self._rules[key] = self._new_rule(h, grading, branches, no_cuts, **powers)
        return self._rules[key]

    def _new_rule(
        self, h: Array, grading: Grading, branches: Branches, cuts: Cuts, **powers: float
    ) -> HeightRule:
        more = cuts(np.ones(1)).ravel().tolist()
        return HeightRule.over(h, grading, self.heights, branches=branches, cuts=more, **powers)

    @cached_property
    def _rules(self) -> dict[tuple[Any, ...], HeightRule]:
        return {}

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is kept, which is large: other processes compute their own."""
        return {name: value for name, value in vars(self).items() if name != "_rules"}


@dataclass(frozen=True)
class _RandomRadii(Summits):
    """Summits whose radii are random, given their heights."""

    curvature: RandomCurvature

    @property
    def unbounded(self) -> bool:
        return bool(np.isinf(self.curvature.largest))

    def _new_rule(
        self, h: Array, grading: Grading, branches: Branches, cuts: Cuts, **powers: float
    ) -> HeightRule:
        return rule_of_radii(h, grading, self.curvature, branches, cuts, **powers)


@dataclass(frozen=True)
class _ListedSummits(Summits):
    """The summits of a list, each as probable as another; a separation seldom meets one that jumps."""

    radii: MeasuredRadii | None = None

    def _new_rule(
        self, h: Array, grading: Grading, branches: Branches, cuts: Cuts, **powers: float
    ) -> HeightRule:
        if self.radii is None:
            return super()._new_rule(h, grading, branches, cuts, **powers)
        lowest = float(h.min())
        lowest = min([lowest, *(branch.lowest(lowest) for branch in branches)])
        s, ratios = np.array(self.radii.heights.heights), np.array(self.radii.ratios)
        touching = s > lowest
        number = int(touching.sum())
        return HeightRule(s[touching], np.full(number, 1 / s.size), 1 - number / s.size, ratios[touching])


def summits_of(heights: HeightLaw, radii: RandomCurvature | MeasuredRadii | None) -> Summits:
    """Kind of the summits of these heights and radii."""
    if isinstance(radii, RandomCurvature):
        return _RandomRadii(heights, radii)
    if isinstance(heights, MeasuredHeights):
        return _ListedSummits(heights, radii)
    return Summits(heights)
