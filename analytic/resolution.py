"""Where a grading varies: its pieces and the series that stand for it there, and negative moduli."""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from analytic.arrays import Array, Ints
from analytic.gradings import Clipped, Custom, Exponential, Grading, Homogeneous, Table
from analytic.piecewise import MOST_PIECES, PiecewiseSeries, chebyshev_points, fitted, to_coefficients
from analytic.roots import sign_changes

_LONG, _SHORT = 25, 13  # terms of polynomials: for Gauss rules, and to stand for a grading
_WIDEST = 4.0
_NEAR, _GROWTH = 64.0, 1.25  # heights up to here are looked at in equal steps, then in ever wider ones
_EDGES = 10.0 ** -np.arange(3.0, 13.0)  # a steep ramp may begin right at an edge
_CHECKS = np.concatenate([_EDGES, np.linspace(0, 1, 66)[1:-1], 1 - _EDGES])
_TINY = 2.0**-10
_TOLERANCE = 1e-14
_EVEN, _NARROW = 5.0, 2.0**-6  # greatest ratio of values on an interval, unless it is so narrow
_OF_ONE = 2.0**-52  # rounding, as of 1 - tanh(s), that is not chased into narrow intervals
_REMEMBERED = 256  # ranges, each of which every bound of a law and every slope asks again
_NOISE = 2.0**-50  # of a grading, over its greatest value: more is a mistake
_SLIVER = 64  # spacings of floats: pieces so narrow only close in on a jump
_ABOUT = 2.0**-8  # a kink is what no polynomial describes up to here on either side
_STEP, _POINTS = 0.5, np.linspace(0, 1, 33)  # heights at which a bound is looked at, between its breaks
_NEARBY = 2.0**-14  # heights on either side that tell whether a bound comes nearer
_ROUGHLY = 2.0**24  # spacings of heights to which its turn is found: it hardly moves there
Curve = Callable[[Array], Array]
_DATA = Homogeneous, Exponential, Table, PiecewiseSeries


def _misfit(terms: int, grading: Curve, low: Array, high: Array, heights: Array) -> tuple[Array, Array]:
    """How far a polynomial on each interval is from the grading at heights there, and how far it may be."""
    width = (high - low)[:, None]
    at_nodes, at_heights = grading(chebyshev_points(low, high, terms)), grading(heights)
    basis = chebyshev.chebvander(2 * (heights - low[:, None]) / width - 1, terms - 1)
    fit = np.einsum("ijk,ik->ij", basis, at_nodes @ to_coefficients(terms))
    values = np.concatenate([at_nodes, at_heights], axis=1)
    # A height is only known to its last digit: a slope of spread/width turns that into noise.
    last_digit = np.spacing(np.maximum(np.abs(low), np.abs(high)))
    noise = 4 * last_digit * np.ptp(values, axis=1) / width[:, 0]
    size = np.abs(values)
    misfit = np.abs(fit - at_heights).max(axis=1)
    if terms == _SHORT:  # which is to be as accurate next to each height, where values have one size
        narrow = width[:, 0] <= _NARROW
        uneven = size.max(axis=1) > _EVEN * size.min(axis=1)
        misfit = np.where(uneven & ~narrow, np.inf, misfit)
        noise = noise + np.where(narrow, _OF_ONE, 0.0)
    return misfit, _TOLERANCE * size.max(axis=1) + noise


def marks(low: float, high: float, step: float) -> list[float]:
    """Multiples of a step between two heights and, far from the mean, ever fewer."""
    far = [_NEAR]
    while far[-1] < max(abs(low), abs(high)):
        far.append(_GROWTH * far[-1])
    regular = np.arange(-_NEAR, _NEAR, step).tolist()
    return [x for x in (*regular, *far, *(-x for x in far)) if low < x < high]


def _spread_over(low: Array, high: Array) -> Array:
    """Heights at which a polynomial on each interval is checked, shape (intervals, heights)."""
    return np.asarray(low[:, None] + (high - low)[:, None] * _CHECKS)


