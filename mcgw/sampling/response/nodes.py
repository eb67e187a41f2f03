"""The nodes of the tree as the rows see them: heights, moduli, and how accurate a series must be there."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from analytic import Grading, resolved_breaks
from mcgw.machine.compiling import njit
from mcgw.sampling.cells import TO_COEFFICIENTS, Mesh, evenness, height_noise
from mcgw.sampling.response.rows import Rows
from mcgw.sampling.response.tree import Tree
from mcgw.sampling.rules import multiply
from mcgw.scene.fields import EXACT

__all__ = ["LAST_DIGITS", "Nodes", "Precision"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_SCATTER = 8  # asperities more than expected
_DIGITS = 8.0  # last digits of a height that a formula may lose
_NODES = 32  # that add to one sum, with errors of their own
_COLUMNS = 64  # series at a time
_SMALLEST = 1 / 64  # see `Precision.of_least`


class Precision(NamedTuple):
    """How accurate a series must be.

    Attributes
    ----------
    accuracy : float
        Relative to a value on the node, or to the sum of a surface where that is sure to be larger.
    of_least : bool
        Whether to the least value, that a single asperity may have, or to the largest.
    """

    accuracy: float = EXACT
    of_least: bool = False


LAST_DIGITS = Precision()


@dataclass(frozen=True)
class Nodes:
    """All nodes, one an array element.

    Parameters
    ----------
    start, end : ndarray
        Their heights, shape (nodes,).
    above, moduli : ndarray
        Heights above the start at the Chebyshev points of a node's variable, and E*(s)/E* there; shape
        (points, nodes).
    parent : ndarray of bool
        Whether it has children.
    broken : ndarray of bool
        Whether the grading has a break inside a parent, which its values at 20 heights may not show.
    crowd : ndarray
        Asperities of a surface there, at most.
    even, noise : ndarray
        Share of the largest value that errors are held against, and share that the last digit of a height
        makes: of rows that depend on the modulus.
    precision : Precision
        Of a series.
    """

    start: Array
    end: Array
    above: Array
    moduli: Array
    parent: NDArray[np.bool_]
    broken: NDArray[np.bool_]
    crowd: Array
    even: Array
    noise: Array
    precision: Precision

    @classmethod
    def of(cls, mesh: Mesh, tree: Tree, grading: Grading, n_asperities: int, precision: Precision) -> "Nodes":
        """The nodes of a tree, for surfaces of so many asperities."""
        start, end = mesh.edges[tree.first], mesh.edges[tree.last]
        above = tree.above
        moduli = grading(start + above)
        kinks = np.array(resolved_breaks(grading, *mesh.range))
        inside = np.searchsorted(kinks, end) > np.searchsorted(kinks, start, side="right")
        e, t = moduli.T, above.T
        largest = np.maximum(np.abs(e).max(axis=1), np.finfo(float).tiny)
        return cls(
            start=start,
            end=end,
            above=above,
            moduli=moduli,
            parent=tree.left >= 0,
            broken=inside & (tree.left >= 0),
            crowd=n_asperities * tree.probability + _SCATTER,
            even=evenness(grading, e),
            noise=height_noise(start, t, e) / largest,
            precision=precision,
        )

    def at(self, node: Ints, h: Array) -> tuple[Array, Array]:
        """Heights above separations at the points of some nodes, and the moduli there: (points, nodes)."""
        above, e = _taken(self.above, self.moduli, node, self.start[node] - h)
        return above, e

    def series(
        self, values: Array, node: Ints, row: Ints, rows: Rows, *, of_many: bool
    ) -> tuple[Array, Ints]:
        """Chebyshev series of rows on nodes, and how many leading coefficients of each count.

        Parameters
        ----------
        values : ndarray
            At the points of the nodes, shape (points, pairs).
        node, row : ndarray of int
            Whose they are, shape (pairs,).
        rows : Rows
            All rows.
        of_many : bool
            Keep what counts in a sum over many nodes, whose errors add up: it is used if others need the
            moments.

        Returns
        -------
        (ndarray, ndarray)
            Coefficients, shape (order, pairs), zero beyond those kept; and how many moments each node must
            have.
        """
        rough = self._rough_noise(node, row, rows) if rows.rough.any() else np.zeros(len(row))
        limits = self.even, self.noise, self.crowd, rows.graded, rows.total
        share = _NODES if of_many else 1
        values = np.ascontiguousarray(values)
        c, count = _series(values, TO_COEFFICIENTS, node, row, limits, rough, self.precision, share)
        return c, count

    def _rough_noise(self, node: Ints, row: Ints, rows: Rows) -> Array:
        """What the last digit of a height makes of a power of its small distance from where a row begins."""
        noise = np.zeros(len(row))
        rough = rows.rough[row]
        start, low = self.start[node[rough]], rows.low[row[rough]]
        near = np.isfinite(low) & (start > low)
        share = np.spacing(np.abs(start[near])) / (start[near] - low[near])
        noise[np.flatnonzero(rough)[near]] = np.minimum(_DIGITS * share, 1.0)
        return noise


@njit(nogil=True, cache=True)
def _taken(above: Any, moduli: Any, node: Any, more: Any) -> Any:
    """Columns of both, the first with something added to each."""
    heights, e = np.empty((above.shape[0], node.size)), np.empty((above.shape[0], node.size))
    for i in range(above.shape[0]):
        for j in range(node.size):
            heights[i, j] = more[j] + above[i, node[j]]
            e[i, j] = moduli[i, node[j]]
    return heights, e


@njit(nogil=True, cache=True)
def _share_of_least(values: Any) -> Any:
    """The least of some values over the largest, but no less than a share: sums may change their sign."""
    least, largest = np.inf, 0.0
    for value in values:
        least, largest = min(least, abs(value)), max(largest, abs(value))
    return max(least, _SMALLEST * largest) / largest if largest > 0.0 else 1.0


@njit(nogil=True, cache=True)
def _series(
    values: Any,
    to_coefficients: Any,
    node: Any,
    row: Any,
    limits: Any,
    rough: Any,
    precision: Any,
    share: Any,
) -> Any:
    """Coefficients, up to the last from which on all together are more than the error that is let."""
    even, noise, crowd, graded, total = limits
    accuracy, of_least = precision
    order, series = values.shape
    c, count = np.empty(values.shape), np.zeros(series, dtype=np.int64)
    multiply(to_coefficients, values, c)
    tails, tail = np.empty((order, _COLUMNS)), np.empty(_COLUMNS)
    for first in range(0, series, _COLUMNS):
        n = min(_COLUMNS, series - first)
        tail[:] = 0.0
        for i in range(order - 1, -1, -1):
            for j in range(n):
                tail[j] += abs(c[i, first + j])
                tails[i, j] = tail[j]
        for j in range(n):
            at = first + j
            by_modulus = graded[row[at]]
            enough = even[node[at]] * tail[j] if by_modulus else tail[j]
            if of_least:
                enough = _share_of_least(values[:, at]) * tail[j]
            enough = max(enough, total[row[at]] / crowd[node[at]])
            if of_least:
                enough = max(enough, EXACT / accuracy * tail[j])
            least = max(noise[node[at]] if by_modulus else 0.0, rough[at]) * tail[j]
            alone, kept = max(accuracy * enough, least), max(accuracy / share * enough, least)
            for i in range(order):
                count[at] += tails[i, j] > alone
                if not tails[i, j] > kept:
                    c[i, at] = 0.0
    return c, count
