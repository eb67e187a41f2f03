"""The integrals F_n and F*_n of the theory, to 1e-13 at any separation (Eqs. 2, 3, 7-9).

By Gauss-Legendre in a root of the approach, whatever the power and the smooth grading. For h >= 0 everything
is relative to phi(h), so nothing underflows before the answer does.
"""

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.gradings import Grading, Homogeneous
from analytic.height_rule import HeightRule
from analytic.heights import GAUSSIAN, Gaussian, HeightLaw, exp_minus_half_square
from analytic.quadrature import NODES, ends_of, gauss_legendre, regular_edges, towards_both_ends
from analytic.quantities import QUANTITIES
from analytic.resolution import resolved_breaks
from analytic.roots import last_separations

_GRID = np.concatenate([np.linspace(-40, 10, 251), np.geomspace(10.5, 1000, 60)])  # separations


def _relative(n: float, h: float, grading: Grading, breaks: Array) -> float:
    """``int (s-h)^n g phi / phi(max(h, 0))`` over s > h."""
    start, top = ends_of(GAUSSIAN, np.array([h]), grading, power=1)
    inner = breaks[(start < breaks) & (breaks < top)]
    edges = np.unique([*regular_edges(GAUSSIAN, start, top), *inner])
    width, above = np.diff(edges)[:, None], max(h, 0.0)
    place, weight = towards_both_ends(NODES if (2 * n) % 1 == 0 else 2 * NODES)
    approach = (edges[:-1] - h)[:, None] + width * place
    beyond = approach + (h - above)  # s - above, without cancellation
    density = np.exp(GAUSSIAN.log_ratio(np.array(above), beyond))
    return float(np.sum(width * weight * approach**n * density * grading(above + beyond)))


def _by_rule(n: float, h: float, grading: Grading, heights: HeightLaw) -> float:
    rule = HeightRule.over([h], grading, heights, power=1, exponent=n + 1)
    return float(rule.probabilities @ (grading(rule.heights) * (rule.heights - h) ** n))


def quotient(
    h: ArrayLike, above: tuple[float, Grading | None], below: tuple[float, Grading | None], heights: HeightLaw
) -> Array:
    """Quotient of two integrals, each by its power and grading, also where both underflow."""
    a, b = (fn_scaled(n, h, grading, heights=heights) for n, grading in (above, below))
    return a / b


def fn_scaled(
    n: float, h: ArrayLike, grading: Grading | None = None, *, heights: HeightLaw = GAUSSIAN
) -> Array:
    """Return ``F(h)/phi(h)`` for h >= 0, else ``F(h)``, as of laws of heights that are not Gaussian."""
    h = np.asarray(h, dtype=np.float64)
    if not 0 <= n < np.inf:
        raise ValueError(f"n = {n!r}: give a finite number that is not negative")
    if not np.all(np.isfinite(h)):
        raise ValueError("h: every separation must be finite")
    grading, flat = Homogeneous() if grading is None else grading, h.ravel().tolist()
    if not isinstance(heights, Gaussian) or not flat:
        return np.reshape([_by_rule(n, x, grading, heights) for x in flat], h.shape)
    breaks = np.array(resolved_breaks(grading, *ends_of(heights, np.unique(h), grading, power=1)))
    values = [_relative(n, x, grading, breaks) for x in flat]
    unit = np.where(h >= 0, 1.0, 1 / np.sqrt(2 * np.pi))
    return np.asarray(unit * np.reshape(values, h.shape))


