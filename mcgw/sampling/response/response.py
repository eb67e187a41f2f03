"""Physics as a matrix: what each moment of each cell adds to each quantity at each separation.

On a cell above a separation every law of contact is smooth in the cell's uniform u, so its Chebyshev
coefficients turn the sums T_j into the sum of the law. On the cell that starts at the separation a
half-integer law is sqrt(u) times smooth, and takes the sums R_j. A node of the tree of cells stands in
for all its cells wherever the law is resolved on it; else its children do. No law is ever compiled: any
Python E*(s) is evaluated at 20 heights a node.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mcgw.sampling.cells import NODES, Mesh
from mcgw.sampling.layout import Layout
from mcgw.sampling.response.assembly import Entry, tiles_of
from mcgw.sampling.response.dense import Parts
from mcgw.sampling.response.product import Tiles
from mcgw.sampling.response.series import ACCURACY, ContactLaws
from mcgw.sampling.response.tree import Tree, heights_above, tree_over
from mcgw.scene.scene import Scene

__all__ = ["Response", "layout_of", "response_of"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_MOST, _MOST_IN_CELL = 12, 19  # moments: what is not resolved by so many is left to the children, or refused


@dataclass(frozen=True)
class Response:
    """A sparse matrix that runs from the moments to the answers by way of the tree.

    Parameters
    ----------
    parts : Parts
        What it is made of.
    tiles : Tiles
        Given the moments of the cells: those of the nodes, and of these the answers.
    shape : (int, int)
        Number of quantities and separations.
    """

    parts: Parts
    tiles: Tiles
    shape: tuple[int, int]

    @property
    def layout(self) -> Layout:
        """The moments that each cell must have."""
        return self.parts.layout

    def __matmul__(self, moments: Array) -> Array:
        """Quantities of every surface: moments (rows, surfaces) to (quantities, surfaces, separations)."""
        return self.tiles.apply(moments, self.shape)

    def matrix(self) -> Array:
        """All of it as numbers, shape (quantities, separations, moments): large, slow and plain to see."""
        return self.parts.matrix(self.shape[0] * self.shape[1]).reshape(*self.shape, -1)


def response_of(
    scene: Scene,
    mesh: Mesh,
    quantities: tuple[str, ...],
    *,
    kept: Layout | None = None,
    accuracy: float = ACCURACY,
) -> Response:
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
    kept : Layout, optional
        The moments there are; default: as many as it takes.
    accuracy : float, optional
        Take as many moments as this needs.

    Returns
    -------
    Response
        By default accurate to 1e-13 of the largest value of each law on each cell, or of the sum of a
        surface.

    Raises
    ------
    ValueError
        If the grading is not resolved on a cell, or not by the moments there are.
    """
    tree, laws = tree_over(mesh), _laws(scene, mesh, quantities, lasting=kept is not None, accuracy=accuracy)
    parts = Parts(mesh, tree, *_walk(mesh, tree, laws, kept))
    tiles = tiles_of(mesh, tree, laws, parts.entries, parts.plain, parts.rooted)
    return Response(parts, tiles, (len(quantities), laws.separations))


def layout_of(
    scene: Scene,
    mesh: Mesh,
    quantities: tuple[str, ...],
    *,
    lasting: bool = False,
    accuracy: float = ACCURACY,
) -> Layout:
    """Moments that a response would need, without making it.

    Parameters
    ----------
    scene, mesh, quantities, accuracy
        As for a response.
    lasting : bool, optional
        Resolve the laws for surfaces of any number of contacts.

    Returns
    -------
    Layout
        Of the cells of the mesh.

    Raises
    ------
    ValueError
        If the grading is not resolved on a cell.
    """
    laws = _laws(scene, mesh, quantities, lasting=lasting, accuracy=accuracy)
    _, plain, rooted = _walk(mesh, tree_over(mesh), laws, None)
    return Layout(plain[: mesh.size], rooted)


def _laws(
    scene: Scene, mesh: Mesh, quantities: tuple[str, ...], *, lasting: bool, accuracy: float
) -> ContactLaws:
    """The laws of some quantities on a mesh, each separation once, in increasing order."""
    scene = replace(scene, separations=tuple(sorted(set(scene.separations))))
    between = (mesh.edges[0], mesh.edges[-1]) if mesh.size else (0.0, 0.0)
    return ContactLaws.of(scene, quantities, between, lasting=lasting, accuracy=accuracy)


def _walk(mesh: Mesh, tree: Tree, laws: ContactLaws, kept: Layout | None) -> tuple[list[Entry], Ints, Ints]:
    """From the root down: give each law to the coarsest nodes that resolve it."""
    entries: list[Entry] = []
    plain, rooted = np.zeros(tree.size, dtype=np.int64), np.zeros(mesh.size, dtype=np.int64)
    start = mesh.edges[tree.first]
    heights = [heights_above(mesh, tree, node) for node in range(tree.size)]
    moduli = laws.grading(start[:, None] + np.reshape(heights, (tree.size, len(NODES))))
    stack = [(tree.size - 1, np.arange(len(laws.h)), 0)] if tree.size else []
    while stack:
        node, which, inherited = stack.pop()
        a, b = start[node], mesh.edges[tree.last[node]]
        which = which[laws.h[which] < b]
        t, e = heights[node], moduli[node]
        smooth = laws.smooth_from(which, a)
        if tree.left[node] >= 0:
            smooth &= ~laws.broken_between(which, a, b)
        p = tree.probability[node]
        c, needed = laws.plain(which[smooth], a, t, e, p)
        done = needed <= (_MOST if tree.left[node] >= 0 else _MOST_IN_CELL)
        if done.any():
            entries.append(Entry(node, False, which[smooth][done], c[:, done]))
        rest = np.concatenate([which[smooth][~done], which[~smooth]])
        if tree.left[node] >= 0:
            plain[node] = max(inherited, needed[done].max(initial=0))
            stack += [(tree.left[node], rest, plain[node]), (tree.right[node], rest, plain[node])]
            continue
        if not done.all():
            raise ValueError(f"grading: not resolved near s = {a:.6g}; give its breaks, or a smoother one")
        for_parents = _for_parents(laws, a, t, e, p) if inherited > 1 else inherited
        plain[node] = max(needed.max(initial=0), for_parents)
        at_edge = which[~smooth]
        if at_edge.size:
            c, needed = laws.from_edge(at_edge, a, t, e, p)
            rooted[node] = needed.max()
            entries.append(Entry(node, True, at_edge, c))
    if kept:
        _check_kept(mesh, kept, Layout(plain[: mesh.size], rooted))
        plain[: mesh.size], rooted = kept.plain, kept.rooted
    return entries, plain, rooted


def _for_parents(laws: ContactLaws, a: float, t: Array, e: Array, p: float) -> int:
    """Moments of a cell that the moments of its parents need at most.

    In the cell's uniform the height bends, so that even the first moments of a parent take many of its. But
    what parents stand in for are laws from farther below, smoother on this cell than the nearest ones: no
    more of its moments count than those would need. One of them counts the asperities.
    """
    _, nearest = laws.plain(laws.nearest(a), a, t, e, p)
    return int(nearest.max(initial=1))


def _check_kept(mesh: Mesh, kept: Layout, needed: Layout) -> None:
    short = (needed.plain > kept.plain) | (needed.rooted > kept.rooted)
    if short.any():
        s = mesh.edges[np.flatnonzero(short)[0]]
        raise ValueError(
            f"the moments kept do not resolve this near s = {s:.4g}; simulate the scene anew with it"
        )
