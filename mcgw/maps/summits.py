"""Every summit of a map: where it is, how high, and how sharp along its two principal directions."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mcgw.formats.table import Column, Table
from mcgw.maps.summit_sums import EDGE, SummitSums
from mcgw.maps.topography import Topography

__all__ = ["Summits", "summit_contact", "summits_of", "write_summits"]

Array = NDArray[np.float64]

_COLUMNS = ("x", "y", "height", "radius", "curvature_1", "curvature_2", "tile")
_UNITS = (
    "x, y, height and radius in m, curvature_1 and curvature_2 in 1/m; height is above the mean of the "
    "summits, radius is 1/sqrt(curvature_1 curvature_2)"
)
# Of the fourth order, as in the sums: from two points before to two points after.
_SLOPE = np.array([1, -8, 0, 8, -1]) / 12
_BEND = np.array([-1, 16, -30, 16, -1]) / 12


@dataclass(frozen=True)
class Summits:
    """Summits of a map; arrays of shape (summits,) if nothing else is said.

    Parameters
    ----------
    x, y : ndarray
        From the corner of the map after trimming and cropping, whose first pixel has its centre at half
        a pixel, m.
    heights : ndarray
        About their mean, m.
    curvatures : ndarray
        Principal curvatures, shape (2, summits), the larger ones first, 1/m; positive.
    tile : ndarray of int
        Sub-area of each, counted from 0 along x first.
    unresolved : int
        How many are ridges between pixels, of which only a mean curvature is known: both are that.
    """

    x: Array
    y: Array
    heights: Array
    curvatures: Array
    tile: NDArray[np.int64]
    unresolved: int

    @property
    def radii(self) -> Array:
        """Of the spheres that carry nearly what the summits do, ``1/sqrt(k1 k2)``, m (Greenwood 2006)."""
        return np.asarray(1 / np.sqrt(self.curvatures[0] * self.curvatures[1]))


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
    curvatures, unresolved = _curvatures(used, j, i)
    right, up = _apex(used.heights, j, i)
    dx, dy = used.pixel
    return Summits(
        origin[0] + (i + 0.5 + right) * dx,
        origin[1] + (j + 0.5 + up) * dy,
        counted.heights - counted.heights.mean(),
        curvatures,
        counted.part,
        unresolved,
    )


def _at(z: Array, j: NDArray[np.int64], i: NDArray[np.int64]) -> Array:
    """Heights at points that may lie beyond the edges of a periodic map."""
    return np.asarray(z[j % z.shape[0], i % z.shape[1]])


def _curvatures(used: Topography, j: NDArray[np.int64], i: NDArray[np.int64]) -> tuple[Array, int]:
    """Principal curvatures, and how many had to be taken from the mean curvature."""
    z, (dx, dy) = used.heights, used.pixel
    here = _at(z, j, i)  # differences from it lose no digits
    steps = range(-2, 3)
    xx = sum(w * (_at(z, j, i + s) - here) for s, w in zip(steps, _BEND, strict=True)) / dx**2
    yy = sum(w * (_at(z, j + s, i) - here) for s, w in zip(steps, _BEND, strict=True)) / dy**2
    xy = np.zeros(len(i))
    for down, v in zip(steps, _SLOPE, strict=True):
        for along, w in zip(steps, _SLOPE, strict=True):
            if v * w != 0:
                xy += v * w * (_at(z, j + down, i + along) - here)
    mean, turn = -(xx + yy) / 2, np.hypot((xx - yy) / 2, xy / (dx * dy))
    found = np.array([mean + turn, mean - turn])
    ridges = ~(found[1] > 0)
    # The neighbours next to it are lower, so these plain differences have a sign.
    j, i, here = j[ridges], i[ridges], here[ridges]
    plain = (2 * here - _at(z, j, i + 1) - _at(z, j, i - 1)) / dx**2
    plain += (2 * here - _at(z, j + 1, i) - _at(z, j - 1, i)) / dy**2
    found[:, ridges] = plain / 2
    return found, int(ridges.sum())


def _apex(z: Array, j: NDArray[np.int64], i: NDArray[np.int64]) -> tuple[Array, Array]:
    """Vertex, within the summit's own pixel, of the paraboloid through it and its neighbours, in pixels."""
    gx, gy = (_at(z, j, i + 1) - _at(z, j, i - 1)) / 2, (_at(z, j + 1, i) - _at(z, j - 1, i)) / 2
    xx = _at(z, j, i + 1) - 2 * _at(z, j, i) + _at(z, j, i - 1)
    yy = _at(z, j + 1, i) - 2 * _at(z, j, i) + _at(z, j - 1, i)
    xy = (_at(z, j + 1, i + 1) - _at(z, j + 1, i - 1) - _at(z, j - 1, i + 1) + _at(z, j - 1, i - 1)) / 4
    det = xx * yy - xy * xy
    flat = ~(det > 0)
    det = np.where(flat, 1.0, det)
    right, up = ((gy * xy - gx * yy) / det, (gx * xy - gy * xx) / det)
    return tuple(np.where(flat, 0.0, np.clip(t, -0.5, 0.5)) for t in (right, up))  # type: ignore[return-value]


