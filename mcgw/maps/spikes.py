"""Points that stand out of their surroundings: dust, dropouts, wrong readings."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from mcgw.maps.topography import Topography

__all__ = ["Spikes", "spike_heights", "spikes_of"]

Array = NDArray[np.float64]

_REACH = 3  # pixels from a point to the ring around it: a spike is narrower than five
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
    shape = topography.heights.shape
    if min(shape) <= 2 * _REACH:
        return np.zeros(shape)
    padded = np.pad(topography.heights, _REACH, mode="reflect")
    low = _ring(padded, ndimage.minimum_filter1d, np.minimum)
    high = _ring(padded, ndimage.maximum_filter1d, np.maximum)
    ranges = high - low
    above = np.maximum(topography.heights - high, 0.0) + np.minimum(topography.heights - low, 0.0)
    usual = float(np.median(ranges)) or float(ranges.mean())  # 0: most of the map is flat
    return np.asarray(np.where(np.abs(above) > _OUT * np.maximum(ranges, usual), above, 0.0))


def _ring(padded: Array, filter1d: Any, extreme: Any) -> Array:
    """Lowest or highest value on the square of seven points around every one."""
    along = filter1d(padded, 2 * _REACH + 1, axis=1)[:, _REACH:-_REACH]
    down = filter1d(padded, 2 * _REACH + 1, axis=0)[_REACH:-_REACH]
    rows = extreme(along[: -2 * _REACH], along[2 * _REACH :])
    return np.asarray(extreme(rows, extreme(down[:, : -2 * _REACH], down[:, 2 * _REACH :])))
