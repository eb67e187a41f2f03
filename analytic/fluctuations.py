"""Exact statistics of finite surfaces: what the mean-value theory leaves out.

One surface has N independent asperities (or a Poisson number of them with mean N), so a quantity is
a sum of N independent terms ``f(s_i)``. Its cumulants follow from integrals over one asperity. These
are taken with a fixed set of heights and probabilities (`HeightRule`): Gauss-Legendre in
``sqrt(s - h_k)`` on pieces that no separation and no break divides, graded towards separations with a
close neighbour. Means and variances underflow with the density, beyond h = 37.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike, NDArray

from analytic.gradings import Grading, Homogeneous
from analytic.heights import Gaussian, HeightLaw, exp_minus_half_square
from analytic.integrals import fn
from analytic.law_rule import law_rule
from analytic.quantities import QUANTITIES
from analytic.resolution import resolved_breaks
from analytic.surface import Surface

__all__ = ["Cumulants", "HeightRule", "covariance", "cumulants"]

Array = NDArray[np.float64]
Count = Literal["fixed", "poisson"]

_REACH = 13.0
_NODES = 64
_STEP = 4.0  # widest piece, on which the density is resolved as far down as s = -40
_RATIO = 8.0  # of a piece to its distance from the next separation below


def _graded(h: Array) -> list[float]:
    """Edges above close neighbours, whose ``sqrt(s - h)`` almost has its kink inside the next piece."""
    edges = []
    for lower, upper in pairwise(h):
        distance = upper - lower
        while distance < 1:
            edges.append(upper + distance)
            distance *= _RATIO
    return edges


@dataclass(frozen=True, slots=True)
class HeightRule:
    """Heights and their probabilities: ``E f(s) = probabilities @ f(heights)`` for any sum of Hertz terms.

    Parameters
    ----------
    heights : ndarray
        Reduced heights above the lowest separation, shape (m,).
    probabilities : ndarray
        Their weights, shape (m,).
    below : float
        Probability of a height below the lowest separation, where nothing touches.
    """

    heights: Array
    probabilities: Array
    below: float

    @classmethod
    def over(cls, separations: ArrayLike, grading: Grading, law: HeightLaw | None = None) -> "HeightRule":
        """The rule for these reduced separations, this grading and law (left out: Gaussian)."""
        h = np.unique(np.asarray(separations, dtype=np.float64))
        if not (law is None or isinstance(law, Gaussian)):
            return cls(*law_rule(law, h, grading), float(law.below(h[0])))
        low, last = float(h[0]), max(float(h[-1]), 0.0)
        top = last + _REACH**2 / (last + np.hypot(last, _REACH))
        regular = _STEP * np.arange(np.floor(low / _STEP) + 1, np.ceil(top / _STEP))
        cuts = [*h, *_graded(h), *regular, *resolved_breaks(grading, max(low, -_REACH), top), top]
        edges = np.unique([c for c in cuts if c <= top])
        x, w = leggauss(_NODES)
        x, w = (1 + x) / 2, w / 2
        pieces = []
        for left, right in pairwise(edges):
            anchor = h[h <= left][-1]
            start, stop = np.sqrt(left - anchor), np.sqrt(right - anchor)
            v = start + (stop - start) * x
            s = anchor + v * v
            density = exp_minus_half_square(s) / np.sqrt(2 * np.pi)
            pieces.append((s, 2 * v * (stop - start) * w * density))
        heights, probabilities = (np.concatenate(part) for part in zip(*pieces, strict=True))
        return cls(heights, probabilities, float(fn(0, -h[0])))

    def fluctuations(self, f: Array, count: Count) -> tuple[Array, Array]:
        """What makes the columns of `f` fluctuate, at the heights and below them all.

        Deviations from the mean for a fixed number of asperities, the terms themselves for a Poisson one.
        """
        if count == "fixed":
            _, deviation, at_zero = self.deviations(f)
            return deviation, at_zero
        return f, np.zeros(f.shape[1])

    def products(self, f: Array, at_zero: Array) -> Array:
        """Mean products of all columns of `f`, which is `at_zero` below all heights."""
        return np.asarray((f * self.probabilities[:, None]).T @ f + self.below * np.outer(at_zero, at_zero))

    def whitening(self, f: Array, at_zero: Array, least: float) -> Array:
        """Matrix that turns columns of unit variance into uncorrelated ones, shape (columns, axes).

        Combinations with a variance up to `least` are left out: differences of nearly equal columns.
        """
        size, axes = np.linalg.eigh(self.products(f, at_zero))
        return np.asarray(axes[:, size > least] / np.sqrt(size[size > least]))

    def deviations(self, f: Array) -> tuple[Array, Array, Array]:
        """Mean of each column of `f`; its deviations at the heights; and that of 0, below all heights.

        Counted from what almost every asperity contributes (nothing, or the same), so that a variance
        like 1e-89 keeps its digits.
        """
        origin = np.where(self.below > 0.5, 0.0, f[np.argmax(self.probabilities)])
        shifted = f - origin
        offset = self.probabilities @ shifted - self.below * origin
        return self.probabilities @ f, shifted - offset, -origin - offset

    def terms(self, quantities: Sequence[str], separations: ArrayLike, grading: Grading) -> Array:
        """What one asperity adds to each quantity, over its scale: shape (m, quantities * separations)."""
        h = np.asarray(separations, dtype=np.float64)
        approach = self.heights[:, None] - h
        modulus = grading(self.heights)[:, None]
        columns = []
        for name in quantities:
            q = QUANTITIES[name]
            power = np.where(approach > 0, np.abs(approach) ** q.exponent, 0.0)
            columns.append(power * modulus**q.modulus)
        return np.concatenate(columns, axis=1)


@dataclass(frozen=True, slots=True)
class Cumulants:
    """Exact statistics of a quantity over surfaces, each an array over the separations.

    Parameters
    ----------
    mean, variance : ndarray
        In the unit of the quantity, and its square.
    skewness, excess_kurtosis : ndarray
        Of the distribution over surfaces; nan where the variance is 0.
    """

    mean: Array
    variance: Array
    skewness: Array
    excess_kurtosis: Array


def cumulants(
    surface: Surface,
    quantity: str,
    h: ArrayLike,
    grading: Grading | None = None,
    *,
    n_asperities: float | None = None,
    count: Count = "fixed",
    law: HeightLaw | None = None,
) -> Cumulants:
    """Mean, variance, skewness and excess kurtosis of a quantity of one finite surface.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    quantity : {"load", "area", "stiffness", "contacts", "conductance"}
        The sum over asperities.
    h : array_like
        Reduced separations d/sigma, any shape.
    grading : Grading, optional
        E*(s)/E*; left out: homogeneous.
    n_asperities : float, optional
        Number of asperities; left out: eta A_n.
    count : {"fixed", "poisson"}, optional
        Whether this number is the same on every surface, or the mean of a Poisson law (a window on
        an unbounded surface).
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    Cumulants
        Arrays in the shape of `h`.

    Raises
    ------
    KeyError
        If there is no such quantity.
    """
    grading = Homogeneous() if grading is None else grading
    n = surface.n_asperities if n_asperities is None else n_asperities
    scale = QUANTITIES[quantity].scale(surface)
    h = np.asarray(h, dtype=np.float64)
    rows = [_one_asperity(quantity, x, grading, count, law) for x in h.ravel()]
    k1, k2, k3, k4 = np.array(rows).reshape(*h.shape, 4).transpose(-1, *range(h.ndim))
    with np.errstate(divide="ignore", invalid="ignore"):
        return Cumulants(
            n * scale * k1, n * scale**2 * k2, k3 / k2 / np.sqrt(n * k2), k4 / k2 / (n * k2)
        )  # k2 to a power would underflow long before these ratios overflow


def _one_asperity(
    quantity: str, h: float, grading: Grading, count: Count, law: HeightLaw | None
) -> tuple[float, ...]:
    """First four cumulants that one asperity contributes, over the scale, from moments about the mean."""
    rule = HeightRule.over([h], grading, law)
    f = rule.terms([quantity], [h], grading)
    if count == "poisson":
        m1, m2, m3, m4 = (float((rule.probabilities @ f**k)[0]) for k in (1, 2, 3, 4))
        return m1, m2, m3, m4
    mean, deviation, at_zero = rule.deviations(f)
    m2, m3, m4 = (float((rule.probabilities @ deviation**k + rule.below * at_zero**k)[0]) for k in (2, 3, 4))
    return float(mean[0]), m2, m3, m4 - 3 * m2 * m2


def covariance(
    surface: Surface,
    quantities: Sequence[str],
    separations: ArrayLike,
    grading: Grading | None = None,
    *,
    n_asperities: float | None = None,
    count: Count = "fixed",
    law: HeightLaw | None = None,
) -> Array:
    """Covariance over surfaces between all quantities at all separations.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    quantities : sequence of str
        Names of Q quantities.
    separations : array_like
        K reduced separations.
    grading : Grading, optional
        E*(s)/E*; left out: homogeneous.
    n_asperities : float, optional
        Number of asperities; left out: eta A_n.
    count : {"fixed", "poisson"}, optional
        As in `cumulants`.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        Shape (Q, K, Q, K), in the product of the units.
    """
    grading = Homogeneous() if grading is None else grading
    n = surface.n_asperities if n_asperities is None else n_asperities
    h = np.asarray(separations, dtype=np.float64)
    rule = HeightRule.over(h, grading, law)
    f = rule.terms(quantities, h, grading)
    matrix = rule.products(*rule.fluctuations(f, count))
    scale = np.repeat([QUANTITIES[name].scale(surface) for name in quantities], h.size)
    return np.asarray(n * matrix * np.outer(scale, scale)).reshape(2 * (len(quantities), h.size))
