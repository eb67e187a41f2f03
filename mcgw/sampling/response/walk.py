"""From the root down, level by level: give each row to the coarsest nodes that resolve it."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mcgw.machine.compiling import njit
from mcgw.machine.in_threads import in_threads
from mcgw.sampling.cells import NODES, Mesh
from mcgw.sampling.response.nodes import Nodes
from mcgw.sampling.response.rows import Rows
from mcgw.sampling.response.tree import Tree
from mcgw.sampling.rules import product

__all__ = ["Entries", "walk"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_MOST, _MOST_IN_CELL = 12, 19  # moments: what is not resolved by so many is left to the children, or refused
_U = (1 + NODES) / 2
# Multiplies a Chebyshev series by u = (1 + x)/2, and leaves zeros where they are.
_TIMES_U = np.eye(len(NODES)) / 2 + np.eye(len(NODES), k=1) / 4 + np.eye(len(NODES), k=-1) / 4
_TIMES_U[1, 0] = 0.5
_PAIRS = 1024  # of a row and a node, at a time
_MANY = 16  # times that many: worth another thread


@dataclass(frozen=True)
class Entries:
    """Series of rows on nodes, one an array element.

    Parameters
    ----------
    node, row : ndarray of int
        Whose they are.
    rooted : ndarray of bool
        Whether they multiply the R_j of a cell, or the T_j of a node.
    length : ndarray of int
        How many coefficients each has; further ones are zero.
    coefficients : ndarray
        Of all of them, one after the other.
    """

    node: Ints
    row: Ints
    rooted: NDArray[np.bool_]
    length: Ints
    coefficients: Array

    @classmethod
    def of(cls, node: Ints, row: Ints, which: Ints, c: Array, *, rooted: bool = False) -> "Entries":
        """Some of the series of these nodes and rows, whose coefficients have the shape (order, series)."""
        length, coefficients = _packed(c, which)
        return cls(node[which], row[which], np.full(len(which), rooted), length, coefficients)

    @property
    def start(self) -> Ints:
        """Where the coefficients of each begin."""
        return np.cumsum(self.length) - self.length

    @classmethod
    def joined(cls, parts: list["Entries"]) -> "Entries":
        """Some after the others."""
        return cls(
            np.concatenate([_NO_INDEX, *(part.node for part in parts)]),
            np.concatenate([_NO_INDEX, *(part.row for part in parts)]),
            np.concatenate([_NO_INDEX.astype(bool), *(part.rooted for part in parts)]),
            np.concatenate([_NO_INDEX, *(part.length for part in parts)]),
            np.concatenate([np.empty(0), *(part.coefficients for part in parts)]),
        )


_NO_INDEX = np.empty(0, dtype=np.int64)


@njit(nogil=True, cache=True)
def _packed(c: Any, which: Any) -> Any:
    """How many coefficients some series have, up to the last that is not zero, and all of these."""
    length, total = np.empty(which.size, dtype=np.int64), 0
    for k in range(which.size):
        n = c.shape[0]
        while n > 0 and c[n - 1, which[k]] == 0.0:
            n -= 1
        length[k] = n
        total += n
    coefficients, at = np.empty(total), 0
    for k in range(which.size):
        for i in range(length[k]):
            coefficients[at] = c[i, which[k]]
            at += 1
    return length, coefficients


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
    ValueError
        If a row begins or ends inside a cell, or is not resolved on one.
    """
    plain, rooted = np.zeros(tree.size, dtype=np.int64), np.zeros(mesh.size, dtype=np.int64)
    found: list[Entries] = []
    row = np.arange(len(rows.h) if tree.size else 0)
    node = np.full(len(row), tree.size - 1)
    while len(node):
        node, row, smooth = _met(node, row, rows, nodes)
        left = np.ones(len(node), dtype=bool)
        together = _together(np.flatnonzero(smooth))
        resolved = in_threads(lambda few: _resolved(rows, nodes, node[few], row[few]), together, least=_MANY)  # noqa: B023
        for few, (series, needed, done) in zip(together, resolved, strict=True):
            found.append(series)
            np.maximum.at(plain, series.node, needed)
            left[few[done]] = False
        begins = left & ~nodes.parent[node]
        for series, needed in _begun_series(rows, nodes, node[begins], row[begins]):
            found.append(series)
            np.maximum.at(rooted if series.rooted.any() else plain, series.node, needed)
        left &= nodes.parent[node]
        node, row = node[left], row[left]
        node, row = np.concatenate([tree.left[node], tree.right[node]]), np.concatenate([row, row])
    for_parents = _inherited(plain, tree.left, tree.right)[: mesh.size]
    cells = slice(0, mesh.size)
    plain[cells] = np.maximum(plain[cells], _of_parents(rows, nodes, for_parents))
    return Entries.joined(found), plain, rooted


