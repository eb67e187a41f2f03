"""What differs by the summits of a surface: of one radius, drawn together with the height, or measured."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from analytic.arrays import Array, Ints
from analytic.curvature import RandomCurvature
from analytic.gradings import Grading
from analytic.height_rule import Cuts, HeightRule
from analytic.heights import HeightLaw
from analytic.laws.branch import Branch
from analytic.measured_summits import MeasuredHeights, MeasuredRadii

_HIGHEST = 1e-300  # share of heights above the highest separation that is looked at
_TOGETHER, _SHARED = 12, 1e-12  # separations that share a rule, and least share that touches at the last
_KEPT = 4_000_000  # points of rules over heights and radii


@dataclass(frozen=True)
class Summits:
    """Heights and radii of the summits of a surface.

    Parameters
    ----------
    heights : HeightLaw
        Law of the reduced heights.
    radii : RandomCurvature or MeasuredRadii, optional
        Default: all have one.
    """

    heights: HeightLaw
    radii: RandomCurvature | MeasuredRadii | None

    @property
    def listed(self) -> bool:
        """Whether there is a list of them, so that means change summit by summit."""
        return isinstance(self.heights, MeasuredHeights)

    @property
    def unbounded(self) -> bool:
        """Whether the fourth power of the radius has no mean."""
        return isinstance(self.radii, RandomCurvature) and math.isinf(self.radii.largest)

    @property
    def highest(self) -> float:
        """Where probabilities underflow, or the highest of listed heights."""
        return float(self.heights.isf(np.array(_HIGHEST), 0.0))

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

    def rule(
        self,
        h: Array,
        grading: Grading,
        branches: tuple[Branch, ...] = (),
        cuts: Cuts | None = None,
        **powers: float,
    ) -> HeightRule:
        """Return `HeightRule.over` these summits; the same again, unless there are `cuts`."""
        key = (branches, h.tobytes(), cuts, *powers.values())  # each quantity and statistic asks again
        if key in self._rules:
            return self._rules[key]
        new = HeightRule.over(h, grading, self.heights, self.radii, branches=branches, cuts=cuts, **powers)
        if cuts is None:
            while sum(kept.heights.size for kept in self._rules.values()) > _KEPT:
                self._rules.pop(next(iter(self._rules)))
            self._rules[key] = new
        return new

    @cached_property
    def _rules(self) -> dict[tuple[Any, ...], HeightRule]:
        return {}

    def __getstate__(self) -> dict[str, Any]:
        """Leave out what is kept, which is large: other processes compute their own."""
        return {name: value for name, value in vars(self).items() if name != "_rules"}
