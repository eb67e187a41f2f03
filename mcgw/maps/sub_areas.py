"""What each sub-area of a map tells by itself, and whether one of them carries the whole map."""

import math
from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array
from mcgw.formats.table import Column, Table
from mcgw.maps.summit_sums import SUMS, SummitSums

TILES = (  # what stands above their table in a file
    "eta in 1/m^2, radius and sigma in m, by the summits of the tile; m0 in m^2, m2, m4 in 1/m^2; heights "
    "are about the mean of the tile"
)
_HALF = 0.5


def tiles_of(counted: SummitSums) -> Table:
    """What each sub-area tells by itself, a row each, counted along x first.

    By its summits their number, density, inverse mean curvature and standard deviation of heights, nan where
    they are too few; and spectral moments of heights about its own mean, so that waves longer than it count
    less than on the whole map.
    """
    points, *sums = np.where(counted.sums[0] > 0, counted.sums, np.nan)  # where nothing was seen
    m = dict(zip(SUMS[1:], sums / points, strict=True))
    number = np.bincount(counted.part, minlength=counted.parts)

    def mean(values: Array) -> Array:
        total = np.bincount(counted.part, values, minlength=counted.parts)
        return np.asarray(np.where(number > 0, total / np.maximum(number, 1), np.nan))

    squares = mean((counted.heights - mean(counted.heights)[counted.part]) ** 2)
    several = np.where(number > 1, number / np.maximum(number - 1, 1), np.nan)
    tile = np.arange(counted.parts)
    return Table(
        (
            Column("tile", tile),
            Column("column", tile % counted.across),
            Column("row", tile // counted.across),
            Column("summits", number),
            Column("eta", number / (points * counted.pixel_area), unit="1/m^2"),
            Column("radius", 1 / mean(counted.curvatures), "R", "m"),
            Column("sigma", np.sqrt(squares * several), unit="m"),
            Column("m0", m["z2"] - m["z"] ** 2, unit="m^2"),
            Column("m2", (m["slope_x"] + m["slope_y"]) / 2),
            Column("m4", m["bend"], unit="1/m^2"),
        )
    )


def variation(values: Array) -> float:
    """Standard deviation over the tiles, over the mean; nan where fewer than two tell anything."""
    values = values[np.isfinite(values)]
    return float(values.std(ddof=1) / values.mean()) if values.size > 1 else math.nan


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
    for moment, square in squares.items():
        part = int(np.argmax(square))
        rest = (square.sum() - square[part]) / (points.sum() - points[part])
        left = float(rest / (square.sum() / points.sum()))
        if left < _HALF:
            return Alone(moment, left, part % counted.across, part // counted.across, counted.across)
    return None
