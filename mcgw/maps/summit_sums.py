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
def _pass(z: Any, mean: Any, seen: Any, dx: Any, dy: Any, across: Any, sums: Any) -> Any:
    """Fill `sums`; return which points are summits: higher than their neighbours, or the last of equal ones.

    Heights count from their `mean`; of points that are not `seen` nothing does.
    """
    rows, columns = z.shape[0] - 8, z.shape[1] - 8
    summits = np.zeros((rows, columns), dtype=np.bool_)
    per_x, per_y, per_xx, per_yy = 1 / dx, 1 / dy, 1 / (dx * dx), 1 / (dy * dy)
    column = np.arange(columns) * across // columns
    for j in range(rows):
        row = (j * across // rows) * across
        for i in range(columns):
            b, a = j + 4, i + 4
            if not seen[b, a]:
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
            if (c >= w1) & (c >= v1) & (c > x1) & (c > y1):  # one branch: what it takes is guessed wrong
                here, above, below = z[b, a], z[b - 1], z[b + 1]
                earlier = max(z[b, a - 1], above[a - 1], above[a], above[a + 1])
                summits[j, i] = here >= earlier and here > max(below[a - 1], below[a + 1])
    return summits


def _apexes(around: Array) -> tuple[Array, Array, Array]:
    """Highest points, within each summit's own pixel, of paraboloids through three by three points.

    Above the summit; and the vertex from there along x and y, as near as the pixel's edge, in pixels.
    """
    (nw, n, ne), (w, c, e), (sw, s, se) = around
    gx, gy, xx, yy, xy = (e - w) / 2, (s - n) / 2, e - 2 * c + w, s - 2 * c + n, (se - sw - ne + nw) / 4

    def rise(g: Array, c: Array) -> Array:  # of g t + c t^2/2 for t from -1/2 to 1/2
        return np.divide(-g * g, 2 * c, out=abs(g) / 2 + c / 8, where=abs(g) < -c / 2)

    det = xx * yy - xy * xy
    x, y = (
        np.divide(part, det, out=np.zeros_like(det), where=det > 0)
        for part in (gy * xy - gx * yy, gx * xy - gy * xx)
    )
    edges = [gx * side + xx / 8 + rise(gy + xy * side, yy) for side in (-0.5, 0.5)]
    edges += [gy * side + yy / 8 + rise(gx + xy * side, xx) for side in (-0.5, 0.5)]
    vertex = gx * x + gy * y + (xx * x * x + yy * y * y) / 2 + xy * x * y
    inside = np.where(2 * np.maximum(abs(x), abs(y)) < 1, vertex, 0.0)
    return np.maximum.reduce([inside, 0 * inside, *edges]), x.clip(-_HALF, _HALF), y.clip(-_HALF, _HALF)


def _curvatures(around: Array, dx: float, dy: float) -> tuple[Array, Array]:
    """Mean and principal curvatures of summits in the middle of five by five points, 1/m."""
    (w2, w1, c, x1, x2), (v2, v1, _, y1, y2) = around[2], around[:, 2]
    per_xx, per_yy = 1 / (dx * dx), 1 / (dy * dy)
    xx = (16 * (x1 + w1) - (x2 + w2) - 30 * c) / 12 * per_xx
    yy = (16 * (y1 + v1) - (y2 + v2) - 30 * c) / 12 * per_yy
    xy = sum(_FIRST[p] * _FIRST[q] * around[p, q] for p, q in np.ndindex(5, 5)) / (dx * dy)
    mean, turn = -(xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    plain = ((x1 + w1 - 2 * c) * per_xx + (y1 + v1 - 2 * c) * per_yy) / -2
    return mean, np.where(mean > turn, [mean + turn, mean - turn], plain)


def summit_sums_of(topography: Topography, *, across: int = 4, seen: Marks | None = None) -> Summits:
    """Go once over a map that lacks no points, with `across` sub-areas along each axis.

    Four points at each edge are left out, unless the map is periodic. Where a mask says what was `seen`,
    points count whose differences and neighbours were; ValueError if none is left.
    """
    z, mean = np.ascontiguousarray(topography.heights), topography.heights.mean()
    counts = np.ones(z.shape, dtype=np.bool_)
    if seen is not None:  # with their neighbours, as far as differences reach
        mode: Literal["wrap", "nearest"] = "wrap" if topography.periodic else "nearest"
        counts = ndimage.minimum_filter(seen, 2 * 2 + 1, mode=mode)  # pixels that the differences reach
    if topography.periodic:
        z, counts = np.pad(z, EDGE, mode="wrap"), np.pad(counts, EDGE, mode="wrap")
    rows, columns = (n - 2 * EDGE for n in z.shape)
    if min(rows, columns) < 4 * across:
        raise ValueError(
            f"{max(columns, 0)} x {max(rows, 0)} points are left: too few for {across} x {across} sub-areas"
        )
    sums = np.zeros((len(SUMS), across * across))
    j, i = np.nonzero(_pass(z, mean, counts, *topography.pixel, across, sums))
    if not sums[0].any():
        raise ValueError("too many points are missing, so none has all its neighbours; use --missing fill")
    if not (np.abs(sums) < LARGEST).all():  # alpha takes their squares
        raise ValueError(
            f"heights between {z.min() - mean:.3g} and {z.max() - mean:.3g} m about their mean, on pixels of "
            f"{topography.pixel[0]:.3g} m: squares of their derivatives overflow, or points are missing; "
            "give the right unit and pixel"
        )
    tile = j * across // rows * across + i * across // columns
    near = np.arange(EDGE - 2, EDGE + 3)
    around = z[j + near[:, None, None], i + near[:, None]]
    rise, x, y = _apexes(around[1:4, 1:4])
    heights, (dx, dy) = around[2, 2] + rise - mean, topography.pixel
    bends, curvatures = _curvatures(around - mean, dx, dy)
    first = 0.5 if topography.periodic else 0.5 + EDGE  # centre of the first pixel that counts
    return Summits(
        sums, (i + first + x) * dx, (j + first + y) * dy, heights, bends, curvatures, tile, topography.pixel
    )


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
