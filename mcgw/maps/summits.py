"""Every summit of a map: its place, height and two principal curvatures.

Also estimates from each sub-area alone.
"""

import math
from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.formats.table import Column, Table
from mcgw.maps.summit_sums import EDGE, SUMS, SummitSums
from mcgw.maps.topography import Topography

# What stands above their tables in a file.
SUMMITS = "height is above the mean of the summits, radius is 1/sqrt(curvature_1 curvature_2)"
TILES = "eta, radius and sigma by the summits of the tile; heights are about the mean of the tile"


@dataclass(frozen=True)
class Summits:
    """Summits of a map; arrays have the shape (summits,) unless stated otherwise.

    Parameters
    ----------
    x, y : ndarray
        Positions from the corner of the trimmed and cropped map, m; the centre of its first pixel is half a
        pixel from the corner.
    heights : ndarray
        Heights relative to their mean, m.
    curvatures : ndarray
        Principal curvatures, shape (2, summits), the larger ones first, 1/m; positive.
    tile : ndarray of int
        Sub-area of each, counted from 0 along x first.
    unresolved : int
        Number of summits on ridges between pixels, of which only the mean curvature is known; both curvatures
        equal it.
    size : (float, float) or None
        Width and height of what was counted, m, by which a periodic cell repeats.
    """

    x: Array
    y: Array
    heights: Array
    curvatures: Array
    tile: Ints
    unresolved: int
    size: tuple[float, float] | None = None

    @property
    def radii(self) -> Array:
        """Radii of spheres that carry nearly the summits' loads, ``1/sqrt(k1 k2)``, m (Greenwood 2006)."""
        return np.asarray(1 / np.sqrt(self.curvatures[0] * self.curvatures[1]))

    def table(self) -> Table:
        """Return a row for each summit."""
        lengths = {"x": self.x, "y": self.y, "height": self.heights, "radius": self.radii}
        sharpness = zip(("curvature_1", "curvature_2"), self.curvatures, strict=True)
        columns = [Column(name, values, unit="m") for name, values in lengths.items()]
        columns += [Column(name, values, unit="1/m") for name, values in sharpness]
        return Table((*columns, Column("tile", self.tile)))


def summits_of(used: Topography, counted: SummitSums, origin: tuple[float, float]) -> Summits:
    """Return every summit that was counted on a map, without form and filtered.

    Its corner lies at the `origin` of the map as it was read, x and y in m.
    """
    margin = 0 if used.periodic else EDGE
    size = [(n - 2 * margin) * p for n, p in zip(used.heights.shape[::-1], used.pixel, strict=True)]
    places, beside, (larger, smaller) = np.split(counted.summits[2:], 3)
    x, y = (
        corner + margin * p + at * length + vertex * p
        for corner, p, length, at, vertex in zip(origin, used.pixel, size, places, beside, strict=True)
    )
    curvatures = np.array([larger, np.where(np.isnan(smaller), larger, smaller)])
    heights, unresolved = counted.heights - counted.heights.mean(), int(np.isnan(smaller).sum())
    return Summits(x, y, heights, curvatures, counted.part, unresolved, (size[0], size[1]))


def tiles_of(counted: SummitSums) -> Table:
    """Estimates from each sub-area alone, one row each, counted along x first.

    From its summits: their number, density, inverse mean curvature and standard deviation of heights, nan
    where they are too few. And spectral moments of heights about its own mean, so that waves longer than the
    sub-area count less than on the whole map.
    """
    points, *sums = np.where(counted.sums[0] > 0, counted.sums, np.nan)  # where nothing was seen
    m = dict(zip(SUMS[1:], sums / points, strict=True))
    number = np.bincount(counted.part, minlength=counted.parts)

    def mean(values: Array) -> Array:
        total = np.bincount(counted.part, values, minlength=counted.parts)
        return np.asarray(np.where(number > 0, total / np.maximum(number, 1), np.nan))

    squares = mean((counted.heights - mean(counted.heights)[counted.part]) ** 2)
    several = np.where(number > 1, number / np.maximum(number - 1, 1), np.nan)
    tile, across = np.arange(counted.parts), math.isqrt(counted.parts)
    return Table(
        (
            Column("tile", tile),
            Column("column", tile % across),
            Column("row", tile // across),
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
    """Return the standard deviation over the tiles, over the mean; nan where fewer than two tell anything."""
    values = values[np.isfinite(values)]
    if values.size < 2 or not values.any():
        return math.nan
    return float(values.std(ddof=1) / values.mean())
