"""What each sub-area of a map tells by itself, and whether one of them carries the whole map."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mcgw.formats.table import Column, Table
from mcgw.maps.summit_sums import SUMS, SummitSums

__all__ = ["Alone", "Tiles", "alone_of", "tiles_of", "write_tiles"]

Array = NDArray[np.float64]

_MEASURED = ("summits", "eta", "radius", "sigma", "m0", "m2", "m4")
_UNITS = (
    "eta in 1/m^2, radius and sigma in m, by the summits of the tile; m0 in m^2, m2, m4 in 1/m^2; heights "
    "are about the mean of the tile"
)
_HALF = 0.5


@dataclass(frozen=True)
class Tiles:
    """Sub-areas of a map, each by itself; arrays of shape (tiles,), counted along x first.

    Parameters
    ----------
    across : int
        How many there are along each axis.
    summits : ndarray of int
        Summits on each.
    eta, radius, sigma : ndarray
        Density, inverse mean curvature and standard deviation of heights of the summits counted there,
        1/m^2, m, m; nan where there are too few.
    m0, m2, m4 : ndarray
        Spectral moments, m^2, 1, 1/m^2; heights are taken about the mean of the tile, so that waves longer
        than it count less than on the whole map.
    """

    across: int
    summits: NDArray[np.int64]
    eta: Array
    radius: Array
    sigma: Array
    m0: Array
    m2: Array
    m4: Array

    def variation(self, name: str) -> float:
        """Standard deviation over the tiles of one of these numbers, over their mean."""
        values = getattr(self, name)
        values = values[np.isfinite(values)]
        return float(values.std(ddof=1) / values.mean()) if values.size > 1 else math.nan


def tiles_of(counted: SummitSums) -> Tiles:
    """What each sub-area tells."""
    points, *sums = np.where(counted.sums[0] > 0, counted.sums, np.nan)  # where nothing was seen
    m = dict(zip(SUMS[1:], sums / points, strict=True))
    number = np.bincount(counted.part, minlength=counted.parts)

    def mean(values: Array) -> Array:
        total = np.bincount(counted.part, values, minlength=counted.parts)
        return np.asarray(np.where(number > 0, total / np.maximum(number, 1), np.nan))

    squares = mean((counted.heights - mean(counted.heights)[counted.part]) ** 2)
    several = np.where(number > 1, number / np.maximum(number - 1, 1), np.nan)
    return Tiles(
        round(counted.parts**0.5),
        number,
        number / (points * counted.pixel_area),
        1 / mean(counted.curvatures),
        np.sqrt(squares * several),
        m["z2"] - m["z"] ** 2,
        (m["slope_x"] + m["slope_y"]) / 2,
        m["bend"],
    )


def write_tiles(tiles: Tiles, path: Path) -> None:
    """Write a table with a row for each tile; a comment above it tells the units."""
    tile = np.arange(tiles.across**2)
    counted = {"tile": tile, "column": tile % tiles.across, "row": tile // tiles.across}
    columns = counted | {name: getattr(tiles, name) for name in _MEASURED}
    Table(tuple(Column(name, values) for name, values in columns.items())).write(path, comment=_UNITS)


@dataclass(frozen=True, slots=True)
class Alone:
    """A sub-area without which a mean square is less than half.

    Parameters
    ----------
    moment : {"m0", "m2", "m4"}
        Of heights, slopes or second derivatives.
    left : float
        Share of it that is left without this sub-area.
    column, row : int
        Which sub-area, from 0.
    across : int
        Sub-areas along each axis.
    """

    moment: str
    left: float
    column: int
    row: int
    across: int


def alone_of(counted: SummitSums) -> Alone | None:
    """The sub-area that most of a mean square stands on, if there is one; m4 before m2 before m0."""
    sums = dict(zip(SUMS, counted.sums, strict=True))
    points = sums["points"]
    if np.count_nonzero(points) == 1:
        return None
    mean = sums["z"].sum() / points.sum()
    squares = {
        "m4": sums["bend"],
        "m2": sums["slope_x"] + sums["slope_y"],
        "m0": sums["z2"] - 2 * mean * sums["z"] + mean**2 * points,
    }
    across = round(counted.parts**0.5)
    for moment, square in squares.items():
        part = int(np.argmax(square))
        rest = (square.sum() - square[part]) / (points.sum() - points[part])
        left = float(rest / (square.sum() / points.sum()))
        if left < _HALF:
            return Alone(moment, left, part % across, part // across, across)
    return None
