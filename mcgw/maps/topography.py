"""Height maps, as every reader returns and every writer takes them; and units of heights in files."""

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array
from mcgw.formats.units import METRES

MOST_PIXELS = 2**28  # 16384 x 16384: 2 GiB as float64
SMALLEST, LARGEST = 1e-150, 1e150  # of what is squared, m: sums of squares and a dozen times that, too
_FINEST = 1e-30  # m, of a pixel, whose eighth power still counts
_SMALL, _PACKED = 2**22, 20  # points that any file may declare, and that each of its bytes may hold
_ENOUGH = 2**20  # differences between neighbours tell their median to a thousandth
XYZ = 3
STEEPEST = 10.0  # 84 degrees: no instrument that gives a height map sees such slopes all over it
FLATTEST = 1e-6  # and no surface is so flat from one pixel to the next
_SENTINELS = (-9999.0, -99999.0, -32768.0, 32767.0, 1e30, -1e30, 1e10, -1e10, 3.4028235e38, -3.4028235e38)
_FAR = 3.0  # ranges of all other heights
_EQUAL = 1e-6  # relative, of a height and the number that stands for a missing one; beyond 1e30 a hundredth


@dataclass(frozen=True)
class Topography:
    """Heights on a regular grid.

    Parameters
    ----------
    heights : ndarray
        m, shape (rows, columns): row j lies at y = (j + 1/2) dy, column i at x = (i + 1/2) dx. Missing
        points are nan.
    pixel : (float, float)
        dx and dy, m.
    periodic : bool, optional
        Whether opposite edges fit together.
    assumed_unit : str, optional
        Unit assumed for the heights if the file does not state it; empty if it is known.

    Raises
    ------
    ValueError
        If the array is not two-dimensional, or empty, or a pixel has no positive size, or a height is
        infinite, or powers of any of these are beyond floating-point numbers.
    """

    heights: Array
    pixel: tuple[float, float]
    periodic: bool = False
    assumed_unit: str = ""

    def __post_init__(self) -> None:
        if self.heights.ndim != 2:
            raise ValueError(f"a map has rows and columns, not {self.heights.ndim} dimension(s)")
        checked_shape(*self.heights.shape)
        if not all(_FINEST < p < 1 / _FINEST for p in self.pixel):
            raise ValueError(
                f"pixel = {self.pixel}: give its size in m, two numbers > 0, {_FINEST:g} to {1 / _FINEST:g}"
            )
        if self.highest > LARGEST:
            raise ValueError(
                f"a height is {self.highest:.3g} m, too large to be squared; give the right unit or scale, "
                "and nan where points are missing"
            )

    @property
    def size(self) -> tuple[float, float]:
        """Extent along x and y, m, including the whole width of the outer pixels."""
        rows, columns = self.heights.shape
        return columns * self.pixel[0], rows * self.pixel[1]

    @cached_property
    def highest(self) -> float:
        """Largest absolute height, m; nan if all points are missing."""
        return max(abs(float(end.reduce(self.heights, axis=None))) for end in (np.fmax, np.fmin))

    @property
    def missing(self) -> int:
        """Number of points without a height."""
        return int(np.count_nonzero(~np.isfinite(self.heights)))

    @property
    def steepness(self) -> float:
        """Typical slope, from medians of the differences between neighbours, which spikes do not affect.

        For a large map, about a million of them are used, on equally spaced lines.
        """
        every = max(self.heights.size // _ENOUGH, 1)
        usual = [
            float(np.nanmedian(np.abs(differences))) / pixel
            for lines, pixel in ((self.heights, self.pixel[0]), (self.heights.T, self.pixel[1]))
            if np.isfinite(differences := np.diff(lines[::every])).any()
        ]
        return math.hypot(*usual)


class Raw(NamedTuple):
    """What a file holds of a map or of a profile, before a user adds what it does not tell.

    Parameters
    ----------
    heights : ndarray
        In their unit, shape (rows, columns) or (points,).
    unit : str, optional
        Of the heights, where the file tells it.
    pixel : (float, float), optional
        Size of a pixel, m; of a profile nan.
    periodic : bool, optional
        Whether opposite edges fit together.
    places : ndarray, optional
        Of the points of a profile along its line, in their unit.
    unit_of_places : str, optional
        Where the file tells it.
    assumed : str, optional
        Unit that was assumed of places.
    """

    heights: NDArray[Any]
    unit: str | None = None
    pixel: tuple[float, float] = (math.nan, math.nan)
    periodic: bool = False
    places: Array | None = None
    unit_of_places: str | None = None
    assumed: str = ""


def check_file(path: Path) -> None:
    """Refuse a name that is none of a regular file.

    Raises
    ------
    ValueError
        If there is none, or it is something else.
    """
    if not path.is_file():
        raise ValueError(f"{path}: is not a regular file" if path.exists() else f"{path}: no such file")


def checked_shape(rows: int, columns: int, *, held: int | None = None) -> tuple[int, int]:
    """Rows and columns, if a map can have so many; `held` is how many bytes a file may hold packed for them.

    Raises
    ------
    ValueError
        If there is none, or more than 2^28 points, or more than any map packs into its file.
    """
    if rows < 1 or columns < 1:
        raise ValueError(f"{columns} x {rows} points: a map has one or more along each axis")
    if rows * columns > MOST_PIXELS:
        raise ValueError(
            f"{columns} x {rows} points: more than the maximum of {MOST_PIXELS}; crop the map first"
        )
    if held is not None and rows * columns > max(_SMALL, _PACKED * held):
        raise ValueError(f"{columns} x {rows} points: more than {held} bytes hold of a map")
    return rows, columns


def in_metres(path: Path, raw: NDArray[Any], metre: float, missing: float | None) -> Array:
    """Heights of a file in m, nan where it holds the number that stands for a missing point.

    Parameters
    ----------
    path : Path
        Of the file, for errors.
    raw : ndarray
        As the file has them.
    metre : float
        Size of their unit, m.
    missing : float or None
        Number that stands for a missing point, in that unit.

    Raises
    ------
    ValueError
        If they are complex or no numbers, `missing` is nowhere, or a number such as -9999 lies far from all
        other heights and `missing` is not given.
    """
    if raw.dtype.kind not in "fiu":
        raise ValueError(f"{path}: heights are {raw.dtype.name}, not real numbers; give their real part")
    z = raw.astype(np.float64)
    if missing is not None:
        marked = _equal(z, missing)
        if not marked.any():
            raise ValueError(f"{path}: no height is {missing:g}; leave --missing-value out")
        z[marked] = np.nan
    elif sentinel := _sentinel(z):
        value, number = sentinel
        raise ValueError(
            f"{path}: {number} of {z.size} heights are {value:.8g}, far from all others; if they stand for "
            f"missing points, give --missing-value={value:.8g}"
        )
    z *= metre
    return z


def _equal(z: Array, value: float) -> NDArray[np.bool_]:
    return np.abs(z - value) <= (0.01 if abs(value) > 1e30 else _EQUAL) * abs(value)


def _sentinel(z: Array) -> tuple[float, int] | None:
    """Return a number that stands for missing points, and how many of them there are."""
    with np.errstate(invalid="ignore"):
        for value in _SENTINELS:
            end = np.fmin.reduce(z, axis=None) if value < 0 else np.fmax.reduce(z, axis=None)
            if not _equal(np.array(end), value):
                continue
            others = z[~_equal(z, value) & np.isfinite(z)]
            if not others.size:
                continue
            low, high = float(others.min()), float(others.max())
            if max(low - value, value - high) > _FAR * (high - low):
                return float(end), z.size - int(np.count_nonzero(~_equal(z, value)))
    return None


def height_unit(path: Path, told: str | None, given: str | None) -> tuple[float, str]:
    """Size of the unit of heights, m, and the unit that was assumed ("m") if neither file nor user tells one.

    Raises
    ------
    ValueError
        If a unit is unknown, or the file and the user contradict each other.
    """
    if given is not None and told is not None and metres_in(path, given) != metres_in(path, told):
        raise ValueError(f"{path}: heights are in {told} as the file says, not in {given}; leave --unit out")
    unit = told or given
    return (1.0, "m") if unit is None else (metres_in(path, unit), "")


def metres_in(path: Path, unit: str) -> float:
    """Size of a unit of length, m.

    Raises
    ------
    ValueError
        If it is unknown.
    """
    if unit not in METRES:
        raise ValueError(f"{path}: {unit!r} is not a known unit of length: {', '.join(METRES)}")
    return METRES[unit]
