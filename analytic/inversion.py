"""The separation at a given load (or area, ...), and comparisons at equal load."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, Ints
from analytic.gradings import Grading
from analytic.heights import GAUSSIAN, HeightLaw
from analytic.integrals import fn, quotient
from analytic.quantities import QUANTITIES
from analytic.roots import sign_changes

LOWEST = -40.0  # separation that is looked at
_GRID = np.concatenate([np.linspace(LOWEST, 10, 251), np.geomspace(10.5, 1000, 60)])


def last_separations(
    log_mean: Callable[[ArrayLike], Array], log_targets: Array, grid: Array, about: Array, name: str
) -> Array:
    """Find the largest separations at which a mean has given values, in the shape of their logarithms.

    `log_mean` takes separations to the logarithm of the mean, nan where that is negative. They are looked for
    between those of an increasing grid, from where `about` says, which is the same to some digits. A value
    that is not reached there is a ValueError with the `name`.
    """
    targets = log_targets.ravel()
    each = np.arange(targets.size)

    def excess(h: Array, which: Ints) -> Array:  # -100 also where the mean is not positive
        return np.fmax(log_mean(h) - targets[which], -100.0)

    k = np.array([np.flatnonzero(about >= target).max(initial=0) for target in targets], dtype=np.int64)
    k = np.minimum(k, grid.size - 2)
    more = excess(grid[k], each)
    while (below := (k > 0) & (more < 0)).any():
        k -= below
        more = excess(grid[k], each)
    less = excess(grid[k + 1], each)
    while (above := (k < grid.size - 2) & (less >= 0)).any():
        k += above
        more, less = np.where(above, less, more), excess(grid[k + 1], each)
    if np.any(more < 0) or np.any(less >= 0):
        raise ValueError(f"{name}: not reached for h from {grid[0]:g} to {grid[-1]:.4g}; give another value")
    ends, unit = (less, more), np.ones(targets.size)
    return sign_changes(excess, grid[k + 1], grid[k], unit, at_ends=ends).reshape(log_targets.shape)


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