def write_summits(summits: Summits, path: Path) -> None:
    """Write a table with a row for each summit; a comment above it tells the units."""
    found = (summits.x, summits.y, summits.heights, summits.radii, *summits.curvatures, summits.tile)
    table = Table(tuple(Column(name, values) for name, values in zip(_COLUMNS, found, strict=True)))
    table.write(path, comment=_UNITS)


@dataclass(frozen=True)
class SummitContact:
    """Sums over the summits that touch; arrays of shape (tiles, separations).

    Parameters
    ----------
    load, area, stiffness : ndarray
        N, m^2, N/m.
    contacts : ndarray of int
        Summits that touch.
    """

    load: Array
    area: Array
    stiffness: Array
    contacts: NDArray[np.int64]


def summit_contact(
    heights: ArrayLike,
    radii: ArrayLike,
    E_star: float,
    separations: ArrayLike,
    *,
    tile: ArrayLike | None = None,
) -> SummitContact:
    """Load, area, stiffness and number of contacts of measured summits, each a Hertzian one by itself.

    Parameters
    ----------
    heights, radii : array_like
        Of the summits, m, shape (summits,).
    E_star : float
        Composite modulus, Pa.
    separations : array_like
        Of the flat above the zero of the heights, m, shape (separations,).
    tile : array_like of int, optional
        Which tile each summit stands on, from 0; left out: all on one.

    Returns
    -------
    SummitContact
        Of each tile: the mean over them is that of the whole map over their number.

    Raises
    ------
    ValueError
        If the lists have not one length, or a radius or the modulus is not positive.

    Notes
    -----
    With the approach u = z - d: load 4/3 E* sqrt(R) u^1.5, area pi R u, stiffness 2 E* sqrt(R u)
    (Hertz 1882; the deterministic model of Greenwood and Williamson 1966, their Eqs. 8 to 10).

    Examples
    --------
    >>> found = summit_contact([1e-6, 2e-6], [1e-5, 1e-5], 1e11, [0.0, 1.5e-6])
    >>> found.contacts.tolist()
    [[2, 1]]
    """
    z, radius = np.asarray(heights, dtype=np.float64), np.asarray(radii, dtype=np.float64)
    part = np.zeros(z.shape, dtype=np.int64) if tile is None else np.asarray(tile, dtype=np.int64)
    if not (z.ndim == 1 and z.shape == radius.shape == part.shape):
        raise ValueError(f"heights {z.shape}, radii {radius.shape}, tile {part.shape}: give one list each")
    if not (np.all(radius > 0) and E_star > 0):
        raise ValueError("radii and E_star: give numbers > 0")
    tiles = int(part.max()) + 1 if part.size else 1
    separation = np.atleast_1d(np.asarray(separations, dtype=np.float64))
    sums = np.zeros((3, tiles, separation.size))
    contacts = np.zeros((tiles, separation.size), dtype=np.int64)
    for k, d in enumerate(separation):
        touch = z > d
        u, R, here = z[touch] - d, radius[touch], part[touch]
        load = 4 / 3 * E_star * np.sqrt(R) * u * np.sqrt(u)
        terms = (load, math.pi * R * u, 2 * E_star * np.sqrt(R * u))
        for total, term in zip(sums, terms, strict=True):
            total[:, k] = np.bincount(here, term, minlength=tiles)
        contacts[:, k] = np.bincount(here, minlength=tiles)
    load, area, stiffness = sums
    return SummitContact(load, area, stiffness, contacts)
