"""A sparse product in tiles: rows that are combinations of given rows, and of each other.

Rows go in groups of four, and a group has a place in a table only from when it is fetched or computed to
when it is last needed. The given rows are the moments of cells from the lowest height to the highest, and a
computed row needs those of a range of heights: so groups are computed in one sweep from the highest cell
down, and the table is small enough to stay in the cache.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.machine.in_threads import in_threads, pieces
from mcgw.machine.memory import aligned
from mcgw.sampling.block import Layout
from mcgw.sampling.cells import Mesh
from mcgw.sampling.lanes import fused
from mcgw.sampling.response.gathering import FOUR, Lines, gathered, in_fours
from mcgw.sampling.response.rows import Rows
from mcgw.sampling.response.series import Entries
from mcgw.sampling.response.tree import Tree, transfers

_WIDTH = 64  # surfaces at a time: what they need of the table stays in the innermost cache


@dataclass(frozen=True)
class Tiles:
    """Steps, each of which fetches some groups of given rows and computes one group.

    Parameters
    ----------
    fetches : ndarray of int
        Given row of each row of each group that is fetched, -1 for zeros; shape (fetches, 4).
    fetch_ends, tile_ends : ndarray of int
        How many groups are fetched, and tiles used, up to each step and with it.
    fetched, used, computed : ndarray of int
        Place in the table of each group that is fetched, each tile's column, each step's result.
    values : ndarray
        Shape (tiles, 4, 4).
    answers : ndarray of int
        Which answer each computed row is, -1 for none; shape (steps, 4).
    """

    fetches: Ints
    fetch_ends: Ints
    fetched: Ints
    tile_ends: Ints
    used: NDArray[np.uint64]
    values: Array
    computed: Ints
    answers: Ints

    def apply(self, given: Array, shape: tuple[int, int]) -> Array:
        """Answers.

        Parameters
        ----------
        given : ndarray
            Shape (rows, surfaces).
        shape : (int, int)
            Of the answers of one surface.

        Returns
        -------
        ndarray
            Shape (shape[0], surfaces, shape[1]).
        """
        fetching = self.fetches, self.fetch_ends, self.fetched
        program = *fetching, self.tile_ends, self.used, self.values, self.computed, self.answers
        rows = int(max(self.fetched.max(initial=0), self.computed.max(initial=0))) + FOUR
        result = np.empty((shape[0], given.shape[1], shape[1]))

        def share(ends: tuple[int, int]) -> None:
            table, sums = aligned(rows * _WIDTH), aligned(FOUR * _WIDTH)
            for first in range(*ends, _WIDTH):
                _sweep(program, table, sums, given, first, min(_WIDTH, ends[1] - first), result)

        in_threads(share, pieces(given.shape[1], _WIDTH))
        return result


@njit(cache=True)
def _sweep(program: Any, table: Any, sums: Any, given: Any, first: Any, n: Any, result: Any) -> None:
    """Take all steps for `n` surfaces from `first` on; the sum over a row has one order, in any block.

    Unsigned places in the table, for a signed one may count from its end.
    """
    fetches, fetch_ends, fetched, tile_ends, used, values, computed, answers = program
    width = np.uint64(_WIDTH)
    separations = result.shape[2]
    fetch = tile = 0
    for step in range(computed.size):
        while fetch < fetch_ends[step]:
            for r in range(FOUR):
                row, at = fetches[fetch, r], np.uint64(fetched[fetch] + r) * width
                filled = n if row >= 0 else 0
                for k in range(filled):
                    table[at + np.uint64(k)] = given[np.uint64(row), np.uint64(first + k)]
                for k in range(filled, _WIDTH):
                    table[at + np.uint64(k)] = 0.0
            fetch += 1
        sums[:] = 0.0
        while tile < tile_ends[step]:
            ka = used[tile] * width
            kb, kc, kd = ka + width, ka + np.uint64(2) * width, ka + np.uint64(3) * width
            a0, b0, c0, d0 = values[tile, 0, 0], values[tile, 0, 1], values[tile, 0, 2], values[tile, 0, 3]
            a1, b1, c1, d1 = values[tile, 1, 0], values[tile, 1, 1], values[tile, 1, 2], values[tile, 1, 3]
            a2, b2, c2, d2 = values[tile, 2, 0], values[tile, 2, 1], values[tile, 2, 2], values[tile, 2, 3]
            a3, b3, c3, d3 = values[tile, 3, 0], values[tile, 3, 1], values[tile, 3, 2], values[tile, 3, 3]
            for k in range(_WIDTH):
                i = np.uint64(k)
                w, x, y, z = table[ka + i], table[kb + i], table[kc + i], table[kd + i]
                sums[i] += fused(a0, w, b0 * x) + fused(c0, y, d0 * z)
                sums[i + width] += fused(a1, w, b1 * x) + fused(c1, y, d1 * z)
                sums[i + np.uint64(2) * width] += fused(a2, w, b2 * x) + fused(c2, y, d2 * z)
                sums[i + np.uint64(3) * width] += fused(a3, w, b3 * x) + fused(c3, y, d3 * z)
            tile += 1
        at = np.uint64(computed[step]) * width
        for k in range(FOUR * _WIDTH):
            table[at + np.uint64(k)] = sums[np.uint64(k)]
        for r in range(FOUR):
            answer = answers[step, r]
            if answer >= 0:
                q, separation = answer // separations, answer % separations
                for k in range(n):
                    result[q, first + k, separation] = sums[r * _WIDTH + k]


@dataclass(frozen=True)
class Parts:
    """What a response is made of.

    Parameters
    ----------
    mesh, tree : Mesh, Tree
        Cells, and the nodes over them.
    rows : Rows
        What to simulate.
    entries : Entries
        What each node gives to the rows.
    plain, rooted : ndarray of int
        How many T_j each node has, and how many R_j each cell.
    """

    mesh: Mesh
    tree: Tree
    rows: Rows
    entries: Entries
    plain: Ints
    rooted: Ints

    @property
    def layout(self) -> Layout:
        """Moments of the cells."""
        return Layout(self.plain[: self.mesh.size], self.rooted)


def tiles_of(parts: Parts, order: Ints) -> Tiles:
    """Tiles that make the answers of the moments of the cells.

    Parameters
    ----------
    parts : Parts
        Series on the nodes of the tree.
    order : ndarray of int
        The answers, four by four such as need the same cells.

    Returns
    -------
    Tiles
        To apply to moments as `Layout` has them.
    """
    rows, entries = _Rows.of(parts), parts.entries
    parent, child, moment, coefficients = transfers(parts.mesh, parts.tree, parts.plain)
    order_of_series = coefficients.shape[1]
    at, length = np.arange(len(parent)) * order_of_series, np.minimum(parts.plain[child], order_of_series)
    to_parents = Lines(rows.plain[parent] + moment, rows.plain[child], length, at, coefficients.ravel())
    places = np.empty_like(order)
    places[order] = np.arange(len(order))
    node, rooted = entries.node, entries.rooted
    start, size = rows.plain[node], parts.plain[node]
    start[rooted], size[rooted] = rows.rooted[node[rooted]], parts.rooted[node[rooted]]
    row, length = rows.end + places[parts.rows.answer[entries.row]], np.minimum(entries.length, size)
    to_answers = Lines(row, start, length, entries.start, entries.coefficients)
    answers = np.full(rows.end - rows.given.size + in_fours(len(order)), -1)  # what each computed row is
    answers[rows.end - rows.given.size :][: len(order)] = order
    given, computed = rows.given, answers.reshape(-1, FOUR)
    found = gathered(to_parents, to_answers, len(given), len(computed))
    step, fetches, ends, fetched, tile_ends, used, values, at = found
    return Tiles(given[fetches], ends, fetched, tile_ends, used, values, at, computed[step])


@dataclass(frozen=True)
class _Rows:
    """Where things stand: the T_j and R_j of each cell, the T_j of each parent, then the answers.

    Each of them begins a group of four rows.
    """

    plain: Ints
    rooted: Ints
    end: int
    given: Ints

    @classmethod
    def of(cls, parts: Parts) -> "_Rows":
        cells, parents = parts.layout, parts.plain[parts.mesh.size :]
        sizes = np.stack([cells.plain, cells.rooted], axis=1).ravel()
        starts = np.concatenate([[0], np.cumsum(in_fours(np.concatenate([sizes, parents])))])
        of_cells, of_parents = starts[: len(sizes)], starts[len(sizes) : -1]
        given = np.full(starts[len(sizes)], -1)
        moment = np.arange(sizes.sum())
        given[np.repeat(of_cells - np.cumsum(sizes) + sizes, sizes) + moment] = moment
        plain = np.concatenate([of_cells[::2], of_parents])
        return cls(plain, of_cells[1::2], int(starts[-1]), given.reshape(-1, FOUR))
