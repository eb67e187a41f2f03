"""Heights on a grid or along a line, as every writer takes them; and what a reader gets and gives."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Legendre
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from analytic.arrays import Array
from mcgw.formats.units import METRES

MOST_PIXELS = 2**28  # 16384 x 16384: 2 GiB as float64
SMALLEST, LARGEST = 1e-150, 1e150  # of what is squared, m: sums of squares and a dozen times that, too
_FINEST = 1e-30  # m, of a pixel, whose eighth power still counts
XYZ = 3
LEAST_POINTS = 8  # of a profile
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

        For a large map about a million of them, on equally spaced lines, tell their median to a thousandth.
        """
        every = max(self.heights.size // 2**20, 1)
        usual = [
            float(np.nanmedian(np.abs(differences))) / pixel
            for lines, pixel in ((self.heights, self.pixel[0]), (self.heights.T, self.pixel[1]))
            if np.isfinite(differences := np.diff(lines[::every])).any()
        ]
        return math.hypot(*usual)

    @property
    def doubtful(self) -> str:
        """Why the unit of the heights or of the pixel is implausible; empty if it is plausible."""
        slope = self.steepness
        if self.assumed_unit and slope > STEEPEST:
            return (
                f"gives no unit of its heights, and in {self.assumed_unit} their typical slope would be "
                f"{slope:.3g}; give --unit (um, nm, ...), or another --pixel"
            )
        if slope and not FLATTEST <= slope <= STEEPEST:
            return (
                f"the typical slope of this map is {slope:.3g}, which no surface has ({FLATTEST:g} to "
                f"{STEEPEST:g}): its heights, or its pixel of {self.pixel[0]:.3g} m, are in another unit"
            )
        return ""


@dataclass(frozen=True)
class Profile:
    """Heights on an even grid along a line.

    Parameters
    ----------
    heights : ndarray
        m, shape (points,); none is missing.
    spacing : float
        Between two points, m.
    assumed_unit : str, optional
        Unit assumed for the lengths if the file does not state it; empty if it is known.
    filled : int, optional
        Number of missing heights that were filled along straight lines.
    resampled : bool, optional
        Whether the places were uneven, so that heights were interpolated.

    Raises
    ------
    ValueError
        If there are fewer than 8 points, one is missing, or the spacing is no length.
    """

    heights: Array
    spacing: float
    assumed_unit: str = ""
    filled: int = 0
    resampled: bool = False

    def __post_init__(self) -> None:
        if self.heights.ndim != 1:
            raise ValueError(f"a profile has one row of heights, not {self.heights.ndim} dimensions")
        if self.heights.size < LEAST_POINTS:
            raise ValueError(f"{self.heights.size} points: a profile has {LEAST_POINTS} or more")
        if not np.all(np.isfinite(self.heights)):
            raise ValueError("points of the profile are missing (nan); fill them first")
        if not (math.isfinite(self.spacing) and self.spacing > 0):
            raise ValueError(f"spacing = {self.spacing!r}: give a length > 0 m")

    @property
    def length(self) -> float:
        """Length along the line, m, including the whole spacing of the outer points."""
        return self.heights.size * self.spacing

    @property
    def steepness(self) -> float:
        """Typical slope, from the median difference between neighbours."""
        return float(np.median(np.abs(np.diff(self.heights)))) / self.spacing

    @property
    def doubtful(self) -> str:
        """Why the assumed unit of the lengths is implausible; empty if it is plausible."""
        if not self.assumed_unit:
            return ""
        if self.steepness > STEEPEST:
            return f"the typical slope is {self.steepness:.3g}"
        if self.spacing > 1e-2:  # m: no stylus steps so far
            return f"the points are {self.spacing:g} m apart"
        return f"it is {self.length:.3g} m long" if self.length > 0.2 else ""

    def without_form(self, order: int) -> "Profile":
        """Subtract the polynomial of least squares of this order; the mean in any case."""
        t = np.linspace(-1, 1, self.heights.size)
        return replace(self, heights=self.heights - Legendre.fit(t, self.heights, order)(t))

    def smoothed(self, cutoff: float) -> "Profile":
        """Apply the Gaussian filter of ISO 16610-21 and leave off the margins of one cutoff it cannot reach.

        Raises
        ------
        ValueError
            If nothing would be left.
        """
        radius = math.ceil(cutoff / self.spacing)
        if 2 * radius + LEAST_POINTS > self.heights.size:
            raise ValueError(
                f"cutoff = {cutoff:g} m: leaves nothing of a profile of {self.length:g} m after removing "
                "margins of one cutoff"
            )
        width = math.sqrt(filter_variance(cutoff)) / self.spacing
        filtered = gaussian_filter1d(self.heights, width, radius=radius)
        return replace(self, heights=filtered[radius : filtered.size - radius])


def filter_variance(cutoff: float) -> float:
    """Of the window of the Gaussian filter, m^2: half the amplitude is left at the cutoff (ISO 16610-61)."""
    return math.log(2) / (2 * math.pi**2) * cutoff**2


def checked_shape(rows: int, columns: int, *, held: int | None = None) -> tuple[int, int]:
    """Rows and columns, if a map can have so many; `held` is how many bytes of a file hold them packed."""
    if rows < 1 or columns < 1:
        raise ValueError(f"{columns} x {rows} points: a map has one or more along each axis")
    if rows * columns > MOST_PIXELS:
        raise ValueError(
            f"{columns} x {rows} points: more than the maximum of {MOST_PIXELS}; crop the map first"
        )
    if held is not None and rows * columns > max(2**22, 20 * held):  # 20 points in a byte, or a small map
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
    steps: Any = None  # pixel (dx, dy) of a map, or places of the points of a profile, where they are told
    lateral: str | None = None  # unit of these, where it is known
    periodic: bool = False  # whether opposite edges fit together


def metres_in(path: Path, unit: str | None) -> float:
    """Size of a unit of length, m; none is m."""
    if unit is not None and unit not in METRES:
        raise ValueError(f"{path}: {unit!r} is not a known unit of length: {', '.join(METRES)}")
    return METRES[unit or "m"]
