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
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from analytic import QUANTITIES, Grading, Surface
from mcgw.cells import NODES, TO_COEFFICIENTS, Mesh
from mcgw.moments import Layout
from mcgw.tree import Tree, transfer, tree_over

__all__ = ["Response", "response_of"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_ACCURACY = 1e-13  # relative to the largest value of a law on the cell
_TIMES_U = TO_COEFFICIENTS @ ((1 + NODES[:, None]) / 2 * chebyshev.chebvander(NODES, len(NODES) - 1))
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
            for k in range(pointers[r], pointers[r + 1]):
                value = values[k]
                column = columns[k]
                for i in range(32):
                    table[given + r, i] += value * table[column, i]
        result[:, first : first + n] = table[given + computed - answers :, :n]
    return result


def response_of(
    mesh: Mesh,
    surface: Surface,
    grading: Grading,
    quantities: tuple[str, ...],
    separations: tuple[float, ...],
) -> Response:
    """Build the response of a mesh.

    Parameters
    ----------
    mesh : Mesh
        Cells with every separation on an edge.
    surface : Surface
        For the dimensions.
    grading : Grading
        E*(s)/E*, any callable whose breaks are edges of the mesh.
    quantities : tuple of str
        Rows of the answer.
    separations : tuple of float
        Columns of the answer, in any order.

    Returns
    -------
    Response
        Accurate to 1e-13 of the largest value of each law on each cell.

    Raises
    ------
    ValueError
        If the grading is not resolved on a cell.
    """
    tree = tree_over(mesh)
    laws = _Laws.of(surface, grading, quantities, separations)
    entries, plain, rooted = _walk(mesh, tree, laws)
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
    shape = (len(quantities), len(separations))
    return Response(layout, pointers, column[order], value[order], shape)


_NOTHING = (np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0))


@dataclass(frozen=True)
class _Laws:
    """All laws that are asked for, one an array element: ``scale (s - h)^exponent e(s)^modulus``."""

    h: Array
    exponent: Array
    modulus: NDArray[np.bool_]
    scale: Array
    grading: Grading

    @classmethod
    def of(
        cls, surface: Surface, grading: Grading, quantities: tuple[str, ...], separations: tuple[float, ...]
    ) -> "_Laws":
        chosen = [QUANTITIES[name] for name in quantities]
        repeat = len(separations)
        return cls(
            h=np.tile(separations, len(chosen)),
            exponent=np.repeat([q.exponent for q in chosen], repeat),
            modulus=np.repeat([bool(q.modulus) for q in chosen], repeat),
            scale=np.repeat([q.scale(surface) for q in chosen], repeat),
            grading=grading,
        )

    def coefficients(self, which: Ints, a: float, t: Array, power: Array, base: Array) -> Array:
        """Chebyshev coefficients of ``scale base^power e(a + t)^modulus``: shape (order, laws)."""
        graded = np.where(self.modulus[which], self.grading(a + t)[:, None], 1.0)
        return np.asarray(TO_COEFFICIENTS @ (self.scale[which] * graded * base**power))

    def smooth_from(self, which: Ints, a: float) -> NDArray[np.bool_]:
        """Which laws are smooth functions of the uniform on a node that starts at `a`."""
        h = self.h[which]
        return np.asarray((h < a) | ((h == a) & (self.exponent[which] % 1 == 0)))


@dataclass(frozen=True)
class _Entry:
    """Coefficients of some laws on one node; `rooted` ones multiply the R_j."""

    node: int
    rooted: bool
    laws: Ints
    coefficients: Array


def _needed(coefficients: Array) -> Ints:
    """Number of leading coefficients that describe each law (column) to the accuracy."""
    tail = np.cumsum(np.abs(coefficients)[::-1], axis=0)[::-1]
    return np.asarray((tail > _ACCURACY * tail[0]).sum(axis=0), dtype=np.int64)


def _walk(mesh: Mesh, tree: Tree, laws: _Laws) -> tuple[list[_Entry], Ints, Ints]:
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
        c = laws.coefficients(
            which[smooth], a, t, laws.exponent[which[smooth]], (a - laws.h[which[smooth]]) + t[:, None]
        )
        needed = _needed(c)
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
        plain[node] = max(needed.max(initial=0), min(inherited, _witness(laws, a, t)))
        at_edge = which[~smooth]
        if at_edge.size:
            c = _rooted_coefficients(laws, at_edge, a, t)
            rooted[node] = _needed(c).max()
            entries.append(_Entry(node, True, at_edge, c))
    return entries, plain, rooted


def _witness(laws: _Laws, a: float, t: Array) -> int:
    """Moments that a cell must hand to its parents: those of the nearest separations below it."""
    every = np.arange(len(laws.h))
    smooth = every[laws.smooth_from(every, a)]
    nearest = [
        same[laws.h[same] == laws.h[same].max()][0]
        for n in np.unique(laws.exponent[smooth])
        if (same := smooth[laws.exponent[smooth] == n]).size
    ]
    which = np.array(nearest, dtype=np.int64)
    c = laws.coefficients(which, a, t, laws.exponent[which], (a - laws.h[which]) + t[:, None])
    return int(_needed(c).max(initial=1))


def _rooted_coefficients(laws: _Laws, which: Ints, a: float, t: Array) -> Array:
    """Of ``law/sqrt(u)`` on the cell that starts at the separation, relatively accurate down to u = 0.

    With t = u q(u) the law is ``sqrt(u) u^(n-1/2) q^n e``: the power of u is put in exactly.
    """
    u = (1 + NODES) / 2
    c = laws.coefficients(which, a, t, laws.exponent[which], (t / u)[:, None])
    steep = laws.exponent[which] > 1
    c[:, steep] = _TIMES_U @ c[:, steep]
    return c


def _transfers(mesh: Mesh, tree: Tree, plain: Ints, node_row: Ints) -> list[tuple[Ints, Ints, Array]]:
    """Entries that make the moments of the parents."""
    pairs = []
    for node in range(mesh.size, tree.size):
        for child, right in ((tree.left[node], False), (tree.right[node], True)):
            matrix = transfer(tree.share(node), right, plain[node], plain[child])
            row, column = np.indices(matrix.shape)
            pairs.append((node_row[node] + row.ravel(), node_row[child] + column.ravel(), matrix.ravel()))
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
        moment, law = np.indices(c.shape)
        pairs.append((first + entry.laws[law].ravel(), start + moment.ravel(), c.ravel()))
    return pairs
