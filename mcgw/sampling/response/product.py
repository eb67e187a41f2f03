"""A sparse product in tiles: rows that are combinations of given rows, and of each other.

Rows go in groups of four. The given rows are the moments of the cells; after them come the moments of the
parents, each after its children, and then the answers. A tile is four rows by four columns of the matrix
from all rows that went before to the rows of a group.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.machine.in_threads import in_threads, pieces
from mcgw.sampling.block import Layout
from mcgw.sampling.cells import Mesh
from mcgw.sampling.response.rows import Rows
from mcgw.sampling.response.series import Entries
from mcgw.sampling.response.tree import Tree, transfers

FOUR = 4  # rows and columns of a tile
_WIDTH = 64  # surfaces at a time: what a tile needs of them stays in the innermost cache


class Lines(NamedTuple):
    """Pieces of rows of a matrix, one an array element; a row may have several.

    Attributes
    ----------
    row : ndarray of int
        Whose they are.
    start, length : ndarray of int
        First column, and number of columns.
    at : ndarray of int
        Where their values begin.
    values : ndarray
        Of the columns of all lines.
    """

    row: Ints
    start: Ints
    length: Ints
    at: Ints
    values: Array

    def entries(self) -> tuple[Ints, Ints, Array]:
        """Row, column and value of everything that is not zero."""
        line = np.repeat(np.arange(len(self.row)), self.length)
        along = np.arange(len(line)) - np.repeat(np.cumsum(self.length) - self.length, self.length)
        value = self.values[self.at[line] + along]
        some = np.flatnonzero(value)
        return self.row[line[some]], self.start[line[some]] + along[some], value[some]


@dataclass(frozen=True)
class Tiles:
    """Groups of given rows, and steps that compute one group each.

    Parameters
    ----------
    given : ndarray of int
        Which row each row of the given groups is, -1 for zeros; shape (groups, 4).
    ends : ndarray of int
        How many tiles are used up to each step and with it.
    columns : ndarray of int
        Group of columns of each tile.
    values : ndarray
        Shape (tiles, 4, 4): row, column.
    answers : ndarray of int
        Which answer each computed row is, -1 for none; shape (steps, 4).
    """

    given: Ints
    ends: Ints
    columns: Ints
    values: Array
    answers: Ints

    @classmethod
    def of(cls, lines: Iterable[Lines], given: Ints, answers: Ints) -> "Tiles":
        """Gather the lines of rows that follow the given ones."""
        row, column, value = map(np.concatenate, zip(*(each.entries() for each in lines), strict=True))
        groups = len(given) + len(answers)
        tile, which = np.unique(row // FOUR * groups + column // FOUR, return_inverse=True)
        values = np.zeros((len(tile), FOUR, FOUR))
        values[which, row % FOUR, column % FOUR] = value
        ends = np.searchsorted(tile // groups, np.arange(len(given), groups), side="right")
        return cls(given, ends, tile % groups, values, answers)

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
        program = self.given.ravel(), self.ends, self.columns, self.values, self.answers
        rows = self.given.size + self.answers.size
        result = np.empty((shape[0], given.shape[1], shape[1]))

        def share(ends: tuple[int, int]) -> None:
            table, sums = np.empty(rows * _WIDTH), np.empty(FOUR * _WIDTH)
            for first in range(*ends, _WIDTH):
                _sweep(program, table, sums, given, first, min(_WIDTH, ends[1] - first), result)

        in_threads(share, pieces(given.shape[1], _WIDTH))
        return result


@njit(cache=True, fastmath={"contract"})
def _sweep(program: Any, table: Any, sums: Any, given: Any, first: Any, n: Any, result: Any) -> None:
    """Take all steps for `n` surfaces from `first` on; the sum over a row has one order, in any block.

    Places in the table are unsigned: for a signed one may count from its end, and the loop is three times
    as slow.
    """
    rows, ends, columns, values, answers = program
    separations, tile, width = result.shape[2], 0, np.uint64(_WIDTH)
    for r in range(rows.size):
        filled, at = n if rows[r] >= 0 else 0, np.uint64(r) * width
        for k in range(filled):
            table[at + np.uint64(k)] = given[np.uint64(rows[r]), np.uint64(first + k)]
        for k in range(filled, _WIDTH):
            table[at + np.uint64(k)] = 0.0
    for step in range(ends.size):
        sums[:] = 0.0
        while tile < ends[step]:
            v, at = values[tile], np.uint64(FOUR * columns[tile]) * width
            a0, b0, c0, d0 = v[0, 0], v[0, 1], v[0, 2], v[0, 3]
            a1, b1, c1, d1 = v[1, 0], v[1, 1], v[1, 2], v[1, 3]
            a2, b2, c2, d2 = v[2, 0], v[2, 1], v[2, 2], v[2, 3]
            a3, b3, c3, d3 = v[3, 0], v[3, 1], v[3, 2], v[3, 3]
            for k in range(_WIDTH):
                i = np.uint64(k)
                j = at + i
                a, b = table[j], table[j + width]
                c, d = table[j + np.uint64(2) * width], table[j + np.uint64(3) * width]
                sums[i] += (a0 * a + b0 * b) + (c0 * c + d0 * d)
                sums[i + width] += (a1 * a + b1 * b) + (c1 * c + d1 * d)
                sums[i + np.uint64(2) * width] += (a2 * a + b2 * b) + (c2 * c + d2 * d)
                sums[i + np.uint64(3) * width] += (a3 * a + b3 * b) + (c3 * c + d3 * d)
            tile += 1
        at = np.uint64(rows.size + FOUR * step) * width
        for k in range(FOUR * _WIDTH):
            table[at + np.uint64(k)] = sums[k]
        for r in range(FOUR):
            answer = answers[step, r]
            for k in range(n if answer >= 0 else 0):
                result[answer // separations, first + k, answer % separations] = sums[r * _WIDTH + k]


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
    answers = np.full(rows.end - rows.given.size + _in_fours(len(order)), -1)  # what each computed row is
    answers[rows.end - rows.given.size :][: len(order)] = order
    return Tiles.of((to_parents, to_answers), rows.given, answers.reshape(-1, FOUR))


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
        starts = np.concatenate([[0], np.cumsum(_in_fours(np.concatenate([sizes, parents])))])
        of_cells, of_parents = starts[: len(sizes)], starts[len(sizes) : -1]
        given = np.full(starts[len(sizes)], -1)
        moment = np.arange(sizes.sum())
        given[np.repeat(of_cells - np.cumsum(sizes) + sizes, sizes) + moment] = moment
        plain = np.concatenate([of_cells[::2], of_parents])
        return cls(plain, of_cells[1::2], int(starts[-1]), given.reshape(-1, FOUR))


def _in_fours(rows: Any) -> Any:
    """Return the next multiple of four."""
    return (rows + FOUR - 1) // FOUR * FOUR
