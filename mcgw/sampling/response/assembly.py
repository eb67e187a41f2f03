"""From coefficients to tiles: where moments and answers stand, and what takes one to the other."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mcgw.sampling.cells import Mesh
from mcgw.sampling.layout import Layout
from mcgw.sampling.response.product import FOUR, Blocks, Tiles, in_fours
from mcgw.sampling.response.series import ContactLaws
from mcgw.sampling.response.tree import Tree, transfer

__all__ = ["Entry", "tiles_of"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Entry:
    """Coefficients of some laws on one node; `rooted` ones multiply the R_j."""

    node: int
    rooted: bool
    laws: Ints
    coefficients: Array


def tiles_of(
    mesh: Mesh, tree: Tree, laws: ContactLaws, entries: list[Entry], plain: Ints, rooted: Ints
) -> Tiles:
    """Tiles that make the sums of all laws of the moments of the cells.

    Parameters
    ----------
    mesh, tree : Mesh, Tree
        Cells, and the nodes over them.
    laws : ContactLaws
        The answers.
    entries : list of Entry
        What each node gives to them.
    plain, rooted : ndarray of int
        How many T_j each node has, and how many R_j each cell.

    Returns
    -------
    Tiles
        To apply to moments as `Layout` has them.
    """
    rows = _Rows.of(Layout(plain[: mesh.size], rooted), plain[mesh.size :])
    order = np.lexsort((laws.h, laws.exponent % 1 == 0))  # in fours that need the same cells
    answers = _answers(entries, plain, rooted, rows, np.argsort(order))
    return Tiles.of([*_transfers(mesh, tree, plain, rows), *answers], rows.given, rows.answers(order))


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
    def of(cls, cells: Layout, parents: Ints) -> "_Rows":
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


def _transfers(mesh: Mesh, tree: Tree, plain: Ints, rows: _Rows) -> list[Blocks]:
    """Blocks that make the moments of the parents."""
    blocks = []
    for node in range(mesh.size, tree.size):
        for child in (tree.left[node], tree.right[node]):
            matrix = transfer(mesh, tree, node, child)[: plain[node], : plain[child]]
            blocks.append(_blocks(rows.plain[node] + np.arange(len(matrix)), rows.plain[child], matrix.T))
    return blocks


def _answers(entries: list[Entry], plain: Ints, rooted: Ints, rows: _Rows, places: Ints) -> list[Blocks]:
    """Blocks that make the answers."""
    blocks = []
    for entry in entries:
        size, start = (rooted, rows.rooted) if entry.rooted else (plain, rows.plain)
        coefficients = entry.coefficients[: size[entry.node]]
        blocks.append(_blocks(rows.end + places[entry.laws], start[entry.node], coefficients))
    return blocks


def _blocks(rows: Ints, start: int, coefficients: Array) -> Blocks:
    """Coefficients (columns, rows) of neighbouring columns from `start` on, without blocks of zeros."""
    n = -(-len(coefficients) // FOUR)
    filled = np.zeros((n * FOUR, len(rows)))
    filled[: len(coefficients)] = coefficients
    blocks = filled.reshape(n, FOUR, len(rows)).transpose(0, 2, 1)
    block, row = np.nonzero(blocks.any(axis=2))
    return rows[row], start + FOUR * block, blocks[block, row]
