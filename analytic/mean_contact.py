"""What one asperity contributes in the mean, under any law of contact: sums over a rule of heights."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic.curvature import RandomCurvature
from analytic.gradings import Grading
from analytic.height_rule import HeightRule
from analytic.heights import Gaussian, HeightLaw
from analytic.laws.branch import Branch, UnloadingBranch
from analytic.laws.law import piece_of
from analytic.laws.slopes import jump_terms, slope_term
from analytic.laws.ways import Ways
from analytic.measured_summits import MeasuredHeights, MeasuredRadii
from analytic.quantities import quantity_of
from analytic.radii_rule import jumps_of_radii, rule_of_radii

__all__ = ["MeanContact"]

Array = NDArray[np.float64]

_LOWEST, _HIGHEST = -40.0, 1000.0  # separations that are looked at
_COUNTS = 13.0  # no lower height does
_RAREST = 1e-280  # share of heights above the highest of them
_KEPT = 4_000_000  # points of rules over heights and radii
_LAST_DIGITS = 4 * np.finfo(float).eps


@dataclass(frozen=True)
class MeanContact:
    """Means over the heights, per asperity and over the scale of each quantity.

    Parameters
    ----------
    ways : Ways
        Law of contact and history, in reduced units.
    grading : Grading
        E*(s)/E*.
    heights : HeightLaw
        Law of the reduced heights.
    summits : MeasuredRadii or RandomCurvature, optional
        The very summits, where heights were measured together with radii; or the law of their radii.
    """

    ways: Ways
    grading: Grading
    heights: HeightLaw
    summits: MeasuredRadii | RandomCurvature | None = None

    @property
    def together(self) -> int:
        """How many separations share a rule: other height laws leave out what the lowest hardly needs."""
        return 8 if isinstance(self.heights, Gaussian) else 1

    def mean(self, quantity: str, h: Array) -> Array:
        """Mean at separations of any shape."""
        beyond = np.isfinite(h) & (self.heights.sf(h) == 0)  # far ones would make a rule long
        result = np.zeros(np.shape(h))
        result[~beyond] = self._in_parts(h[~beyond], lambda part: self._sums(part, quantity).mean(quantity))
        return result

    def share(self, piece: int, h: Array) -> Array:
        """Share of the contacts in which this piece of the law holds; nan without a contact."""
        return self._in_parts(h, lambda part: self._sums(part, "contacts").share(piece))

    def slope(self, quantity: str, h: Array) -> Array:
        """How fast the mean falls with the separation, jumps of asperities included; of a loading one."""
        return self._in_parts(h, lambda part: self._sums(part, quantity).slope(quantity))

    def _in_parts(self, h: Array, function: Callable[[Array], Array]) -> Array:
        """A few separations at a time: they share a rule."""
        flat = np.ravel(h)
        if not np.all(np.isfinite(flat)):
            raise ValueError("h: every separation must be finite")
        order = np.argsort(flat)
        result = np.empty(flat.size)
        for k in range(0, flat.size, self.together):
            part = order[k : k + self.together]
            result[part] = function(flat[part])
        return result.reshape(np.shape(h))

    def _sums(self, h: Array, quantity: str) -> "_Sums":
        return _Sums(self, h, self.rule(h, self.ways.among([quantity])))

    def rule(self, h: Array, branches: tuple[Branch, ...] = ()) -> HeightRule:
        """Heights, and radii, for integrals of what is added on these branches at these separations."""
        if isinstance(self.summits, MeasuredRadii):
            return HeightRule.of_summits(h, self.summits, branches)
        if self.summits is None:
            return HeightRule.over(h, self.grading, self.heights, branches=branches)
        key = (branches, h.tobytes())
        if key not in self._rules:
            while sum(kept.heights.size for kept in self._rules.values()) > _KEPT:
                self._rules.pop(next(iter(self._rules)))
            self._rules[key] = rule_of_radii(h, self.grading, self.summits, branches)
        return self._rules[key]

    @cached_property
    def _rules(self) -> dict[tuple[tuple[Branch, ...], bytes], HeightRule]:
        """Those over heights and radii: every quantity and statistic asks again for the same."""
        return {}

    def __getstate__(self) -> dict[str, Any]:
        """Without what is kept, which is large: other processes compute their own."""
        return {name: value for name, value in vars(self).items() if name != "_rules"}

    def separations_at(self, quantity: str, values: Array) -> Array:
        """Largest separations with given means, in the shape of `values`.

        Raises
        ------
        ValueError
            If the mean does not have a value where it can be told from 0, at h = -40 or above.
        """
        grid = self._grid(quantity)
        about = self._in_parts(grid, lambda part: self._roughly(quantity, part))
        found = [self._separation_at(quantity, x, grid, about) for x in np.ravel(values).tolist()]
        return np.array(found, dtype=np.float64).reshape(np.shape(values))

    def _roughly(self, quantity: str, h: Array) -> Array:
        """Mean by a rule that is not cut where pieces of the law end: to a percent, and soon done."""
        rule = self.rule(h)
        return np.asarray(rule.probabilities @ rule.terms([quantity], h, self.grading, self.ways))

    def _separation_at(self, quantity: str, value: float, grid: Array, about: Array) -> float:
        high_enough = np.flatnonzero(about >= value)
        k = int(high_enough[-1]) if high_enough.size else 0
        left, right = grid[max(k - 1, 0)], grid[min(k + 2, grid.size - 1)]
        if not self._excess(left, quantity, value) > 0 > self._excess(right, quantity, value):
            left, right = self._bracket(grid, quantity, value)
        from scipy.optimize import brentq  # imports half of SciPy, which few separations are asked for

        return float(brentq(self._excess, left, right, (quantity, value), xtol=1e-15, rtol=_LAST_DIGITS))

    def _bracket(self, grid: Array, quantity: str, value: float) -> tuple[float, float]:
        high_enough = np.flatnonzero(self.mean(quantity, grid) >= value)
        if not high_enough.size or high_enough[-1] == grid.size - 1:
            raise ValueError(
                f"{quantity}: not reached between h = {grid[0]:g} and {grid[-1]:.4g}; give another value"
            )
        return float(grid[high_enough[-1]]), float(grid[high_enough[-1] + 1])

    def _grid(self, quantity: str) -> Array:
        """Separations from where all touches to where probabilities underflow, or the highest height."""
        if isinstance(self.heights, MeasuredHeights):
            top = self.heights.support[1]
        else:
            top = min(float(self.heights.isf(np.array(_RAREST), 0.0)), _HIGHEST)
        near = min(top, 12.0)
        far = np.geomspace(near, top, 25)[1:] if top > near else np.empty(0)
        grid = np.concatenate([np.linspace(_LOWEST, -4, 10)[:-1], np.linspace(-4, near, 41), far])
        low = self._lowest(quantity, near)
        return np.concatenate([[low], grid[grid > low]])

    def _lowest(self, quantity: str, near: float) -> float:
        """Lowest separation of the grid: that of the turn, or above it one that has no negative modulus."""
        if self.ways.law.elastic:
            return _LOWEST
        branch = self.ways.of(quantity)
        lowest = branch.deepest if isinstance(branch, UnloadingBranch) else _LOWEST
        s = np.linspace(max(self.heights.support[0], -_COUNTS), near, 4001)
        negative = np.flatnonzero(self.grading(s) < 0)
        return max(lowest, float(s[min(negative[-1] + 1, s.size - 1)])) if negative.size else lowest

    def _excess(self, h: float, quantity: str, value: float) -> float:
        """Logarithm relative to the value; -100 also where the mean is not positive."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return float(np.fmax(np.log(self.mean(quantity, np.array(h)) / value), -100.0))


