"""A sparse product in tiles: rows that are combinations of given rows, and of each other.

The given rows are the moments of cells from the lowest height to the highest, and a computed row needs
those of a range of heights. So rows are computed in one sweep from the highest cell down, in which given
rows are fetched when they are first needed: what the next row needs is still in the cache.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mcgw.sampling.in_threads import in_threads, pieces

__all__ = ["FOUR", "Blocks", "Tiles", "in_fours"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Places = NDArray[np.uint64]
Blocks = tuple[Ints, Ints, Array]  # rows, first columns, values of shape (blocks, 4)

FOUR = 4  # rows and columns of a tile
_WIDTH = 64  # surfaces at a time


def in_fours(rows: Any) -> Any:
    """Rounded up."""
    return (rows + FOUR - 1) // FOUR * FOUR


@dataclass(frozen=True)
class Tiles:
    """Groups of four rows, in the order in which they are computed.

    First come the given rows, then four that are zero, for a tile may reach beyond the given ones, then
    the computed ones, in fours.

    Parameters
    ----------
    rows : ndarray of int
        First row of each group.
    lowest : ndarray of int
        First given row that a group, or an earlier one, needs.
    pointers, columns : ndarray
        First tile of each group, and first column of each tile.
    values : ndarray
        Shape (tiles, 4, 4).
    """

    rows: Ints
    lowest: Ints
    pointers: Places
    columns: Places
    values: Array

    @classmethod
    def of(cls, blocks: Sequence[Blocks], given: int, computed: int) -> "Tiles":
        """Gather blocks of single rows, each of which needs given rows and rows of earlier groups."""
        row, column, value = (np.concatenate(part) for part in zip(*(_NOTHING, *blocks), strict=True))
        group, place = np.divmod(row - (given + FOUR), FOUR)
        (group, column), tile = np.unique(np.stack([group, column]), axis=1, return_inverse=True)
        values = np.zeros((len(group), FOUR, FOUR))
        values[tile, place] = value
        lowest = _lowest(group, column, given, computed // FOUR)
        order = np.lexsort((np.arange(len(lowest)), -lowest))
        turn = np.argsort(np.argsort(order)[group], kind="stable")
        sizes = np.bincount(group, minlength=len(lowest))[order]
        pointers = np.concatenate([[0], np.cumsum(sizes)])
        rows = given + FOUR + FOUR * order
        return cls(
            rows, lowest[order], pointers.astype(np.uint64), column[turn].astype(np.uint64), values[turn]
        )

    def apply(self, given: Array, shape: tuple[int, int]) -> Array:
        """Answers, the last computed rows.

        Parameters
        ----------
        given : ndarray
            Shape (rows, surfaces).
        shape : (int, int)
            Of the answers of one surface.

        Returns
        -------
        ndarray
            Shape (shape[0], surfaces, shape[1]).
        """
        parts = self.rows, self.lowest, self.pointers, self.columns, self.values
        result = np.empty((shape[0], given.shape[1], shape[1]))

        def share(ends: tuple[int, int]) -> None:
            _apply(*parts, given, ends, result)

        in_threads(share, pieces(given.shape[1], _WIDTH))
        return result


_NOTHING: Blocks = (np.empty(0, np.int64), np.empty(0, np.int64), np.empty((0, FOUR)))


def _lowest(group: Ints, column: Ints, given: int, groups: int) -> Ints:
    """First given row that each group needs, by way of the others too; `given` if none."""
    lowest = np.full(groups, given)
    np.minimum.at(lowest, group, np.minimum(column, given))
    inner = column > given
    source = (column[inner] - (given + FOUR)) // FOUR
    while True:  # as often as the tree has levels
        reached = lowest.copy()
        np.minimum.at(reached, group[inner], lowest[source])
        if np.array_equal(reached, lowest):
            return lowest
        lowest = reached


@njit(nogil=True, cache=True)
def _apply(
    rows: Any, lowest: Any, pointers: Any, columns: Any, values: Any, given: Any, ends: Any, result: Any
) -> None:
    """All rows for some of the surfaces; the sum over a row has one order, whatever the block."""
    known = given.shape[0]
    quantities, _, separations = result.shape
    size = known + FOUR + FOUR * rows.size
    answers = size - (quantities * separations + FOUR - 1) // FOUR * FOUR
    table = np.empty((size, _WIDTH))
    for first in range(ends[0], ends[1], _WIDTH):
        n = min(_WIDTH, ends[1] - first)
        table[known : known + FOUR] = 0.0
        _sweep(table.reshape(-1), given, first, n, rows, lowest, pointers, columns, values)
        for q in range(quantities):
            for i in range(n):
                for k in range(separations):
                    result[q, first + i, k] = table[answers + q * separations + k, i]


@njit(nogil=True, cache=True, fastmath={"contract"})
def _sweep(
    table: Any,
    given: Any,
    first: Any,
    n: Any,
    rows: Any,
    lowest: Any,
    pointers: Any,
    columns: Any,
    values: Any,
) -> None:
    """Fill a flat table. Unsigned places, for a signed one may count from the end."""
    sums = np.empty(FOUR * _WIDTH)
    fetched = given.shape[0]
    for group in range(rows.size):
        for row in range(lowest[group], fetched):
            for k in range(n):
                table[np.uint64(row * _WIDTH + k)] = given[np.uint64(row), np.uint64(first + k)]
            for k in range(n, _WIDTH):
                table[np.uint64(row * _WIDTH + k)] = 0.0
        fetched = lowest[group]
        sums[:] = 0.0
        for tile in range(pointers[group], pointers[group + 1]):
            ka = columns[tile] * np.uint64(_WIDTH)
            kb, kc, kd = ka + np.uint64(_WIDTH), ka + np.uint64(2 * _WIDTH), ka + np.uint64(3 * _WIDTH)
            a0, b0, c0, d0 = values[tile, 0, 0], values[tile, 0, 1], values[tile, 0, 2], values[tile, 0, 3]
            a1, b1, c1, d1 = values[tile, 1, 0], values[tile, 1, 1], values[tile, 1, 2], values[tile, 1, 3]
            a2, b2, c2, d2 = values[tile, 2, 0], values[tile, 2, 1], values[tile, 2, 2], values[tile, 2, 3]
            a3, b3, c3, d3 = values[tile, 3, 0], values[tile, 3, 1], values[tile, 3, 2], values[tile, 3, 3]
            for k in range(_WIDTH):
                i = np.uint64(k)
                w, x, y, z = table[ka + i], table[kb + i], table[kc + i], table[kd + i]
                sums[i] += (a0 * w + b0 * x) + (c0 * y + d0 * z)
                sums[i + np.uint64(_WIDTH)] += (a1 * w + b1 * x) + (c1 * y + d1 * z)
                sums[i + np.uint64(2 * _WIDTH)] += (a2 * w + b2 * x) + (c2 * y + d2 * z)
                sums[i + np.uint64(3 * _WIDTH)] += (a3 * w + b3 * x) + (c3 * y + d3 * z)
        at = np.uint64(rows[group] * _WIDTH)
        for k in range(FOUR * _WIDTH):
            table[at + np.uint64(k)] = sums[np.uint64(k)]
