"""A binary tree over the cells: far from a separation, coarse cells serve as well as fine ones.

The uniform of a parent cell is affine in its child's, so the moments of the parent follow from those
of its children exactly: the upward pass of a fast multipole method.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from mcgw.sampling.cells import NODES, TO_COEFFICIENTS, Mesh

__all__ = ["Tree", "transfer", "tree_over"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Tree:
    """Nodes: first the cells in their order, then parents, each after its two children.

    Parameters
    ----------
    first, last : ndarray of int
        Range of cells ``first <= c < last`` of each node.
    left, right : ndarray of int
        Children of each node, -1 for a cell.
    probability : ndarray
        Of a height in each node.
    """

    first: NDArray[np.int64]
    last: NDArray[np.int64]
    left: NDArray[np.int64]
    right: NDArray[np.int64]
    probability: Array

    @property
    def size(self) -> int:
        """Number of nodes; the last one is the root."""
        return len(self.first)

    def share(self, node: int) -> float:
        """Share of the left child in its parent."""
        left, right = self.probability[self.left[node]], self.probability[self.right[node]]
        return float(left / (left + right)) if left + right > 0 else 0.5

    def offsets(self, mesh: Mesh, node: int) -> Array:
        """Heights of a node above its lower edge, at the Chebyshev points of its own uniform."""
        first, last = self.first[node], self.last[node]
        if last - first == 1:
            return mesh.offsets(int(first), (1 + NODES) / 2)
        bounds = np.concatenate([[0.0], np.cumsum(mesh.probability[first:last])])
        at = bounds[-1] * (1 + NODES) / 2
        cell = np.clip(np.searchsorted(bounds, at) - 1, 0, last - first - 1)
        u = np.clip((at - bounds[cell]) / mesh.probability[first + cell], 0.0, 1.0)
        return np.asarray((mesh.edges[first + cell] - mesh.edges[first]) + mesh.offsets(first + cell, u))


def tree_over(mesh: Mesh) -> Tree:
    """Pair neighbours, level by level, up to one root."""
    first, last = list(range(mesh.size)), list(range(1, mesh.size + 1))
    left, right = [-1] * mesh.size, [-1] * mesh.size
    probability = [float(p) for p in mesh.probability]
    level = list(range(mesh.size))
    while len(level) > 1:
        above = []
        for a, b in zip(level[::2], level[1::2], strict=False):
            above.append(len(first))
            first.append(first[a])
            last.append(last[b])
            left.append(a)
            right.append(b)
            probability.append(probability[a] + probability[b])
        level = above + level[len(level) - len(level) % 2 :]
    links = [np.array(column, dtype=np.int64) for column in (first, last, left, right)]
    return Tree(links[0], links[1], links[2], links[3], np.array(probability, dtype=np.float64))


def transfer(share: float, right: bool, rows: int, columns: int) -> Array:
    """Matrix from the moments T_k of a child to its part of the moments T_j of the parent."""
    x = share * (NODES + 1) - 1 if not right else 2 * share - 1 + (1 - share) * (NODES + 1)
    return np.asarray((TO_COEFFICIENTS @ chebyshev.chebvander(x, max(rows - 1, 0))).T[:rows, :columns])
