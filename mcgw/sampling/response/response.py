"""Physics as a matrix: what each moment of each cell adds to each quantity at each separation.

On a cell above a separation every law of contact is smooth in the cell's uniform u, so its Chebyshev
coefficients turn the sums T_j into the sum of the law. On the cell that starts at the separation a
half-integer law is sqrt(u) times smooth, and takes the sums R_j. A node of the tree of cells stands in
for all its cells wherever the law is resolved on it; else its children do. No law is ever compiled: any
Python E*(s) is evaluated at 20 heights a node.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.sampling.block import Layout
from mcgw.sampling.cells import Mesh
from mcgw.sampling.response.product import Parts, Tiles, tiles_of
from mcgw.sampling.response.rows import hertz_rows
from mcgw.sampling.response.tree import Nodes, tree_over
from mcgw.sampling.response.walk import walk
from mcgw.scene.parts import EXACT
from mcgw.scene.scene import Scene


def matrix_of(response: Any) -> Array:
    """All of it as numbers, shape (quantities, separations, moments): large, slow and plain to see."""
    answers = response @ np.eye(int(response.layout.starts[-1]))
    return np.ascontiguousarray(np.moveaxis(answers, 1, 2))


@dataclass(frozen=True)
class Response:
    """A sparse matrix that runs from the moments to the answers by way of the tree.

    Parameters
    ----------
    layout : Layout
        The moments that each cell must have.
    tiles : Tiles
        Given the moments of the cells: those of the nodes, and of these the answers.
    shape : (int, int)
        Number of quantities and separations.
    """

    layout: Layout
    tiles: Tiles
    shape: tuple[int, int]

    def out_of(self, layout: Layout) -> "Response":
        """Return the same, bit by bit, out of moments of which each cell may have more than this needs."""
        there = np.append(layout.rows_of(self.layout), -1)
        return replace(self, tiles=replace(self.tiles, given=there[self.tiles.given]))

    def __matmul__(self, moments: Array) -> Array:
        """Quantities of every surface: moments (rows, surfaces) to (quantities, surfaces, separations)."""
        return self.tiles.apply(moments, self.shape)

    matrix = matrix_of


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
    return Response(parts.layout, tiles_of(parts, parts.rows.order(shape[0] * shape[1])), shape)


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
    return Parts(mesh, tree, rows, entries, plain, rooted)
