"""Sums of products of every two columns: the compiled loop behind covariances.

A library's matrix product adds in an order that depends on how many threads it has; this one does not.
"""

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mcgw.machine.compiling import njit
from mcgw.machine.in_threads import in_threads

__all__ = ["packed", "products", "unpacked"]

Array = NDArray[np.float64]

_ROWS = 256  # of a column at a time: those of all columns stay near
_BANDS = 16  # that threads share


@njit(nogil=True, cache=True, fastmath={"reassoc", "contract"})
def _sum_products(columns: Any, first: int, stop: int, out: Any) -> None:  # pragma: no cover - compiled
    """Add the products of columns `first` ... `stop - 1` with all up to themselves."""
    rows = columns.shape[1]
    for start in range(0, rows, _ROWS):
        end = min(start + _ROWS, rows)
        for i in range(first, stop):
            x, place = columns[i, start:end], i * (i + 1) // 2
            for j in range(i + 1):
                y, total = columns[j, start:end], 0.0
                for k in range(end - start):
                    total += x[k] * y[k]
                out[place + j] += total


def products(columns: Array) -> Array:
    """Sums over the rows of products of every two columns.

    Parameters
    ----------
    columns : ndarray
        Shape (columns, rows), contiguous.

    Returns
    -------
    ndarray
        The lower triangle, row after row, shape (columns (columns + 1)/2,): the same bits for any number of
        threads.
    """
    width = len(columns)
    out = np.zeros(width * (width + 1) // 2)
    ends = np.unique((width * np.sqrt(np.linspace(0, 1, _BANDS + 1))).round().astype(int)).tolist()
    bands = list(pairwise(ends))
    turns = [
        bands[k] for start in (0, 1) for k in range(start, len(bands), 2)
    ]  # halves of about the same work
    in_threads(lambda band: _sum_products(columns, *band, out), turns)
    return out


def packed(x: Array, y: Array) -> Array:
    """The lower triangle of the products of two vectors' elements, packed."""
    row, column = np.tril_indices(len(x))
    return np.asarray(x[row] * y[column])


def unpacked(triangle: Array, width: int) -> Array:
    """The symmetric matrix of a packed triangle."""
    matrix = np.empty((width, width))
    row, column = np.tril_indices(width)
    matrix[row, column] = matrix[column, row] = triangle
    return matrix
