"""Height maps, as every writer takes them; and what every reader gets and gives, in the units of the file."""

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


class ForeignError(ValueError):
    """A file that is not in one of our formats, but may be in another."""


class Given(NamedTuple):
    """What a user says of a file."""

    pixel: tuple[float, float] | None  # m; of a profile the first is the distance between points
    unit: str | None  # of the heights
    missing: float | None  # number that stands for a missing point, in the unit of the file


class Raw(NamedTuple):
    """What a file holds of a map or of a profile, before a user adds what it does not tell."""

    heights: NDArray[Any]  # in their unit, shape (rows, columns) or (points,)
    unit: str | None = None  # of the heights, where the file tells it
    pixel: tuple[float, float] | None = None  # of a map, where the file tells it
    periodic: bool = False  # whether opposite edges fit together
    places: Array | None = None  # of the points of a profile along its line
    lateral: str | None = None  # unit of the pixel or the places, where it is known


def metres_in(path: Path, unit: str | None) -> float:
    """Size of a unit of length, m; none is m.

    Raises
    ------
    ValueError
        If it is unknown.
    """
    if unit is not None and unit not in METRES:
        raise ValueError(f"{path}: {unit!r} is not a known unit of length: {', '.join(METRES)}")
    return METRES[unit or "m"]
