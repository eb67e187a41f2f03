"""The height map of a field of asperities: the upper envelope of paraboloid caps.

A bin of a regular grid holds about one asperity. The highest cap above a point is sought bin by bin,
ring by ring, until no asperity further out could rise above what was found: the cost is proportional
to the number of pixels plus that of asperities.
"""

import math
from typing import Any

import numpy as np
from numba import prange

from analytic.arrays import Ints, Marks
from mcgw.machine.compiling import njit
from mcgw.maps.synthetic import Asperities
from mcgw.maps.topography import Topography, checked_shape


def _binned(field: Asperities) -> tuple[Ints, Any, tuple[int, int]]:
    """Sort asperities into about as many bins, nearly square.

    Gives the order that this is; places, heights and sharpness 1/(2R) bin by bin, with the first asperity of
    each bin and the number of all; and how many bins there are along y and x.
    """
    per_length = math.sqrt(max(field.number, 1) / (field.size[0] * field.size[1]))
    columns, rows = (min(max(int(length * per_length), 1), 2**15) for length in field.size)
    i = np.minimum((field.x / field.size[0] * columns).astype(np.int64), columns - 1)
    j = np.minimum((field.y / field.size[1] * rows).astype(np.int64), rows - 1)
    order = np.argsort(j * columns + i, kind="stable")
    starts = np.concatenate([[0], np.cumsum(np.bincount(j * columns + i, minlength=rows * columns))])
    x, y, z, radii = (each[order] for each in (field.x, field.y, field.z, field.radii))
    return order, (x, y, z, 0.5 / radii, starts), (rows, columns)


@njit(cache=True)
def _highest(
    px: Any, py: Any, caps: Any, top: Any, flattest: Any, shape: Any, size: Any, periodic: Any
) -> Any:
    """Height of the envelope above (px, py); of the caps the fourth numbers are 1/(2R)."""
    x, y, z, per, starts = caps
    rows, columns = shape
    bx, by = size[0] / columns, size[1] / rows
    ci, cj = min(int(px / bx), columns - 1), min(int(py / by), rows - 1)
    ex, ey = px - ci * bx, py - cj * by  # inside its own bin
    margin = min(min(ex, bx - ex), min(ey, by - ey))
    least = min(bx, by)
    best = -np.inf
    for ring in range(max(rows, columns) + 1):
        away = max((ring - 1) * least + margin, 0.0) if ring else 0.0
        if best >= top - away * away * flattest:
            break
        for dj in range(-ring, ring + 1):
            turns_y, j = divmod(cj + dj, rows)
            step = 1 if abs(dj) == ring else 2 * ring
            for di in range(-ring, ring + 1, max(step, 1)):
                i = ci + di
                turns_x, i = (0, i) if 0 <= i < columns else divmod(i, columns)
                if (turns_x or turns_y) and not periodic:
                    continue
                for k in range(starts[j * columns + i], starts[j * columns + i + 1]):
                    dx, dy = x[k] + turns_x * size[0] - px, y[k] + turns_y * size[1] - py
                    best = max(best, z[k] - (dx * dx + dy * dy) * per[k])
    return best


@njit(parallel=True, cache=True)
def _heights(px: Any, py: Any, caps: Any, shape: Any, size: Any, periodic: Any) -> Any:
    """Envelope above points in rows and columns."""
    result = np.empty(px.shape)
    top, flattest = caps[2].max(), caps[3].min()
    for j in prange(px.shape[0]):
        for i in range(px.shape[1]):
            result[j, i] = _highest(px[j, i], py[j, i], caps, top, flattest, shape, size, periodic)
    return result


def envelope(
    field: Asperities, shape: tuple[int, int], *, width: float | None = None, periodic: bool = False
) -> Topography:
    """Upper envelope of the caps ``z_i - r^2/(2R)`` on a grid of rows and columns, heights in m.

    The map has the extent of the field; or a `width` along x in m, with square pixels and the corner of the
    field. If it is `periodic`, caps reach across the edges of the field. ValueError if there is no asperity,
    no pixel or too many of them, or the map reaches beyond the field.
    """
    rows, columns = checked_shape(*shape)
    if not field.number:
        raise ValueError("the surface has no asperity: nothing to map")
    pixel = (field.size[0] / columns, field.size[1] / rows)
    if width is not None:
        widest = min(field.size[0], field.size[1] * columns / rows)
        if not 0 < width <= (1 + 1e-9) * widest:
            raise ValueError(
                f"width = {width:g} m: give a length > 0, up to the nominal area's {widest:.4g} m"
            )
        pixel = (width / columns, width / columns)
    x, y = ((np.arange(n) + 0.5) * p for n, p in zip((columns, rows), pixel, strict=True))
    points = (np.broadcast_to(each, (rows, columns)) for each in (x, y[:, None]))
    heights = _heights(*points, *_binned(field)[1:], field.size, periodic)
    return Topography(heights, pixel, periodic and width is None)


def hidden_summits(field: Asperities, *, periodic: bool = False) -> Marks:
    """Which summits lie below the cap of a taller neighbour, across the edges too if periodic."""
    order, caps, shape = _binned(field)
    hidden = np.empty(field.number, dtype=np.bool_)
    x, y, z = (of_each[:, None] for of_each in caps[:3])
    hidden[order] = (_heights(x, y, caps, shape, field.size, periodic) > z)[:, 0]
    return hidden
