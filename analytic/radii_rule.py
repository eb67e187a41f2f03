"""A quadrature rule over heights and radii of summits of random curvature, under any law of contact.

Sums over a surface, means as well as those of products, are integrals over the curvature, in the root of
which they are smooth: the heights at which a contact changes its law depend on the radius alone. So there
are some radii, each with a rule over the heights of its own; all are found at once.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array, Ints
from analytic.curvature import MEAN_CURVATURE, RandomCurvature
from analytic.gradings import Grading
from analytic.height_rule import HeightRule
from analytic.law_rule import ends_of
from analytic.laws.branch import Branch
from analytic.laws.cuts import cuts_of_each
from analytic.laws.slopes import jump_terms
from analytic.quadrature import SPANS, WIDEST, above_neighbours, gauss_legendre, rooted
from analytic.quantities import quantity_of
from analytic.resolution import resolved_breaks

_NODES, _AS_WIDE = 64, 0.6  # points for curvatures, if their density bends over so many heights
_HEIGHTS = 32  # points of a piece
_RAREST = 1e-18  # share of the touching heights above which curvatures are left out


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
        own[bound] = self.law.cdf(self.curvatures[-1], s[bound])
        own[~bound] = self.law.pdf(self.curvatures[which[~bound]], s[~bound])
        return np.asarray(self.weights[which] * own * self.law.heights.pdf(s))


def rule_of_radii(
    separations: Array, grading: Grading, law: RandomCurvature, branches: Iterable[Branch]
) -> HeightRule:
    """The rule for these reduced separations, this grading and law of the radii.

    Parameters
    ----------
    separations : ndarray
        Reduced separations, in any order.
    grading : Grading
        E*(s)/E*.
    law : RandomCurvature
        Of the radii, given the heights.
    branches : iterable of Branch
        Those of what is summed.
    """
    branches, h, heights = tuple(branches), np.unique(separations), law.heights
    radii = Radii.over(law, float(h[-1]))
    lowest = np.unique([*h, *(branch.lowest(float(h[0])) for branch in branches)])
    below = float(heights.cdf(lowest[0]))
    start, top = ends_of(heights, lowest, grading)
    if not start < top:
        return HeightRule(np.empty(0), np.empty(0), below, np.empty(0))
    widest = min(SPANS * law.narrowest, WIDEST)
    regular = np.linspace(start, top, int(np.ceil((top - start) / widest)) + 1)
    breaks = resolved_breaks(grading, start, top)
    common = np.concatenate([regular, breaks, lowest, above_neighbours(lowest)])
    number = radii.ratios.size
    cuts, which = [np.tile(common, number)], [np.repeat(np.arange(number), common.size)]
    for branch in (branch.with_radii(radii.ratios) for branch in branches):
        for x in h.tolist():
            found = cuts_of_each(branch, grading, np.full(number, x), start, top)
            cuts.append(found[0])
            which.append(found[1])
    left, right, of = _pieces(np.concatenate(cuts), np.concatenate(which), start, top)
    s, weights = rooted(left, right, lowest, _HEIGHTS)
    of = np.repeat(of, _HEIGHTS)
    return HeightRule(s, weights * radii.density(s, of), below, radii.ratios[of])


def _pieces(cuts: Array, which: Ints, start: float, top: float) -> tuple[Array, Array, Ints]:
    """Ends of the pieces between the cuts of each radius, and the number of the radius."""
    inside = (cuts >= start) & (cuts <= top)
    cuts, which = cuts[inside], which[inside]
    order = np.lexsort((cuts, which))
    cuts, which = cuts[order], which[order]
    held = np.flatnonzero((np.diff(which) == 0) & (np.diff(cuts) > 0))
    return cuts[held], cuts[held + 1], which[held]


def jumps_of_radii(
    quantity: str, branch: Branch, grading: Grading, law: RandomCurvature, h: float, top: float
) -> float:
    """What summits add to the slope of the mean by jumping, as `jump_terms`, over all radii."""
    radii = Radii.over(law, h)
    ratios, ends = radii.ratios, (float(h), top)
    at = np.full(ratios.shape, h)
    found = jump_terms(quantity, branch.with_radii(ratios), grading, radii.density, at, ends)
    return float(found @ ratios ** quantity_of(quantity).radius)


def with_radii(rule: HeightRule, curvature: RandomCurvature) -> HeightRule:
    """Spread a rule over heights to heights and radii of summits.

    Exact for sums, their products and third powers where one summit adds a power of its radius, up to 1;
    fourth powers of the radius have a mean only if it is bounded.
    """
    ratio, probability = curvature.rule(rule.heights)
    heights = np.broadcast_to(rule.heights, ratio.shape)
    return HeightRule(heights.ravel(), (rule.probabilities * probability).ravel(), rule.below, ratio.ravel())
