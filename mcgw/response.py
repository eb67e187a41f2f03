"""Physics as a matrix: what each moment of each cell adds to each quantity at each separation.

On a cell (or a node of the tree of cells) above a separation every law of contact is smooth in the
cell's uniform u, so its Chebyshev coefficients turn the sums T_j into the sum of the law. On the cell
that starts at the separation a half-integer law is sqrt(u) times smooth, and takes the sums R_j. A
node stands in for all its cells wherever the law is resolved on it; else its children do. No law is
ever compiled: any Python E*(s) is evaluated at 20 heights a node.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray

from mcgw.cells import Mesh
from mcgw.laws import ACCURACY, Laws
from mcgw.moments import Layout
from mcgw.scene import Scene
from mcgw.tree import Tree, transfer, tree_over

__all__ = ["Response", "response_of"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_MOST_MOMENTS = 18  # what is not resolved by so many is left to the children


@dataclass(frozen=True)
class Response:
    """A sparse matrix that runs from the moments to the answers by way of the tree.

    Rows are computed in order: row r is a combination of earlier rows, of which the first ones are
    the moments of the cells and the last ones the answers.

    Parameters
    ----------
    layout : Layout
        The moments that each cell must have.
    pointers, columns, values : ndarray
        Compressed sparse rows of all that is computed.
    shape : (int, int)
        Number of quantities and separations.
    """

    layout: Layout
    pointers: Ints
    columns: Ints
    values: Array
    shape: tuple[int, int]

    def __matmul__(self, moments: Array) -> Array:
        """Quantities of every surface: moments (rows, surfaces) to (quantities, separations, surfaces)."""
        answers = _apply(self.pointers, self.columns, self.values, moments, self.shape[0] * self.shape[1])
        return np.asarray(answers).reshape(*self.shape, moments.shape[1])


@njit(parallel=True, cache=True)
def _apply(pointers: Any, columns: Any, values: Any, moments: Any, answers: int) -> Any:
    """All rows for 32 surfaces at a time; the sum over a row has one order, whatever the block."""
    given, surfaces = moments.shape
    computed = pointers.size - 1
    result = np.zeros((answers, surfaces))
    for chunk in prange((surfaces + 31) // 32):
        first = chunk * 32
        n = min(32, surfaces - first)
        table = np.zeros((given + computed, 32))
        table[:given, :n] = moments[:, first : first + n]
        for r in range(computed):
            start, stop = pointers[r], pointers[r + 1]
            row = given + r
            for k in range(start, stop - 3, 4):  # four at once: the row itself is the bottleneck
                a, b, c, d = values[k], values[k + 1], values[k + 2], values[k + 3]
                ka, kb, kc, kd = columns[k], columns[k + 1], columns[k + 2], columns[k + 3]
                for i in range(32):
                    table[row, i] += (a * table[ka, i] + b * table[kb, i]) + (
                        c * table[kc, i] + d * table[kd, i]
                    )
            for k in range(stop - (stop - start) % 4, stop):
                for i in range(32):
                    table[row, i] += values[k] * table[columns[k], i]
        result[:, first : first + n] = table[given + computed - answers :, :n]
    return result


def response_of(
    scene: Scene,
    mesh: Mesh,
    quantities: tuple[str, ...],
    *,
    kept: Layout | None = None,
    lasting: bool = False,
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
        Rows of the answer.
    kept : Layout, optional
        The moments there are; left out: as many as it takes.
    lasting : bool, optional
        Resolve the laws for surfaces of any number of contacts.
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
    tree = tree_over(mesh)
    between = (mesh.edges[0], mesh.edges[-1]) if mesh.size else (0.0, 0.0)
    laws = Laws.of(scene, quantities, between, lasting=lasting or kept is not None, accuracy=accuracy)
    entries, plain, rooted = _walk(mesh, tree, laws, kept)
    layout = Layout(plain[: mesh.size], rooted)
    starts = layout.starts
    inner = starts[-1] + np.concatenate([[0], np.cumsum(plain[mesh.size :])]).astype(np.int64)
    node_row = np.concatenate([starts[:-1], inner[:-1]])
    pairs = [
        *_transfers(mesh, tree, plain, node_row),
        *_answers(entries, plain, rooted, node_row, int(inner[-1])),
    ]
    row, column, value = (np.concatenate(part) for part in zip(*pairs, strict=True)) if pairs else _NOTHING
    order = np.argsort(row, kind="stable")
    computed = int(inner[-1] - starts[-1]) + len(laws.h)
    pointers = np.searchsorted(row[order], starts[-1] + np.arange(computed + 1))
    shape = (len(quantities), len(scene.separations))
    return Response(layout, pointers, column[order], value[order], shape)


_NOTHING = (np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0))


@dataclass(frozen=True)
class _Entry:
    """Coefficients of some laws on one node; `rooted` ones multiply the R_j."""

    node: int
    rooted: bool
    laws: Ints
    coefficients: Array


def _walk(mesh: Mesh, tree: Tree, laws: Laws, kept: Layout | None) -> tuple[list[_Entry], Ints, Ints]:
    """From the root down: give each law to the coarsest nodes that resolve it."""
    entries: list[_Entry] = []
    plain, rooted = np.zeros(tree.size, dtype=np.int64), np.zeros(mesh.size, dtype=np.int64)
    stack = [(tree.size - 1, np.arange(len(laws.h)), 0)] if tree.size else []
    while stack:
        node, which, inherited = stack.pop()
        a, b = mesh.edges[tree.first[node]], mesh.edges[tree.last[node]]
        which = which[laws.h[which] < b]
        t = tree.offsets(mesh, node)
        smooth = laws.smooth_from(which, a)
        if tree.left[node] >= 0:
            smooth &= ~laws.broken_between(which, a, b)
        p = tree.probability[node]
        c, needed = laws.plain(which[smooth], a, t, p)
        done = needed <= _MOST_MOMENTS
        if done.any():
            entries.append(_Entry(node, False, which[smooth][done], c[:, done]))
        rest = np.concatenate([which[smooth][~done], which[~smooth]])
        if tree.left[node] >= 0:
            plain[node] = max(inherited, needed[done].max(initial=0))
            stack += [(tree.left[node], rest, plain[node]), (tree.right[node], rest, plain[node])]
            continue
        if not done.all():
            raise ValueError(f"grading: not resolved near s = {a:.6g}; give its breaks, or a smoother one")
        # A law is smoother the farther it is, so what the parents need of this cell is no more than
        # the nearest laws need, down to one row that counts.
        _, nearest = laws.plain(laws.nearest(a), a, t, p)
        plain[node] = max(needed.max(initial=0), min(inherited, nearest.max(initial=1)))
        at_edge = which[~smooth]
        if at_edge.size:
            c, needed = laws.from_edge(at_edge, a, t, p)
            rooted[node] = needed.max()
            entries.append(_Entry(node, True, at_edge, c))
    if kept:
        _check_kept(mesh, kept, Layout(plain[: mesh.size], rooted))
        plain[: mesh.size], rooted = kept.plain, kept.rooted
    return entries, plain, rooted


def _check_kept(mesh: Mesh, kept: Layout, needed: Layout) -> None:
    short = (needed.plain > kept.plain) | (needed.rooted > kept.rooted)
    if short.any():
        s = mesh.edges[np.flatnonzero(short)[0]]
        raise ValueError(
            f"the moments kept do not resolve this near s = {s:.4g}; simulate the scene anew with it"
        )


def _transfers(mesh: Mesh, tree: Tree, plain: Ints, node_row: Ints) -> list[tuple[Ints, Ints, Array]]:
    """Entries that make the moments of the parents."""
    pairs = []
    for node in range(mesh.size, tree.size):
        for child, right in ((tree.left[node], False), (tree.right[node], True)):
            matrix = transfer(tree.share(node), right, plain[node], plain[child])
            row, column = np.tril_indices(len(matrix), m=matrix.shape[1])  # no degree is raised
            pairs.append((node_row[node] + row, node_row[child] + column, matrix[row, column]))
    return pairs


def _answers(
    entries: list[_Entry], plain: Ints, rooted: Ints, node_row: Ints, first: int
) -> list[tuple[Ints, Ints, Array]]:
    """Entries that make the answers."""
    pairs = []
    for entry in entries:
        size = rooted[entry.node] if entry.rooted else plain[entry.node]
        start = node_row[entry.node] + (plain[entry.node] if entry.rooted else 0)
        c = entry.coefficients[:size]
        moment, law = np.nonzero(c)
        pairs.append((first + entry.laws[law], start + moment, c[moment, law]))
    return pairs
