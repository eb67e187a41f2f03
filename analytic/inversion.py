"""Given the load (or area, ...), the separation; and comparisons at equal load."""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from analytic.gradings import Grading
from analytic.heights import HeightLaw
from analytic.integrals import fn, fn_scaled
from analytic.quantities import QUANTITIES, Quantity
from analytic.surface import Surface

__all__ = ["ratio_at_equal_load", "separation_at"]

Array = NDArray[np.float64]

_RANGE = (-40.0, 1000.0)
_LAST_DIGITS = 4 * np.finfo(float).eps


def separation_at(
    surface: Surface,
    quantity: str,
    value: ArrayLike,
    grading: Grading | None = None,
    *,
    law: HeightLaw | None = None,
) -> Array:
    """Separation at which a mean has a given value.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    quantity : {"load", "area", "stiffness", "contacts", "conductance"}
        What is known.
    value : array_like
        Its values, in its SI unit, any shape.
    grading : Grading, optional
        E*(s)/E*; left out: homogeneous.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        Reduced separations d/sigma; the largest one where a strongly negative modulus makes several.

    Raises
    ------
    ValueError
        If a value is not positive or not reached between h = -40 and 1000.
    """
    q = QUANTITIES[quantity]
    chosen = grading if q.modulus else None
    target = np.asarray(value, dtype=np.float64)
    per_surface = surface.n_asperities * q.scale(surface)
    if not np.all(np.isfinite(target) & (target > 0)):
        raise ValueError(f"{quantity} = {value!r}: give finite values > 0 {q.unit}")
    return _separations(q, np.log(target / per_surface), chosen, law)


def _separations(
    quantity: Quantity, log_target: Array, grading: Grading | None, law: HeightLaw | None = None
) -> Array:
    """Largest h with ``log F*_n(h) = log_target``."""
    n = quantity.exponent
    grid = np.concatenate([np.linspace(_RANGE[0], 10, 251), np.geomspace(10.5, _RANGE[1], 60)])
    on_grid = fn(n, grid, grading, log=True, law=law)
    roots = []
    for target in log_target.ravel():
        high_enough = np.flatnonzero(on_grid >= target)
        if not high_enough.size or high_enough[-1] == len(grid) - 1:
            raise ValueError(
                f"{quantity.name}: not reached between h = {_RANGE[0]:g} and {_RANGE[1]:g}; "
                "give another value"
            )
        left, right = grid[high_enough[-1] : high_enough[-1] + 2].tolist()
        roots.append(_root(left, right, (n, grading, law, target)))
    return np.array(roots, dtype=np.float64).reshape(log_target.shape)


def _root(left: float, right: float, problem: tuple[float, Grading | None, HeightLaw | None, float]) -> float:
    # A target right at the end of the bracket may lie beyond it by a last digit.
    if _excess(left, *problem) <= 0:
        return left
    if _excess(right, *problem) >= 0:
        return right
    return float(brentq(_excess, left, right, problem, xtol=1e-15, rtol=_LAST_DIGITS))


def _excess(h: float, n: float, grading: Grading | None, law: HeightLaw | None, log_target: float) -> float:
    """Logarithm relative to the target; -100 also where the integral is not positive."""
    return float(np.fmax(fn(n, h, grading, log=True, law=law) - log_target, -100.0))


def ratio_at_equal_load(quantity: str, h: ArrayLike, grading: Grading) -> Array:
    """A mean of the graded surface relative to the homogeneous one under the same load.

    Parameters
    ----------
    quantity : {"area", "stiffness", "contacts", "conductance"}
        What to compare.
    h : array_like
        Reduced separations of the homogeneous surface, which set the load.
    grading : Grading
        E*(s)/E*.

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
    other = _separations(QUANTITIES["load"], fn(1.5, h, log=True), grading)
    chosen = grading if q.modulus else None
    # Relative to the loads, which are equal: hardly sensitive to the last digits of h2, and no underflow.
    graded = fn_scaled(q.exponent, other, chosen) / fn_scaled(1.5, other, grading)
    return graded / (fn_scaled(q.exponent, h) / fn_scaled(1.5, h))
