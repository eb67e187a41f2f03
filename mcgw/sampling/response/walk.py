"""From the root down: give each row to the coarsest nodes that resolve it."""

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.sampling.cells import Mesh
from mcgw.sampling.response.hertz_walk import HertzWalk
from mcgw.sampling.response.law_walk import LawWalk
from mcgw.sampling.response.nodes import Nodes
from mcgw.sampling.response.rows import Powers, Rows
from mcgw.sampling.response.series import Entries
from mcgw.sampling.response.tree import Tree


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


def _inherited(plain: Ints, left: Ints, right: Ints) -> Ints:
    """Moments that each node needs for its parent; parents come to need as many as theirs, in `plain` too."""
    inherited, needed = [0] * plain.size, plain.tolist()
    links = zip(range(plain.size - 1, -1, -1), left[::-1].tolist(), right[::-1].tolist(), strict=True)
    parent = left >= 0
    for node, *children in links:  # parents come after their children
        for child in children if parent[node] else ():
            inherited[child] = needed[node]
            if parent[child]:
                needed[child] = max(needed[child], needed[node])
    plain[:] = needed
    return np.array(inherited, dtype=np.int64)
