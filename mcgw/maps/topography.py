"""A height map: what every reader gives and every writer takes."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["MOST_PIXELS", "STEEPEST", "Topography", "checked_shape"]

Array = NDArray[np.float64]

MOST_PIXELS = 2**28  # 16384 x 16384: 2 GiB as float64
STEEPEST = 10.0  # 84 degrees: no instrument that gives a height map sees such slopes all over it


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
        What heights were taken to be in where nobody told it; empty: it is known.

    Raises
    ------
    ValueError
        If the array is not two-dimensional, or empty, or a pixel has no positive size.
    """

    heights: Array
    pixel: tuple[float, float]
    periodic: bool = False
    assumed_unit: str = ""

    def __post_init__(self) -> None:
        if self.heights.ndim != 2:
            raise ValueError(f"a map has rows and columns, not {self.heights.ndim} dimension(s)")
        checked_shape(*self.heights.shape)
        if not all(math.isfinite(p) and p > 0 for p in self.pixel):
            raise ValueError(f"pixel = {self.pixel}: give its size in m, two numbers > 0")

    @property
    def size(self) -> tuple[float, float]:
        """Extent along x and y, m: pixels count with their whole width."""
        rows, columns = self.heights.shape
        return columns * self.pixel[0], rows * self.pixel[1]

    @property
    def missing(self) -> int:
        """Number of points without a height."""
        return int(np.count_nonzero(~np.isfinite(self.heights)))

    @property
    def steepness(self) -> float:
        """The usual slope: from medians of the differences between neighbours, which no spike changes."""
        usual = [
            float(np.nanmedian(np.abs(differences))) / pixel
            for axis, pixel in ((1, self.pixel[0]), (0, self.pixel[1]))
            if np.isfinite(differences := np.diff(self.heights, axis=axis)).any()
        ]
        return math.hypot(*usual)


def checked_shape(rows: int, columns: int) -> tuple[int, int]:
    """Rows and columns, if a map can have so many.

    Raises
    ------
    ValueError
        If there is none, or more than 2^28 points.
    """
    if rows < 1 or columns < 1:
        raise ValueError(f"{columns} x {rows} points: a map has one or more along each axis")
    if rows * columns > MOST_PIXELS:
        raise ValueError(
            f"{columns} x {rows} points: more than the {MOST_PIXELS} that are read; crop it first"
        )
    return rows, columns
