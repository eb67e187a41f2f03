"""Chebyshev series on pieces: what is left of a slow or unknown function once it is evaluated."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.polynomial import chebyshev

from analytic.arrays import Array, hold
from analytic.roots import sign_changes

MOST_PIECES = 4096  # as text they stay below two megabytes
_MOST_TERMS, _MOST_NAME = 64, 200
_SAME, _SAME_END = 4e-13, 0.1  # of two resolutions: of the largest value next by, and of their ends
_INSIDE = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
_NOISE = 3e-16


@dataclass(frozen=True, repr=False)
class PiecewiseSeries:
    """Chebyshev series on neighbouring intervals: what `analytic.resolved` makes of any grading.

    Outside its outermost edges it keeps the value that it has there; at an edge it is that of the interval
    above. It is evaluated by sums, products and quotients alone: every processor gives the same bits.

    Parameters
    ----------
    edges : sequence of float
        Reduced heights, increasing, where the intervals meet and end.
    coefficients : sequence of sequences of float
        For each interval those of T_0, T_1, ... in a variable that runs from -1 to 1 over it; as
        `numpy.polynomial.chebyshev` has them.
    name : str, optional
        Of the function that it stands for; for people.
    kinks : sequence of float, optional
        Which inner edges are jumps or kinks; at the others the curve goes on smoothly.
    checked : bool, optional
        As of `Custom`.

    Raises
    ------
    ValueError
        If the edges do not increase, a number is not finite, or there are not as many series as intervals.

    Examples
    --------
    >>> ramp = PiecewiseSeries([0.0, 2.0], [[2.0, 1.0]], name="ramp")
    >>> ramp
    PiecewiseSeries('ramp', 1 piece from s = 0 to 2)
    >>> ramp(np.array([-1.0, 0.0, 0.5, 2.0, 3.0]))
    array([1. , 1. , 1.5, 3. , 3. ])
    """

    edges: Sequence[float]
    coefficients: Sequence[Sequence[float]]
    name: str = ""
    kinks: Sequence[float] = ()
    checked: bool = True
    smooth: ClassVar[bool] = True

    def __post_init__(self) -> None:
        rows = tuple(tuple(map(float, c)) for c in self.coefficients)
        hold(self, edges=tuple(map(float, self.edges)), coefficients=rows)
        hold(self, name=str(self.name)[:_MOST_NAME], kinks=tuple(map(float, self.kinks)))
        pieces = len(self.edges) - 1
        if not 1 <= pieces <= MOST_PIECES or not _rising(self.edges):
            raise ValueError(f"edges: give 2 to {MOST_PIECES + 1} finite heights that increase")
        if len(self.coefficients) != pieces:
            raise ValueError(
                f"coefficients: give {pieces} lists, one for each interval between the edges, "
                f"not {len(self.coefficients)}"
            )
        if not all(1 <= len(c) <= _MOST_TERMS and np.all(np.isfinite(c)) for c in self.coefficients):
            raise ValueError(f"coefficients: each list must have 1 to {_MOST_TERMS} finite numbers")
        if not (_rising(self.kinks) and set(self.kinks) <= set(self.breaks)):
            raise ValueError("kinks: they must increase, and each must be an inner edge")

    def __repr__(self) -> str:
        """Name and extent; the coefficients are too many to be read."""
        n = len(self.coefficients)
        pieces = f"{n} piece{'s' if n > 1 else ''}"
        return f"PiecewiseSeries({self.name!r}, {pieces} from s = {self.edges[0]:g} to {self.edges[-1]:g})"

    @property
    def breaks(self) -> tuple[float, ...]:
        """The inner edges."""
        return tuple(self.edges[1:-1])

    @cached_property
    def _table(self) -> tuple[Array, Array, Array]:
        """Lower and upper ends, shape (pieces,), and coefficients, shape (order, pieces)."""
        edges, order = np.array(self.edges), max(map(len, self.coefficients))
        padded = [[*c, *[0.0] * (order - len(c))] for c in self.coefficients]
        return edges[:-1], edges[1:], np.ascontiguousarray(np.array(padded).T)

    def __call__(self, s: Any) -> Array:
        """Its values, by Clenshaw's scheme; a small step into the complex plane gives the slope."""
        s = np.asarray(s)
        low, high, c = self._table
        piece = np.searchsorted(high[:-1], s.real, side="right")
        a, b = low[piece], high[piece]
        inside = np.clip(s.real, a, b) + (1j * s.imag if np.iscomplexobj(s) else 0.0)
        x = ((inside - a) - (b - inside)) / (b - a)
        return np.asarray(chebyshev.chebval(x, c[:, piece], tensor=False))

    def agrees(self, other: "PiecewiseSeries") -> bool:
        """Return whether both stand for one function, resolved perhaps where its last digits are others."""
        lows, highs = ([self.edges[k], other.edges[k]] for k in (0, -1))
        if not np.allclose([lows[0], highs[0]], [lows[1], highs[1]], atol=_SAME_END):
            return False
        low, high = max(lows), min(highs)
        edges = np.unique(np.clip([*self.edges, *other.edges], low, high))
        s = edges[:-1, None] + np.diff(edges)[:, None] * _INSIDE
        mine = self(s)
        return bool(np.all(np.abs(mine - other(s)) <= _SAME * np.abs(mine).max(axis=1, keepdims=True)))

    @cached_property
    def zeros(self) -> tuple[float, ...]:
        """Heights where it changes its sign; none is missed, but where it is zero to rounding alone."""
        low, high, c = self._table
        places = [*self.edges, *np.nextafter(self.edges[1:-1], -np.inf)]
        for k in np.flatnonzero(np.abs(c[0]) <= np.abs(c[1:]).sum(axis=0)):  # the others have none
            own = np.trim_zeros(c[:, k], "b")
            roots = np.sort(chebyshev.chebroots(own).real) if own.size > 1 else np.empty(0)
            between = (1 + np.clip((roots[1:] + roots[:-1]) / 2, -1, 1)) / 2
            places += (low[k] + (high[k] - low[k]) * between).tolist()
        s = np.unique(places)
        s = s[self(s) != 0]
        sign = np.sign(self(s))
        change = np.flatnonzero(sign[1:] != sign[:-1])
        behind = sign_changes(lambda x, _: self(x), s[change], s[change + 1], np.zeros(change.size))
        return tuple(behind.tolist())  # the first heights on the far side