def fn(
    n: float,
    h: ArrayLike,
    grading: Grading | None = None,
    *,
    log: bool = False,
    heights: HeightLaw = GAUSSIAN,
) -> Array:
    r"""Return the integral F_n (Eq. 2), with a grading F*_n (Eqs. 3, 5, 7).

    .. math:: F^*_n(h) = \int_h^\infty (s - h)^n \phi(s) E^*(s)/E^* ds

    Relative error at most 1e-13 for every h from -40 to 1000. The paper says that no closed form
    exists; there is one: ``Gamma(n+1)/sqrt(2 pi) exp(-h^2/4) D_{-n-1}(h)`` with the parabolic cylinder
    function D, and ``F*_n(h) = gamma F_n(h) - (gamma-1) sqrt(e) F_n(h+1)`` for Eq. 4. Quadrature is more
    accurate, and takes any grading.

    Parameters
    ----------
    n : float
        Power of the approach, not negative: 0, 1/2, 1, 3/2, or any other.
    h : array_like
        Reduced separations d/sigma, any shape.
    grading : Grading, optional
        E*(s)/E*; default: homogeneous.
    log : bool, optional
        Return the natural logarithm, which does not underflow; nan where the integral is negative.
    heights : HeightLaw, optional
        Law of the heights, with its density in place of phi. Another than the Gaussian is integrated
        to 1e-11 as far as its density reaches in double precision.

    Returns
    -------
    ndarray
        In the shape of `h`.

    Raises
    ------
    ValueError
        If `n` is negative or not finite, or a separation is not finite.

    Examples
    --------
    >>> import analytic
    >>> round(float(analytic.fn(1, 0.0)), 12)
    0.398942280401
    >>> round(float(analytic.fn(1.5, 100.0, analytic.Exponential(2.0), log=True)), 9)
    -5011.454471272
    """
    h = np.asarray(h, dtype=np.float64)
    value, scaled = fn_scaled(n, h, grading, heights=heights), (h >= 0) & isinstance(heights, Gaussian)
    if log:
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.log(value) - np.where(scaled, h * h / 2 + np.log(2 * np.pi) / 2, 0.0)
    return np.asarray(value * np.where(scaled, exp_minus_half_square(h) / np.sqrt(2 * np.pi), 1.0))


def fn_paper(n: float, h: ArrayLike, gamma: float, ngp: int) -> Array:
    """Return F*_n by the paper's own scheme, Eq. (9) corrected: Gauss-Legendre in t = exp(-s).

    As printed, Eqs. (8) and (9) do not compute F*_n: the exponential has the wrong sign
    (``exp[(-ln t)^2/2]`` diverges), and the abscissae and weights need ``exp(-h)`` in place of
    ``exp(-h/2)``. The corrected scheme converges slowly, as ngp^(-2n-2), and loses all digits below
    h = -2; it is here so that its error can be shown.

    Parameters
    ----------
    n : float
        Power of the approach.
    h : array_like
        Reduced separations, any shape.
    gamma : float
        Grading of Eq. (4); 1 is homogeneous.
    ngp : int
        Number of Gauss points.

    Returns
    -------
    ndarray
        In the shape of `h`.
    """
    h = np.asarray(h, dtype=np.float64)[..., None]
    x, w = gauss_legendre(ngp)
    log_t = np.log(x)  # of t exp(h), so that s - h = -log_t even where exp(-h) underflows
    s = h - log_t
    terms = (-log_t) ** n * np.exp(-s * s / 2) * (gamma - (gamma - 1) * np.exp(-s)) / x
    return np.asarray(terms @ w / np.sqrt(2 * np.pi))


def ratio_at_equal_load(
    quantity: str, h: ArrayLike, grading: Grading, *, heights: HeightLaw = GAUSSIAN
) -> Array:
    """Return a mean of the graded surface over that of the homogeneous one at equal load, by Hertz's law.

    Parameters
    ----------
    quantity : {"area", "stiffness", "contacts", "conductance"}
        What to compare.
    h : array_like
        Reduced separations of the homogeneous surface, which set the load.
    grading : Grading
        E*(s)/E*.
    heights : HeightLaw, optional
        Law of the heights.

    Returns
    -------
    ndarray
        ``F*_n(h2)/F_n(h)`` with h2 from ``F*_{3/2}(h2) = F_{3/2}(h)``, in the shape of `h`.

    Examples
    --------
    Stiffer tips conduct *less* at a given load, the opposite of the paper's conclusion:

    >>> import analytic
    >>> float(analytic.ratio_at_equal_load("conductance", 2.0, analytic.Exponential(2.0)).round(3))
    0.548
    """
    q = QUANTITIES[quantity]
    h = np.asarray(h, dtype=np.float64)

    def log_load(at: ArrayLike) -> Array:
        return fn(1.5, at, grading, log=True, heights=heights)

    target = fn(1.5, h, log=True, heights=heights)
    other = last_separations(log_load, target, _GRID, log_load(_GRID), "load")

    # Relative to the loads, which are equal: hardly sensitive to the last digits of h2, and no underflow.
    graded = quotient(other, (q.exponent, grading if q.modulus else None), (1.5, grading), heights)
    return graded / quotient(h, (q.exponent, None), (1.5, None), heights)
