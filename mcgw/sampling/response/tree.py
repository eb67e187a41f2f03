"""A binary tree over the cells: far from a separation, coarse cells serve as well as fine ones.

The variable of a cell is its uniform, that of a parent the height itself, from -1 to 1. A law of contact is
smooth in the height on wide nodes too, where it would not be in a uniform: the tail of the law of heights
is in the cells alone. The variable of a parent is affine in its child's, or a smooth function of a cell's
uniform, so its moments follow from theirs: the upward pass of a fast multipole method. Rows see its nodes by
their heights, their moduli, and how accurate a series must be there.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import Grading, resolved_breaks
from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.sampling.cells import NODES, TO_COEFFICIENTS, Mesh, tolerances
from mcgw.sampling.kernels import multiply

_SCATTER = 8  # asperities more than expected


@dataclass(frozen=True)
class Tree:
    """Nodes: first the cells in their order, then parents, each after its two children; at last the root."""

    first: NDArray[np.int64]  # first cell of each node
    last: NDArray[np.int64]  # the cell after its last one
    left: NDArray[np.int64]  # one child of each node, -1 for a cell
    right: NDArray[np.int64]  # the other
    probability: Array  # of a height in each node, shape (nodes,)
    # heights above the lower edges of nodes, at the Chebyshev points of their variables: (nodes, points)
    above: Array


@lru_cache(maxsize=8)  # another grading asks for the same
def tree_over(mesh: Mesh) -> Tree:
    """Pair neighbours, level by level, up to one root."""
    cells, size = mesh.size, max(2 * mesh.size - 1, 0)
    (first, last, left, right), probability = np.full((4, size), -1), np.empty(size)
    level = np.arange(cells)
    first[:cells], last[:cells], probability[:cells] = level, level + 1, mesh.probability
    end = cells
    while len(level) > 1:
        a, b = level[: len(level) // 2 * 2].reshape(-1, 2).T
        above = np.arange(end, end + len(a))
        first[above], last[above], left[above], right[above] = first[a], last[b], a, b
        probability[above] = probability[a] + probability[b]
        level, end = np.concatenate([above, level[2 * len(a) :]]), end + len(a)
    u = (1 + NODES) / 2
    heights = (mesh.edges[last] - mesh.edges[first])[:, None] * u
    heights[:cells] = mesh.offsets(np.arange(cells), np.repeat(u[:, None], cells, axis=1)).T
    return Tree(first, last, left, right, probability, heights)


def transfers(mesh: Mesh, tree: Tree, moments: Ints) -> tuple[Ints, Ints, Ints, Array]:
    """Return what the moments T_k of each child add to the moments T_j of its parent.

    A node has so many `moments`. Parents, children, j, and coefficients of T_0, T_1, ... of the child, shape
    (lines, order).
    """
    parent = np.repeat(np.arange(mesh.size, len(tree.left)), 2)
    child = np.stack([tree.left, tree.right], axis=1)[mesh.size :].ravel()
    start, end = mesh.edges[tree.first[parent]], mesh.edges[tree.last[parent]]
    s = (mesh.edges[tree.first[child]] - start)[:, None] + tree.above[child]
    wanted = moments[parent]
    pair = np.repeat(np.arange(len(parent)), wanted)
    moment = np.arange(len(pair)) - np.repeat(np.cumsum(wanted) - wanted, wanted)
    coefficients = np.empty((len(pair), len(NODES)))
    _transfer(
        2 * s / (end - start)[:, None] - 1, wanted, tree.left[child] >= 0, TO_COEFFICIENTS, coefficients
    )
    return parent[pair], child[pair], moment, coefficients


@njit(cache=True)
def _transfer(x: Any, moments: Any, of_parent: Any, to_coefficients: Any, coefficients: Any) -> None:
    """Series in the variable of each child of T_j(x), x the variable of its parent at the child's points."""
    order, most = x.shape[1], 2
    for wanted in moments:  # a reduction by NumPy's name imports half of SciPy
        most = max(most, wanted)
    powers, series = np.zeros((order, most)), np.empty((order, most))
    line = 0
    for pair in range(moments.size):
        for i in range(order):
            powers[i, 0], powers[i, 1] = 1.0, x[pair, i]
        for j in range(2, moments[pair]):
            for i in range(order):
                powers[i, j] = powers[i, j - 1] * (2 * x[pair, i]) - powers[i, j - 2]
        multiply(to_coefficients, powers, series)
        for j in range(moments[pair]):
            for k in range(order):
                raised = of_parent[pair] and k > j  # no degree is, but for rounding
                coefficients[line, k] = 0.0 if raised else series[k, j]
            line += 1


@dataclass(frozen=True)
class Nodes:
    """All nodes, one an array element."""

    start: Array  # height at which each begins, shape (nodes,)
    end: Array  # and ends
    above: Array  # heights above the start at the Chebyshev points of its variable, shape (nodes, points)
    moduli: Array  # E*(s)/E* there
    parent: NDArray[np.bool_]  # whether it has children
    # whether the grading has a break inside a parent, which its values at 20 heights may not show
    broken: NDArray[np.bool_]
    crowd: Array  # asperities of a surface there, at most
    even: Array  # share of the largest value that errors are held against, of rows that depend on the modulus
    noise: Array  # share that the last digit of a height makes, of the same rows
    # of a series, relative to a value on the node, or to the sum of a surface where that is sure to be larger
    accuracy: float

    @classmethod
    def of(cls, mesh: Mesh, tree: Tree, grading: Grading, n_asperities: int, accuracy: float) -> "Nodes":
        """Return the nodes of a tree, for surfaces of so many asperities."""
        start, end = mesh.edges[tree.first], mesh.edges[tree.last]
        above = tree.above
        moduli = grading(start[:, None] + above)
        kinks = np.array(resolved_breaks(grading, *mesh.range))
        inside = np.searchsorted(kinks, end) > np.searchsorted(kinks, start, side="right")
        largest = np.maximum(np.abs(moduli).max(axis=1), np.finfo(float).tiny)
        even, noise = tolerances(grading, start, above, moduli)
        return cls(
            start=start,
            end=end,
            above=above,
            moduli=moduli,
            parent=tree.left >= 0,
            broken=inside & (tree.left >= 0),
            crowd=n_asperities * tree.probability + _SCATTER,
            even=even,
            noise=noise / largest,
            accuracy=accuracy,
        )
