"""The walk for rows of Hertz's law, compiled as a whole: row by row, from the root down."""

from typing import Any

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.machine.in_threads import in_threads
from mcgw.sampling.response.rows import Rows, raise_to
from mcgw.sampling.response.series import (
    APART,
    MOST,
    MOST_IN_CELL,
    TABLES,
    WHOLE,
    Entries,
    length_of,
    meeting,
    raised,
    series_of,
)
from mcgw.sampling.response.tree import Nodes, Tree

_ROWS = 512  # worth another thread; what is found of them stays in memory that the process has
_NONE = np.empty(0, dtype=np.int64)
_DEEPEST = 128  # nodes that wait: one a level, and a tree has no more than 64


class HertzWalk:
    """Series of rows whose formulas are `Powers`, which begin at their separations and never end.

    Parameters
    ----------
    tree, nodes : Tree, Nodes
        Nodes over the cells.
    rows : Rows
        What to simulate.
    """

    def __init__(self, tree: Tree, nodes: Nodes, rows: Rows) -> None:
        self._rows, formulas = len(rows.h) if tree.left.size else 0, rows.formulas
        self._of = (
            (rows.h, rows.rooted, rows.graded, formulas.exponent, formulas.scale),
            (tree.left, tree.right, nodes.broken, nodes.end),
            (nodes.start, nodes.above, nodes.moduli),
            nodes.limits(rows),
            TABLES,
        )

    def entries(self) -> tuple[Entries, Ints, Ints, Array, float]:
        """What each node gives; how many T_j and R_j it must have; where that fails.

        The last two are starts of cells on which a row is not resolved, the lowest among them, and the lowest
        separation that is not an edge; infinite if there is none.
        """
        parts: list[Any] = in_threads(
            lambda first: _walk((first, min(first + _ROWS, self._rows)), _NONE, _NONE, *self._of),
            range(0, max(self._rows, 1), _ROWS),
        )
        found, coefficients, plain, rooted, unresolved, inside, _ = zip(*parts, strict=True)
        node, row, root, length = np.concatenate(found).reshape(-1, 4).T.copy()
        entries = Entries(node, row, root.astype(bool), length, np.concatenate(coefficients))
        lost = np.unique(unresolved)
        lost = lost[np.isfinite(lost)]
        return entries, np.max(plain, axis=0), np.max(rooted, axis=0), lost, min(inside)

    def needed(self, node: Ints, row: Ints) -> Ints:
        """Moments that each of these nodes needs for a row that is smooth on it."""
        return np.asarray(_walk((0, 0), node, row, *self._of)[-1])


@njit()
def _series(row: Any, node: Any, rows: Any, nodes: Any, limits: Any, tables: Any, work: Any) -> Any:
    """Series of a row on a node, the last one of `work`, and how many coefficients of it count.

    Where the row begins, ``s - h = u q(u)`` and it is ``u^n q^n e``: cut as q^n e, whose root of u is left.
    """
    h, _, graded, exponent, scale = rows
    start, above, moduli = nodes
    transform, times_u, u = tables
    x, values, c = work
    begins, more = h[row] == start[node], start[node] - h[row]
    if begins:
        for i in range(x.size):
            x[i] = above[node, i] / u[i]
    else:
        for i in range(x.size):
            x[i] = more + above[node, i]
    raise_to(exponent[row], x, values[0])
    for i in range(x.size):
        values[0, i] = scale[row] * (moduli[node, i] if graded[row] else 1.0) * values[0, i]
    count = series_of(values, node, row, limits, 0.0, not begins, transform, c)
    if begins:
        raised(c, int(exponent[row]), times_u)
        count += int(exponent[row])
    return count


@njit(cache=True)
def _walk(
    ends: Any, some: Any, of_rows: Any, rows: Any, links: Any, nodes: Any, limits: Any, tables: Any
) -> Any:
    """Node, row, root and length of each series, their coefficients, and the end of `HertzWalk.entries`.

    Then what some nodes need of some rows, pair by pair: one loop for both is compiled once.
    """
    h, with_root, graded = rows[:3]
    left, right, broken, node_ends = links
    starts, order = nodes[0], nodes[1].shape[1]
    plain, rooted = np.zeros(left.size, dtype=np.int64), np.zeros(left.size, dtype=np.int64)
    c = np.empty((1, order))
    work = np.empty(order), np.empty((1, order)), c
    needed_by = np.empty(some.size, dtype=np.int64)
    for k in range(some.size):
        needed_by[k] = _series(of_rows[k], some[k], rows, nodes, limits, tables, work)
    unresolved = inside = np.inf
    found, coefficients, n, used = np.empty(4096, dtype=np.int64), np.empty(16384), 0, 0
    waiting = np.empty(_DEEPEST, dtype=np.int64)
    for row in range(ends[0], ends[1]):
        waiting[0], many = left.size - 1, 1
        while many:
            many -= 1
            node = waiting[many]
            parent, split = left[node] >= 0, broken[node] and graded[row]
            how = meeting(
                h[row], np.inf, with_root[row], split, starts[node], node_ends[node], parent, limits[-1]
            )
            if how == APART:
                continue
            if how == WHOLE or not parent:
                needed = _series(row, node, rows, nodes, limits, tables, work)
                if how != WHOLE:
                    rooted[node] = max(rooted[node], needed)
                    inside = min(inside, h[row] if h[row] != starts[node] else np.inf)
                elif needed <= (MOST if parent else MOST_IN_CELL):
                    plain[node] = max(plain[node], needed)
                elif not parent:
                    unresolved = min(unresolved, starts[node])
                if not parent or needed <= MOST:
                    found, coefficients = _with_room(found, n, 4), _with_room(coefficients, used, order)
                    length = length_of(c)
                    found[n], found[n + 1], found[n + 2], found[n + 3] = node, row, how != WHOLE, length
                    for k in range(length):
                        coefficients[used + k] = c[0, k]
                    n, used = n + 4, used + length
                    continue
            waiting[many], waiting[many + 1] = right[node], left[node]
            many += 2
    return found[:n], coefficients[:used], plain, rooted, unresolved, inside, needed_by


@njit()
def _with_room(numbers: Any, used: Any, more: Any) -> Any:
    """The same numbers in an array that more go into."""
    if used + more <= numbers.size:
        return numbers
    longer = np.empty(2 * numbers.size + more, numbers.dtype)
    for k in range(used):
        longer[k] = numbers[k]
    return longer
