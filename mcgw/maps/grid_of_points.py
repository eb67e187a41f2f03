"""Heights from lists of points: x, y and z a line, on a regular grid in any order, or along a line."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array
from mcgw.maps.topography import checked_shape

_SAME = 0.3  # of the widest step: places nearer than that are one
_EVEN = 0.05  # of a step that a place may be off the grid
_SPARSE = 4  # points of the grid for each one that is there


def grid_of(path: Path, points: Array) -> tuple[Array, tuple[float, float]]:
    """Return heights on the grid on which the points lie, and its pixel; nan where there is none.

    Parameters
    ----------
    path : Path
        Of the file, for errors.
    points : ndarray
        Of x, y and z, shape (points, 3), in any order.

    Raises
    ------
    ValueError
        If the places along x or y are not evenly spaced, most of the grid is empty, a place has two heights,
        or all points lie on one line.
    """
    if not np.isfinite(points[:, :2]).all():
        raise ValueError(f"{path}: a point lacks x or y")
    (columns, dx, i), (rows, dy, j) = (_places(path, name, points[:, k]) for k, name in enumerate("xy"))
    if min(columns, rows) == 1:
        raise ValueError(f"{path}: all points lie on one line: a profile; give x and z alone")
    checked_shape(rows, columns)
    if rows * columns > _SPARSE * len(points):
        raise ValueError(
            f"{path}: {len(points)} points on a grid of {columns} x {rows}: scattered points are not a map; "
            "interpolate them to a grid first"
        )
    heights = np.full((rows, columns), np.nan)
    number = np.bincount(j * columns + i, minlength=rows * columns)
    if number.max() > 1:
        twice = int(np.argmax(number[j * columns + i] > 1))
        raise ValueError(f"{path}: x = {points[twice, 0]:g}, y = {points[twice, 1]:g} has two heights")
    heights[j, i] = points[:, 2]
    return heights, (dx, dy)


def _places(path: Path, name: str, values: Array) -> tuple[int, float, NDArray[np.intp]]:
    """Return the number of places along an axis, their distance, and which one each point has."""
    ordered = np.unique(values)
    steps = np.diff(ordered)
    if not steps.size:
        return 1, 0.0, np.zeros(values.size, dtype=np.intp)
    begins = np.concatenate([[True], steps > _SAME * steps.max()])
    first = ordered[begins]
    places = np.searchsorted(first, values, side="right") - 1
    centres = np.bincount(places, weights=values) / np.bincount(places)
    distance = float(f"{(centres[-1] - centres[0]) / max(len(first) - 1, 1):.12g}")  # as a text may give it
    even = centres[0] + distance * np.arange(len(first))
    if not np.all(np.abs(values - even[places]) <= _EVEN * distance):
        raise ValueError(
            f"{path}: {name} of the points is not evenly spaced ({len(first)} places from {ordered[0]:g} to "
            f"{ordered[-1]:g}); single points with x, y and z are a map only on a regular grid"
        )
    return len(first), distance, places


def along_line(points: Array) -> int | None:
    """Return which of x (0) and y (1) rises along points that all have one value of the other, if they do."""
    for along, across in ((0, 1), (1, 0)):
        if np.ptp(points[:, across]) == 0 < np.ptp(points[:, along]):
            return along
    return None
