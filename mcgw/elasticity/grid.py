"""How far a load at one point of a grid presses down the half-space at another one."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft
from scipy.special import erfc

from analytic.arrays import Array, Ints

# Ewald's two sums, with so narrow a split that only the nearest image counts in the first: erfc(6) is 2e-17.
_SPLIT = 12.0  # over the shorter side
_FEWEST = 46  # points along the shorter side, at which the second sum has no more than the grid's waves


@dataclass(frozen=True)
class Grid:
    """Points of a rectangle on a half-space, and the potential 1/r between them.

    A load P at one point presses the surface down by ``P/(pi E*)`` times `potential` at another one.

    Parameters
    ----------
    shape : (int, int)
        Rows and columns.
    size : (float, float)
        Extent along x and y, m.
    periodic : bool
        Whether the rectangle repeats itself without end. Displacements then count from their mean: the
        potential is the sum over all images in a neutral background (Ewald). Otherwise it is 1/r, and
        displacements count from the undeformed body.

    Raises
    ------
    ValueError
        If a periodic grid has fewer than 46 points along its shorter side.
    """

    shape: tuple[int, int]
    size: tuple[float, float]
    periodic: bool

    def __post_init__(self) -> None:
        if self.periodic and min(self.size) / max(self.pixel) < _FEWEST:
            raise ValueError(
                f"{self.shape[1]} x {self.shape[0]} points: give {_FEWEST} or more a side of a periodic map"
            )

    @property
    def pixel(self) -> tuple[float, float]:
        """Distance of points along x and y, m."""
        return self.size[0] / self.shape[1], self.size[1] / self.shape[0]

    @property
    def area(self) -> float:
        """Nominal area, m^2."""
        return self.size[0] * self.size[1]

    @cached_property
    def potential(self) -> Array:
        """Potential by offsets of rows and columns, 1/m; at no offset that of a load's own images.

        Offsets wrap around: its shape is that of the grid, doubled where there are no images.
        """
        rows, columns = (n if self.periodic else 2 * n for n in self.shape)
        dx, dy = self.pixel
        x, y = columns * dx * fft.fftfreq(columns), rows * dy * fft.fftfreq(rows)[:, None]
        r = np.hypot(x, y)
        r[0, 0] = 1.0
        if not self.periodic:
            found = 1 / r
            found[0, 0] = 0.0
            return np.asarray(found)
        split = _SPLIT / min(self.size)
        near = erfc(split * r) / r
        near[0, 0] = -2 * split / math.sqrt(math.pi)
        k = 2 * math.pi * np.hypot(fft.rfftfreq(columns, dx), fft.fftfreq(rows, dy)[:, None])
        k[0, 0] = 1.0
        waves = 2 * math.pi * erfc(k / (2 * split)) / k
        waves[0, 0] = -2 * math.sqrt(math.pi) / split
        return np.asarray(near + fft.irfft2(waves, s=(rows, columns)) / (dx * dy))

    @cached_property
    def _series(self) -> Array:
        return np.asarray(fft.rfft2(self.potential))

    def between(self, places: Ints) -> Array:
        """Potential between all pairs of points, shape (n, n), of rows and columns of shape (2, n)."""
        rows, columns = places
        tall, wide = self.potential.shape
        apart = (rows[:, None] - rows) % tall, (columns[:, None] - columns) % wide
        return np.asarray(self.potential[apart])

    def pressed(self, by: Ints, loads: Array, at: Ints) -> Array:
        """Sum of the potentials of loads at some points, at others: by Fourier series, for many."""
        spread = np.zeros(self.shape)
        spread[tuple(by)] = loads
        shape = self.potential.shape
        return np.asarray(fft.irfft2(fft.rfft2(spread, shape) * self._series, shape)[tuple(at)])
