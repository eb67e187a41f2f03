"""From the root down, a level of the tree at a time: give each row to the coarsest nodes that resolve it."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import in_threads, njit
from mcgw.sampling.cells import Mesh
from mcgw.sampling.response.rows import Rows
from mcgw.sampling.response.series import (
    APART,
    MOST,
    MOST_IN_CELL,
    TABLES,
    WHOLE,
    Entries,
    U,
    length_of,
    meeting,
    raised,
    series_of,
)
from mcgw.sampling.response.tree import Nodes, Tree
from mcgw.sampling.stretches import SMALLEST

_PAIRS = 1024  # of a row and a node, at a time
_MANY = 16  # times that many: worth another thread
_NONE = np.empty(0, dtype=np.int64)


class _Walk:
    """Series of rows on the nodes of a tree."""

    def __init__(self, tree: Tree, nodes: Nodes, rows: Rows) -> None:
        self._tree, self._nodes, self._rows = tree, nodes, rows
        # what the errors of series are held against, for compiled loops: `series_of` tells
        self._limits = nodes.even, nodes.noise, nodes.crowd, rows.graded, rows.total, nodes.accuracy

    def entries(self) -> tuple[Entries, Ints, Ints, Array, float]:
        """Return what each node gives; how many T_j and R_j it must have; where that fails.

        The last two are starts of cells on which a row is not resolved, increasing, and the lowest
        separation that is not an edge; infinite if there is none.
        """
        tree, nodes = self._tree, self._nodes
        plain, rooted = np.zeros(tree.size, dtype=np.int64), np.zeros(tree.size, dtype=np.int64)
        found = [_entries(_NONE, _NONE, np.empty((0, len(U))))]
        unresolved, inside = [np.empty(0)], np.inf
        row = np.arange(len(self._rows.h) if tree.size else 0)
        node = np.full(len(row), tree.size - 1)
        while len(node):
            node, row, smooth = self._met(node, row)
            left = np.ones(len(node), dtype=bool)
            together = _together(np.flatnonzero(smooth))
            resolved = in_threads(lambda few: self._resolved(node[few], row[few]), together, least=_MANY)  # noqa: B023
            for few, (series, needed, done) in zip(together, resolved, strict=True):
                found.append(series)
                np.maximum.at(plain, series.node, needed)
                left[few[done]] = False
            cells = left & ~nodes.parent[node]
            unresolved.append(nodes.start[node[cells & smooth]])
            begins = cells & ~smooth
            low = self._rows.low[row[begins]]  # rows that begin inside a cell
            inside = low[low != nodes.start[node[begins]]].min(initial=inside)
            for root, which, c, needed in self._starts(node[begins], row[begins]):
                found.append(_entries(node[begins][which], row[begins][which], c, rooted=root))
                np.maximum.at(rooted if root else plain, node[begins][which], needed)
            left &= nodes.parent[node]
            node, row = node[left], row[left]
            node, row = np.concatenate([tree.left[node], tree.right[node]]), np.concatenate([row, row])
        joined = Entries(*map(np.concatenate, zip(*found, strict=True)))
        return joined, plain, rooted, np.unique(np.concatenate(unresolved)), inside

    def _met(self, node: Ints, row: Ints) -> tuple[Ints, Ints, NDArray[np.bool_]]:
        """Nodes and rows that have heights in common, and whether the row is one smooth function there."""
        nodes, rows = self._nodes, self._rows
        split, low, high = nodes.broken[node] & rows.graded[row], rows.low[row], rows.high[row]
        how = _meetings(low, high, rows.rooted[row], split, nodes.start[node], nodes.end[node])
        here = how != APART
        return node[here], row[here], how[here] == WHOLE

    def _resolved(self, node: Ints, row: Ints) -> tuple[Entries, Ints, Ints]:
        """Series of rows that are smooth on nodes, where resolved; how many coefficients count; and which."""
        rows, parent = self._rows, self._nodes.parent[node]
        c, needed = self.smooth(node, row)
        rough = rows.rough[row] & (rows.low[row] == self._nodes.start[node])
        smallest = (rough | (self._nodes.end[node] - self._nodes.start[node] <= 2 * SMALLEST)) & ~parent
        needed[smallest] = np.minimum(needed[smallest], MOST_IN_CELL)
        which = np.flatnonzero(needed <= np.where(parent, MOST, MOST_IN_CELL))
        return _entries(node[which], row[which], c[which]), needed[which], which

    def smooth(self, node: Ints, row: Ints) -> tuple[Array, Ints]:
        """Series of rows that are smooth on nodes, and how many coefficients must count.

        What no sum over many nodes can show is zero.
        """
        nodes, rows = self._nodes, self._rows
        values = rows.formulas.values(row, *nodes.at(node, rows.h[row]))
        c, needed = self._series(values, node, row, np.zeros(len(row)), of_many=True)
        begins = np.flatnonzero(rows.begins[row] & (rows.low[row] == nodes.start[node]))
        for _, which, begun, count in self._starts(node[begins], row[begins]):
            c[begins[which]], needed[begins[which]] = begun, count
        return c, needed

    def _starts(self, node: Ints, row: Ints) -> Iterator[tuple[bool, Ints, Array, Ints]]:
        """Of rows that begin where a node does: rooted or not, which ones, series, and how many count."""
        nodes = self._nodes
        if not row.size:
            return
        parts = self._rows.formulas.at_start(row, *nodes.at(node, nodes.start[node]), U)
        for rooted, which, values, power in parts:
            yield rooted, which, *self._series(values, node[which], row[which], power, of_many=False)

    def _series(
        self, values: Array, node: Ints, row: Ints, power: Array, *, of_many: bool
    ) -> tuple[Array, Ints]:
        """Series of values (points, pairs) times powers of u, shape (pairs, order), and how many count."""
        rough = self._nodes.rough_noise(node, row, self._rows)
        by_pairs = np.ascontiguousarray(values.T)
        c, count = _all_series(by_pairs, node, row, self._limits, rough, of_many, power, TABLES)
        return c, count


def _together(pairs: Ints) -> list[Ints]:
    """Return a few at a time, whose series stay in the cache."""
    return [pairs[first : first + _PAIRS] for first in range(0, len(pairs), _PAIRS)]


@njit(cache=True)
def _meetings(low: Any, high: Any, rooted: Any, split: Any, start: Any, end: Any) -> Any:
    """`meeting` of each row and node."""
    how = np.empty(low.size, dtype=np.int64)
    for k in range(low.size):
        how[k] = meeting(low[k], high[k], rooted[k], split[k], start[k], end[k])
    return how


@njit(cache=True)
def _all_series(
    values: Any, node: Any, row: Any, limits: Any, rough: Any, of_many: Any, power: Any, tables: Any
) -> Any:
    """`series_of` each row on each node, times its power of u, and how many coefficients of each count."""
    transform, times_u, _ = tables
    series, count = np.empty(values.shape), np.empty(len(values), dtype=np.int64)
    for k in range(len(values)):
        c = series[k : k + 1]
        count[k] = series_of(values[k : k + 1], node[k], row[k], limits, rough[k], of_many, transform, c)
        raised(c, int(power[k]), times_u)
        count[k] += int(power[k])
    return series, count


def _entries(node: Ints, row: Ints, c: Array, *, rooted: bool = False) -> Entries:
    """Series of these nodes and rows, with coefficients of shape (series, order)."""
    length, coefficients = _packed(c)
    return Entries(node, row, np.full(len(node), rooted), length, coefficients)


@njit(cache=True)
def _packed(series: Any) -> Any:
    """How many coefficients some series have, up to the last that is not zero, and all of these."""
    length, used = np.empty(len(series), dtype=np.int64), 0
    coefficients = np.empty(series.size)
    for k in range(len(series)):
        n = length_of(series[k : k + 1])
        for i in range(n):
            coefficients[used + i] = series[k, i]
        length[k], used = n, used + n
    return length, coefficients[:used]


class UnresolvedError(ValueError):
    """Cells are too wide for what is asked: their lower edges are its `starts`, increasing."""

    def __init__(self, starts: Array) -> None:
        self.starts = starts
        super().__init__(
            f"not resolved near s = {starts[0]:.6g}: the modulus there, or a contact law, changes too "
            'fast for cells; use sampler = "tail" or a smoother grading'
        )


def walk(mesh: Mesh, tree: Tree, rows: Rows, nodes: Nodes) -> tuple[Entries, Ints, Ints]:
    """Return the series of all rows; how many T_j each node must have, and how many R_j each cell.

    UnresolvedError if a row is not resolved on some cells, ValueError if one begins or ends inside a cell.
    """
    series = _Walk(tree, nodes, rows)
    entries, plain, rooted, unresolved, inside = series.entries()
    if unresolved.size:
        raise UnresolvedError(unresolved)
    if np.isfinite(inside):
        raise ValueError(f"a break of the contact law at s = {inside:.6g} is not an edge of the cells")
    inherited = _inherited(plain, tree.left, tree.right)[: mesh.size]
    cell, row = rows.nearest(nodes.start[: mesh.size])
    nearest = np.ones(mesh.size, dtype=np.int64)
    for few in _together(np.arange(len(cell))):
        np.maximum.at(nearest, cell[few], series.smooth(cell[few], row[few])[1])
    # In the cell's uniform the height bends, so that even the first moments of a parent take many of its. But
    # what parents stand in for are rows from farther below, smoother on this cell than the nearest ones: no
    # more of its moments count than those would need. One of them counts the asperities. Below where rows
    # dwindle to nothing the farther ones are the rougher: of these cells' moments none is left out.
    low, high = np.searchsorted(nodes.start[: mesh.size], [rows.low[rows.lost], rows.high[rows.lost]])
    begun, ended = (np.bincount(at, minlength=mesh.size)[: mesh.size] for at in (low, high))
    nearest[np.cumsum(begun - ended) > 0] = MOST_IN_CELL
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
