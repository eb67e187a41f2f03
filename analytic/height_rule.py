"""A quadrature rule over the heights, and what makes a sum over independent asperities fluctuate.

One surface has N independent asperities (or a Poisson number of them with mean N), so the cumulants of a
quantity are N times integrals over one of them, taken with a fixed set of heights and probabilities. Where
radii are random the integrals are over the curvature too, in the root of which they are smooth: the heights
at which a contact changes its law depend on the radius alone. So there are some radii, each with pieces of
the heights of its own.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.arrays import Array
from analytic.curvature import MEAN_CURVATURE, RandomCurvature
from analytic.gradings import Grading
from analytic.heights import GAUSSIAN, HeightLaw
from analytic.laws.branch import Branch
from analytic.measured_summits import MeasuredHeights, MeasuredRadii
from analytic.quadrature import NODES, ends_of, in_pieces, regular_edges
from analytic.resolution import resolved_breaks

Count = Literal["fixed", "poisson"]
Cuts = Callable[[Array], Array]  # of ratios of radii: heights, shape (cuts, radii)

_TOGETHER = 2**17  # terms that are found together: a cache holds them
_DIVERGES = 4  # power of the radius of a summit that has no mean
_PER_PIECE = 32  # points of a piece of many radii


@dataclass(frozen=True, slots=True)
class HeightRule:
    """Heights and their probabilities: ``E f(s) = probabilities @ f(heights)`` for any sum of contacts.

    Parameters
    ----------
    heights, probabilities : ndarray
        Reduced heights above the lowest separation, and their weights, shape (m,).
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
        radii: RandomCurvature | MeasuredRadii | None = None,
        *,
        branches: Iterable[Branch] = (),
        cuts: Cuts | None = None,
        **powers: float,
    ) -> "HeightRule":
        """Return the rule for these reduced separations, this grading, and laws of the heights and radii.

        `branches` are those of what is summed, `cuts` gives heights at which it jumps or bends besides,
        `powers` are the highest ones of modulus and approach, as of `analytic.quadrature.ends_of`. Heights
        increase, of each radius; those of a list keep its order.
        """
        branches, h = tuple(branches), np.unique(np.asarray(separations, dtype=np.float64))
        lowest = np.unique([*h, *(branch.lowest(h[0]) for branch in branches)])
        below = float(heights.cdf(lowest[0]))
        if isinstance(heights, MeasuredHeights):  # a separation seldom meets one that jumps
            s = np.array(heights.heights)
            touching = s > lowest[0]
            ratios = np.array(radii.ratios)[touching] if isinstance(radii, MeasuredRadii) else None
            return cls(s[touching], np.full(touching.sum(), 1 / s.size), below, ratios)
        start, top = ends_of(heights, lowest, grading, **powers)
        if not start < top:
            return cls(np.empty(0), np.empty(0), below)
        own = radii if isinstance(radii, RandomCurvature) else None
        if own is None:
            ratios, regular = np.ones(1), np.array(regular_edges(heights, start, top))
        else:
            curvatures, of_radii, regular = own.rule(h[-1], start, top)
            ratios = MEAN_CURVATURE / curvatures
        ends = [np.concatenate([regular, resolved_breaks(grading, start, top), lowest])] * ratios.size
        if cuts is not None:
            ends = [np.append(*each) for each in zip(ends, cuts(ratios).T, strict=True)]
        for branch in [branch for branch in branches if not branch.one_piece]:
            branch = branch if own is None else branch.with_radii(ratios)
            found = branch.regimes(grading, np.repeat(h, ratios.size), start, top)  # the radii in turn
            some, bounds = found.separation % ratios.size, np.stack([found.low, found.high])
            ends = [np.append(each, bounds[:, some == k]) for k, each in enumerate(ends)]
        ends = [np.unique(np.clip(each, start, top)) for each in ends]
        left, right = (np.concatenate([each[part] for each in ends]) for part in (np.s_[:-1], np.s_[1:]))
        if own is None:
            return cls(*_of_heights(heights, left, right), below)
        s, weights = in_pieces(left, right, _PER_PIECE)
        of = np.repeat(np.arange(ratios.size), [_PER_PIECE * (each.size - 1) for each in ends])
        return cls(s, weights * of_radii[of] * own.density(s, curvatures[of]), below, ratios[of])

    def mean(self, f: Array) -> Array:
        """Return the mean of each column of `f` above the lowest separation; in this thread alone."""
        return np.asarray(np.einsum("i,ij->j", self.probabilities, f))

    def fluctuations(self, f: Array, count: Count) -> "Fluctuations":
        """Return what makes sums of the columns of `f` fluctuate: terms, or deviations from their means."""
        mean, p = self.mean(f), np.append(self.probabilities, self.below)
        parts = np.append(f, np.zeros((1, f.shape[1])), axis=0)
        if count == "fixed" and self.heights.size:
            if self.below <= 0.5:  # counted from what almost all add: a variance like 1e-89 keeps its digits
                parts -= f[np.argmax(self.probabilities)]
            parts -= np.einsum("i,ij->j", p, parts)
        return Fluctuations(p, mean, parts, np.zeros(mean.size))

    def terms(
        self, quantities: Sequence[str], h: ArrayLike, grading: Grading, ways: Branch, slope: bool = False
    ) -> Array:
        """Return what an asperity adds, over scales, or its `slope`: shape (m, quantities * separations)."""
        h, modulus = np.asarray(h, dtype=np.float64), grading(self.heights)
        if not ways.law.elastic and modulus.min(initial=0.0) < 0:  # nothing yields there
            k = np.flatnonzero(modulus < 0)[-1]
            raise ValueError(
                f"grading: E*(s)/E* = {modulus[k]:.4g} at s = {self.heights[k]:.4g}, and law = "
                f"{ways.law.name!r} needs a modulus >= 0; clip it (clip = true), or use larger separations"
            )
        terms = np.zeros((self.heights.size, len(quantities), h.size))
        for branch in ways.among(quantities):
            which = [k for k, name in enumerate(quantities) if ways.of(name) == branch]
            several = [quantities[k] for k in which]
            step = max(1, _TOGETHER // max(1, h.size))
            for first in range(0, self.heights.size, step):
                part = slice(first, first + step)
                own = branch.with_radii(None if self.ratios is None else self.ratios[part])
                found = own.terms(several, h[:, None], self.heights[part], modulus[part], slope=slope)
                terms[part, which] = found.transpose(2, 0, 1)
        return terms.reshape(self.heights.size, len(quantities) * h.size)


def _of_heights(law: HeightLaw, left: Array, right: Array) -> tuple[Array, Array]:
    """Return heights and probabilities, those at a singular end exact where no heights are told apart."""
    s, weights = in_pieces(left, right, NODES)
    probabilities = (weights * law.pdf(s)).reshape(-1, NODES)
    for ends, share, other in ((left, law.cdf, right), (right, law.sf, left)):
        narrow = np.isin(ends, law.singular)
        if narrow.any():
            probabilities[narrow] = share(other[narrow])[:, None] / NODES
    return s, probabilities.ravel()


@dataclass(frozen=True, slots=True)
class Fluctuations:
    """Random parts of what one asperity contributes to some sums, the columns.

    Parameters
    ----------
    probabilities : ndarray
        Those of the heights of a rule, and of one below them; shape (m + 1,).
    mean : ndarray
        What one asperity contributes in the mean, shape (columns,).
    parts : ndarray
        The random part at each of these heights, shape (m + 1, columns).
    radius : ndarray
        Power of the radius in each column, where radii have means up to the third power only; else 0.
    """

    probabilities: Array
    mean: Array
    parts: Array
    radius: Array

    def moment(self, k: int) -> Array:
        """Return the mean of the `k`-th power, shape (columns,); infinite where there is none."""
        powers = reduce(np.multiply, [self.parts] * k)  # ten times as fast as **
        found = np.einsum("i,ij->j", self.probabilities, powers)  # in this thread alone
        return np.where(k * self.radius < _DIVERGES, found, np.inf)

    def products(self) -> Array:
        """Return the mean products of all columns, shape (columns, columns)."""
        return np.asarray((self.parts * self.probabilities[:, None]).T @ self.parts)

    def take(self, columns: NDArray[Any], unit: Array | float = 1.0) -> "Fluctuations":
        """Return some of the columns, in units of `unit`."""
        parts = self.parts[:, columns] / unit
        return Fluctuations(self.probabilities, self.mean[columns] / unit, parts, self.radius[columns])

    def turned(self, axes: Array) -> "Fluctuations":
        """Return combinations of the columns; `axes` has shape (columns, combinations)."""
        radius = np.where(axes, self.radius[:, None], 0.0).max(axis=0, initial=0.0)
        return Fluctuations(self.probabilities, self.mean @ axes, self.parts @ axes, radius)

    def whitening(self, least: float) -> Array:
        """Return the matrix that makes columns uncorrelated, but combinations of up to `least` variance."""
        size, axes = np.linalg.eigh(self.products())
        return np.asarray(axes[:, size > least] / np.sqrt(size[size > least]))
