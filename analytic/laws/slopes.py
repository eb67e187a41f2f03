"""How fast sums grow when a surface comes nearer: within the pieces of a law, and where pieces change."""

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from analytic.gradings import Grading
from analytic.heights import HeightLaw
from analytic.laws.branch import LoadingBranch
from analytic.laws.crossings import Bound, crossings_of
from analytic.laws.spot import piece_of
from analytic.resolution import resolved_breaks

__all__ = ["jump_terms", "slope_term"]

Array = NDArray[np.float64]

_COMPLEX_STEP = 1e-30
_TOUCH = 1e-60  # root of the penetration at first touch: at 0 itself slopes are 0/0
_ABOUT, _NODES = 2.0**-6, 16  # of the fit from which the slope of a bound is taken
_JUMP = 1e-9  # a bound that misses by more jumps over the penetration


def slope_term(quantity: str, branch: LoadingBranch, penetration: Array, e: Array) -> Array:
    """Derivative by the penetration of what asperities add, within the piece that holds.

    Parameters
    ----------
    quantity : str
        Its name.
    branch : LoadingBranch
        With the law in reduced units.
    penetration, e : ndarray
        Reduced penetration s - h, negative without contact, and modulus E*(s)/E*; of any shapes that
        broadcast.

    Returns
    -------
    ndarray
        In the common shape of penetration and modulus, 0 without contact.
    """
    penetration, e = np.broadcast_arrays(penetration, e)
    piece = piece_of(branch.law, penetration, e)
    result = np.zeros(penetration.shape)
    for j in np.unique(piece[penetration > 0]):
        here = (piece == j) & (penetration > 0)
        y = np.sqrt(penetration[here])
        step = _COMPLEX_STEP * y
        value = branch.of_some(here).of_root(quantity, int(j), y + 1j * step, e[here])
        result[here] = np.imag(value) / step / (2 * y)
    return result


def jump_terms(
    quantity: str,
    branch: LoadingBranch,
    grading: Grading,
    heights: HeightLaw,
    separations: Array,
    ends: tuple[float, float],
) -> Array:
    """What asperities add to the slope of the mean by jumping: at first touch and from piece to piece.

    An asperity of height t jumps by D when the separation is that at which ``t - h = limit(e(t))``. As the
    surface comes nearer by dh, those of a range of ``dh/abs(1 - d limit/dt)`` heights do so.

    Parameters
    ----------
    quantity : str
        Its name.
    branch, grading, heights
        In reduced units.
    separations : ndarray
        Reduced separations, shape (k,).
    ends : (float, float)
        Range of heights that count.

    Returns
    -------
    ndarray
        Shape (k,).
    """
    (low, high), law = ends, branch.law
    e = grading(separations)
    total = np.zeros(separations.shape)
    touch = np.full(separations.shape, _TOUCH)
    for j in np.unique(piece_of(law, 0 * separations, e)):
        first = branch.of_root(quantity, int(j), touch, e)
        total += np.where(piece_of(law, 0 * separations, e) == j, first, 0.0) * heights.density(separations)
    for j in range(len(law.limits(np.ones(1)))):

        def bound(s: Array, j: int = j) -> Array:
            return np.asarray(law.limits(grading(s))[j])

        found = crossings_of(bound, grading, separations, low, high)
        t, h = found.height, separations[found.separation]
        y, e = np.sqrt(np.maximum(t - h, 0.0)), grading(t)
        jump = branch.of_root(quantity, j + 1, y, e) - branch.of_root(quantity, j, y, e)
        met = jump * heights.density(t) * _shares(bound, grading, t, h, ends)
        np.add.at(total, found.separation, met)
    return total


def _shares(bound: Bound, grading: Grading, t: Array, h: Array, ends: tuple[float, float]) -> Array:
    """Heights that cross the bound for each unit of the separation; none where the bound jumps."""
    breaks = np.array([ends[0], *resolved_breaks(grading, *ends), ends[1]])
    shares = []
    for s, level in zip(t, h, strict=True):
        both = np.array([np.nextafter(s, -np.inf), s])
        with np.errstate(divide="ignore", over="ignore"):
            missed = np.abs(both - level - bound(both))
        if not np.all(missed <= _JUMP * np.maximum(1, np.abs(both - level))):
            shares.append(0.0)
            continue
        k = int(np.clip(np.searchsorted(breaks, s, side="right"), 1, breaks.size - 1))
        left, right = max(breaks[k - 1], s - _ABOUT), min(np.nextafter(breaks[k], -np.inf), s + _ABOUT)
        shares.append(1 / abs(1 - _slope(bound, float(s), float(left), float(right))))
    return np.array(shares)


def _slope(bound: Bound, s: float, left: float, right: float) -> float:
    """Derivative of a bound, by the polynomial through some of its values."""
    x = chebyshev.chebpts1(_NODES)
    values = bound(left + (right - left) * (1 + x) / 2)
    c = chebyshev.chebder(chebyshev.chebfit(x, values, _NODES - 1))
    return float(chebyshev.chebval(2 * (s - left) / (right - left) - 1, c)) * 2 / (right - left)
