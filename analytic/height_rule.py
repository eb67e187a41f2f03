"""A quadrature rule over the heights, and what makes a sum over independent asperities fluctuate.

One surface has N independent asperities (or a Poisson number of them with mean N), so a quantity is
a sum of N independent terms ``f(s_i)``. Its cumulants follow from integrals over one asperity, taken with a
fixed set of heights and probabilities (`HeightRule`).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.arrays import Array, Ints
from analytic.gradings import Grading
from analytic.heights import GAUSSIAN, HeightLaw
from analytic.law_rule import law_rule
from analytic.laws.branch import Branch
from analytic.laws.law import ContactLaw

Count = Literal["fixed", "poisson"]

_TOGETHER = 2**17  # terms that are found together: a cache holds them
_DIVERGES = 4  # power of the radius of a summit that has no mean


def _check(s: Array, modulus: Array, contact: ContactLaw) -> None:
    """Nothing yields at a negative modulus."""
    negative = np.flatnonzero(modulus < 0)
    if negative.size:
        k = negative[-1]
        raise ValueError(
            f"grading: E*(s)/E* = {modulus[k]:.4g} at s = {s[k]:.4g}, and law = {contact.name!r} needs a "
            "modulus >= 0; clip it (clip = true), or use larger separations"
        )


@dataclass(frozen=True, slots=True)
class HeightRule:
    """Heights and their probabilities: ``E f(s) = probabilities @ f(heights)`` for any sum of contacts.

    Parameters
    ----------
    heights : ndarray
        Reduced heights above the lowest separation, shape (m,).
    probabilities : ndarray
        Their weights, shape (m,).
    below : float
        Probability of a height below the lowest separation, where nothing touches.
    ratios : ndarray, optional
        Radius of the summit at each of them over that of the surface, where radii differ, shape (m,).
    """

    heights: Array
    probabilities: Array
    below: float
    ratios: Array | None = None

    @classmethod
    def over(
        cls,
        separations: ArrayLike,
        grading: Grading,
        heights: HeightLaw = GAUSSIAN,
        *,
        branches: Iterable[Branch] = (),
        cuts: Sequence[float] = (),
        **powers: float,
    ) -> "HeightRule":
        """Return the rule for these reduced separations, this grading and law of the heights.

        `branches` are those of what is summed, `cuts` heights at which it jumps or bends besides, `powers`
        the highest ones of modulus and approach, as of `analytic.law_rule.ends_of`.
        """
        branches, h = tuple(branches), np.unique(np.asarray(separations, dtype=np.float64))
        lowest = np.unique([*h, *(branch.lowest(h[0]) for branch in branches)])

        def changes(low: float, high: float) -> list[float]:
            """Heights where another formula holds."""
            found = [branch.regimes(grading, h, low, high) for branch in branches]
            return [*cuts, *(s for each in found for s in (*each.low.tolist(), *each.high.tolist()))]

        rule = law_rule(heights, lowest, grading, further=changes, **powers)
        return cls(*rule, float(heights.cdf(lowest[0])))

    def mean(self, f: Array) -> Array:
        """Return the mean of each column of `f` above the lowest separation; in this thread alone."""
        return np.asarray(np.einsum("i,ij->j", self.probabilities, f))

    def fluctuations(self, f: Array, count: Count) -> "Fluctuations":
        """Return what makes sums of the columns of `f` fluctuate.

        For a fixed number of asperities the deviations of the terms from their means, counted from what
        almost every asperity contributes (nothing, or the same), so that a variance like 1e-89 keeps its
        digits; for a Poisson number the terms themselves.
        """
        mean = self.mean(f)
        if count == "poisson" or not self.heights.size:
            return Fluctuations(self, mean, f, np.zeros(f.shape[1]))
        usual = np.zeros(f.shape[1]) if self.below > 0.5 else f[np.argmax(self.probabilities)]
        shifted = f - usual
        offset = self.mean(shifted) - self.below * usual
        shifted -= offset
        return Fluctuations(self, mean, shifted, -usual - offset)

    def terms(
        self, quantities: Sequence[str], separations: ArrayLike, grading: Grading, ways: Branch
    ) -> Array:
        """Return what an asperity adds, over scales of quantities: shape (m, quantities * separations)."""
        h, modulus = np.asarray(separations, dtype=np.float64), grading(self.heights)
        if not ways.law.elastic:
            _check(self.heights, modulus, ways.law)
        terms = np.zeros((self.heights.size, len(quantities), h.size))
        for branch in ways.among(quantities):
            which = [k for k, name in enumerate(quantities) if ways.of(name) == branch]
            several = [quantities[k] for k in which]
            step = max(1, _TOGETHER // max(1, h.size))
            for first in range(0, self.heights.size, step):
                part = slice(first, first + step)
                own = branch.with_radii(None if self.ratios is None else self.ratios[part])
                found = own.terms(several, h[:, None], self.heights[part], modulus[part])
                terms[part, which] = found.transpose(2, 0, 1)
        return terms.reshape(self.heights.size, len(quantities) * h.size)


@dataclass(frozen=True, slots=True)
class Fluctuations:
    """Random parts of what one asperity contributes to some sums, the columns.

    A sum over N asperities has N times the variance, and N times the third cumulant, of one.

    Parameters
    ----------
    rule : HeightRule
        Heights and their probabilities.
    mean : ndarray
        What one asperity contributes in the mean, shape (columns,).
    at_heights : ndarray
        The random part at each height of the rule, shape (m, columns).
    below : ndarray
        That below all of them, shape (columns,).
    radius : ndarray, optional
        Power of the radius in each column, where radii have means up to the third power only.
    """

    rule: HeightRule
    mean: Array
    at_heights: Array
    below: Array
    radius: Array | None = None

    def moment(self, k: int) -> Array:
        """Return the mean of the `k`-th power, shape (columns,); infinite where there is none."""
        rule = self.rule
        powers = reduce(np.multiply, [self.at_heights] * k)  # ten times as fast as **
        found = np.asarray(rule.mean(powers) + rule.below * self.below**k)
        return found if self.radius is None else np.where(k * self.radius < _DIVERGES, found, np.inf)

    def combined(self, mean: Array, own: Ints, factor: Array, other: Ints, press: Array) -> "Fluctuations":
        """Return those of columns `own` times `factor` and columns `other` times `press`, to first order."""
        radius = self.radius
        if radius is not None:
            radius = np.maximum(
                *(np.where(by != 0, radius[k], 0.0) for k, by in ((own, factor), (other, press)))
            )
        return Fluctuations(
            self.rule,
            mean,
            self.at_heights[:, own] * factor + self.at_heights[:, other] * press,
            self.below[own] * factor + self.below[other] * press,
            radius,
        )

    def products(self) -> Array:
        """Return the mean products of all columns, shape (columns, columns)."""
        weighted = self.at_heights * self.rule.probabilities[:, None]
        return np.asarray(weighted.T @ self.at_heights + self.rule.below * np.outer(self.below, self.below))

    def take(self, columns: NDArray[Any], unit: Array | float = 1.0) -> "Fluctuations":
        """Return some of the columns, in units of `unit`."""
        return Fluctuations(
            self.rule,
            self.mean[columns] / unit,
            self.at_heights[:, columns] / unit,
            self.below[columns] / unit,
            None if self.radius is None else self.radius[columns],
        )

    def turned(self, axes: Array) -> "Fluctuations":
        """Return combinations of the columns; `axes` has shape (columns, combinations)."""
        radius = None if self.radius is None else np.where(axes, self.radius[:, None], 0.0).max(axis=0)
        return Fluctuations(self.rule, self.mean @ axes, self.at_heights @ axes, self.below @ axes, radius)

    def whitening(self, least: float) -> Array:
        """Return the matrix that makes columns of unit variance uncorrelated, shape (columns, axes).

        Combinations with a variance up to `least` are left out: differences of nearly equal columns.
        """
        size, axes = np.linalg.eigh(self.products())
        return np.asarray(axes[:, size > least] / np.sqrt(size[size > least]))
