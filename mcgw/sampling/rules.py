"""Points, weights and products of matrices in plain arithmetic: the same bits on every processor.

The libraries that do this elsewhere choose their order of summation, and how they round, by the processor.
"""

import math
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from analytic.arrays import Array
from mcgw.machine.compiling import njit
from mcgw.sampling.lanes import LANES, alike, fused, load, store

_TOGETHER = 4 * LANES  # columns


def _sine(x: Any) -> Array:
    """Taylor's series, for numbers from -pi/2 to pi/2."""
    value = np.ones(x.shape)
    for k in range(26, 0, -2):
        value = 1.0 - value * (x * x) / (k * (k + 1))
    return np.asarray(x * value)


def chebyshev_points(n: int) -> Array:
    """Zeros of T_n in increasing order, shape (n,)."""
    return _sine(math.pi / (2 * n) * np.arange(1 - n, n, 2))


def chebyshev_transform(points: Array) -> Array:
    """Matrix from values at the Chebyshev points to coefficients of the series, shape (n, n)."""
    n = len(points)
    matrix = np.asarray(chebyshev.chebvander(points, n - 1).T * (2 / n), dtype=np.float64)
    matrix[0] /= 2
    return matrix


@cache
def gauss_legendre(n: int) -> tuple[Array, Array]:
    """Points and weights of Gauss's rule on (0, 1).

    Parameters
    ----------
    n : int
        How many.

    Returns
    -------
    (ndarray, ndarray)
        The points in increasing order.
    """
    x = _sine(math.pi * (np.arange(n) - (n - 1) / 2) / (n + 0.5))
    for _ in range(6):  # quadratic convergence from three digits
        last, value = np.ones_like(x), x
        for k in range(2, n + 1):
            last, value = value, ((2 * k - 1) * x * value - (k - 1) * last) / k
        x = x - value * (1 - x * x) / (n * (last - x * value))
    w = (1 - x) * (1 + x) / (n * last) ** 2
    return (1 + x) / 2, w / w.sum()


def product(a: Array, b: Array) -> Array:
    """Product of two matrices, each sum in the order of its terms.

    Parameters
    ----------
    a, b : ndarray
        Shape (..., n) and (n, m), or (n,).

    Returns
    -------
    ndarray
        Shape (..., m), or (...).
    """
    rows, columns = (
        np.ascontiguousarray(a.reshape(math.prod(a.shape[:-1]), a.shape[-1])),
        np.ascontiguousarray(b.reshape(len(b), math.prod(b.shape[1:]))),
    )
    result = np.empty((len(rows), columns.shape[1]))
    multiply(rows, columns, result)
    return result.reshape(a.shape[:-1] + b.shape[1:])


@njit(cache=True)
def multiply(a: Any, b: Any, result: Any) -> None:
    """As `product`, in compiled loops: sixteen columns at a time, whose sums stay in registers."""
    columns = b.shape[1]
    whole = columns // _TOGETHER * _TOGETHER
    for j in range(0, whole, _TOGETHER):
        for i in range(a.shape[0]):
            s = t = u = v = alike(0.0)
            for k in range(a.shape[1]):
                x, at = alike(a[i, k]), k * columns + j
                s, t = fused(x, load(b, at), s), fused(x, load(b, at + LANES), t)
                u, v = fused(x, load(b, at + 2 * LANES), u), fused(x, load(b, at + 3 * LANES), v)
            at = i * columns + j
            store(result, at, s)
            store(result, at + LANES, t)
            store(result, at + 2 * LANES, u)
            store(result, at + 3 * LANES, v)
    for j in range(whole, columns - LANES + 1, LANES):
        for i in range(a.shape[0]):
            s = alike(0.0)
            for k in range(a.shape[1]):
                s = fused(alike(a[i, k]), load(b, k * columns + j), s)
            store(result, i * columns + j, s)
    for j in range(columns // LANES * LANES, columns):
        for i in range(a.shape[0]):
            result[i, j] = 0.0
            for k in range(a.shape[1]):
                result[i, j] = fused(a[i, k], b[k, j], result[i, j])


def triangle(columns: Array) -> Array:
    """Upper triangle R with a diagonal >= 0 of the QR decomposition of a matrix, by Gram and Schmidt.

    Parameters
    ----------
    columns : ndarray
        Shape (n, m), n >= m.

    Returns
    -------
    ndarray
        Shape (m, m).
    """
    left, m = columns.copy(), columns.shape[1]
    result = np.zeros((m, m))
    for j in range(m):
        size = np.sqrt(product(left[:, j], left[:, j]))
        result[j, j] = size
        if size > 0:
            direction = left[:, j] / size
            result[j, j + 1 :] = product(direction, left[:, j + 1 :])
            left[:, j + 1 :] -= direction[:, None] * result[j, j + 1 :]
    return result
