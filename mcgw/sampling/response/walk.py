"""From the root down, a level of the tree at a time: give each row to the coarsest nodes that resolve it."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.sampling.cells import NODES, TO_COEFFICIENTS, Mesh
from mcgw.sampling.kernels import multiply
from mcgw.sampling.response.rows import Rows
from mcgw.sampling.response.tree import Nodes, Tree
from mcgw.sampling.stretches import SMALLEST

_MOST, _MOST_IN_CELL = 12, 19  # moments: what is not resolved by so many is left to the children, or refused
_APART, _PARTLY, _WHOLE = 0, 1, 2
_NODES = 32  # that add to one sum, with errors of their own
_DIGITS = 8.0  # last digits of a height that a formula may lose
_PAIRS = 1024  # of a row and a node, at a time: their series stay in the cache
_ORDER = len(NODES)
_U = (1 + NODES) / 2
# Multiplies coefficients, from their right, by u = (1 + x)/2, and leaves zeros where they are.
_TIMES_U = np.eye(_ORDER) / 2 + (np.eye(_ORDER, k=1) + np.eye(_ORDER, k=-1)) / 4
_TIMES_U[0, 1] = 0.5
_TABLES = np.ascontiguousarray(TO_COEFFICIENTS.T), _TIMES_U


class Entries(NamedTuple):
    """Series of rows on nodes, one an array element."""

    node: Ints  # of which node
    row: Ints  # of which row
    rooted: NDArray[np.bool_]  # whether they multiply the R_j of a cell, or the T_j of a node
    coefficients: Array  # shape (series, order); zero beyond those that count


class UnresolvedError(ValueError):
    """Cells are too wide for what is asked: their lower edges are its `starts`, increasing."""

    def __init__(self, starts: Array) -> None:
        self.starts = starts
        super().__init__(
            f"not resolved near s = {starts[0]:.6g}: the modulus there, or a contact law, changes too "
            'fast for cells; use sampler = "auto" or a smoother grading'
        )


def walk(mesh: Mesh, tree: Tree, rows: Rows, nodes: Nodes) -> tuple[Entries, Ints, Ints]:
    """Return the series of all rows; how many T_j each node must have, and how many R_j each cell.

    UnresolvedError if a row is not resolved on some cells, ValueError if one begins or ends inside a cell.
    """
    of_nodes = nodes.even, nodes.noise, nodes.crowd, nodes.start, nodes.end
    of_rows = rows.graded, rows.total, rows.low, rows.high, rows.rough, rows.lost, rows.h
    series = _Walk(tree, nodes, rows, (of_nodes, of_rows, nodes.accuracy))
    entries, plain, rooted, unresolved, inside = series.entries()
    if unresolved.size:
        raise UnresolvedError(unresolved)
    if np.isfinite(inside):
        raise ValueError(f"a break of the contact law at s = {inside:.6g} is not an edge of the cells")
    inherited = _inherited(plain, tree.left, tree.right)[: mesh.size]
    cell, row = rows.nearest(nodes.start[: mesh.size])
    nearest = np.ones(mesh.size, dtype=np.int64)
    np.maximum.at(nearest, cell, series.smooth(cell, row)[1])
    # In the cell's uniform the height bends, so that even the first moments of a parent take many of its. But
    # what parents stand in for are rows from farther below, smoother on this cell than the nearest ones: no
    # more of its moments count than those would need. One of them counts the asperities. Below where rows
    # dwindle to nothing the farther ones are the rougher: of these cells' moments none is left out.
    low, high = np.searchsorted(nodes.start[: mesh.size], [rows.low[rows.lost], rows.high[rows.lost]])
    begun, ended = (np.bincount(at, minlength=mesh.size)[: mesh.size] for at in (low, high))
    nearest[np.cumsum(begun - ended) > 0] = _MOST_IN_CELL
    of_parents = np.where(inherited > 1, nearest, inherited)
    plain[: mesh.size] = np.maximum(plain[: mesh.size], of_parents)
    return entries, plain, rooted[: mesh.size]


class _Walk(NamedTuple):
    """Series of rows on the nodes of a tree."""

    tree: Tree
    nodes: Nodes
    rows: Rows
    limits: Any  # what the errors of series are held against: `_all_series` tells

    def entries(self) -> tuple[Entries, Ints, Ints, Array, float]:
        """Return what each node gives; how many T_j and R_j it must have; where that fails.

        The last two are starts of cells on which a row is not resolved, increasing, and the lowest
        separation that is not an edge; infinite if there is none.
        """
        tree, nodes, rows, size = self.tree, self.nodes, self.rows, len(self.nodes.start)
        plain, rooted = np.zeros(size, dtype=np.int64), np.zeros(size, dtype=np.int64)
        found = [(np.empty(0, dtype=np.int64),) * 2 + (False, np.empty((0, _ORDER)))]
        unresolved, inside = [np.empty(0)], np.inf
        row = np.arange(len(rows.h) if size else 0)
        node = np.full(len(row), size - 1)
        while len(node):
            split = nodes.broken[node] & rows.graded[row]
            ends = nodes.start[node], nodes.end[node]
            how = _meetings(rows.low[row], rows.high[row], rows.rooted[row], split, *ends)
            node, row, how = (part[how != _APART] for part in (node, row, how))
            left, whole = np.ones(len(node), dtype=bool), np.flatnonzero(how == _WHOLE)
            c, needed, some = self.resolved(node[whole], row[whole])
            done = whole[some]
            left[done] = False
            found.append((node[done], row[done], False, c[some]))
            np.maximum.at(plain, node[done], needed[some])
            cells = left & ~nodes.parent[node]
            unresolved.append(nodes.start[node[cells & (how == _WHOLE)]])
            begins = np.flatnonzero(cells & (how != _WHOLE))
            low = rows.low[row[begins]]  # rows that begin inside a cell
            inside = low[low != nodes.start[node[begins]]].min(initial=inside)
            for root, which, c, needed in self.starts(node[begins], row[begins]):
                at = node[begins[which]]
                found.append((at, row[begins[which]], root, c))
                np.maximum.at(rooted if root else plain, at, needed)
                wide = nodes.end[at] - nodes.start[at] > 2 * SMALLEST
                unresolved.append(nodes.start[at[(needed > _MOST_IN_CELL) & wide]])
            node, row = (part[left & nodes.parent[node]] for part in (node, row))
            node, row = np.concatenate([tree.left[node], tree.right[node]]), np.concatenate([row, row])
        of_node, of_row, root, c = zip(*found, strict=True)
        is_rooted = np.repeat(root, [len(part) for part in of_node])
        joined = Entries(np.concatenate(of_node), np.concatenate(of_row), is_rooted, np.concatenate(c))
        return joined, plain, rooted, np.unique(np.concatenate(unresolved)), inside

    def resolved(self, node: Ints, row: Ints) -> tuple[Array, Ints, Ints]:
        """Return what `smooth` does, and which series are resolved: on the smallest of cells all are."""
        nodes, rows = self.nodes, self.rows
        c, needed = self.smooth(node, row)
        rough = rows.rough[row] & (rows.low[row] == nodes.start[node])
        smallest = (rough | (nodes.end[node] - nodes.start[node] <= 2 * SMALLEST)) & ~nodes.parent[node]
        needed[smallest] = np.minimum(needed[smallest], _MOST_IN_CELL)
        return c, needed, np.flatnonzero(needed <= np.where(nodes.parent[node], _MOST, _MOST_IN_CELL))

    def smooth(self, node: Ints, row: Ints) -> tuple[Array, Ints]:
        """Series of rows that are smooth on nodes, and how many coefficients must count.

        What no sum over many nodes can show is zero.
        """
        nodes, rows = self.nodes, self.rows
        c, needed = np.empty((len(node), _ORDER)), np.empty(len(node), dtype=np.int64)
        for first in range(0, len(node), _PAIRS):
            few = slice(first, first + _PAIRS)
            at, of = node[few], row[few]
            above = (nodes.start[at] - rows.h[of])[:, None] + nodes.above[at]
            values, power = rows.formulas.values(of, above, nodes.moduli[at]), np.zeros(len(at))
            _all_series(values, at, of, power, True, self.limits, _TABLES, c[few], needed[few])
        begins = np.flatnonzero(rows.begins[row] & (rows.low[row] == nodes.start[node]))
        for _, which, begun, count in self.starts(node[begins], row[begins]):
            c[begins[which]], needed[begins[which]] = begun, count
        return c, needed

    def starts(self, node: Ints, row: Ints) -> Iterator[tuple[bool, Ints, Array, Ints]]:
        """Of rows that begin where a node does: rooted or not, which ones, series, and how many count."""
        if not row.size:
            return
        nodes = self.nodes
        parts = self.rows.formulas.at_start(row, nodes.above[node], nodes.moduli[node], _U)
        for rooted, which, values, power in parts:
            c, needed = np.empty(values.shape), np.empty(len(which), dtype=np.int64)
            _all_series(values, node[which], row[which], power, False, self.limits, _TABLES, c, needed)
            yield rooted, which, c, needed


@njit(cache=True)
def _meetings(low: Any, high: Any, rooted: Any, split: Any, start: Any, end: Any) -> Any:
    """Return how rows that hold from `low` to `high` meet nodes: not, as one smooth function, or partly.

    A row may begin with a root, and a modulus that it depends on may have a break inside the node: `split`.
    """
    how = np.full(low.size, _APART)
    for k in range(low.size):
        if low[k] < end[k] and high[k] > start[k]:
            begun = low[k] < start[k] or (low[k] == start[k] and not rooted[k])
            how[k] = _WHOLE if begun and end[k] <= high[k] and not split[k] else _PARTLY
    return how


@njit(cache=True)
def _all_series(
    values: Any, node: Any, row: Any, power: Any, of_many: Any, limits: Any, tables: Any, c: Any, count: Any
) -> None:
    """Chebyshev series of rows on nodes, and how many leading coefficients count: moments of the node.

    Parameters
    ----------
    values : ndarray
        At the points of the nodes, shape (pairs, points); overwritten.
    node, row : ndarray
        Whose they are.
    power : ndarray
        Whole powers of u to multiply them by, once they are cut: accurate to the row down to u = 0.
    of_many : bool
        Keep what counts in a sum over many nodes, whose errors add up: it is used if others need the moments.
    limits : tuple
        Of nodes and of rows, and the accuracy of a series (`Nodes`, `Rows`).
    tables : tuple
        Of values to coefficients, and of these to those of u times the series, from their right.
    c, count : ndarray
        Where the series, of shape (pairs, order), zero beyond those kept, and the numbers are written.
    """
    (even, noise, crowd, start, end), (graded, total, low, high, rough, lost, h), accuracy = limits
    transform, times_u = tables
    order = c.shape[1]
    multiply(values, transform, c)
    for k in range(len(values)):
        n, r, tail, digits = node[k], row[k], 0.0, noise[node[k]] if graded[row[k]] else 0.0
        for i in range(order - 1, -1, -1):
            tail += abs(c[k, i])
            values[k, i] = tail
        if rough[r] and math.isfinite(low[r]):
            digits = max(digits, _lost_digits(start[n], low[r], end[n] - start[n], h[r]))
        if lost[r]:
            digits = max(digits, _lost_digits(end[n], high[r], end[n] - start[n], h[r]))
        enough = accuracy * max((even[n] if graded[r] else 1.0) * tail, total[r] / crowd[n])
        alone, kept = max(enough, digits * tail), max(enough / (_NODES if of_many else 1), digits * tail)
        needed = order
        while needed > 0 and not values[k, needed - 1] > alone:
            needed -= 1
            if not values[k, needed] > kept:
                c[k, needed] = 0.0
        for _ in range(int(power[k])):
            for i in range(order):  # a slice set to an array takes 4 s to compile, with the text of its error
                values[k, i] = c[k, i]
            multiply(values[k : k + 1], times_u, c[k : k + 1])
        count[k] = needed + int(power[k])


@njit()
def _lost_digits(edge: Any, end: Any, width: Any, h: Any) -> Any:
    """Return what last digits make of a power of a height's distance from the end of a row at separation h.

    On a node that is wider than this distance the power is much larger elsewhere, and errors with it.
    """
    distance = abs(edge - end)
    lost = _DIGITS * np.spacing(max(abs(edge), abs(edge - h))) / max(distance, width)
    return min(lost, 1.0) if distance > 0 else 0.0


@njit(cache=True)
def _inherited(plain: Any, left: Any, right: Any) -> Any:
    """Moments that each node needs for its parent; parents come to need as many as theirs, in `plain` too."""
    inherited = np.zeros_like(plain)
    for node in range(plain.size - 1, -1, -1):  # parents come after their children
        if left[node] >= 0:
            for child in (left[node], right[node]):
                inherited[child] = plain[node]
                if left[child] >= 0:
                    plain[child] = max(plain[child], plain[node])
    return inherited
