"""One pass over a map: every summit, and sums of squares of its derivatives, sub-area by sub-area."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from scipy import ndimage

from analytic import SpectralMoments
from analytic.arrays import Array, Ints, Marks
from mcgw.formats.table import Column, Table
from mcgw.machine.compiling import njit
from mcgw.maps.topography import LARGEST, Topography

# Rows of the sums: points, powers of height, squared slopes, squared second derivatives, the latter by plain
# differences too, which tell whether the pixel resolves them, and products of slopes.
SUMS = ("points", "z", "z2", "z3", "slope_x", "slope_y", "bend", "bend_1", "slope_xy")
EDGE = 4  # pixels left out at the edge
_OF_EACH = ("x", "y", "heights", "bends", "curvatures", "tile")
_HALF = 0.5 - 1e-7  # pixels: a summit lies within its own
# What stands above their tables in a file.
SUMMITS = "height is above the mean of the summits, radius is 1/sqrt(curvature_1 curvature_2)"
TILES = "eta, radius and sigma by the summits of the tile; heights are about the mean of the tile"
_FIRST = (1 / 12, -8 / 12, 0.0, 8 / 12, -1 / 12)  # the first difference of the fourth order


@dataclass(frozen=True)
class Summits:
    """Summits of a map, and sums over it: the basis of its estimates.

    Arrays of summits have the shape (summits,). On ridges between pixels both curvatures are the mean one, by
    plain differences.
    """

    sums: Array  # in the order of `SUMS`, shape (sums, sub-areas), m, m^2, ...
    x: Array  # places from the corner of the map, half a pixel before the centre of its first one, m;
    y: Array  # those of `mcgw.fit` are on the trimmed and cropped map
    heights: Array  # above the map's zero, m
    bends: Array  # mean curvatures, 1/m
    curvatures: Array  # principal ones, shape (2, summits), the larger ones first, 1/m; positive
    tile: Ints  # sub-area of each, counted from 0 along x first
    pixel: tuple[float, float]  # size of a pixel, m

    @property
    def radii(self) -> Array:
        """Radii of spheres that carry nearly the summits' loads, ``1/sqrt(k1 k2)``, m (Greenwood 2006)."""
        return np.asarray(1 / np.sqrt(self.curvatures[0] * self.curvatures[1]))

    @property
    def parts(self) -> int:
        """Number of sub-areas."""
        return int(self.sums.shape[1])

    @property
    def area(self) -> float:
        """Area of all points that count, m^2."""
        return float(self.sums[0].sum()) * math.prod(self.pixel)

    @property
    def mean_squares(self) -> dict[str, float]:
        """Means over the map, by the names of `SUMS`."""
        sums = self.sums.sum(axis=1)
        return dict(zip(SUMS[1:], (sums[1:] / sums[0]).tolist(), strict=True))

    @property
    def moments(self) -> SpectralMoments:
        """Moments, averaged over both axes."""
        m = self.mean_squares
        return SpectralMoments(m["z2"] - m["z"] ** 2, (m["slope_x"] + m["slope_y"]) / 2, m["bend"])

    def without(self, part: int) -> "Summits":
        """All but one sub-area."""
        kept, sums = self.tile != part, np.where(np.arange(self.parts) == part, 0.0, self.sums)
        rows: Any = {name: getattr(self, name)[..., kept] for name in _OF_EACH}
        return replace(self, sums=sums, **rows)

    @classmethod
    def together(cls, found: Sequence["Summits"], sums: Array) -> "Summits":
        """Summits of one after the other, and sums over all."""
        rows: Any = {name: np.concatenate([getattr(x, name) for x in found], axis=-1) for name in _OF_EACH}
        return replace(found[0], sums=sums, **rows)

    def table(self) -> Table:
        """Return a row for each summit, whose height is above the mean of all."""
        heights, sharpness = self.heights - self.heights.mean(), ("curvature_1", "curvature_2")
        lengths = {"x": self.x, "y": self.y, "height": heights, "radius": self.radii}
        columns = [Column(name, values, unit="m") for name, values in lengths.items()]
        columns += [Column(*each, unit="1/m") for each in zip(sharpness, self.curvatures, strict=True)]
        return Table((*columns, Column("tile", self.tile)))

    def tiles(self) -> Table:
        """Return estimates from each sub-area alone, one row each, counted along x first.

        From its summits: their number, density, inverse mean curvature and standard deviation of heights, nan
        where they are too few. And spectral moments of heights about its own mean, so that waves longer than
        the sub-area count less than on the whole map.
        """
        number = np.bincount(self.tile, minlength=self.parts)

        def mean(values: Array) -> Array:
            return np.asarray(np.bincount(self.tile, values, self.parts) / number)

        tile, across = np.arange(self.parts), math.isqrt(self.parts)
        with np.errstate(divide="ignore", invalid="ignore"):  # nan where nothing was seen
            m = dict(zip(SUMS[1:], self.sums[1:] / self.sums[0], strict=True))
            squares = mean((self.heights - mean(self.heights)[self.tile]) ** 2)
            return Table((
                Column("tile", tile),
                Column("column", tile % across),
                Column("row", tile // across),
                Column("summits", number),
                Column("eta", number / (self.sums[0] * math.prod(self.pixel)), unit="1/m^2"),
                Column("radius", 1 / mean(self.bends), "R", "m"),
                Column("sigma", np.sqrt(squares * number / (number - 1)), unit="m"),
                Column("m0", m["z2"] - m["z"] ** 2, unit="m^2"),
                Column("m2", (m["slope_x"] + m["slope_y"]) / 2),
                Column("m4", m["bend"], unit="1/m^2"),
            ))  # fmt: skip


@njit(cache=True)
def _is_summit(z: Any, j: Any, i: Any) -> Any:
    """Whether a point is higher than its eight neighbours; of equal ones the last counts.

    No point is that has no height, or has a neighbour without. So never are two neighbours, whatever a map
    holds: one in every square of two points by two at most.
    """
    here = z[j, i]
    for dj in range(-1, 2):
        for di in range(-1, 2):
            other = z[j + dj, i + di]
            later = dj > 0 or (dj == 0 and di > 0)
            if (dj or di) and not (other < here or (other == here and not later)):
                return False
    return True


@njit(cache=True)
def _rise(g: Any, c: Any) -> Any:
    """Highest value of ``g t + c t^2/2`` for t from -1/2 to 1/2."""
    if c < 0 and abs(g) < -c / 2:
        return -g * g / (2 * c)
    return abs(g) / 2 + c / 8


@njit(cache=True)
def _apex(z: Any, j: Any, i: Any) -> Any:
    """Highest point, within the summit's own pixel, of the paraboloid through it and its neighbours.

    Above the summit; and its vertex from there along x and y, as near as the pixel's edge, in pixels.
    """
    gx, gy = (z[j, i + 1] - z[j, i - 1]) / 2, (z[j + 1, i] - z[j - 1, i]) / 2
    xx, yy = z[j, i + 1] - 2 * z[j, i] + z[j, i - 1], z[j + 1, i] - 2 * z[j, i] + z[j - 1, i]
    xy = (z[j + 1, i + 1] - z[j + 1, i - 1] - z[j - 1, i + 1] + z[j - 1, i - 1]) / 4
    best, x, y = 0.0, 0.0, 0.0
    for side in (-0.5, 0.5):
        best = max(best, gx * side + xx / 8 + _rise(gy + xy * side, yy))
        best = max(best, gy * side + yy / 8 + _rise(gx + xy * side, xx))
    det = xx * yy - xy * xy
    if det > 0:
        x, y = (gy * xy - gx * yy) / det, (gx * xy - gy * xx) / det
        if 2 * max(abs(x), abs(y)) < 1:
            best = max(best, gx * x + gy * y + (xx * x * x + yy * y * y) / 2 + xy * x * y)
    return best, min(max(x, -_HALF), _HALF), min(max(y, -_HALF), _HALF)


@njit(cache=True)
def _pass(
    z: Any, mean: Any, seen: Any, dx: Any, dy: Any, across: Any, sums: Any, summits: Any, part_of: Any
) -> Any:
    """Fill `sums`; write place, height, curvatures and sub-area of each summit; give their number.

    Heights count from their `mean`. Of points that are not `seen`, unless that is empty, nothing is written.
    """
    rows, columns = z.shape[0] - 8, z.shape[1] - 8
    found = 0
    per_x, per_y, per_xx, per_yy = 1 / dx, 1 / dy, 1 / (dx * dx), 1 / (dy * dy)
    column = np.arange(columns) * across // columns
    for j in range(rows):
        row = (j * across // rows) * across
        for i in range(columns):
            b, a = j + 4, i + 4
            if seen.size and not seen[b, a]:
                continue
            c = z[b, a] - mean
            x1, x2, y1, y2 = z[b, a + 1] - mean, z[b, a + 2] - mean, z[b + 1, a] - mean, z[b + 2, a] - mean
            w1, w2, v1, v2 = z[b, a - 1] - mean, z[b, a - 2] - mean, z[b - 1, a] - mean, z[b - 2, a] - mean
            sx = (8 * (x1 - w1) - (x2 - w2)) / 12 * per_x
            sy = (8 * (y1 - v1) - (y2 - v2)) / 12 * per_y
            xx = (16 * (x1 + w1) - (x2 + w2) - 30 * c) / 12 * per_xx
            yy = (16 * (y1 + v1) - (y2 + v2) - 30 * c) / 12 * per_yy
            xx1, yy1 = (x1 + w1 - 2 * c) * per_xx, (y1 + v1 - 2 * c) * per_yy
            k = row + column[i]
            sums[0, k] += 1
            sums[1, k] += c
            sums[2, k] += c * c
            sums[3, k] += c * c * c
            sums[4, k] += sx * sx
            sums[5, k] += sy * sy
            sums[6, k] += (xx * xx + yy * yy) / 2
            sums[7, k] += (xx1 * xx1 + yy1 * yy1) / 2
            sums[8, k] += sx * sy
            higher = (c >= w1) & (c >= v1) & (c > x1) & (c > y1)  # no branch: what it takes is guessed wrong
            if higher and found < part_of.size and _is_summit(z, b, a):
                rise, x, y = _apex(z, b, a)
                summits[0, found], summits[1, found] = (a + 0.5 + x) * dx, (b + 0.5 + y) * dy
                summits[2, found], summits[3, found] = z[b, a] + rise - mean, -(xx + yy) / 2
                xy = 0.0
                for p in range(5):
                    for q in range(5):
                        xy += _FIRST[p] * _FIRST[q] * (z[b + p - 2, a + q - 2] - mean)
                xy *= per_x * per_y
                turn = np.hypot((xx - yy) / 2, xy)
                summits[4, found], summits[5, found] = turn - (xx + yy) / 2, -turn - (xx + yy) / 2
                if not summits[5, found] > 0:  # the neighbours are lower: plain differences have a sign
                    summits[4, found] = summits[5, found] = -(xx1 + yy1) / 2
                part_of[found] = k
                found += 1
    return found


def summit_sums_of(topography: Topography, *, across: int = 4, seen: Marks | None = None) -> Summits:
    """Go once over a map that lacks no points, with `across` sub-areas along each axis.

    Four points at each edge are left out, unless the map is periodic. Where a mask says what was `seen`,
    points count whose differences and neighbours were; ValueError if none is left.
    """
    z, mean = np.ascontiguousarray(topography.heights), topography.heights.mean()
    counts = np.empty((0, 0), dtype=np.bool_)
    if seen is not None:  # with their neighbours, as far as differences reach
        mode: Literal["wrap", "nearest"] = "wrap" if topography.periodic else "nearest"
        counts = ndimage.minimum_filter(seen, 2 * 2 + 1, mode=mode)  # pixels that the differences reach
    if topography.periodic:
        z = np.pad(z, EDGE, mode="wrap")
        counts = np.pad(counts, EDGE, mode="wrap") if seen is not None else counts
    rows, columns = (n - 2 * EDGE for n in z.shape)
    if min(rows, columns) < 4 * across:
        raise ValueError(
            f"{max(columns, 0)} x {max(rows, 0)} points are left: too few for {across} x {across} sub-areas"
        )
    sums = np.zeros((len(SUMS), across * across))
    most = ((rows + 1) // 2) * ((columns + 1) // 2)  # one in every square of two points by two
    summits, part = np.empty((6, most)), np.empty(most, dtype=np.int64)
    found = _pass(z, mean, counts, *topography.pixel, across, sums, summits, part)
    if not sums[0].any():
        raise ValueError("too many points are missing, so none has all its neighbours; use --missing fill")
    if not (np.abs(sums) < LARGEST).all():  # alpha takes their squares
        raise ValueError(
            f"heights between {z.min() - mean:.3g} and {z.max() - mean:.3g} m about their mean, on pixels of "
            f"{topography.pixel[0]:.3g} m: squares of their derivatives overflow, or points are missing; "
            "give the right unit and pixel"
        )
    (dx, dy), added = topography.pixel, EDGE if topography.periodic else 0  # pixels around the map
    x, y, heights, bends, *curvatures = summits[:, :found].copy()
    places = x - added * dx, y - added * dy
    return Summits(sums, *places, heights, bends, np.array(curvatures), part[:found].copy(), topography.pixel)


def coarse_sums_of(topography: Topography, *, across: int = 4, seen: Marks | None = None) -> Summits:
    """Go over the four maps of every second point along each axis, and put together what they show."""
    pixel = (2 * topography.pixel[0], 2 * topography.pixel[1])
    rows, columns = (n - n % 2 for n in topography.heights.shape)  # all four of one size
    found = []
    for j, i in np.ndindex(2, 2):
        every = (slice(j, rows, 2), slice(i, columns, 2))
        half = Topography(topography.heights[every], pixel, topography.periodic)
        found.append(summit_sums_of(half, across=across, seen=None if seen is None else seen[every]))
    return Summits.together(found, np.sum([f.sums for f in found], axis=0))


def variation(values: Array) -> float:
    """Return the standard deviation over the tiles, over the mean; nan where fewer than two tell anything."""
    values = values[np.isfinite(values)]
    if values.size < 2 or not values.any():
        return math.nan
    return float(values.std(ddof=1) / values.mean())
