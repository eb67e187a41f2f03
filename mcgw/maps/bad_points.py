"""Bad points of a map: missing, spikes, or cut off."""

import math
from typing import Any

import numpy as np
from scipy import ndimage
from scipy.sparse import coo_array, diags_array
from scipy.sparse.linalg import cg

from analytic.arrays import Array
from mcgw.maps.topography import Topography

_STEPS, _CLOSE = 2000, 1e-8
_REACH = 3  # pixels from a point to the ring around it: a spike is narrower than five
BENT = 7.0  # times the usual bend: exceeded once in 4e11 points of a Gaussian map
_OF_MEDIAN = 0.6745  # median over standard deviation of a Gaussian
_OUT = 3.0  # ranges of the ring: 12 deviations of white noise beyond it; ridges, pits and peaks stay below
_LOOKED_AT = 2**18  # points tell the steps of up to some thousand levels
_MOST_LEVELS = 2**12
_MORE = 1.3  # times the points of the next level: of a summit that a step cuts, no level has more


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
    ways = np.array([[[0, 1]], [[0, -1]], [[1, 0]], [[-1, 0]]])
    at = tuple(np.moveaxis(np.clip(np.argwhere(missing) + ways, 0, np.array(heights.shape) - 1), -1, 0))
    beside = index[at]  # beyond an edge the point itself stands for its missing neighbour
    way, point = np.nonzero(beside >= 0)
    others = coo_array((np.ones(way.size), (point, beside[way, point])), shape=(number, number))
    matrix: Any = diags_array(np.full(number, 4.0), format="csr") - others.tocsr()
    start = result[missing]
    known = np.where(beside < 0, result[at], 0.0).sum(axis=0)
    away = known - matrix @ start  # solved for the difference, since heights may be far from zero
    scale = float(np.abs(away).max())
    if scale > 0:
        found = cg(matrix, away / scale, rtol=_CLOSE, maxiter=min(_STEPS, 10 * math.isqrt(number) + 50))[0]
        result[missing] = start + scale * found
    return np.asarray(result)


def spike_heights(topography: Topography) -> Array:
    """How far every point of a spike stands above (or, below 0, under) its ring, m; 0 for all others.

    Points of a spike stand out of the ring three pixels around them, on a map that lacks no points: by more
    than three times the range of heights on that ring, and on half of all rings of the map. So the scale is
    that of the surface next to the point, and a few spikes do not change it.
    """
    heights = topography.heights
    above = np.zeros(heights.shape)
    if min(heights.shape) <= 2 * _REACH:
        return above
    ring = np.pad(np.zeros((2 * _REACH - 1,) * 2, dtype=np.bool_), 1, constant_values=True)
    filters = ndimage.minimum_filter, ndimage.maximum_filter
    low, high = (extreme(heights, footprint=ring, mode="mirror") for extreme in filters)
    high -= low
    some = high[:: max(heights.size // 2**20, 1)]  # rings: enough for their median to a thousandth
    usual = float(np.median(some)) or float(some.mean())  # 0: most of it is flat
    out = np.clip(heights - low, None, 0) + np.clip(heights - low - high, 0, None)
    return np.where(np.abs(out) > _OUT * np.maximum(high, usual), out, 0.0)


def small_spike_heights(topography: Topography) -> Array:
    """Heights of spikes above the mean of their four neighbours, for points with unusual bends.

    A spike may be lower than its surroundings are high and still have most of the curvature of a map. Its
    second differences lie beyond seven times the usual ones, and beyond those of the points next to it.
    """
    bends = ndimage.laplace(topography.heights, mode="nearest")
    size = np.abs(bends)
    out = (size > BENT * usual_bend(bends)) & (size == ndimage.maximum_filter(size, 3))
    return np.asarray(np.where(out, bends / -4, 0.0))


def usual_bend(bends: Array) -> float:
    """Return the standard deviation of Gaussian bends that have the median of these; some may be nan."""
    return float(np.nanmedian(np.abs(bends - np.nanmedian(bends)))) / _OF_MEDIAN


def recorded(heights: Array) -> tuple[float, float]:
    """Return resolution and clipping of a map as it was read; some points may be missing.

    The step between two heights that follow each other, m, 0 if they are as good as continuous; and the
    share of the points that have the greatest height, or the least, where they are more than a range that
    holds all heights leaves there, else 0.
    """
    some = heights.ravel()[:: max(heights.size // _LOOKED_AT, 1)]
    levels = np.unique(some[np.isfinite(some)])
    steps = np.diff(levels)
    step = float(np.median(steps)) if 1 < levels.size < min(_MOST_LEVELS, some.size / 8) else 0.0
    clipped = 0.0
    for end, inwards in ((np.nanmax(heights), -step), (np.nanmin(heights), step)):
        number = np.count_nonzero(heights == end)
        below = np.count_nonzero(np.abs(heights - (end + inwards)) < step / 2) if step else 0
        if number > max(_MORE * below, 1):  # the next level has clearly fewer
            clipped = max(clipped, number / heights.size)
    return step, clipped
