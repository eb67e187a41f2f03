"""What single contacts do: load, slope and area of each from its penetration; and the field around one.

How far a load at one point of a grid presses down the half-space at another one.
"""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Protocol

import numpy as np
from scipy import fft
from scipy.special import erfc

from analytic.arrays import Array, Ints, Marks

# Two summits at one place are in neutral balance, whichever of them carries how much, if their fields are
# those of a contact whose squared radius is this times the sum of theirs.
_NEUTRAL = 1.125
# Ewald's two sums, with so narrow a split that only the nearest image counts in the first: erfc(6) is 2e-17.
_SPLIT = 12.0  # over the shorter side
_FEWEST = 46  # points along the shorter side, at which the second sum has no more than the grid's waves


class Spots(Protocol):
    """Contacts of summits, none of which feels another one here: of each from its penetration, m."""

    @property
    def heights(self) -> Array:
        """Of the summits, m, shape (n,)."""

    @property
    def E_star(self) -> float:  # noqa: N802 - as everywhere
        """Composite modulus of the half-space, Pa."""

    def load(self, penetration: Array) -> Array:
        """N."""

    def slope(self, penetration: Array) -> Array:
        """Derivative of the load, N/m."""

    def squared_radius(self, penetration: Array) -> Array:
        """Of the contact, m^2."""

    def only(self, which: Marks) -> "Spots":
        """Some of them."""


@dataclass(frozen=True)
class HertzSpots:
    """Hertz's contacts on summits of their own radii.

    Parameters
    ----------
    heights, radii : ndarray
        Of the summits, m, shape (n,).
    E_star : float
        Composite modulus, Pa.
    """

    heights: Array
    radii: Array
    E_star: float

    def load(self, penetration: Array) -> Array:
        """Load of each, N."""
        return np.asarray(2 / 3 * penetration * self.slope(penetration))

    def slope(self, penetration: Array) -> Array:
        """Stiffness of each, 2 E* a, N/m."""
        return np.asarray(2 * self.E_star * np.sqrt(self.squared_radius(penetration)))

    def squared_radius(self, penetration: Array) -> Array:
        """Squared radius of each contact, m^2."""
        return np.asarray(self.radii * np.maximum(penetration, 0.0))

    def only(self, which: Marks) -> "HertzSpots":
        """Some of them."""
        return HertzSpots(self.heights[which], self.radii[which], self.E_star)


def field_beyond_point(squared_distance: Array, squared_radii: Array) -> tuple[Array, Array]:
    """How much more or less a spot presses down a point than its load would from its centre, per load.

    Around a Hertz contact of radius a (Johnson, Contact Mechanics, 1985, Eqs. 3.41 and 3.42, recalled and
    checked against the integral)::

        u pi E*/P = 3/4 [(2 a^2 - r^2) asin(min(a/r, 1)) + a sqrt(r^2 - a^2)_+ ] / a^3,

    of which 1/r is taken off. Between two spots a is that of both, so that the potential is mutual:
    ``a^2 = 1.125 (a_i^2 + a_j^2)``; averaged over both contacts, 1 in place of 1.125 is exact to the
    second order in a/r.

    Parameters
    ----------
    squared_distance, squared_radii : ndarray
        Of pairs: r^2 > 0 and a_i^2 + a_j^2, m^2.

    Returns
    -------
    (ndarray, ndarray)
        The difference, 1/m, and its derivative by a_i^2 or a_j^2, 1/m^3; both 0 where nothing touches.
    """
    touching = squared_radii > 0
    a2 = _NEUTRAL * np.where(touching, squared_radii, 1.0)
    x = squared_distance / a2
    beyond = np.maximum(x, 1.0)
    angle, root = np.arcsin(beyond**-0.5), np.sqrt(beyond - 1)
    field = 0.75 * ((2 - x) * angle + root)
    by_x = 0.75 * (root / beyond - angle)
    more = field / np.sqrt(a2) - squared_distance**-0.5
    by_radii = -_NEUTRAL * (field / 2 + x * by_x) / a2**1.5
    return np.where(touching, more, 0.0), np.where(touching, by_radii, 0.0)


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
                f"{self.shape[1]} x {self.shape[0]} points: give {_FEWEST} or more per side of a periodic map"
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


sized_grid = lru_cache(maxsize=2)(Grid)  # their potential takes as long as a balance
