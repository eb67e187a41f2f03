"""What one asperity contributes in the mean, per asperity and over the scale of each quantity."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.gradings import Grading, Homogeneous
from analytic.height_rule import HeightRule
from analytic.heights import HeightLaw
from analytic.inversion import LOWEST, last_separations
from analytic.law_rule import law_integral
from analytic.laws.branch import UnloadingBranch, Ways
from analytic.laws.law import piece_of
from analytic.laws.pieces import slope_term
from analytic.quadrature import REACH
from analytic.quantities import Quantity, quantity_of
from analytic.summits import Summits

_HIGHEST = 1000.0  # separation that is looked at
_STEP = 2e-3  # of differences: where the mean has 12 digits, those of the slope are off by 1e-9 of the mean


def fall_of(mean: Callable[[Array], Array], h: ArrayLike) -> Array:
    """How fast a mean falls with the separation, by differences of the fourth order; in the shape of `h`."""
    h = np.asarray(h, dtype=np.float64)
    step = _STEP / (1 + np.abs(h))
    lower2, lower, upper, upper2 = mean(h + np.multiply.outer([-2, -1, 1, 2], step))
    return np.asarray((8 * (lower - upper) - (lower2 - upper2)) / (12 * step))


@dataclass(frozen=True)
class MeanContact:
    """Means under any law of contact: sums over a rule of heights and radii.

    Parameters
    ----------
    ways : Ways
        Law of contact and history, in reduced units.
    grading : Grading
        E*(s)/E*.
    summits : Summits
        Their heights and radii.
    """

    ways: Ways
    grading: Grading
    summits: Summits

    @property
    def together(self) -> int:
        """How many separations share a rule."""
        return self.summits.together

    def mean(self, quantity: str, h: ArrayLike) -> Array:
        """Mean at separations of any shape."""
        h = np.asarray(h, dtype=np.float64)
        beyond = np.isfinite(h) & (self.summits.heights.sf(h) == 0)  # far ones would make a rule long
        result = np.zeros(np.shape(h))
        result[~beyond] = self._in_parts(h[~beyond], quantity, partial(self._mean, quantity))
        return result

    def share(self, piece: int, h: ArrayLike) -> Array:
        """Share of the contacts in which this piece of the law holds; nan without a contact."""
        return self._in_parts(h, "contacts", partial(self._share, piece))

    def slope(self, quantity: str, h: ArrayLike) -> Array:
        """How fast the mean falls with the separation, jumps of asperities included.

        If asperities have yielded, others than the load are refused on unloading.
        """
        q = quantity_of(quantity)
        if q.unloading and not self.ways.law.elastic:
            if q.base != "load":
                raise ValueError(f"quantity = {quantity!r}: its slope is not known; give 'load_unloading'")
            return q.exponent * self.mean("load_slope_unloading", h)
        if self.summits.listed:
            return self._in_parts(h, q.base, partial(self._slope, q.base))
        if q.base == "contacts":
            return self.summits.heights.pdf(np.asarray(h, dtype=np.float64))
        return fall_of(partial(self.mean, q.base), h)

    def rule(self, h: ArrayLike, quantities: Sequence[str]) -> HeightRule:
        """Heights, and radii, for integrals of what is added to these quantities at these separations."""
        return self.summits.rule(np.asarray(h, dtype=np.float64), self.grading, self.ways.among(quantities))

    def separations_at(
        self, quantity: str, values: Array, mean: Callable[[ArrayLike], Array] | None = None
    ) -> Array:
        """Largest separations with given means, in the shape of `values`; perhaps by a closer `mean`.

        Refused if the mean does not have a value where it can be told from 0, at h = -40 or above.
        """
        grid, found = self._grid(quantity), mean or partial(self.mean, quantity)
        rough = self.rule(grid[:1], [])  # right to a percent, but in tails that this separation hardly needs
        with np.errstate(divide="ignore", invalid="ignore"):
            about = np.log(self._mean(quantity, grid, rough))
            return last_separations(lambda h: np.log(found(h)), np.log(values), grid, about, quantity)

    def _in_parts(self, h: ArrayLike, quantity: str, function: Callable[[Array, HeightRule], Array]) -> Array:
        """Return a few separations at a time, which share a rule."""
        flat = np.ravel(np.asarray(h, dtype=np.float64))
        if not np.all(np.isfinite(flat)):
            raise ValueError("h: every separation must be finite")
        order = np.argsort(flat)
        result = np.empty(flat.size)
        for k in range(0, flat.size, self.together):
            part = order[k : k + self.together]
            result[part] = function(flat[part], self.rule(flat[part], [quantity]))
        return result.reshape(np.shape(h))

    def _mean(self, quantity: str, h: Array, rule: HeightRule) -> Array:
        return rule.mean(rule.terms([quantity], h, self.grading, self.ways))

    def _share(self, piece: int, h: Array, rule: HeightRule) -> Array:
        s, e, law = rule.heights, self.grading(rule.heights), self._ways_of(rule).law
        inside = np.stack([(s > x) & (piece_of(law, s - x, e) == piece) for x in h], axis=1)
        with np.errstate(invalid="ignore"):
            return np.asarray(rule.mean(inside) / self._mean("contacts", h, rule))

    def _slope(self, quantity: str, h: Array, rule: HeightRule) -> Array:
        s, p = rule.heights, rule.probabilities
        if not s.size:
            return np.zeros(h.shape)
        if rule.ratios is not None:
            p = p * rule.ratios ** quantity_of(quantity).radius
        branch, e = self._ways_of(rule).loading, self.grading(s)
        return np.array([np.sum(p * slope_term(quantity, branch, s - x, e)) for x in h])

    def _ways_of(self, rule: HeightRule) -> Ways:
        """In units of each summit, where radii differ."""
        return self.ways if rule.ratios is None else self.ways.with_radii(rule.ratios)

    def _grid(self, quantity: str) -> Array:
        """Separations from where all touches to where probabilities underflow, or the highest height."""
        top = min(self.summits.highest, _HIGHEST)
        near = min(top, 12.0)
        far = np.geomspace(near, top, 25)[1:] if top > near else np.empty(0)
        grid = np.concatenate([np.linspace(LOWEST, -4, 10)[:-1], np.linspace(-4, near, 41), far])
        low = self._lowest(quantity, near)
        return np.concatenate([[low], grid[grid > low]])

    def _lowest(self, quantity: str, near: float) -> float:
        """Lowest separation of the grid: that of the turn, or above it one that has no negative modulus."""
        if self.ways.law.elastic:
            return LOWEST
        branch = self.ways.of(quantity)
        lowest = branch.deepest if isinstance(branch, UnloadingBranch) else LOWEST
        s = np.linspace(max(self.summits.heights.support[0], -REACH), near, 4001)
        negative = np.flatnonzero(self.grading(s) < 0)
        return max(lowest, float(s[min(negative[-1] + 1, s.size - 1)])) if negative.size else lowest


@dataclass(frozen=True)
class MeanPowers:
    """Means where an asperity adds a power of its approach, as under Hertz's law: integrals over heights.

    Parameters
    ----------
    contact : MeanContact
        The same asperities by their formulas.
    """

    contact: MeanContact
    together: ClassVar[int] = 1
    ways: ClassVar[None] = None

    def mean(self, quantity: str, h: ArrayLike) -> Array:
        """Mean at separations of any shape."""
        q = quantity_of(quantity)
        return self._integral(q.exponent, q, h)

    def slope(self, quantity: str, h: ArrayLike) -> Array:
        """How fast the mean falls with the separation."""
        q = quantity_of(quantity)
        if q.exponent >= 1:
            return q.exponent * self._integral(q.exponent - 1, q, h)
        if q.base == "contacts" or self.contact.summits.listed:
            return self.contact.slope(q.base, h)
        return fall_of(partial(self.mean, q.base), h)

    def _integral(self, n: float, q: Quantity, h: ArrayLike) -> Array:
        h = np.asarray(h, dtype=np.float64)
        return law_integral(n, h, self._heights(q), self._grading(q) or Homogeneous())

    def rule(self, h: ArrayLike, quantities: Sequence[str]) -> HeightRule:  # noqa: ARG002 - the same for all
        """Heights, and radii, for integrals of powers at these separations."""
        return self.contact.summits.rule(np.asarray(h, dtype=np.float64), self.contact.grading)

    def separations_at(self, quantity: str, values: Array) -> Array:
        """Largest separations with given means, in the shape of `values`."""
        return self.contact.separations_at(quantity, values, partial(self.mean, quantity))

    def _grading(self, q: Quantity) -> Grading | None:
        return self.contact.grading if q.modulus else None

    def _heights(self, q: Quantity) -> HeightLaw:
        return self.contact.summits.weighted(q.radius)
