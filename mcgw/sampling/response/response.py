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
from typing import Any

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.machine.threads import in_threads, pieces
from mcgw.sampling.cells import Mesh
from mcgw.sampling.moments import Layout
from mcgw.sampling.response.rows import Rows, hertz_rows
from mcgw.sampling.response.tree import Nodes, Tree, transfers, tree_over
from mcgw.sampling.response.walk import Entries, walk
from mcgw.scene.ensemble import EXACT
from mcgw.scene.scene import Scene

FOUR = 4  # rows and columns of a tile
_WIDTH = 64  # surfaces at a time: what a tile needs of them stays in the innermost cache


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
        surfaces = moments.shape[1]
        if surfaces < _WIDTH:
            moments = np.pad(moments, ((0, 0), (0, _WIDTH - surfaces)))
        n, flat = moments.shape[1], np.ascontiguousarray(moments).reshape(-1)
        result = np.empty((self.shape[0], n, self.shape[1]))

        def share(ends: tuple[int, int]) -> None:
            table, sums = np.empty(self.answers.size * _WIDTH), np.empty(FOUR * _WIDTH)
            for first in range(*ends, _WIDTH):
                _sweep(program, table, sums, flat, min(first, n - _WIDTH), result)  # some of the last twice

        in_threads(share, pieces(n, _WIDTH))
        return result[:, :surfaces]

    matrix = matrix_of


@njit(cache=True, fastmath={"contract"})
def _sweep(program: Any, table: Any, sums: Any, given: Any, first: Any, result: Any) -> None:
    """Take all steps for 64 surfaces from `first` on; the sum over a row has one order, in any block."""
    rows, ends, columns, values, answers = program
    surfaces, separations, tile, width = np.uint64(result.shape[1]), result.shape[2], 0, np.uint64(_WIDTH)
    for step in range(ends.size):
        sums[:] = 0.0
        while tile < ends[step]:
            column = columns[tile]
            if column < len(rows):
                a, b, c, d = rows[column]
                start = np.uint64(first)
                _add(values[tile], given, start, surfaces, (a, b, c, d), sums)
            else:
                a = FOUR * (column - len(rows))
                _add(values[tile], table, np.uint64(0), width, (a, a + 1, a + 2, a + 3), sums)
            tile += 1
        for r in range(FOUR):
            answer, at = answers[step, r], np.uint64(FOUR * step + r) * width
            for k in range(_WIDTH):
                table[at + np.uint64(k)] = sums[r * _WIDTH + k]
            for k in range(_WIDTH if answer >= 0 else 0):
                result[answer // separations, first + k, answer % separations] = sums[r * _WIDTH + k]


@njit(cache=True, fastmath={"contract"})
def _add(tile: Any, table: Any, start: Any, stride: Any, rows: Any, sums: Any) -> None:
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
    for k in range(_WIDTH):
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
    rows, entries, layout = parts.rows, parts.entries, parts.layout
    shape = len(quantities), len(scene.all_separations)
    # The T_j and the R_j of each cell, the T_j of each parent, then the answers: each begins four rows.
    of_parents = _in_fours(parts.plain[mesh.size :])
    padded = Layout(_in_fours(layout.plain), _in_fours(layout.rooted))
    begin = int(padded.starts[-1])
    end = begin + int(of_parents.sum())
    plain = np.concatenate([padded.starts[:-1], begin + np.cumsum(of_parents) - of_parents])
    given = np.full(begin, -1)
    given[padded.rows_of(layout)] = np.arange(layout.starts[-1])
    # Answers four by four such as need the same cells.
    h, rooted = np.full(shape[0] * shape[1], np.inf), np.zeros(shape[0] * shape[1], dtype=bool)
    last_first = rows.answer[::-1]  # of several rows the first counts
    h[last_first], rooted[last_first] = rows.h[::-1], rows.rooted[::-1]
    order = np.lexsort((h, ~rooted))
    places = end + np.argsort(order)
    answers = np.full(end - begin + _in_fours(len(order)), -1)  # what each computed row is
    answers[end - begin :][: len(order)] = order
    # Lines of the matrix: row, first column, number of columns.
    parent, child, moment, of_moments = transfers(mesh, parts.tree, parts.plain)
    node, root = entries.node, entries.rooted
    to_parents = plain[parent] + moment, plain[child], parts.plain[child]
    start, size = plain[node], parts.plain[node]
    start[root] += padded.plain[node[root]]
    size[root] = layout.rooted[node[root]]
    lines = np.concatenate([to_parents, (places[rows.answer[entries.row]], start, size)], axis=1)
    tiles = _tiles_of(lines, np.concatenate([of_moments, entries.coefficients]), begin, begin + len(answers))
    return Response(layout, shape, given.reshape(-1, FOUR), *tiles, answers.reshape(-1, FOUR))


def _in_fours(n: Any) -> Any:
    """Whole groups of four rows for so many."""
    return -(-n // FOUR) * FOUR


def _tiles_of(lines: Ints, values: Array, first: int, end: int) -> tuple[Ints, Ints, Array]:
    """Gather lines of the rows `first` ... `end` in tiles: how many up to each four rows, columns, values."""
    lines[2] = np.minimum(lines[2], values.shape[1])
    order = np.argsort(lines[0] // FOUR)
    most = int(((lines[1] % FOUR + lines[2] + FOUR - 1) // FOUR).sum())
    ends, columns = np.empty((end - first) // FOUR, dtype=np.int64), np.empty(most, dtype=np.int64)
    tiles = np.zeros((most, FOUR, FOUR))
    n = _fill(order, lines, values, first // FOUR, ends, columns, tiles)
    return ends, columns[:n], tiles[:n]


@njit(cache=True)
def _fill(order: Any, lines: Any, values: Any, first: Any, ends: Any, columns: Any, tiles: Any) -> Any:
    """Write what is not zero of lines, taken in this order, four rows after four; return how many tiles."""
    place = np.full(first + len(ends), -1)  # of each group of columns the tile, in the current group of rows
    tile = at = 0
    for group in range(len(ends)):
        begin, of_group = tile, at
        while at < len(order) and lines[0, order[at]] // FOUR == first + group:
            line, at = order[at], at + 1
            for j in range(lines[2, line]):
                column = (lines[1, line] + j) // FOUR
                if values[line, j] != 0.0 and place[column] < begin:
                    place[column], k = begin, tile
                    while k > begin and columns[k - 1] > column:
                        columns[k] = columns[k - 1]
                        k -= 1
                    columns[k] = column
                    tile += 1
        for k in range(begin, tile):
            place[columns[k]] = k
        for k in range(of_group, at):
            line = order[k]
            for j in range(lines[2, line]):
                column = lines[1, line] + j
                if values[line, j] != 0.0:
                    tiles[place[column // FOUR], lines[0, line] % FOUR, column % FOUR] = values[line, j]
        ends[group] = tile
    return tile
