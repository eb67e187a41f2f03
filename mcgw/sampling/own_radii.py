"""Radii of summits from uniforms: the law of a radius given the height, inverted once and tabulated.

A summit's radius is ``c R``; its sums need sqrt(c), which goes with the root of the load, and c. For a given
height the share of summits with a smaller curvature is a uniform; what is tabulated is sqrt(c) as a function
of the height and of this uniform, or of what it lacks to 1 in the upper half. Each octave of the smaller of
the two has pieces of its own, down to 2^-64, so that the flattest and the sharpest of 1e15 summits have the
right law too. On a piece sqrt(c) is a polynomial of degree 4 in the height and 5 in the uniform: a share p
of the summits becomes one of p (1 +- 2e-5), and is off by at most 3e-8 of all summits (1e-6 below alpha = 2).

The response there: one matrix for each power of the radius. Sums of load, stiffness and conductance count a
summit with the root of its radius, areas with the radius. The matrices are those of one radius; only the
moments differ (`mcgw.sampling.weighted_sums`).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from analytic import Nayak, RandomCurvature, quantity_of
from analytic.arrays import Array
from analytic.curvature import MEAN_CURVATURE
from analytic.quadrature import gauss_legendre
from mcgw.machine.compiling import njit
from mcgw.sampling.kernels import chebyshev_transform, product
from mcgw.sampling.moments import Layout
from mcgw.sampling.response.response import Response, matrix_of

_PANELS = 4  # in a unit of height
_OCTAVES, _FINE, _PARTS = 64, 8, 4  # of a uniform; those that are cut, and into how many parts
_PIECES = _FINE * _PARTS + _OCTAVES - _FINE
_IN_HEIGHT, _IN_SHARE = 5, 6  # terms
_NEVER = 1e-22  # share of the heights beyond which none is drawn
_FURTHEST, _POINTS = 46.0, 501  # logarithm of the least share, and curvatures that tell the law
_X, _W = gauss_legendre(6)


@dataclass(frozen=True, eq=False)
class RadiusTable:
    """The table of sqrt(c) by the height and the share of summits with a smaller curvature."""

    bottom: float  # reduced height at which it begins
    largest: float  # no sqrt(c) is larger
    # of powers of the height, then of the share, whose pieces from below stand before those from above:
    # shape (panels, 2 pieces, 5, 6)
    coefficients: Array

    def root_ratios(self, s: Array, centred: Array, fine: Array) -> Array:
        """sqrt(c) of summits of heights `s`, from two uniforms between -1 and 1 each."""
        return np.asarray(_root_ratios(self.coefficients, self.bottom, self.largest, s, centred, fine))


@lru_cache(maxsize=8)
def radius_table(curvature: RandomCurvature, lowest: float) -> RadiusTable:
    """Tabulate the radii of summits above `lowest`."""
    heights = Nayak(curvature.alpha)
    low = max(lowest, float(heights.ppf(np.array(_NEVER))))
    high = max(float(heights.isf(np.array(_NEVER))), low)
    first, last = np.floor(_PANELS * low), np.floor(_PANELS * high) + 1
    points = chebyshev.chebpts1(_IN_HEIGHT)
    s = (np.arange(first, last)[:, None] + (1 + points) / 2) / _PANELS
    roots = np.sqrt(MEAN_CURVATURE / _inverted(curvature.alpha, s.ravel(), _shares())).reshape(
        *s.shape, 2 * _PIECES, _IN_SHARE
    )
    to_height, to_share = _powers(_IN_HEIGHT), _powers(_IN_SHARE)
    by_height = np.moveaxis(product(to_height, np.moveaxis(roots, 1, 0).reshape(_IN_HEIGHT, -1)), 0, -1)
    by_height = by_height.reshape(len(s), 2 * _PIECES, _IN_SHARE, _IN_HEIGHT)
    by_both = product(to_share, np.moveaxis(by_height, 2, 0).reshape(_IN_SHARE, -1))
    coefficients = np.moveaxis(by_both.reshape(_IN_SHARE, len(s), 2 * _PIECES, _IN_HEIGHT), 0, -1)
    return RadiusTable(
        float(first) / _PANELS, float(np.sqrt(curvature.largest)), np.ascontiguousarray(coefficients)
    )


def _powers(n: int) -> Array:
    """From values at Chebyshev points to coefficients of powers."""
    of_series = np.stack([np.pad(chebyshev.cheb2poly(row), (0, n))[:n] for row in np.eye(n)], axis=1)
    return product(np.asarray(of_series, dtype=np.float64), chebyshev_transform(chebyshev.chebpts1(n)))


def _shares() -> Array:
    """Shares at the Chebyshev points of each piece, shape (pieces, terms)."""
    fine = np.arange(_FINE * _PARTS)
    low = np.concatenate(
        [
            2.0 ** -(fine // _PARTS + 2.0) * (1 + fine % _PARTS / _PARTS),
            2.0 ** -(np.arange(_FINE, _OCTAVES) + 2.0),
        ]
    )
    width = np.concatenate([2.0 ** -(fine // _PARTS + 2.0) / _PARTS, low[_FINE * _PARTS :]])
    return np.asarray(low[:, None] + width[:, None] * (1 + chebyshev.chebpts1(_IN_SHARE)) / 2)


def _inverted(alpha: float, s: Array, share: Array) -> Array:
    """Curvatures below, then above which a share of the summits lies: (heights, 2, *share.shape)."""
    law = RandomCurvature(alpha)
    g = _evenly_likely(law, s)
    inner = g[:-1, None] + np.diff(g, axis=0)[:, None] * _X[:, None]
    mass = (law.pdf(inner, s) * _W[:, None]).sum(axis=1) * np.diff(g, axis=0)
    density, bend = law.pdf(g, s), 1 + law.elasticity(g, s)
    below = np.cumsum(np.concatenate([g[:1] * density[:1] / bend[:1], mass]), axis=0)
    above = np.cumsum(np.concatenate([mass, -g[-1:] * density[-1:] / bend[-1:]])[::-1], axis=0)[::-1]
    wanted, found = np.log(share.ravel()), np.empty((s.size, 2, share.size))
    for side, (sum_, sign) in enumerate(((below, 1.0), (above, -1.0))):
        first = 1.0 / (sign * g * density / sum_)  # of log g by the logarithm of the share
        second = (1 / first - bend) * first * first
        for i in range(s.size):
            order = slice(None, None, int(sign))
            shares, values = np.log(sum_[order, i]), np.log(g[order, i])
            found[i, side] = np.exp(_between(wanted, shares, values, first[order, i], second[order, i]))
    return found.reshape(s.size, 2, *share.shape)


def _evenly_likely(law: RandomCurvature, s: Array) -> Array:
    """Curvatures between which about the same share lies, on a logarithmic scale to either end."""
    top = law.highest(0.0, s)
    g = np.concatenate([np.geomspace(1e-8, 0.1, 100), np.linspace(0.1, 1.05, 400)[1:]])[:, None] * top
    rise = law.pdf(g, s)
    mass = (rise[1:] + rise[:-1]) / 2 * np.diff(g, axis=0)
    below = np.cumsum(np.concatenate([g[:1] * rise[:1] / 4, mass]), axis=0)
    above = np.cumsum(np.concatenate([mass, 1e-3 * rise[-1:]])[::-1], axis=0)[::-1]
    scale = np.log(below) - np.log(above)
    ends = np.maximum(scale[0], -_FURTHEST), np.minimum(scale[-1], _FURTHEST)
    wanted = np.linspace(*ends, _POINTS)
    columns = [np.interp(wanted[:, i], scale[:, i], np.log(g[:, i])) for i in range(s.size)]
    return np.exp(np.stack(columns, axis=1))


def _between(x: Array, at: Array, value: Array, first: Array, second: Array) -> Array:
    """Hermite interpolation of degree 5 from values and two derivatives."""
    i = np.clip(np.searchsorted(at, x) - 1, 0, at.size - 2)
    width = at[i + 1] - at[i]
    t = (x - at[i]) / width
    rise = value[i + 1] - value[i]
    slopes, bends = (width * first[i], width * first[i + 1]), (width**2 * second[i], width**2 * second[i + 1])
    cubic = 10 * rise - 6 * slopes[0] - 4 * slopes[1] - 1.5 * bends[0] + 0.5 * bends[1]
    quartic = -15 * rise + 8 * slopes[0] + 7 * slopes[1] + 1.5 * bends[0] - bends[1]
    quintic = 6 * rise - 3 * slopes[0] - 3 * slopes[1] - 0.5 * bends[0] + 0.5 * bends[1]
    return np.asarray(
        value[i] + t * (slopes[0] + t * (bends[0] / 2 + t * (cubic + t * (quartic + t * quintic))))
    )


@njit(inline="always")
def root_ratio(coefficients: Any, bottom: Any, largest: Any, s: Any, centred: Any, fine: Any) -> Any:
    """sqrt(c) of one summit."""
    p = 0.5 * (1.0 - abs(centred)) + fine * 2.0**-33
    word: Any = np.float64(p).view(np.int64)
    octave = 1021 - (word >> 52)
    if octave < _FINE:
        piece = octave * _PARTS + ((word >> 50) & 3)
        y = (word & ((1 << 50) - 1)) * 2.0**-49 - 1.0
    else:
        piece = min(octave, _OCTAVES - 1) + _FINE * (_PARTS - 1)
        y = (word & ((1 << 52) - 1)) * 2.0**-51 - 1.0
    if centred > 0.0:
        piece += _PIECES
    above = (s - bottom) * _PANELS
    panel = min(max(int(above), 0), coefficients.shape[0] - 1)
    z = 2.0 * (above - panel) - 1.0
    value = 0.0
    for i in range(_IN_HEIGHT - 1, -1, -1):
        inner = coefficients[panel, piece, i, _IN_SHARE - 1]
        for j in range(_IN_SHARE - 2, -1, -1):
            inner = inner * y + coefficients[panel, piece, i, j]
        value = value * z + inner
    return min(value, largest)


@njit(cache=True)
def _root_ratios(coefficients: Any, bottom: Any, largest: Any, s: Any, centred: Any, fine: Any) -> Any:
    result = np.empty(s.size)
    for i in range(s.size):
        result[i] = root_ratio(coefficients, bottom, largest, s[i], centred[i], fine[i])
    return result


@dataclass(frozen=True)
class Families:
    """Responses side by side."""

    powers: tuple[float, ...]  # of the radius, one a family: only those that are asked for
    responses: tuple[Response, ...]  # one a family
    places: tuple[int, ...]  # where each of their quantities, family by family, stands among all
    drawn: tuple[Layout, ...] = ()  # moments of each family, where there are more than it needs

    @classmethod
    def of(
        cls, quantities: tuple[str, ...], response_to: Callable[[tuple[str, ...]], Response]
    ) -> "Families":
        """Sort quantities by their power, and have a response made for each power and its quantities."""
        power = [quantity_of(name).radius for name in quantities]
        powers = tuple(sorted(set(power)))
        groups = [[i for i, p in enumerate(power) if p == one] for one in powers]
        responses = tuple(response_to(tuple(quantities[i] for i in group)) for group in groups)
        return cls(powers, responses, tuple(i for group in groups for i in group))

    @cached_property
    def layout(self) -> Layout:
        """The moments of each cell, one family after the other."""
        parts = self._layouts
        none = [np.empty(0, dtype=np.int64)]
        return Layout(
            np.concatenate(none + [part.plain for part in parts]),
            np.concatenate(none + [part.rooted for part in parts]),
        )

    @property
    def _layouts(self) -> tuple[Layout, ...]:
        return self.drawn or tuple(response.layout for response in self.responses)

    def apart(self, layout: Layout) -> tuple[Layout, ...]:
        """Split a layout by family of moments."""
        if not self.powers:
            return ()
        plain, rooted = (np.split(x, len(self.powers)) for x in (layout.plain, layout.rooted))
        return tuple(Layout(*each) for each in zip(plain, rooted, strict=True))

    def out_of(self, layout: Layout) -> "Families":
        """Return the same, bit by bit, out of moments of which each cell may have more than this needs."""
        drawn = self.apart(layout)
        responses = tuple(x.out_of(more) for x, more in zip(self.responses, drawn, strict=True))
        return replace(self, responses=responses, drawn=drawn)

    def __matmul__(self, moments: Array) -> Array:
        """Quantities of every surface: moments (rows, surfaces) to (quantities, surfaces, separations)."""
        ends = np.cumsum([layout.starts[-1] for layout in self._layouts])
        parts = np.split(moments, ends[:-1])
        found = np.concatenate(
            [response @ part for response, part in zip(self.responses, parts, strict=True)]
        )
        answers = np.empty_like(found)
        answers[list(self.places)] = found
        return answers

    matrix = matrix_of
