"""Moments of crowded cells from their Gaussian limit: the price no longer depends on N.

The moments of a cell with n asperities are sums of n independent vectors ``b(u)``, so for large n
they are Gaussian with mean ``n E b`` and covariance ``n Cov b``, both known exactly. Cells are narrow:
what is approximated is only the small part of the fluctuations that arises inside a cell. In 1e5 surfaces
the first four cumulants of load, area and stiffness cannot be told from the exact ones for N from 10 to
1e9, even if single asperities count as a crowd (`tests/test_aggregate.py`). What gives the approximation
away is the shape: with a threshold of 1, 1 % of the surfaces at light contact have a negative load, with 4
one in 1e5, with 16 or more none.
"""

from functools import cache
from typing import Any

import numpy as np
from numba import njit
from numpy.polynomial import chebyshev
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray
from scipy.special import ndtri

from mcgw.sampling.moments import Layout
from mcgw.sampling.philox import MOMENTS, centred

__all__ = ["CROWDED", "add_gaussian_moments"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

CROWDED = 256  # asperities in a cell, from which its moments count as Gaussian


@cache
def _law_of_moments(plain: int, rooted: int) -> tuple[Array, Array]:
    """Mean of b = (T_0 .., sqrt(u) T_0 ..) for a uniform u, and a root of its covariance.

    The root is the triangle of a QR decomposition, never of the covariance itself, whose least
    eigenvalues are lost to rounding. The rooted ones are nearly dependent: with the highest first
    no later one has a larger part along a direction than the one that gave it.
    """
    v, w = leggauss(48)
    v, w = (1 + v) / 2, w / 2 * (1 + v)  # u = v^2: the integrands are polynomials in v
    x = 2 * v * v - 1
    b = np.concatenate(
        [
            chebyshev.chebvander(x, max(plain, 1) - 1)[:, :plain],
            v[:, None] * chebyshev.chebvander(x, max(rooted, 1) - 1)[:, :rooted],
        ],
        axis=1,
    )
    mean = w @ b
    if plain:
        mean[0] = 1.0  # T_0 counts the asperities
    varying = [*range(min(plain, 1), plain), *range(plain + rooted - 1, plain - 1, -1)]
    order = np.array(varying, dtype=np.int64)
    triangle = np.linalg.qr((b - mean)[:, order] * np.sqrt(w)[:, None], mode="r")
    root = np.zeros((plain + rooted, plain + rooted))
    root[np.ix_(order, order)] = (triangle * np.sign(np.diag(triangle))[:, None]).T
    return mean, root


@njit(nogil=True, cache=True)
def _words(seed: Any, first_surface: Any, rows: Any, surfaces: Any) -> Any:
    """One centred uniform for each of some moments of each surface: shape (rows, surfaces)."""
    result = np.empty((rows.size, surfaces))
    last = rows[-1] + 1
    for first in range(0, surfaces, 8):  # as many as share a line of the cache
        n = min(8, surfaces - first)
        x = np.empty((n, (last + 63) // 64 * 64))
        for i in range(n):
            centred(x[i], seed, MOMENTS, first_surface + first + i, 0, 0, last)
        for j in range(rows.size):
            for i in range(n):
                result[j, first + i] = x[i, rows[j]]
    return result


@njit(nogil=True, cache=True)
def _mix(moments: Any, counts: Any, rows: Any, laws: Any, z: Any) -> None:
    """Write ``n mean + sqrt(n) root z`` where n > 0, in one order of summation."""
    starts, sizes, means, roots = laws
    cells, surfaces = counts.shape
    for c in range(cells):
        n, size, start = np.sqrt(counts[c].astype(np.float64)), sizes[c], starts[c]
        total = np.empty(surfaces)
        for j in range(size):
            total[:] = 0.0
            for k in range(size):
                factor = roots[start + j, k]
                if factor != 0.0:  # a triangle
                    for i in range(surfaces):
                        total[i] += factor * z[start + k, i]
            for i in range(surfaces):
                if n[i] > 0:
                    moments[rows[start + j], i] = counts[c, i] * means[start + j] + n[i] * total[i]


def add_gaussian_moments(seed: int, first: int, counts: Ints, layout: Layout, moments: Array) -> None:
    """Fill in the moments of crowded cells.

    Parameters
    ----------
    seed : int
        The scene's.
    first : int
        Number of the first surface.
    counts : ndarray of int
        Asperities of each crowded cell, else 0; shape (cells, surfaces).
    layout : Layout
        Which moments each cell has.
    moments : ndarray
        Shape (moments, surfaces); written where `counts` is positive.
    """
    crowded = np.flatnonzero(counts.any(axis=1) & (layout.sizes > 0))
    if not crowded.size:
        return
    sizes = layout.sizes[crowded]
    starts = np.cumsum(sizes) - sizes
    rows = np.repeat(layout.starts[crowded] - starts, sizes) + np.arange(sizes.sum())
    means, roots = np.empty(len(rows)), np.zeros((len(rows), sizes.max()))
    for cell, start, size in zip(crowded, starts, sizes, strict=True):
        law = _law_of_moments(int(layout.plain[cell]), int(layout.rooted[cell]))
        means[start : start + size], roots[start : start + size, :size] = law
    words = _words(np.uint64(seed), first, rows, counts.shape[1])
    _make_normal(words)
    _mix(moments, counts[crowded], rows, (starts, sizes, means, roots), words)


def _make_normal(x: Array) -> None:
    """Turn centred uniforms into normal numbers, in place."""
    x += 1
    x /= 2
    ndtri(x, out=x)