@dataclass(frozen=True)
class _Sums:
    """Sums over the rule of a few separations."""

    contact: MeanContact
    h: Array
    rule: HeightRule

    def mean(self, quantity: str) -> Array:
        terms = self.rule.terms([quantity], self.h, self.contact.grading, self.contact.ways)
        return np.asarray(self.rule.probabilities @ terms)

    def share(self, piece: int) -> Array:
        s, e, law = self.rule.heights, self.contact.grading(self.rule.heights), self._ways.law
        inside = np.stack([(s > h) & (piece_of(law, s - h, e) == piece) for h in self.h], axis=1)
        with np.errstate(invalid="ignore"):
            return np.asarray(self.rule.probabilities @ inside / self.mean("contacts"))

    @property
    def _ways(self) -> Ways:
        """In units of each summit, where radii differ."""
        ways = self.contact.ways
        return ways if self.rule.ratios is None else ways.with_radii(self.rule.ratios)

    def slope(self, quantity: str) -> Array:
        grading, heights = self.contact.grading, self.contact.heights
        branch = self._ways.loading
        s, p = self.rule.heights, self.rule.probabilities
        if not s.size:
            return np.zeros(self.h.shape)
        if self.rule.ratios is not None:
            p = p * self.rule.ratios ** quantity_of(quantity).radius
        e = grading(s)
        within = p @ np.stack([slope_term(quantity, branch, s - h, e) for h in self.h], axis=1)
        if isinstance(heights, MeasuredHeights):
            return np.asarray(within)  # between the separations at which one of them jumps
        if isinstance(self.contact.summits, RandomCurvature):
            branch, law, top = self.contact.ways.loading, self.contact.summits, float(s.max())
            met = [jumps_of_radii(quantity, branch, grading, law, x, top) for x in self.h.tolist()]
            return np.asarray(within + met)
        ends = float(s[0]), float(s[-1])
        jumps = jump_terms(quantity, branch, grading, lambda t, _: heights.pdf(t), self.h, ends)
        return np.asarray(within + jumps)
