"""From the root down: give each row to the coarsest nodes that resolve it."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mcgw.machine.compiling import njit
from mcgw.sampling.cells import Mesh
from mcgw.sampling.response.entries import Entries
from mcgw.sampling.response.hertz_walk import HertzWalk
from mcgw.sampling.response.law_walk import LawWalk
from mcgw.sampling.response.nodes import Nodes
from mcgw.sampling.response.rows import Powers, Rows
from mcgw.sampling.response.tree import Tree

__all__ = ["UnresolvedError", "walk"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


class UnresolvedError(ValueError):
    """Cells are too wide for what is asked: their lower edges are its `starts`, increasing."""

    def __init__(self, starts: Array) -> None:
        self.starts = starts
        super().__init__(
            f"not resolved near s = {starts[0]:.6g}: the modulus there, or a contact law under it, bends too "
            'fast for cells; take sampler = "tail", or give a smoother grading'
        )


def walk(mesh: Mesh, tree: Tree, rows: Rows, nodes: Nodes) -> tuple[Entries, Ints, Ints]:
    """Series of all rows.

    Parameters
    ----------
    mesh, tree, nodes : Mesh, Tree, Nodes
        Cells, and the nodes over them.
    rows : Rows
        What is asked.

    Returns
    -------
    (Entries, ndarray, ndarray)
        The series; how many T_j each node must have, and how many R_j each cell.

    Raises
    ------
    UnresolvedError
        If a row is not resolved on some cells.
    ValueError
        If a row begins or ends inside a cell.
    """
    formulas = rows.formulas
    if isinstance(formulas, Powers):
        series: HertzWalk | LawWalk = HertzWalk(tree, nodes, rows, formulas)
    else:
        series = LawWalk(tree, nodes, rows, formulas)
    entries, plain, rooted, unresolved, inside = series.entries()
    if unresolved.size:
        raise UnresolvedError(unresolved)
    if np.isfinite(inside):
        raise ValueError(f"a break of the contact law at s = {inside:.6g} is not an edge of the cells")
    inherited = _inherited(plain, tree.left, tree.right)[: mesh.size]
    cell, row = rows.nearest(nodes.start[: mesh.size])
    nearest = np.ones(mesh.size, dtype=np.int64)
    np.maximum.at(nearest, cell, series.needed(cell, row))
    # In the cell's uniform the height bends, so that even the first moments of a parent take many of its. But
    # what parents stand in for are rows from farther below, smoother on this cell than the nearest ones: no
    # more of its moments count than those would need. One of them counts the asperities.
    of_parents = np.where(inherited > 1, nearest, inherited)
    plain[: mesh.size] = np.maximum(plain[: mesh.size], of_parents)
    return entries, plain, rooted[: mesh.size]


@njit(nogil=True, cache=True)
def _inherited(plain: Any, left: Any, right: Any) -> Any:
    """Moments that each node needs for its parent; parents need as many as theirs."""
    inherited = np.zeros_like(plain)
    for node in range(plain.size - 1, -1, -1):  # parents come after their children
        if left[node] >= 0:
            for child in (left[node], right[node]):
                inherited[child] = plain[node]
                if left[child] >= 0:
                    plain[child] = max(plain[child], plain[node])
    return inherited
