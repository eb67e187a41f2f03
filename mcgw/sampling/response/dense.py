"""The same matrix without any art: each node of the tree in turn, by plain products of small matrices.

It is as large as all moments times all answers, and so of use for small scenes: to look at, and to hold the
sparse product (`mcgw.sampling.response.product`) to.
"""

from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.sampling.cells import Mesh
from mcgw.sampling.layout import Layout
from mcgw.sampling.response.entries import Entries
from mcgw.sampling.response.tree import Tree, transfers
from mcgw.sampling.rules import product


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

    def matrix(self, answers: int) -> Array:
        """What each moment of the cells adds to each answer, shape (answers, moments)."""
        plain, rooted = self._moments_of_nodes()
        matrix, entries = np.zeros((answers, int(self.layout.starts[-1]))), self.entries
        for node, row, root, start, length in zip(
            entries.node, entries.row, entries.rooted, entries.start, entries.length, strict=True
        ):
            moments = (rooted if root else plain)[node][:length]
            matrix[self.answer[row]] += product(entries.coefficients[start:][: len(moments)], moments)
        return matrix

    def _moments_of_nodes(self) -> tuple[list[Array], list[Array]]:
        """T_j of every node and R_j of every cell, as rows of combinations of the moments of the cells."""
        itself, starts = np.eye(int(self.layout.starts[-1])), self.layout.starts
        plain = [itself[a : a + n] for a, n in zip(starts, self.layout.plain, strict=False)]
        rooted = [
            itself[b - n : b] for b, n in zip(starts[1:], self.layout.rooted, strict=True)
        ]  # after the plain ones
        plain += [np.zeros((n, len(itself))) for n in self.plain[self.mesh.size :]]
        for parent, child, j, c in zip(*transfers(self.mesh, self.tree, self.plain), strict=True):
            plain[parent][j] += product(c[: len(plain[child])], plain[child])
        return plain, rooted
