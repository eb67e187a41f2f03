"""What differs by the radii of summits: one for all, drawn together with the height, or measured with it."""

from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from analytic.arrays import Array
from analytic.curvature import RandomCurvature, WeightedHeights
from analytic.gradings import Grading
from analytic.height_rule import HeightRule
from analytic.heights import Gaussian, HeightLaw
from analytic.laws.branch import Branch
from analytic.laws.slopes import jump_terms
from analytic.measured_summits import MeasuredHeights, MeasuredRadii
from analytic.radii_rule import jumps_of_radii, rule_of_radii, with_radii

Branches = tuple[Branch, ...]

_RAREST = 1e-280  # share of heights above the highest separation that is looked at
_KEPT = 4_000_000  # points of rules over heights and radii


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
        return float(self.heights.isf(np.array(_RAREST), 0.0))

    def weighted(self, power: float) -> HeightLaw:  # noqa: ARG002 - of one radius
        """The heights, each with the mean of this power of its radius over that of the surface."""
        return self.heights

    def rule(self, h: Array, grading: Grading, branches: Branches | None = None) -> HeightRule:
        """Heights and radii for sums on these branches, rough without any; None: of powers of both."""
        return HeightRule.over(h, grading, self.heights, branches=branches or ())

    def jumps(self, quantity: str, branch: Branch, grading: Grading, h: Array, rule: HeightRule) -> Array:
        """What summits add to the slope of a mean by jumping, at each separation of a rule."""
        ends = float(rule.heights[0]), float(rule.heights[-1])
        return jump_terms(quantity, branch, grading, lambda s, _: self.heights.pdf(s), h, ends)


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
        if branches is None:
            return with_radii(super().rule(h, grading), self.curvature)
        key = (branches, h.tobytes())  # of one model, every quantity and statistic of which asks again
        if key not in self._rules:
            while sum(kept.heights.size for kept in self._rules.values()) > _KEPT:
                self._rules.pop(next(iter(self._rules)))
            self._rules[key] = rule_of_radii(h, grading, self.curvature, branches)
        return self._rules[key]

    @cached_property
    def _rules(self) -> dict[tuple[Branches, bytes], HeightRule]:
        return {}

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is kept, which is large: other processes compute their own."""
        return {"heights": self.heights, "curvature": self.curvature}

    def jumps(self, quantity: str, branch: Branch, grading: Grading, h: Array, rule: HeightRule) -> Array:
        top = float(rule.heights.max())
        found = [jumps_of_radii(quantity, branch, grading, self.curvature, x, top) for x in h.tolist()]
        return np.array(found)


@dataclass(frozen=True)
class _ListedSummits(Summits):
    """The very summits of a list, each as probable as another; a separation seldom meets one that jumps."""

    radii: MeasuredRadii | None = None

    @property
    def powers(self) -> bool:
        return self.radii is None

    def rule(self, h: Array, grading: Grading, branches: Branches | None = None) -> HeightRule:
        if self.radii is None:
            return super().rule(h, grading, branches)
        return HeightRule.of_summits(h, self.radii, branches or ())

    def jumps(self, *_: Any) -> Array:
        return np.zeros(1)


def summits_of(heights: HeightLaw, radii: RandomCurvature | MeasuredRadii | None) -> Summits:
    """Kind of the summits of these heights and radii."""
    if isinstance(radii, RandomCurvature):
        return _RandomRadii(heights, radii)
    if isinstance(heights, MeasuredHeights):
        return _ListedSummits(heights, radii)
    return Summits(heights)