def _rising(values: Sequence[float]) -> bool:
    return bool(np.all(np.isfinite(values)) and np.all(np.diff(values) > 0))


@cache
def to_coefficients(terms: int) -> Array:
    """Return the matrix from values at Chebyshev points to coefficients, to be multiplied from the right."""
    basis = chebyshev.chebvander(chebyshev.chebpts1(terms), terms - 1) * (2 / terms)  # orthogonal over them
    basis[:, 0] /= 2
    return np.asarray(basis)


def chebyshev_points(low: Array, high: Array, terms: int) -> Array:
    """Return so many heights on each interval, shape (intervals, terms)."""
    return np.asarray(low[:, None] + (high - low)[:, None] * (1 + chebyshev.chebpts1(terms)) / 2)


def fitted(function: Callable[[Array], Array], edges: Array, terms: int) -> PiecewiseSeries:
    """Interpolate a function of an array at the Chebyshev points of every interval between edges."""
    places = chebyshev_points(edges[:-1], edges[1:], terms)
    values = function(places.ravel()).reshape(places.shape)
    return PiecewiseSeries(edges.tolist(), [_without_noise(c) for c in values @ to_coefficients(terms)])


def _without_noise(c: Array) -> list[float]:
    """Coefficients up to the last that is more than rounding: at the ends of an interval they add up."""
    size = np.flatnonzero(np.abs(c) > _NOISE * np.abs(c).max(initial=0.0))
    return c[: size[-1] + 1].tolist() if size.size else [0.0]
