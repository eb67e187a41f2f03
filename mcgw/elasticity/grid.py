"""Points of a periodic rectangle on a half-space, and how far a load at one of them presses down another."""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from scipy import fft
from scipy.special import erfc

from analytic.arrays import Array, Ints

_FEWEST = 46  # points along the shorter side, at which Ewald's second sum has no more than the grid's waves


@dataclass(frozen=True)
class Grid:
    """Points of a rectangle that repeats itself without end, and the potential 1/r between them.

    A load P at one point presses the surface down by ``P/(pi E*)`` times `potential` at another one.
    Displacements count from their mean: the potential is the sum over all images in a neutral background
    (Ewald).
    """

    shape: tuple[int, int]  # rows and columns, 46 or more along the shorter side
    size: tuple[float, float]  # extent along x and y, m

    def __post_init__(self) -> None:
        if min(self.size) / max(self.pixel) < _FEWEST:
            raise ValueError(
                f"{self.shape[1]} x {self.shape[0]} points: give {_FEWEST} or more per side of a periodic map"
            )

    @property
    def pixel(self) -> tuple[float, float]:
        """Distance of points along x and y, m."""
        return self.size[0] / self.shape[1], self.size[1] / self.shape[0]

    @cached_property
    def potential(self) -> Array:
        """Potential by offsets of rows and columns, which wrap around, 1/m; at none that of own images."""
        rows, columns = self.shape
        dx, dy = self.pixel
        r = np.hypot(self.size[0] * fft.fftfreq(columns), self.size[1] * fft.fftfreq(rows)[:, None])
        r[0, 0] = 1.0
        # so narrow a split of Ewald's sums that only the nearest image counts in the first: erfc(6) is 2e-17
        split = 12.0 / min(self.size)
        near = erfc(split * r) / r
        near[0, 0] = -2 * split / math.sqrt(math.pi)
        k = 2 * math.pi * np.hypot(fft.rfftfreq(columns, dx), fft.fftfreq(rows, dy)[:, None])
        k[0, 0] = 1.0
        waves = 2 * math.pi * erfc(k / (2 * split)) / k
        waves[0, 0] = -2 * math.sqrt(math.pi) / split
        return np.asarray(near + fft.irfft2(waves, s=self.shape) / (dx * dy))

    @cached_property
    def _series(self) -> Array:
        return np.asarray(fft.rfft2(self.potential))

    def between(self, places: Ints) -> Array:
        """Potential between all pairs of points, shape (n, n), of rows and columns of shape (2, n)."""
        rows, columns = places
        tall, wide = self.shape
        return np.asarray(self.potential[(rows[:, None] - rows) % tall, (columns[:, None] - columns) % wide])

    def summed(self, places: Ints, loads: Array) -> Array:
        """Sum at each point of the potentials of loads at all of them: by Fourier series, for many."""
        spread = np.zeros(self.shape)
        spread[tuple(places)] = loads
        return np.asarray(fft.irfft2(fft.rfft2(spread) * self._series, self.shape)[tuple(places)])


sized_grid = lru_cache(maxsize=2)(Grid)  # their potential takes as long as a balance