def _rounding(terms: int, grading: Curve, low: Array, high: Array) -> Array:
    """Return the rounding noise of the grading: the misfit left on intervals 1000 times narrower."""
    width = np.maximum(_TINY * (high - low), 4 * np.spacing(np.maximum(np.abs(low), np.abs(high))))
    starts = [low + part * (high - low) for part in (0.19, 0.47, 0.83)]
    left = [_misfit(terms, grading, s, s + width, _spread_over(s, s + width))[0] for s in starts]
    return np.asarray(np.median(left, axis=0))  # one of the three may lie on a jump


def _bisected(terms: int, grading: Curve, edges: Array, noise_of_one: float = _NOISE) -> Array:
    """With further edges, until polynomials describe the grading on all intervals but for rounding noise."""
    left, right, noise = edges[:-1], edges[1:], np.zeros(edges.size - 1)
    most_noise = noise_of_one * np.abs(grading(_spread_over(left, right))).max()
    while left.size:
        misfit, allowed = _misfit(terms, grading, left, right, _spread_over(left, right))
        middle = (left + right) / 2
        bad = (misfit > allowed + noise) & (middle > left) & (middle < right)
        left, middle, right, noise = left[bad], middle[bad], right[bad], noise[bad]
        if left.size:
            noise = np.maximum(noise, np.minimum(8 * _rounding(terms, grading, left, right), most_noise))
        bad = misfit[bad] > allowed[bad] + noise
        left, middle, right, noise = left[bad], middle[bad], right[bad], noise[bad]
        edges = np.union1d(edges, middle)
        if edges.size > MOST_PIECES:
            raise ValueError(
                f"grading: not resolved by {MOST_PIECES} pieces near s = {middle[-1]:.6g}; is it noisy? "
                "Smooth it, or give it as a table"
            )
        left, right = np.concatenate([left, middle]), np.concatenate([middle, right])
        noise = np.concatenate([noise, noise])
    return edges


def _merged(terms: int, grading: Curve, edges: Array, kept: ArrayLike) -> Array:
    """Without the edges that no polynomial needs: neighbours are joined while one describes both."""
    size = 0
    while size != edges.size:
        size = edges.size
        for first in (0, 1):
            i = np.arange(first, edges.size - 2, 2)
            low, middle, high = edges[i], edges[i + 1], edges[i + 2]
            heights = np.concatenate([_spread_over(low, middle), _spread_over(middle, high)], axis=1)
            misfit, allowed = _misfit(terms, grading, low, high, heights)
            edges = np.delete(edges, i[(misfit <= allowed) & ~np.isin(middle, kept)] + 1)
    return edges


def resolved_breaks(grading: Grading, low: float, high: float) -> tuple[float, ...]:
    """Return the heights that cut ``[low, high]`` into pieces on which the grading is a smooth curve.

    A smooth grading is cut at its own breaks; another one is bisected until a polynomial of degree
    24 describes every piece to 1e-14 of its size there, or to its own rounding noise (as that of
    1 - tanh(s) far up). This closes in on the jumps and kinks it did not tell; features narrower
    than 1/16 that come back to where they were can go unseen and are better declared.

    Parameters
    ----------
    grading : Grading
        E*(s)/E*.
    low, high : float
        Range of reduced heights that matters.

    Returns
    -------
    tuple of float
        The cuts, in increasing order, those outside the range left out.

    Raises
    ------
    ValueError
        If more than 4096 pieces are not enough.
    """
    declared = tuple(float(b) for b in grading.breaks if low < b < high)
    if grading.smooth or not low < high:
        return tuple(np.unique(declared).tolist())
    return cuts_of(grading.__call__, declared, low, high)  # a method is equal to that of no equal grading


