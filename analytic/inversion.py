"""Given the load (or area, ...), the separation; and comparisons at equal load."""

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.gradings import Grading, Homogeneous
from analytic.heights import GAUSSIAN, Gaussian, HeightLaw
from analytic.integrals import fn, quotient
from analytic.law_rule import law_rule
from analytic.quantities import QUANTITIES, Quantity

__all__ = ["ratio_at_equal_load", "separations_at", "separations_of_means"]

Array = NDArray[np.float64]

_RANGE = (-40.0, 1000.0)
_GRID = np.concatenate([np.linspace(_RANGE[0], 10, 251), np.geomspace(10.5, _RANGE[1], 60)])
_LAST_DIGITS = 4 * np.finfo(float).eps
Problem = tuple[float, Grading | None, HeightLaw, float]

_FARTHEST = 20.0  # distance of a separation from that of one radius


def separations_at(
    quantity: Quantity, log_target: Array, grading: Grading | None, heights: HeightLaw
) -> Array:
    """Largest h with ``log F*_n(h) = log_target``, in the shape of `log_target`.

    Raises
    ------
    ValueError
        If a value is not reached between h = -40 and 1000.
    """
    n = quantity.exponent

    @cache
    def on_grid() -> Array:
        """For the Gaussian law all at once; else integral by integral, and only if it has to be."""
        return fn(n, _GRID, grading, log=True, heights=heights)

    about = None if isinstance(heights, Gaussian) else _about(n, grading, heights)
    roots = []
    for target in log_target.ravel().tolist():
        problem = (n, grading, heights, target)
        bracket = None if about is None else _near(about, problem)
        if bracket is None:
            last = _last(on_grid(), target)
            if last is None:
                raise ValueError(
                    f"{quantity.name}: not reached between h = {_RANGE[0]:g} and {_RANGE[1]:g}; "
                    "give another value"
                )
            bracket = _GRID[last], _GRID[last + 1]
        roots.append(_root(*bracket, problem))
    return np.array(roots, dtype=np.float64).reshape(log_target.shape)


def _last(values: Array, target: float) -> int | None:
    """Where they are last as large as the target, with a smaller one behind it."""
    high_enough = np.flatnonzero(values >= target)
    return int(high_enough[-1]) if high_enough.size and high_enough[-1] < len(values) - 1 else None


def _about(n: float, grading: Grading | None, heights: HeightLaw) -> Array:
    """Logarithms on the grid to some digits, by the heights and probabilities of its lowest separation."""
    grading = Homogeneous() if grading is None else grading
    s, probabilities = law_rule(heights, _GRID[:1], grading, power=1, exponent=n + 1)
    approach = s - _GRID[:, None]
    terms = np.where(approach > 0, np.abs(approach) ** n, 0.0)
    with np.errstate(all="ignore"):
        return np.asarray(np.log(terms @ (probabilities * grading(s))))


def _near(about: Array, problem: Problem) -> tuple[float, float] | None:
    """Ends around the root, one step farther on either side; None where the exact integrals deny it."""
    last = _last(about, problem[-1])
    if last is None:
        return None
    left, right = _GRID[max(last - 1, 0)], _GRID[min(last + 2, len(_GRID) - 1)]
    return (left, right) if _excess(left, *problem) > 0 > _excess(right, *problem) else None


def _root(left: float, right: float, problem: Problem) -> float:
    # A target right at the end of the bracket may lie beyond it by a last digit.
    if _excess(left, *problem) <= 0:
        return left
    if _excess(right, *problem) >= 0:
        return right
    from scipy.optimize import brentq  # imports half of SciPy, which few separations are asked for

    return float(brentq(_excess, left, right, problem, xtol=1e-15, rtol=_LAST_DIGITS))


def _excess(h: float, n: float, grading: Grading | None, heights: HeightLaw, log_target: float) -> float:
    """Logarithm relative to the target; -100 also where the integral is not positive."""
    return float(np.fmax(fn(n, h, grading, log=True, heights=heights) - log_target, -100.0))


def ratio_at_equal_load(
    quantity: str, h: ArrayLike, grading: Grading, *, heights: HeightLaw = GAUSSIAN
) -> Array:
    """A mean of the graded surface relative to the homogeneous one under the same load, by Hertz's law.

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
    other = separations_at(QUANTITIES["load"], fn(1.5, h, log=True, heights=heights), grading, heights)

    # Relative to the loads, which are equal: hardly sensitive to the last digits of h2, and no underflow.
    graded = quotient(other, (q.exponent, grading if q.modulus else None), (1.5, grading), heights)
    return graded / quotient(h, (q.exponent, None), (1.5, None), heights)


def separations_of_means(mean: Callable[[float], Array], starts: Array, values: Array, name: str) -> Array:
    """Find the separations of given means, looking around those of one radius.

    Parameters
    ----------
    mean : callable
        Takes a separation to the mean, which falls.
    starts, values : ndarray
        Where to begin, and what is looked for; of one shape.
    name : str
        Of the quantity, for the message.

    Raises
    ------
    ValueError
        If a value is not reached.
    """
    from scipy.optimize import brentq  # imports half of SciPy, which few separations are asked for

    found = []
    for middle, value in zip(starts.ravel().tolist(), values.ravel().tolist(), strict=True):

        def excess(h: float, value: float = value) -> float:
            with np.errstate(divide="ignore"):
                return float(np.fmax(np.log(mean(h) / value), -100.0))

        width = 0.25
        while not excess(middle - width) > 0 > excess(middle + width):
            width *= 2
            if width > _FARTHEST:
                raise ValueError(f"{name}: {value:g} is not reached; give another value")
        found.append(brentq(excess, middle - width, middle + width, xtol=1e-13, rtol=1e-14))
    return np.array(found, dtype=np.float64).reshape(values.shape)
