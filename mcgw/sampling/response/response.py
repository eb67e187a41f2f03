"""Physics as a matrix: what each moment of each cell adds to each quantity at each separation.

On a cell above a separation every law of contact is smooth in the cell's uniform u, so its Chebyshev
coefficients turn the sums T_j into the sum of the law. On the cell that starts at the separation a
half-integer law is sqrt(u) times smooth, and takes the sums R_j. A node of the tree of cells stands in
for all its cells wherever the law is resolved on it; else its children do. No law is ever compiled: any
Python E*(s) is evaluated at 20 heights a node.

The matrix is sparse, and kept in tiles of four rows by four columns. The given rows are the moments of the
cells; after them come the moments of the parents, each after its children, and then the answers. Each row is
a combination of rows that went before.
"""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import in_threads, njit, pieces
from mcgw.sampling.block import Layout
from mcgw.sampling.cells import Mesh
from mcgw.sampling.response.rows import Rows, hertz_rows
from mcgw.sampling.response.series import Entries
from mcgw.sampling.response.tree import Nodes, Tree, transfers, tree_over
from mcgw.sampling.response.walk import walk
from mcgw.scene.ensemble import EXACT
from mcgw.scene.scene import Scene

FOUR = 4  # rows and columns of a tile
_WIDTH = 64  # surfaces at a time: what a tile needs of them stays in the innermost cache


class Lines(NamedTuple):
    """Pieces of rows of a matrix, one an array element; a row may have several."""

    row: Ints  # whose they are
    start: Ints  # first column
    length: Ints  # number of columns
    at: Ints  # where their values begin
    values: Array  # of the columns of all lines

    def entries(self) -> tuple[Ints, Ints, Array]:
        """Row, column and value of everything that is not zero."""
        line = np.repeat(np.arange(len(self.row)), self.length)
        along = np.arange(len(line)) - np.repeat(np.cumsum(self.length) - self.length, self.length)
        value = self.values[self.at[line] + along]
        some = np.flatnonzero(value)
        return self.row[line[some]], self.start[line[some]] + along[some], value[some]


def matrix_of(response: Any) -> Array:
    """All of it as numbers, shape (quantities, separations, moments): large, slow and plain to see."""
    answers = response @ np.eye(int(response.layout.starts[-1]))
    return np.ascontiguousarray(np.moveaxis(answers, 1, 2))


@dataclass(frozen=True)
class Response:
    """A sparse matrix that runs from the moments to the answers by way of the tree."""

    layout: Layout  # the moments that each cell must have
    shape: tuple[int, int]  # number of quantities and separations
    given: Ints  # which moment each row of the given groups is, -1 for zeros; shape (groups, 4)
    ends: Ints  # a group is computed in a step: how many tiles are used up to each step and with it
    columns: Ints  # group of columns of each tile
    values: Array  # of the tiles, shape (tiles, 4, 4): row, column
    answers: Ints  # which answer each computed row is, -1 for none; shape (steps, 4)

    def out_of(self, layout: Layout) -> "Response":
        """Return the same, bit by bit, out of moments of which each cell may have more than this needs."""
        there = np.append(layout.rows_of(self.layout), -1)
        return replace(self, given=there[self.given])

    def __matmul__(self, moments: Array) -> Array:
        """Quantities of every surface: moments (rows, surfaces) to (quantities, surfaces, separations)."""
        program = np.maximum(self.given, 0), self.ends, self.columns, self.values, self.answers
        surfaces, flat = moments.shape[1], np.ascontiguousarray(moments).reshape(-1)
        result = np.empty((self.shape[0], surfaces, self.shape[1]))

        def share(ends: tuple[int, int]) -> None:
            table, sums = np.empty(self.answers.size * _WIDTH), np.empty(FOUR * _WIDTH)
            for first in range(*ends, _WIDTH):
                _sweep(program, table, sums, flat, first, min(_WIDTH, ends[1] - first), result)

        in_threads(share, pieces(surfaces, _WIDTH))
        return result

    matrix = matrix_of


