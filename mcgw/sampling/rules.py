"""Chebyshev points and products of matrices: the same bits for any number of threads and jobs.

Libraries of linear algebra share a product out to as many threads as there are, so that of here is written
out: each sum is taken in the order of its terms.
"""

import math
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from analytic.arrays import Array
from mcgw.machine.compiling import njit


def chebyshev_points(n: int) -> Array:
    """Return the zeros of T_n in increasing order, shape (n,)."""
    return np.asarray(np.sin(np.pi / (2 * n) * np.arange(1 - n, n, 2)))


def chebyshev_transform(points: Array) -> Array:
    """Return the matrix from values at the Chebyshev points to coefficients of the series, shape (n, n)."""
    n = len(points)
    matrix = np.asarray(chebyshev.chebvander(points, n - 1).T * (2 / n), dtype=np.float64)
    matrix[0] /= 2
    return matrix


def product(a: Array, b: Array) -> Array:
    """Return the product of two matrices.

    Parameters
    ----------
    a, b : ndarray
        Shape (..., n) and (n, m), or (n,).

    Returns
    -------
    ndarray
        Shape (..., m), or (...).
    """
    rows = np.ascontiguousarray(a.reshape(math.prod(a.shape[:-1]), a.shape[-1]))
    columns = np.ascontiguousarray(b.reshape(len(b), math.prod(b.shape[1:])))
    result = np.empty((len(rows), columns.shape[1]))
    multiply(rows, columns, result)
    return result.reshape(a.shape[:-1] + b.shape[1:])


@njit(cache=True, fastmath={"contract"})
def multiply(a: Any, b: Any, result: Any) -> None:
    """Write `product` of two matrices, in compiled loops."""
    for i in range(a.shape[0]):
        for j in range(b.shape[1]):
            result[i, j] = 0.0
        for k in range(a.shape[1]):
            x = a[i, k]
            for j in range(b.shape[1]):
                result[i, j] += x * b[k, j]
