"""The integrals F_n and F*_n of the theory, to 1e-13 at any separation (Eqs. 2, 3, 7-9).

With s = h + v^2 the integrand ``2 v^(2n+1) g(h + v^2) phi(h + v^2)`` is analytic in v for every
half-integer n, so Gauss-Legendre in v converges exponentially, whatever the smooth grading g; for other
n pieces shrink towards the separation. For h >= 0 everything is relative to phi(h), so nothing
underflows before the answer does.
"""

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.gradings import Grading, Homogeneous
from analytic.heights import GAUSSIAN, Gaussian, HeightLaw, exp_minus_half_square
from analytic.law_rule import law_integral
from analytic.quadrature import NEAREST, REACH, WIDEST, gauss_legendre, panel, towards
from analytic.resolution import resolved_breaks
from analytic.steep import Weight, tame

_TRIED = 9  # separations of a column at which the reach is looked for
_BLOCK = 192  # separations at a time: nodes x block x 8 bytes stay in the cache


def _top(above: Array, reach: float) -> Array:
    """Where the density is lower than at `above` by as much as it is at `reach` than at 0."""
    return np.asarray(above + reach**2 / (above + np.sqrt(above * above + reach**2)))


def _reaches(grading: Grading, h: Array, above: Array) -> tuple[float, float]:
    """Reach on either side that serves all separations of a sorted column."""
    if tame(grading):
        return REACH, REACH
    weight = Weight(lambda s: -s * s / 2, grading, 1)
    upper = lower = REACH
    for k in np.unique(np.linspace(0, len(h) - 1, _TRIED).astype(int)):
        start = max(float(above[k, 0]), 0.0)
        found = weight.reach(start, float(_top(np.array(start), REACH)), np.inf)
        upper = max(upper, float(np.sqrt(found**2 - start**2)))
    if h[0, 0] < -REACH:
        lower = -weight.reach(0.0, -REACH, float(h[0, 0]))
    return upper, lower


def _sorted(n: float, h: Array, grading: Grading) -> Array:
    """Scaled integral for a sorted column of separations, cut at the breaks and at the mean height."""
    above = np.maximum(h, 0.0)
    upper, lower = _reaches(grading, h, above)
    top = _top(above, upper)
    bottom = np.minimum(np.maximum(h, -lower), top)
    cuts = [0.0, *resolved_breaks(grading, float(bottom[0, 0]), float(top[-1, 0]))]
    if max(upper, lower) > REACH:  # farther than what one rule resolves of the density
        cuts += (np.arange(np.ceil(bottom[0, 0] / WIDEST), top[-1, 0] / WIDEST) * WIDEST).tolist()
    inner = [h * 0 + cut for cut in cuts]
    if (2 * n) % 1:  # the power is no polynomial of the root of s - h
        inner += [h + step for step in towards(0.0, NEAREST)]
    edges = np.sort(np.clip([bottom, *inner, top], bottom, top), axis=0)
    result = np.zeros_like(h)
    for low, high in pairwise(edges):
        inside = np.flatnonzero(high > low)
        for k in range(0, inside.size, _BLOCK):
            i = inside[k : k + _BLOCK]
            result[i] += panel(n, h[i], grading, low[i], high[i])
    return np.where(h >= 0, result, result / np.sqrt(2 * np.pi))


def quotient(
    h: ArrayLike, above: tuple[float, Grading | None], below: tuple[float, Grading | None], heights: HeightLaw
) -> Array:
    """Quotient of two integrals, each by its power and grading, also where both underflow."""
    a, b = (fn_scaled(n, h, grading, heights=heights) for n, grading in (above, below))
    return a / b


def fn_scaled(
    n: float, h: ArrayLike, grading: Grading | None = None, *, heights: HeightLaw = GAUSSIAN
) -> Array:
    """Return F_n or F*_n relative to the density at the separation.

    Parameters
    ----------
    n : float
        Power of the approach, not negative.
    h : array_like
        Reduced separations d/sigma, any shape.
    grading : Grading, optional
        E*(s)/E*; default: homogeneous.
    heights : HeightLaw, optional
        Law of the heights.

    Returns
    -------
    ndarray
        ``F(h)/phi(h)`` for h >= 0, ``F(h)`` for h < 0, in the shape of `h`; for another law ``F(h)``.

    Raises
    ------
    ValueError
        If `n` is negative or not finite, or a separation is not finite.
    """
    h = np.asarray(h, dtype=np.float64)
    if not 0 <= n < np.inf:
        raise ValueError(f"n = {n!r}: give a finite number that is not negative")
    if not np.all(np.isfinite(h)):
        raise ValueError("h: every separation must be finite")
    grading = Homogeneous() if grading is None else grading
    if not isinstance(heights, Gaussian):
        return law_integral(n, h, heights, grading)
    order = np.argsort(h, axis=None)
    ordered = h.reshape(-1, 1)[order] + 0.0  # makes -0.0 the same as 0.0
    result = np.empty(h.size)
    gaps = np.flatnonzero(np.diff(ordered[:, 0]) > 2 * REACH) + 1  # no need to know the grading in between
    for i in np.split(np.arange(h.size), gaps) if h.size else ():
        result[order[i]] = _sorted(n, ordered[i], grading)[:, 0]
    return result.reshape(h.shape)


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
    function D, and ``F*_n(h) = gamma F_n(h) - (gamma-1) sqrt(e) F_n(h+1)`` for Eq. 4. The quadrature
    used here is the more accurate way to evaluate it and takes any grading; the tests hold it to both.

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
        to 1e-12 as far as its density reaches in double precision.

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
    value = fn_scaled(n, h, grading, heights=heights)
    relative = (h >= 0) & isinstance(heights, Gaussian)
    above = np.where(relative, h, 0.0)
    if log:
        with np.errstate(divide="ignore", invalid="ignore"):
            density = np.where(relative, above * above / 2 + np.log(2 * np.pi) / 2, 0.0)
            return np.asarray(np.log(value) - density)
    density = np.where(relative, exp_minus_half_square(above) / np.sqrt(2 * np.pi), 1.0)
    return np.asarray(value * density)


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