def _met(node: Ints, row: Ints, rows: Rows, nodes: Nodes) -> tuple[Ints, Ints, NDArray[np.bool_]]:
    """Those nodes and rows that have heights in common, and whether the row is one smooth function there."""
    start, end, low, high = nodes.start[node], nodes.end[node], rows.low[row], rows.high[row]
    # The moments of a parent are good to a share of its width: a lone asperity may be nearer to its start.
    beyond = rows.rooted[row] | (nodes.parent[node] & nodes.precision.of_least)
    whole = (low < start) | ((low == start) & ~beyond)
    whole &= (end <= high) & ~(nodes.broken[node] & rows.graded[row])
    here = (low < end) & (high > start)
    return node[here], row[here], whole[here]


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


def _together(pairs: Ints) -> list[Ints]:
    """A few at a time, whose series stay in the cache."""
    return [pairs[first : first + _PAIRS] for first in range(0, len(pairs), _PAIRS)]


def _resolved(rows: Rows, nodes: Nodes, node: Ints, row: Ints) -> tuple[Entries, Ints, Ints]:
    """Series of rows that are smooth on nodes, where resolved; how many coefficients count; and which."""
    c, needed = _smooth_series(rows, nodes, node, row)
    parent = nodes.parent[node]
    if rows.rough.any():
        begins = rows.rough[row] & (rows.low[row] == nodes.start[node]) & ~parent
        needed[begins] = np.minimum(needed[begins], _MOST_IN_CELL)
    done = needed <= np.where(parent, _MOST, _MOST_IN_CELL)
    _refuse(nodes, node[~(done | parent)])
    which = np.flatnonzero(done)
    return Entries.of(node, row, which, c), needed[which], which


def _refuse(nodes: Nodes, unresolved: Ints) -> None:
    if unresolved.size:
        s = nodes.start[unresolved].min()
        raise ValueError(f"grading: not resolved near s = {s:.6g}; give its breaks, or a smoother one")


def _smooth_series(rows: Rows, nodes: Nodes, node: Ints, row: Ints) -> tuple[Array, Ints]:
    """Series of rows that are smooth on nodes, and how many coefficients must count.

    What no sum over many nodes can show is zero.
    """
    values = rows.formulas.values(row, *nodes.at(node, rows.h[row]))
    c, needed = nodes.series(values, node, row, rows, of_many=True)
    begins = np.flatnonzero(rows.begins[row] & (rows.low[row] == nodes.start[node]))
    for _, which, begun, count in _starts(rows, nodes, node[begins], row[begins]):
        c[:, begins[which]], needed[begins[which]] = begun, count
    return c, needed


def _begun_series(rows: Rows, nodes: Nodes, node: Ints, row: Ints) -> Iterator[tuple[Entries, Ints]]:
    """Series of rows with a root, on the cells at which they begin."""
    if np.any(rows.low[row] != nodes.start[node]):
        s = rows.low[row][rows.low[row] != nodes.start[node]][0]
        raise ValueError(f"a break of the contact law at s = {s:.6g} is not an edge of the cells")
    for root, which, c, needed in _starts(rows, nodes, node, row):
        yield Entries.of(node[which], row[which], np.arange(len(which)), c, rooted=root), needed


def _starts(rows: Rows, nodes: Nodes, node: Ints, row: Ints) -> Iterator[tuple[bool, Ints, Array, Ints]]:
    """Of rows that begin where a node does: rooted or not, which ones, series, and how many count.

    A series is cut before the whole power of u is put in, so that it stays accurate relative to the row
    down to u = 0.
    """
    if not row.size:
        return
    for start in rows.formulas.at_start(row, *nodes.at(node, nodes.start[node]), _U):
        which = start.rows
        c, needed = nodes.series(start.values, node[which], row[which], rows, of_many=False)
        for power in range(int(start.power.max(initial=0))):
            more = start.power >= power + 1
            c[:, more] = product(_TIMES_U, c[:, more])
            needed = needed + more
        yield start.rooted, which, c, needed


def _of_parents(rows: Rows, nodes: Nodes, inherited: Ints) -> Ints:
    """Moments of each cell that the moments of its parents need at most.

    In the cell's uniform the height bends, so that even the first moments of a parent take many of its. But
    what parents stand in for are rows from farther below, smoother on this cell than the nearest ones: no
    more of its moments count than those would need. One of them counts the asperities.
    """
    cell, row = rows.nearest(nodes.start[: len(inherited)])
    nearest = np.ones(len(inherited), dtype=np.int64)
    for few in _together(np.arange(len(cell))):
        _, needed = _smooth_series(rows, nodes, cell[few], row[few])
        np.maximum.at(nearest, cell[few], needed)
    return np.where(inherited > 1, nearest, inherited)
