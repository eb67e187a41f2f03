"""Moments of cells whose summits have radii of their own: each uniform counts with a power of its radius.

The load of a summit of radius ``c R`` is sqrt(c) times that of one of radius R at the same height, its area c
times. Of the uniforms u of a cell, with x = 2u - 1, a surface keeps for each power that is asked for

    T_j = sum w T_j(x),  j < plain        R_j = sum w sqrt(u) T_j(x),  j < rooted       w = sqrt(c) or c

in place of the sums of `mcgw.sampling.moments`; what turns them into loads and areas is the same. A
radius is drawn for each summit from the table of `mcgw.sampling.own_radii`, at its height: that is the
cell's lower edge and its series of the uniform.
"""

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.sampling.cells import Mesh
from mcgw.sampling.kernels import BUFFER, TOGETHER, add_weighted, unfold
from mcgw.sampling.moments import Layout, OneByOne, in_runs_of_cells
from mcgw.sampling.own_radii import Families, RadiusTable, root_ratio
from mcgw.sampling.philox import CELLS, RADII, RADII_LOW, centred

_MOST = 32  # sums of one kind: there are 21
# A thread's workspace: x, sqrt(u), two uniforms of the radius, weights, factors; then sums
_ROOT, _FINE, _COARSE, _WEIGHT, _FACTOR, _SUMS, _WORDS = (k * BUFFER for k in range(1, 8))
_PRICE = 5.0  # of a summit with its radius, in asperities


@njit(inline="always")
def _factor(w: Any, n: Any, squared: Any, rooted: Any) -> None:
    """Weight of each uniform, 0 for what fills the end."""
    for i in range(n):
        f = w[_WEIGHT + i]
        w[_FACTOR + i] = (f * f if squared else f) * (w[_ROOT + i] if rooted else 1.0)


@njit(inline="always", fastmath={"contract"})
def _weigh(w: Any, n: Any, edge: Any, series: Any, table: Any) -> Any:
    """Roots and weights of `n` uniforms; returns how many the loops take, the last ones of weight 0."""
    coefficients, bottom, largest = table
    whole = n + -n % TOGETHER
    for i in range(n, whole):
        w[i] = 1.0
        w[_WEIGHT + i] = 0.0
    for i in range(whole):
        a = b = 0.0
        for k in range(series.size - 1, 0, -1):
            a, b = 2.0 * w[i] * a + (series[k] - b), a
        u = 0.5 * w[i] + 0.5
        w[_FACTOR + i] = u * (w[i] * a + (series[0] - b)) + edge
        w[_ROOT + i] = np.sqrt(u)
    for i in range(n):
        w[_WEIGHT + i] = root_ratio(
            coefficients, bottom, largest, w[_FACTOR + i], w[_COARSE + i], w[_FINE + i]
        )
    return whole


@njit(cache=True)
def _sum_cells(who: Any, kinds: Any, mesh: Any, table: Any, counts: Any, bounds: Any, moments: Any) -> None:
    """Sum a run of cells, all surfaces of one after the other: 32 sums for each kind."""
    (seed, first), (starts, orders, squares), (edges, series) = who, kinds, mesh
    w = np.ones(_WORDS)
    surfaces = counts.shape[1]
    for at in range(bounds[0], bounds[1]):
        cell, surface = at // surfaces, at % surfaces
        n, many = counts[cell, surface], orders[cell]
        for k in range(_SUMS, _SUMS + _MOST * many.size):
            w[k] = 0.0
        for begin in range(0, n, BUFFER):
            m = min(BUFFER, n - begin)
            centred(w, seed, CELLS, first + surface, cell, begin, m)
            centred(w[_COARSE:], seed, RADII, first + surface, cell, begin, m)
            centred(w[_FINE:], seed, RADII_LOW, first + surface, cell, begin, m)
            whole = _weigh(w, m, edges[cell], series[cell], table)
            for kind in range(many.size):
                if many[kind]:
                    _factor(w, whole, squares[kind // 2], kind % 2)
                    add_weighted(w, whole, 0, many[kind], _FACTOR, _SUMS + _MOST * kind)
        for kind in range(many.size):
            sums, row = _SUMS + _MOST * kind, starts[cell, kind]
            for j in range(many[kind]):
                moments[row + j, surface] = w[sums + j]
            unfold(moments, row, many[kind], surface, surface + 1)


@dataclass(frozen=True)
class WithRadii(OneByOne):
    """A uniform and a radius for each asperity."""

    mesh: Mesh  # the cells, whose heights the radii go with
    table: RadiusTable  # the law of the radii
    families: Families  # powers of the radius that are asked for

    def moments(self, seed: int, first: int, counts: Ints, layout: Layout) -> Array:
        """Draw sums over the uniforms of each cell, each with a power of its radius, family by family.

        The same bits for any number of threads and in any block.
        """
        layouts = list(self.families.apart(layout))
        orders = np.stack([part for each in layouts for part in (each.plain, each.rooted)], axis=1)
        before = np.cumsum([0, *(each.starts[-1] for each in layouts)])
        starts = np.stack(
            [
                start + each.starts[:-1] + rooted * each.plain
                for each, start in zip(layouts, before, strict=False)
                for rooted in (0, 1)
            ],
            axis=1,
        )
        kinds = starts, orders, np.array([power == 1.0 for power in self.families.powers])
        mesh = self.mesh.edges, np.ascontiguousarray(self.mesh.stretch.T)
        who, held = (np.uint64(seed), first), (self.table.coefficients, self.table.bottom, self.table.largest)
        return in_runs_of_cells(counts, orders, _PRICE, partial(_sum_cells, who, kinds, mesh, held))

    def draws(self, asperities: float, layout: Layout) -> float:
        """Return a height and two words of a radius, which take about as long."""
        return 6 * asperities if layout.sizes.any() else 0.0