@lru_cache(maxsize=_REMEMBERED)
def cuts_of(
    curve: Curve, declared: tuple[float, ...], low: float, high: float, noise_of_one: float = _NOISE
) -> tuple[float, ...]:
    """As `resolved_breaks`, of any function; noise up to so much of its greatest value is no feature."""
    edges = np.unique([low, *declared, *marks(low, high, _WIDEST), high])
    edges = _bisected(_LONG, curve, edges, noise_of_one)
    return tuple(_merged(_LONG, curve, edges, declared)[1:-1].tolist())


def stretches(
    beyond: Callable[[Array, Ints], Array], grading: Grading, low: float, high: float, radii: int
) -> Array:
    """Return increasing ends of stretches on each of which heights only go beyond bounds, or only back."""
    breaks = np.array(resolved_breaks(grading, low, high))
    sides = np.concatenate([np.nextafter(breaks, -np.inf), breaks, np.nextafter(breaks, np.inf)])
    ends = np.unique([low, *sides[(low < sides) & (sides < high)], *marks(low, high, _STEP), high])
    s = np.unique(ends[:-1, None] + np.diff(ends)[:, None] * _POINTS)

    def curve(x: Array, which: Ints) -> Array:  # the arctangent rises with it, also where it is infinite
        return np.arctan(beyond(x, which))

    rises = np.diff(curve(s, np.arange(radii)[:, None])) >= 0
    bound, which, i = np.nonzero(rises[..., :-1] != rises[..., 1:])

    def rise(x: Array, n: Ints) -> Array:
        around = np.diff(curve(x + _NEARBY * np.array([[-1], [1]]), which[n]), axis=-2)
        return np.asarray(around[bound[n], 0, np.arange(n.size)])

    return np.unique([*ends, *sign_changes(rise, s[i], s[i + 2], np.full(i.size, _ROUGHLY))])


def first_negative(grading: Grading, low: float, high: float) -> float | None:
    """Find the first height between `low` and `high` where the modulus is negative, or None.

    Parameters
    ----------
    grading : Grading
        What to look at: at 4001 heights and next to every break.
    low, high : float
        Range of reduced heights.

    Returns
    -------
    float or None
        Lowest such height looked at.
    """
    breaks = np.asarray(grading.breaks, dtype=np.float64)
    around = np.concatenate([np.nextafter(breaks, -np.inf), breaks, np.nextafter(breaks, np.inf)])
    s = np.sort(np.concatenate([np.linspace(low, high, 4001), around[(around >= low) & (around <= high)]]))
    negative = s[grading(s) < 0]
    return float(negative[0]) if negative.size else None


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
    edges = _bisected(_SHORT, grading, np.unique([low, *marks(low, high, 1.0), *told, high]))
    edges = _merged(_SHORT, grading, edges, told)
    sliver = np.append(False, np.diff(edges) <= _SLIVER * np.spacing(np.abs(edges[1:])))  # left by a jump
    edges = edges[~sliver | np.isin(edges, [*told, high])]  # the one above begins there
    inner, left, right = edges[1:-1], edges[:-1], edges[1:]
    about = np.maximum(_ABOUT, _SLIVER * np.spacing(np.abs(inner)))
    below, above = np.maximum(inner - about, low), np.minimum(inner + about, high)
    misfit, allowed = _misfit(_SHORT, grading, below, above, _spread_over(below, above))
    kinks = inner[np.isin(inner, told) | (misfit > 16 * allowed)].tolist()
    series = fitted(grading, edges, _SHORT)
    ends = np.stack([left, np.nextafter(right, left)], axis=1)
    heights = [_spread_over(left, right), ends, chebyshev_points(left, right, _SHORT)]
    s = np.concatenate(heights, axis=1)  # where it is not negative, its series must not be by rounding
    lacking = np.where(np.all(grading(s) >= 0, axis=1), -2 * series(s).min(axis=1), 0.0)
    raised = [(c[0] + max(more, 0.0), *c[1:]) for c, more in zip(series.coefficients, lacking, strict=True)]
    checked = getattr(getattr(grading, "grading", grading), "checked", True)
    return PiecewiseSeries(edges.tolist(), raised, name_of(grading), kinks, checked)