@njit(cache=True, fastmath={"contract"})
def _sweep(program: Any, table: Any, sums: Any, given: Any, first: Any, n: Any, result: Any) -> None:
    """Take all steps for `n` surfaces from `first` on; the sum over a row has one order, in any block."""
    rows, ends, columns, values, answers = program
    surfaces, separations, tile, width = np.uint64(result.shape[1]), result.shape[2], 0, np.uint64(_WIDTH)
    for step in range(ends.size):
        sums[:] = 0.0
        while tile < ends[step]:
            column = columns[tile]
            if column < len(rows):
                a, b, c, d = rows[column]
                start = np.uint64(first)
                _add(values[tile], given, start, surfaces, (a, b, c, d), sums, n)
            else:
                a = FOUR * (column - len(rows))
                _add(values[tile], table, np.uint64(0), width, (a, a + 1, a + 2, a + 3), sums, n)
            tile += 1
        for r in range(FOUR):
            answer, at = answers[step, r], np.uint64(FOUR * step + r) * width
            for k in range(n):
                table[at + np.uint64(k)] = sums[r * _WIDTH + k]
            for k in range(n if answer >= 0 else 0):
                result[answer // separations, first + k, answer % separations] = sums[r * _WIDTH + k]


@njit(cache=True, fastmath={"contract"})
def _add(tile: Any, table: Any, start: Any, stride: Any, rows: Any, sums: Any, n: Any) -> None:
    """Add what a tile makes of four rows of a table, from `start` on in each.

    Places in the table are unsigned: for a signed one may count from its end, and the loop is three times
    as slow.
    """
    width = np.uint64(_WIDTH)
    ka, kb = start + np.uint64(rows[0]) * stride, start + np.uint64(rows[1]) * stride
    kc, kd = start + np.uint64(rows[2]) * stride, start + np.uint64(rows[3]) * stride
    a0, b0, c0, d0 = tile[0, 0], tile[0, 1], tile[0, 2], tile[0, 3]
    a1, b1, c1, d1 = tile[1, 0], tile[1, 1], tile[1, 2], tile[1, 3]
    a2, b2, c2, d2 = tile[2, 0], tile[2, 1], tile[2, 2], tile[2, 3]
    a3, b3, c3, d3 = tile[3, 0], tile[3, 1], tile[3, 2], tile[3, 3]
    for k in range(n):
        i = np.uint64(k)
        a, b, c, d = table[ka + i], table[kb + i], table[kc + i], table[kd + i]
        sums[i] += (a0 * a + b0 * b) + (c0 * c + d0 * d)
        sums[i + width] += (a1 * a + b1 * b) + (c1 * c + d1 * d)
        sums[i + np.uint64(2) * width] += (a2 * a + b2 * b) + (c2 * c + d2 * d)
        sums[i + np.uint64(3) * width] += (a3 * a + b3 * b) + (c3 * c + d3 * d)


@dataclass(frozen=True)
class Parts:
    """What a response is made of."""

    mesh: Mesh  # cells
    tree: Tree  # the nodes over them
    rows: Rows  # what to simulate
    entries: Entries  # what each node gives to the rows
    plain: Ints  # how many T_j each node has
    layout: Layout  # moments of the cells


def parts_of(scene: Scene, mesh: Mesh, quantities: tuple[str, ...], accuracy: float) -> Parts:
    """Series of what is asked, each separation once, in increasing order, and the moments that they need.

    Raises
    ------
    ValueError
        If the grading is not resolved on a cell.
    """
    if scene.hertzian or not quantities:  # without rows every law is the same
        rows = hertz_rows(scene, quantities)
    else:
        from mcgw.sampling.response.law_rows import law_rows

        rows = law_rows(scene, quantities, mesh)
    tree = tree_over(mesh)
    nodes = Nodes.of(mesh, tree, scene.modulus, scene.n_asperities, accuracy)
    entries, plain, rooted = walk(mesh, tree, rows, nodes)
    return Parts(mesh, tree, rows, entries, plain, Layout(plain[: mesh.size], rooted))


def response_of(scene: Scene, mesh: Mesh, quantities: tuple[str, ...]) -> Response:
    """Build the response of a mesh.

    Parameters
    ----------
    scene : Scene
        Its surface, grading, separations and number of asperities are used.
    mesh : Mesh
        Cells with every separation and every break of the grading on an edge.
    quantities : tuple of str
        Which answers there are. Each separation has its own once, in increasing order: repeated or
        permuted ones give the same bits.

    Returns
    -------
    Response
        Accurate to 1e-13 of the largest value of each law on each cell, or of the sum of a surface.

    Raises
    ------
    ValueError
        If the grading is not resolved on a cell.
    """
    parts = parts_of(scene, mesh, quantities, EXACT)
    shape = len(quantities), len(scene.all_separations)
    order = parts.rows.order(shape[0] * shape[1])  # four by four such as need the same cells
    rows, entries = _Rows.of(parts), parts.entries
    parent, child, moment, coefficients = transfers(parts.mesh, parts.tree, parts.plain)
    order_of_series = coefficients.shape[1]
    at, length = np.arange(len(parent)) * order_of_series, np.minimum(parts.plain[child], order_of_series)
    to_parents = Lines(rows.plain[parent] + moment, rows.plain[child], length, at, coefficients.ravel())
    places = np.empty_like(order)
    places[order] = np.arange(len(order))
    node, rooted = entries.node, entries.rooted
    start, size = rows.plain[node], parts.plain[node]
    start[rooted], size[rooted] = rows.rooted[node[rooted]], parts.layout.rooted[node[rooted]]
    row, length = rows.end + places[parts.rows.answer[entries.row]], np.minimum(entries.length, size)
    begin = np.cumsum(entries.length) - entries.length
    to_answers = Lines(row, start, length, begin, entries.coefficients)
    before = rows.end - rows.given.size
    answers = np.full(before - (-len(order) // FOUR) * FOUR, -1)  # what each computed row is
    answers[before:][: len(order)] = order
    line, column, value = map(np.concatenate, zip(to_parents.entries(), to_answers.entries(), strict=True))
    given = len(rows.given)
    groups = given + len(answers) // FOUR
    tile, which = np.unique(line // FOUR * groups + column // FOUR, return_inverse=True)
    values = np.zeros((len(tile), FOUR, FOUR))
    values[which, line % FOUR, column % FOUR] = value
    ends = np.searchsorted(tile // groups, np.arange(given, groups), side="right")
    tiles = ends, tile % groups, values, answers.reshape(-1, FOUR)
    return Response(parts.layout, shape, rows.given, *tiles)


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
        in_fours = -(-np.concatenate([sizes, parents]) // FOUR) * FOUR
        starts = np.concatenate([[0], np.cumsum(in_fours)])
        of_cells, of_parents = starts[: len(sizes)], starts[len(sizes) : -1]
        given = np.full(starts[len(sizes)], -1)
        moment = np.arange(sizes.sum())
        given[np.repeat(of_cells - np.cumsum(sizes) + sizes, sizes) + moment] = moment
        plain = np.concatenate([of_cells[::2], of_parents])
        return cls(plain, of_cells[1::2], int(starts[-1]), given.reshape(-1, FOUR))
