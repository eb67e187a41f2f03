"""Points without a height get one from the edge of their hole, as a soap film would."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import cg

__all__ = ["filled"]

Array = NDArray[np.float64]

_STEPS, _CLOSE = 2000, 1e-8


def filled(heights: Array) -> Array:
    """Fill missing points: each is the mean of its neighbours left, right, above and below.

    That is Laplace's equation on the pixels. Neighbours beyond the map do not count. In holes wider than
    some thousand points the iteration ends before its limit, near the height of the nearest edge.

    Parameters
    ----------
    heights : ndarray
        Two-dimensional; missing points are nan, not all of them.
    """
    missing = ~np.isfinite(heights)
    number = int(np.count_nonzero(missing))
    if not number:
        return heights
    nearest = ndimage.distance_transform_edt(missing, return_distances=False, return_indices=True)
    result = heights[tuple(nearest)]
    index = np.full(heights.shape, -1, dtype=np.int64)
    index[missing] = np.arange(number)
    neighbours, known = np.zeros(number), np.zeros(number)
    pairs = []
    for here, other in _neighbours():
        holes = missing[here]
        at, beside = index[here][holes], index[other][holes]
        neighbours[at] += 1
        inside = beside >= 0
        pairs.append((at[inside], beside[inside]))
        known[at[~inside]] += result[other][holes][~inside]
    rows, columns = (np.concatenate(found) for found in zip(*pairs, strict=True))
    own = np.arange(number)
    matrix = coo_matrix(
        (
            np.concatenate([neighbours, np.full(rows.size, -1.0)]),
            (np.concatenate([own, rows]), np.concatenate([own, columns])),
        ),
        shape=(number, number),
    ).tocsr()
    start = result[missing]
    away = known - matrix @ start  # solved for the difference: heights may lie far from zero
    scale = float(np.abs(away).max())
    if scale > 0:
        found = cg(matrix, away / scale, rtol=_CLOSE, maxiter=min(_STEPS, 10 * math.isqrt(number) + 50))[0]
        result[missing] = start + scale * found
    return np.asarray(result)


def _neighbours() -> list[tuple[tuple[slice, slice], tuple[slice, slice]]]:
    """Views of a map, and of itself one point further, four ways."""
    every, first, last = slice(None), slice(None, -1), slice(1, None)
    ways = []
    for here, other in ((first, last), (last, first)):
        ways.append(((here, every), (other, every)))
        ways.append(((every, here), (every, other)))
    return ways
