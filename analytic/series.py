"""From any grading to its Chebyshev series: resolved once, it needs the function no more."""

from typing import Any

import numpy as np

from analytic.arrays import Array, Marks
from analytic.gradings import Clipped, Custom, Exponential, Grading, Homogeneous, Table
from analytic.piecewise import MOST_PIECES, PiecewiseSeries, chebyshev_points, fitted
from analytic.resolution import SHORT, bisected, marks, merged, resolved_breaks, spread_over

_DATA = Homogeneous, Exponential, Table, PiecewiseSeries
_SLIVER = 64  # spacings of floats: pieces so narrow only close in on a jump
_ABOUT = 2.0**-8  # a kink is what no polynomial describes up to here on either side


def is_data(grading: Grading) -> bool:
    """Return whether a grading is made of numbers alone, which a file can hold as they are."""
    return type(grading) in _DATA  # a class made of one may do more


def bends(grading: Grading, low: float, high: float) -> tuple[float, ...]:
    """Return `analytic.resolved_breaks` without the edges over which series go on smoothly."""
    match grading:
        case PiecewiseSeries(kinks=kinks):
            found = kinks
        case Clipped(grading=PiecewiseSeries(kinks=kinks), zeros=zeros):
            found = tuple(sorted({*kinks, *(zeros or ())}))
        case _:
            return resolved_breaks(grading, low, high)
    return tuple(s for s in found if low < s < high)


def name_of(grading: Any) -> str:
    """Return the name of the function, if there is one."""
    match grading:
        case Custom(function=function):
            return name_of(function)
        case Clipped(grading=inner):
            return f"{name_of(inner)}, clipped"
        case PiecewiseSeries(name=name):
            return name
    inner = getattr(grading, "func", grading)  # of a functools.partial
    return str(getattr(inner, "__name__", type(inner).__name__))


def resolved(grading: Grading, low: float, high: float) -> PiecewiseSeries:
    """Return the Chebyshev series that stand for a grading between two heights.

    The error is at most 1e-13 of the largest value that the grading has within 1/64 of a height, or what
    the last digit of a height makes of its slope: also where it spans many decades. Only what is below
    2e-16, or so noisy, may be off by that much. Kinks and jumps are found if they are not declared; features
    narrower than 1/80 that come back to where they were can go unseen and are better declared.

    Parameters
    ----------
    grading : Grading
        E*(s)/E*; its `breaks` become edges.
    low, high : float
        Range of reduced heights; beyond it the series keep the values at its ends.

    Returns
    -------
    PiecewiseSeries
        Never negative where the grading is not. Its `kinks` are the heights told, and those found where
        it jumps, bends, or changes within 1/256.

    Raises
    ------
    ValueError
        If more than 4096 pieces are not enough, as for noise, or a value is not finite.

    Examples
    --------
    >>> resolved(Custom(lambda s: 1 + 0.3 * abs(s - 1)), 0.0, 8.0)
    PiecewiseSeries('<lambda>', 2 pieces from s = 0 to 8)
    """
    told = np.unique([float(b) for b in grading.breaks if low < b < high])
    edges = bisected(SHORT, grading, np.unique([low, *marks(low, high, 1.0), *told, high]), MOST_PIECES)
    edges = _without_slivers(merged(SHORT, grading, edges, told), told)
    series = fitted(grading, edges, SHORT.terms).coefficients
    kinks = edges[1:-1][np.isin(edges[1:-1], told) | _bends(grading, edges)].tolist()
    checked = getattr(getattr(grading, "grading", grading), "checked", True)
    found = PiecewiseSeries(edges.tolist(), series, name_of(grading), kinks, checked)
    return _not_below(found, grading, edges[:-1], edges[1:])


def _without_slivers(edges: Array, told: Array) -> Array:
    """Without pieces that a jump left between two floats: the one above begins there."""
    sliver = np.diff(edges) <= _SLIVER * np.spacing(np.abs(edges[1:]))
    upper = np.append(False, sliver)
    drop = np.where(np.isin(edges, told) | (edges == edges[-1]), False, upper)
    return np.asarray(edges[~drop])


def _bends(grading: Grading, edges: Array) -> Marks:
    """At which inner edges no polynomial describes the grading on both sides."""
    inner = edges[1:-1]
    about = np.maximum(_ABOUT, _SLIVER * np.spacing(np.abs(inner)))
    low, high = np.maximum(inner - about, edges[0]), np.minimum(inner + about, edges[-1])
    misfit, allowed = SHORT.misfit(grading, low, high, spread_over(low, high))
    return np.asarray(misfit > 16 * allowed)


def _not_below(found: PiecewiseSeries, grading: Grading, left: Array, right: Array) -> PiecewiseSeries:
    """Return the series raised by their rounding where they are negative and the grading is not."""
    ends = np.stack([left, np.nextafter(right, left)], axis=1)
    heights = np.concatenate(
        [spread_over(left, right), ends, chebyshev_points(left, right, SHORT.terms)], axis=1
    )
    lacking = np.where(np.all(grading(heights) >= 0, axis=1), -2 * found(heights).min(axis=1), 0.0)
    raised = [(c[0] + max(more, 0.0), *c[1:]) for c, more in zip(found.coefficients, lacking, strict=True)]
    return PiecewiseSeries(found.edges, raised, found.name, found.kinks, found.checked)
