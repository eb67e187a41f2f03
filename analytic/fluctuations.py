"""Exact statistics of finite surfaces: what the mean-value theory leaves out.

One surface has N independent asperities (or a Poisson number of them with mean N), so a quantity is
a sum of N independent terms ``f(s_i)``. Its cumulants follow from integrals over one asperity. These
are taken with a fixed set of heights and probabilities (`HeightRule`): Gauss-Legendre in
``sqrt(s - h_k)`` between neighbouring separations h_k, so every kink of every term is an edge.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike, NDArray

from analytic.gradings import Grading, Homogeneous
from analytic.integrals import exp_minus_half_square, fn
from analytic.quantities import QUANTITIES
from analytic.resolution import resolved_breaks
from analytic.surface import Surface

__all__ = ["Cumulants", "HeightRule", "covariance", "cumulants"]

Array = NDArray[np.float64]
Count = Literal["fixed", "poisson"]

_REACH = 13.0
_NODES = 64


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
    def over(cls, separations: ArrayLike, grading: Grading) -> "HeightRule":
        """The rule for these reduced separations and this grading."""
        h = np.unique(np.asarray(separations, dtype=np.float64))
        low = float(max(h[0], -_REACH))
        top = float(max(_REACH, h[-1] + _REACH**2 / (max(h[-1], 0) + np.hypot(max(h[-1], 0), _REACH))))
        cuts = [low, top, 0.0, *h, *resolved_breaks(grading, low, top)]
        edges = np.unique([c for c in cuts if low <= c <= top])
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

    def terms(
        self, surface: Surface, quantities: Sequence[str], separations: ArrayLike, grading: Grading
    ) -> Array:
        """What one asperity adds to each quantity, in SI units: shape (m, quantities * separations)."""
        h = np.asarray(separations, dtype=np.float64)
        approach = self.heights[:, None] - h
        modulus = grading(self.heights)[:, None]
        columns = []
        for name in quantities:
            q = QUANTITIES[name]
            power = np.where(approach > 0, np.abs(approach) ** q.exponent, 0.0)
            columns.append(q.scale(surface) * power * modulus**q.modulus)
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
    h = np.asarray(h, dtype=np.float64)
    rows = [_one_asperity(surface, quantity, x, grading, count) for x in h.ravel()]
    k1, k2, k3, k4 = np.array(rows).reshape(*h.shape, 4).transpose(-1, *range(h.ndim))
    with np.errstate(divide="ignore", invalid="ignore"):
        return Cumulants(n * k1, n * k2, k3 / k2**1.5 / np.sqrt(n), k4 / k2**2 / n)


def _one_asperity(
    surface: Surface, quantity: str, h: float, grading: Grading, count: Count
) -> tuple[float, float, float, float]:
    """First four cumulants that one asperity contributes, from moments about the mean."""
    rule = HeightRule.over([h], grading)
    f = rule.terms(surface, [quantity], [h], grading)[:, 0]
    m1 = float(rule.probabilities @ f)
    centre = m1 if count == "fixed" else 0.0
    m2, m3, m4 = (
        float(rule.probabilities @ (f - centre) ** k + rule.below * (-centre) ** k) for k in (2, 3, 4)
    )
    return (m1, m2, m3, m4 - 3 * m2 * m2) if count == "fixed" else (m1, m2, m3, m4)


def covariance(
    surface: Surface,
    quantities: Sequence[str],
    separations: ArrayLike,
    grading: Grading | None = None,
    *,
    n_asperities: float | None = None,
    count: Count = "fixed",
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

    Returns
    -------
    ndarray
        Shape (Q, K, Q, K), in the product of the units.
    """
    grading = Homogeneous() if grading is None else grading
    n = surface.n_asperities if n_asperities is None else n_asperities
    h = np.asarray(separations, dtype=np.float64)
    rule = HeightRule.over(h, grading)
    f = rule.terms(surface, quantities, h, grading)
    centre = rule.probabilities @ f if count == "fixed" else np.zeros(f.shape[1])
    deviation = f - centre
    matrix = (deviation * rule.probabilities[:, None]).T @ deviation + rule.below * np.outer(centre, centre)
    return np.asarray(n * matrix).reshape(len(quantities), len(h), len(quantities), len(h))
