"""The nodes of the tree as the rows see them: heights, moduli, and how accurate a series must be there."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from analytic import Grading, resolved_breaks
from analytic.arrays import Array, Ints
from mcgw.sampling.cells import Mesh, evenness, height_noise
from mcgw.sampling.response.rows import Rows
from mcgw.sampling.response.tree import Tree
from mcgw.scene.fields import EXACT

_SCATTER = 8  # asperities more than expected
_DIGITS = 8.0  # last digits of a height that a formula may lose


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
        (nodes, points).
    parent : ndarray of bool
        Whether it has children.
    broken : ndarray of bool
        Whether the grading has a break inside a parent, which its values at 20 heights may not show.
    crowd : ndarray
        Asperities of a surface there, at most; with `Precision.of_least`, if all cells were such as its own.
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
        moduli = grading(start[:, None] + above)
        kinks = np.array(resolved_breaks(grading, *mesh.range))
        inside = np.searchsorted(kinks, end) > np.searchsorted(kinks, start, side="right")
        largest = np.maximum(np.abs(moduli).max(axis=1), np.finfo(float).tiny)
        crowd = n_asperities * tree.probability + _SCATTER
        if precision.of_least:  # each node is off by its part of what the sum of them all may be off by
            crowd *= mesh.size / (tree.last - tree.first)
        return cls(
            start=start,
            end=end,
            above=above,
            moduli=moduli,
            parent=tree.left >= 0,
            broken=inside & (tree.left >= 0),
            crowd=crowd,
            even=evenness(grading, moduli),
            noise=height_noise(start, above, moduli) / largest,
            precision=precision,
        )

    def at(self, node: Ints, h: Array) -> tuple[Array, Array]:
        """Heights above separations at the points of some nodes, and the moduli there: (points, nodes)."""
        return (self.start[node] - h) + self.above[node].T, self.moduli[node].T

    def limits(self, rows: Rows) -> tuple[Array, Array, Array, NDArray[np.bool_], Array, float, bool]:
        """What the errors of series are held against, for compiled loops: `series_of` tells."""
        return self.even, self.noise, self.crowd, rows.graded, rows.total, *self.precision

    def rough_noise(self, node: Ints, row: Ints, rows: Rows) -> Array:
        """What the last digit of a height makes of a power of its distance from the end of a row."""
        noise = np.zeros(len(row))
        start, end, low, high = self.start[node], self.end[node], rows.low[row], rows.high[row]
        for at, distance, which in (
            (start, start - low, rows.rough[row] & np.isfinite(low)),
            (end, high - end, rows.lost[row]),
        ):
            near = np.flatnonzero(which & (distance > 0))
            share = np.spacing(np.abs(at[near])) / distance[near]
            noise[near] = np.maximum(noise[near], np.minimum(_DIGITS * share, 1.0))
        return noise
