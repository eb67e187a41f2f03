"""From coefficients to tiles: where moments and answers stand, and what takes one to the other."""

from dataclasses import dataclass

import numpy as np

from analytic.arrays import Ints
from mcgw.sampling.cells import Mesh
from mcgw.sampling.layout import Layout
from mcgw.sampling.response.gathering import FOUR, Lines, in_fours
from mcgw.sampling.response.product import Tiles
from mcgw.sampling.response.series import Entries
from mcgw.sampling.response.tree import Tree, transfers


@dataclass(frozen=True)
class Parts:
    """What a response is made of.

    Parameters
    ----------
    mesh, tree : Mesh, Tree
        Cells, and the nodes over them.
    entries : Entries
        What each node gives to the rows.
    answer : ndarray of int
        Which answer each row adds to.
    plain, rooted : ndarray of int
        How many T_j each node has, and how many R_j each cell.
    """

    mesh: Mesh
    tree: Tree
    entries: Entries
    answer: Ints
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
    rows = _Rows.of(parts)
    return Tiles.of(_transfers(parts, rows), _answers(parts, rows, order), rows.given, rows.answers(order))


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

    def answers(self, order: Ints) -> Ints:
        """Which answer each computed row is: none, but for the last ones."""
        answers = np.full(self.end - self.given.size + in_fours(len(order)), -1)
        answers[self.end - self.given.size :][: len(order)] = order
        return answers.reshape(-1, FOUR)


def _transfers(parts: Parts, rows: _Rows) -> Lines:
    """What makes the moments of the parents."""
    parent, child, moment, coefficients = transfers(parts.mesh, parts.tree, parts.plain)
    at = np.arange(len(parent)) * coefficients.shape[1]
    return Lines(rows.plain[parent] + moment, rows.plain[child], parts.plain[child], at, coefficients.ravel())


def _answers(parts: Parts, rows: _Rows, order: Ints) -> Lines:
    """What makes the answers."""
    node, rooted, entries = parts.entries.node, parts.entries.rooted, parts.entries
    places = np.empty_like(order)
    places[order] = np.arange(len(order))
    start, size = rows.plain[node], parts.plain[node]
    start[rooted], size[rooted] = rows.rooted[node[rooted]], parts.rooted[node[rooted]]
    row, length = rows.end + places[parts.answer[entries.row]], np.minimum(entries.length, size)
    return Lines(row, start, length, entries.start, entries.coefficients)
