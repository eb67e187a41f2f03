"""Convolutions on panels: functions of x from 0 to 1 that are smooth in ``w = x^(1/6)``.

What one asperity adds begins as a broken power of the distance from first touch, and so does the density of
a sum of few: with ``x^(-1/3)`` for a load, ``x^(-1/2)`` at worst. As densities in w they are smooth, piece
by piece, and are held at Gauss's points of panels. With ``u = x - y`` the convolution ::

    (f * g)(x) = int_0^(x/2) [f(y) g(u) + f(u) g(y)] dy

never takes a density next to 0 but as one in w.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from analytic.arrays import Array, Ints, Marks
from analytic.quadrature import gauss_legendre

POWER = 6
_NARROW = 0.25


@lru_cache(maxsize=8)
def panels(number: int, doublings: int, nodes: int, breaks: tuple[float, ...] = ()) -> "Panels":
    """So many equal panels, then others up to 1 of x to 1.4 x, and breaks where functions are not smooth."""
    first = 2.0 ** (-doublings / POWER)
    regular = [first * k / number for k in range(1, number)]
    regular += [2.0 ** (-k / (2 * POWER)) for k in range(2 * doublings, 0, -1)]
    near = [e for e in regular if all(abs(e - b) > _NARROW * first / number for b in breaks)]
    return Panels(tuple(sorted({0.0, 1.0, *near, *breaks})), nodes, breaks)


@dataclass(frozen=True)
class Panels:
    """The points, and how values between them follow from values at them.

    Parameters
    ----------
    edges : tuple of float
        Ends of the panels in w, from 0 to 1.
    nodes : int
        Points in each.
    breaks : tuple of float
        Those of the edges at which functions are not smooth.
    """

    edges: tuple[float, ...]
    nodes: int
    breaks: tuple[float, ...] = ()

    @cached_property
    def starts(self) -> Array:
        """Of the panels."""
        return np.array(self.edges[:-1])

    @cached_property
    def widths(self) -> Array:
        """Of the panels."""
        return np.diff(self.edges)

    @cached_property
    def w(self) -> Array:
        """All points, shape (panels, nodes)."""
        return self.starts[:, None] + self.widths[:, None] * gauss_legendre(self.nodes)[0]

    @cached_property
    def x(self) -> Array:
        """The same as arguments of the law."""
        return self.w**POWER

    @cached_property
    def _barycentric(self) -> Array:
        x = gauss_legendre(self.nodes)[0]
        found = 1 / np.prod(4 * (x[:, None] - x) + np.eye(self.nodes), axis=1)
        return np.asarray(found / np.abs(found).max())

    def derivative(self, values: Array, of: Marks) -> Array:
        """By w, of values at the points of some panels; shape (..., panels, nodes)."""
        x, b = gauss_legendre(self.nodes)[0], self._barycentric
        matrix = b / b[:, None] / (x[:, None] - x + np.eye(self.nodes))
        np.fill_diagonal(matrix, 0.0)
        np.fill_diagonal(matrix, -matrix.sum(axis=1))
        return np.asarray(values @ matrix.T / self.widths[of][:, None])

    def integrals(self, values: Array) -> Array:
        """By w, over each panel."""
        return np.asarray(values @ gauss_legendre(self.nodes)[1] * self.widths)

    def integral_within(
        self, values: Array, factor: Callable[[Array], Array], w: Array, *, up: bool
    ) -> Array:
        """Of values times a factor, from each place to the end of its panel (`up`), or from its start."""
        x, weights = gauss_legendre(self.nodes)
        which = self._which(w)
        t = (w - self.starts[which]) / self.widths[which]
        at = t[:, None] + (1 - t[:, None]) * x if up else t[:, None] * x
        rows = self._between(at.ravel()).reshape(w.size, self.nodes, self.nodes)
        factors = weights * factor(self.starts[which][:, None] + at * self.widths[which][:, None])
        lengths = ((1 - t) if up else t) * self.widths[which]
        return np.asarray(np.einsum("ijk,ij,ik->i", rows, factors, values[which]) * lengths)

    def at(self, values: Array, w: Array) -> Array:
        """Values at other places."""
        which, rows = self._rows(w)
        return np.asarray(np.einsum("ij,ij->i", rows, values[which]))

    def _which(self, w: Array) -> Ints:
        return np.clip(np.searchsorted(self.edges, w, side="right") - 1, 0, self.starts.size - 1)

    def _between(self, t: Array) -> Array:
        """Weights of the values in a panel, at places from 0 to 1 in it: shape (places, nodes)."""
        rows = t[:, None] - gauss_legendre(self.nodes)[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            np.divide(self._barycentric, rows, out=rows)
            total = rows.sum(axis=1)
            rows /= total[:, None]
        hit = ~np.isfinite(total)  # a node itself
        if hit.any():
            rows[hit] = t[hit, None] == gauss_legendre(self.nodes)[0]
        return np.asarray(rows)

    def _rows(self, w: Array) -> tuple[Ints, Array]:
        """Which panels places lie in, and the weights of the values there."""
        which = self._which(w)
        return which, self._between((w - self.starts[which]) / self.widths[which])

    @cached_property
    def _points(self) -> tuple[Ints, Array, Array]:
        """Of all convolutions: number of the result, y in w, and Gauss's weight in w.

        On pieces on which both f and g are smooth, at y as well as at u = x - y.
        """
        x, weights = gauss_legendre(self.nodes)
        w = self.w.ravel()
        ends = w * 0.5 ** (1 / POWER)
        with np.errstate(invalid="ignore"):
            mirrored = (w[:, None] ** POWER - np.array(self.breaks) ** POWER) ** (1 / POWER)
        inside = (mirrored > 0) & (mirrored < ends[:, None])
        both = np.concatenate(
            [
                np.minimum(self.starts, ends[:, None]),
                np.where(inside, mirrored, ends[:, None]),
                ends[:, None],
            ],
            axis=1,
        )
        both.sort(axis=1)
        result, panel = np.nonzero(np.diff(both, axis=1) > 0)
        start, width = both[result, panel], np.diff(both, axis=1)[result, panel]
        return (
            np.repeat(result, self.nodes),
            (start[:, None] + width[:, None] * x).ravel(),
            (width[:, None] * weights).ravel(),
        )

    @cached_property
    def _pairs(self) -> tuple[tuple[Ints, Array], tuple[Ints, Array], Array, Array]:
        """Weights at y and at u of those points, y/x, and what makes of densities in w at u those at x."""
        result, y, weights = self._points
        w = self.w.ravel()[result]
        u = (w**POWER - y**POWER) ** (1 / POWER)
        return self._rows(y), self._rows(u), (y / w) ** POWER, weights * (w / u) ** (POWER - 1)

    def convolution(self, f: Array, of_share: float, constant: float) -> Array:
        """Matrix that takes g to ``int_0^x (of_share y/x + constant) f(y) g(x - y) dy``, densities in w.

        Of shape (points, points), lower triangular by panels; `f` is given at the points.
        """
        from scipy.sparse import csr_array  # few contacts are seldom asked for

        result, (y, u, share, weights) = self._points[0], self._pairs
        matrix = np.zeros((f.size, self.starts.size, self.nodes))
        for own, other, part in ((u, y, share), (y, u, 1 - share)):
            known = np.einsum("ij,ij->i", other[1], f[other[0]])
            factor = known * weights * (of_share * part + constant)
            first = np.flatnonzero(np.diff(result * self.starts.size + own[0], prepend=-1))  # in its panel
            ends, shape = np.append(first, result.size), (first.size, result.size)
            together = csr_array((factor, np.arange(result.size), ends), shape=shape)
            matrix[result[first], own[0][first]] += together @ own[1]
        return matrix.reshape(f.size, f.size)
