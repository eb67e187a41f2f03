"""Points that stand out of their surroundings: dust, dropouts, wrong readings."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from mcgw.maps.topography import Topography

__all__ = ["BENT", "Spikes", "small_spike_heights", "spike_heights", "spikes_of", "usual_bend"]

Array = NDArray[np.float64]

_REACH = 3  # pixels from a point to the ring around it: a spike is narrower than five
BENT = 7.0  # usual bends: once in 4e11 points of a Gaussian map
_OF_MEDIAN = 0.6745  # of a Gaussian deviation
_BAND = 64  # rows that are looked at together: what is made of them stays in the cache
_OUT = 3.0  # ranges of the ring: 12 deviations of white noise beyond it; ridges, pits and peaks stay below


@dataclass(frozen=True, slots=True)
class Spikes:
    """What stands out of a map.

    Parameters
    ----------
    number : int
        Places; adjacent points are one.
    x, y : float
        Where the highest or deepest of them lies, m.
    height : float
        Of that one above (or, below 0, under) the ring of points around it, m.
    """

    number: int
    x: float
    y: float
    height: float


def spikes_of(topography: Topography) -> Spikes | None:
    """Find points that stand out of the ring three pixels around them, on a map that lacks no points.

    By more than three times the range of heights on that ring, and on half of all rings of the map: the
    scale is that of the surface next to the point, and a few spikes do not change it.
    """
    above = spike_heights(topography)
    out = above != 0
    if not out.any():
        return None
    _, number = ndimage.label(out, structure=np.ones((3, 3)))
    j, i = np.unravel_index(int(np.argmax(np.abs(above))), above.shape)
    dx, dy = topography.pixel
    return Spikes(number, (int(i) + 0.5) * dx, (int(j) + 0.5) * dy, float(above[j, i]))


def spike_heights(topography: Topography) -> Array:
    """How far every point of a spike stands above (or, below 0, under) its ring, m; 0 for all others."""
    heights = topography.heights
    above = np.zeros(heights.shape)
    if min(heights.shape) <= 2 * _REACH:
        return above
    ranges, places, found = np.empty(heights.shape), [], []
    rows = np.pad(np.arange(len(heights)), _REACH, mode="reflect")
    for first in range(0, len(heights), _BAND):
        around = heights[rows[first : first + _BAND + 2 * _REACH]]
        padded = np.pad(around, ((0, 0), (_REACH, _REACH)), mode="reflect")
        low, high = _ring(padded, np.minimum), _ring(padded, np.maximum)
        here = slice(first, first + _BAND)
        ranges[here] = high - low
        out = np.maximum(heights[here] - high, 0.0) + np.minimum(heights[here] - low, 0.0)
        at = np.flatnonzero(np.abs(out) > _OUT * ranges[here])
        places.append(at + first * heights.shape[1])
        found.append(out.ravel()[at])
    usual = float(np.median(ranges, overwrite_input=True)) or float(ranges.mean())  # 0: most of it is flat
    at, out = np.concatenate(places), np.concatenate(found)
    most = np.abs(out) > _OUT * usual
    above.flat[at[most]] = out[most]
    return above


def small_spike_heights(topography: Topography) -> Array:
    """The same about the mean of the four neighbours, for points that bend unlike all others.

    A spike may be lower than its surroundings are high and still have most of the curvature of a map. Its
    second differences lie beyond seven times the usual ones, and beyond those of the points next to it.
    """
    bends = ndimage.laplace(topography.heights, mode="nearest")
    size = np.abs(bends)
    out = (size > BENT * usual_bend(bends)) & (size == ndimage.maximum_filter(size, 3))
    return np.asarray(np.where(out, bends / -4, 0.0))


def usual_bend(bends: Array) -> float:
    """Standard deviation of Gaussian bends that have the median of these; some may be nan."""
    return float(np.nanmedian(np.abs(bends - np.nanmedian(bends)))) / _OF_MEDIAN


def _ring(padded: Array, extreme: Any) -> Array:
    """Lowest or highest value on the square of seven points around every one."""
    along, down = _of_seven(padded, extreme), _of_seven(padded.T, extreme).T
    rows = extreme(along[: -2 * _REACH], along[2 * _REACH :])
    return np.asarray(extreme(rows, extreme(down[:, : -2 * _REACH], down[:, 2 * _REACH :])))


def _of_seven(z: Array, extreme: Any) -> Array:
    """Lowest or highest of seven neighbours along a line: of two, of two pairs, and of four and four."""
    two = extreme(z[:, :-1], z[:, 1:])
    four = extreme(two[:, :-2], two[:, 2:])
    return np.asarray(extreme(four[:, :-3], four[:, 3:]))
