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
# Of the fourth order, as in the sums: from two points before to two points after.
_REACH = 2
_SLOPE = np.array([1, -8, 0, 8, -1]) / 12
_BEND = np.array([-1, 16, -30, 16, -1]) / 12


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
    """Look again at every summit that was counted.

    Parameters
    ----------
    used : Topography
        The map that was counted, without form and filtered.
    counted : SummitSums
        Of this map.
    origin : (float, float)
        Where its corner lies on the map as it was read, x and y in m.
    """
    margin = 0 if used.periodic else EDGE
    shape = tuple(n - 2 * margin for n in used.heights.shape)
    i, j = (
        np.rint(p * n - 0.5).astype(np.int64) + margin
        for p, n in zip(counted.places, shape[::-1], strict=True)
    )
    around = _around(used, j, i)
    curvatures, unresolved = _curvatures(around, used.pixel)
    right, up = _apex(around)
    dx, dy = used.pixel
    return Summits(
        origin[0] + (i + 0.5 + right) * dx,
        origin[1] + (j + 0.5 + up) * dy,
        counted.heights - counted.heights.mean(),
        curvatures,
        counted.part,
        unresolved,
        (shape[1] * dx, shape[0] * dy),
    )


def _around(used: Topography, j: Ints, i: Ints) -> Array:
    """Heights of the five by five points around each summit above its own, shape (summits, 5, 5).

    Of a periodic map they may lie beyond its edges.
    """
    rows, columns = used.heights.shape
    near = np.arange(-_REACH, _REACH + 1)
    z = used.heights[(j[:, None, None] + near[:, None]) % rows, (i[:, None, None] + near) % columns]
    return np.asarray(z - z[:, _REACH, _REACH, None, None])  # differences lose no digits


def _curvatures(z: Array, pixel: tuple[float, float]) -> tuple[Array, int]:
    """Principal curvatures, and how many had to be taken from the mean curvature."""
    dx, dy = pixel
    xx, yy = z[:, _REACH] @ _BEND / dx**2, z[:, :, _REACH] @ _BEND / dy**2
    xy = z @ _SLOPE @ _SLOPE / (dx * dy)
    mean, turn = -(xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    found = np.array([mean + turn, mean - turn])
    ridges = ~(found[1] > 0)
    # The neighbours next to it are lower, so these plain differences have a sign.
    plain = (z[ridges, 2, 1] + z[ridges, 2, 3]) / dx**2 + (z[ridges, 1, 2] + z[ridges, 3, 2]) / dy**2
    found[:, ridges] = -plain / 2
    return found, int(ridges.sum())


def _apex(z: Array) -> tuple[Array, Array]:
    """Vertex, within the summit's own pixel, of the paraboloid through it and its neighbours, in pixels."""
    left, right, below, above = z[:, 2, 1], z[:, 2, 3], z[:, 1, 2], z[:, 3, 2]
    gx, gy, xx, yy = (right - left) / 2, (above - below) / 2, right + left, above + below
    xy = (z[:, 3, 3] - z[:, 3, 1] - z[:, 1, 3] + z[:, 1, 1]) / 4
    det = xx * yy - xy * xy
    flat = ~(det > 0)
    det = np.where(flat, 1.0, det)
    ends = (gy * xy - gx * yy) / det, (gx * xy - gy * xx) / det
    x, y = (np.where(flat, 0.0, np.clip(end, -0.5, 0.5)) for end in ends)
    return x, y


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
    """Return the standard deviation over the tiles, over the mean; nan where fewer than two tell anything."""
    values = values[np.isfinite(values)]
    if values.size < 2 or not values.any():
        return math.nan
    return float(values.std(ddof=1) / values.mean())
