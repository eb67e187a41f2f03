"""Contacts of a map's summits, each on the surface as it falls around it."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.ndimage import map_coordinates

from analytic.arrays import Array, Ints, Marks
from mcgw.maps.summits import Summits
from mcgw.maps.topography import Topography

_RAYS, _STEPS, _STEP = 8, 12, 1 / 8  # from a summit; steps along each, of the mean distance between summits
_LEAST = 0.02  # of what a paraboloid falls in a step: contacts grow steadily


@dataclass(frozen=True)
class ProfileSpots:
    """Contacts on summits of any profile that is alike all around.

    Pressed so deep that the contact is wide enough for no tension at its rim (Sneddon, Int. J. Eng. Sci. 3
    (1965) 47, recalled).

    Parameters
    ----------
    heights : ndarray
        Of the summits, m, shape (n,).
    radii : ndarray
        Of contacts, from 0 upwards, m, shape (k,).
    depths : ndarray
        Penetration of each summit at which its contact is as wide, from 0 upwards, m, shape (n, k); in
        between, and beyond, linear in the squared radius.
    E_star : float
        Composite modulus, Pa.
    """

    heights: Array
    radii: Array
    depths: Array
    E_star: float

    @cached_property
    def _bends(self) -> Array:
        """Depth by squared radius from each of the radii on, 1/m."""
        bends = np.diff(self.depths) / np.diff(self.radii**2)
        return np.column_stack([bends, bends[:, -1]])

    @cached_property
    def _under(self) -> Array:
        """Integral of the depth over the contact's radius, up to each of the radii, m^2."""
        bends, flat = self._bends[:, :-1], self.depths - self._bends * self.radii**2
        steps = flat[:, :-1] * np.diff(self.radii) + bends * np.diff(self.radii**3) / 3
        return np.column_stack([np.zeros(len(steps)), np.cumsum(steps, axis=1)])

    def load(self, penetration: Array) -> Array:
        """Load of each, N."""
        at, before = self._before(penetration)
        a, a0, bend = np.sqrt(self.squared_radius(penetration)), self.radii[before], self._bends[at, before]
        flat = self.depths[at, before] - bend * a0**2
        under = self._under[at, before] + flat * (a - a0) + bend * (a**3 - a0**3) / 3
        return np.where(penetration > 0, 2 * self.E_star * (a * penetration - under), 0.0)

    def slope(self, penetration: Array) -> Array:
        """Stiffness of each, 2 E* a, N/m."""
        return np.asarray(2 * self.E_star * np.sqrt(self.squared_radius(penetration)))

    def squared_radius(self, penetration: Array) -> Array:
        """Squared radius of each contact, m^2."""
        at, before = self._before(penetration)
        more = (penetration - self.depths[at, before]) / self._bends[at, before]
        return np.where(penetration > 0, self.radii[before] ** 2 + more, 0.0)

    def _before(self, penetration: Array) -> tuple[Ints, Ints]:
        """Rows, and the last column whose depth is reached."""
        before = (self.depths[:, 1:] <= penetration[:, None]).sum(axis=1)
        return np.arange(len(before)), before

    def only(self, which: Marks) -> "ProfileSpots":
        """Some of them."""
        return ProfileSpots(self.heights[which], self.radii, self.depths[which], self.E_star)


def profile_spots(used: Topography, summits: Summits, tops: Array, E_star: float) -> ProfileSpots:
    """Look how a periodic map falls around its summits.

    Along each of some rays it falls as it does down to the first valley, and from there on as the summit's
    paraboloid does: what rises again is another summit's. The mean over the rays is the profile.

    Parameters
    ----------
    used : Topography
        Periodic.
    summits : Summits
        Of this map.
    tops : ndarray
        Their heights, m, shape (n,).
    E_star : float
        Composite modulus, Pa.
    """
    width, height = used.size
    r = _STEP * math.sqrt(width * height / tops.size) * np.arange(_STEPS + 1.0)
    angle = 2 * math.pi * np.arange(_RAYS) / _RAYS
    rays = [
        (x[:, None, None] + r[:, None] * f(angle)) / pixel - 0.5
        for x, f, pixel in zip((summits.y, summits.x), (np.sin, np.cos), used.pixel[::-1], strict=True)
    ]
    falls = -np.diff(map_coordinates(used.heights, rays, order=3, mode="grid-wrap"), axis=1)
    paraboloids = summits.curvatures.mean(axis=0)[:, None] / 2 * np.diff(r**2)
    past = np.logical_or.accumulate(falls <= 0, axis=1)
    falls = np.where(past, paraboloids[:, :, None], falls).mean(axis=2)
    steps = np.maximum(np.diff(falls @ _sneddon(r).T, prepend=0.0), 2 * _LEAST * paraboloids)
    depths = np.column_stack([np.zeros(tops.size), np.cumsum(steps, axis=1)])
    return ProfileSpots(tops, r, depths, E_star)


def _sneddon(r: Array) -> Array:
    """Depth at each contact radius, by what a profile that is linear in r^2 between them falls in each step.

    That is ``a int_0^a f'(r) / sqrt(a^2 - r^2) dr``.
    """
    roots = np.sqrt(np.maximum(r[1:, None] ** 2 - r**2, 0.0))
    return np.asarray(-2 * r[1:, None] * np.diff(roots) / np.diff(r**2))
