"""What contacts on summits do alone: radius, load and stiffness of each from its penetration."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import map_coordinates
from scipy.optimize import brentq

from analytic.arrays import Array, Ints
from mcgw.maps.summit_sums import Summits
from mcgw.maps.topography import Topography

_RAYS, _STEPS = 8, 6  # from a summit to the rim of its contact


@dataclass(frozen=True)
class Spots:
    """Contacts on summits, none of which feels another one; arrays of shape (n,).

    A summit that falls as r^n all around carries, with a contact of radius a (Sneddon, Int. J. Eng. Sci. 3
    (1965) 47, recalled) ::

        a = radius (delta/depth)^(1/n),    P = 2 E* n/(n + 1) a delta,    dP/ddelta = 2 E* a.

    Examples
    --------
    >>> one = Spots.hertz(np.zeros(1), np.array([1e-5]), 1e9)
    >>> round(float(one.loads(np.array([1e-7]))[0] / (4 / 3 * 1e9 * 1e-5**0.5 * 1e-7**1.5)), 12)
    1.0
    """

    heights: Array  # of the summits, m
    radii: Array  # of one contact on each, m
    depths: Array  # penetration at which each contact has this radius, m
    powers: Array  # n; 2 for a sphere
    E_star: float  # composite modulus, Pa

    @classmethod
    def hertz(cls, heights: Array, radii: Array, E_star: float) -> "Spots":
        """Spheres of radii in m: that of a contact is ``sqrt(R delta)``."""
        return cls(heights, radii, radii, np.full(heights.shape, 2.0), E_star)

    def contact_radii(self, penetrations: Array) -> Array:
        """Of each, m; 0 where it does not touch."""
        return np.asarray(self.radii * (np.maximum(penetrations, 0) / self.depths) ** (1 / self.powers))

    def loads(self, penetrations: Array) -> Array:
        """Of each, N."""
        return np.asarray(self.powers / (self.powers + 1) * penetrations * self.slopes(penetrations))

    def slopes(self, penetrations: Array) -> Array:
        """Stiffness of each, N/m."""
        return np.asarray(2 * self.E_star * self.contact_radii(penetrations))

    def areas(self, penetrations: Array) -> Array:
        """Of each contact, m^2."""
        return np.asarray(math.pi * self.contact_radii(penetrations) ** 2)

    def separation_at(self, load: float) -> float:
        """Separation at which all together carry a load in N, m."""
        z = self.heights
        depth = float(np.ptp(z)) or 1e-9

        def missing(d: float) -> float:
            return float(self.loads(z - d).sum()) - load

        while missing(float(z.max()) - depth) < 0:
            depth *= 2
        return float(brentq(missing, z.max() - depth, z.max(), xtol=1e-14 * depth, rtol=1e-14))

    def least_radii(self, separation: float) -> Array:
        """Radii of their contacts at a separation, at least the root of the mean square, m.

        Those of summits that hardly touch would tell nothing of what happens when they do.
        """
        squared = self.contact_radii(self.heights - separation) ** 2
        return np.asarray(np.sqrt(np.maximum(squared, squared.mean(where=squared > 0))))


def fallen(used: Topography, summits: Summits, which: Ints, spots: Spots, radii: Array) -> Spots:
    """Make spots fall as a periodic map does around its summits, within contacts of some radii.

    Along each of eight rays a summit falls as the map does down to the first valley, and from there on as its
    paraboloid does: what rises again is another summit's. The mean over the rays is its profile, whose load
    and penetration at that radius those of the new spots are, by Sneddon's integrals ::

        depth = a int_0^a f'(r)/sqrt(a^2 - r^2) dr,    P = 2 E* int_0^a r^2 f'(r)/sqrt(a^2 - r^2) dr.

    The spots are those on the summits of these numbers; their heights and modulus stay. `radii` are in m.
    """
    t, angle = np.arange(_STEPS + 1) / _STEPS, 2 * math.pi * np.arange(_RAYS) / _RAYS
    r = radii[:, None] * t
    rays = [
        (x[which, None, None] + r[:, :, None] * f(angle)) / pixel - 0.5
        for x, f, pixel in zip((summits.y, summits.x), (np.sin, np.cos), used.pixel[::-1], strict=True)
    ]
    falls = -np.diff(map_coordinates(used.heights, rays, order=3, mode="grid-wrap"), axis=1)
    paraboloids = summits.curvatures.mean(axis=0)[which, None] / 2 * np.diff(r**2)
    past = np.logical_or.accumulate(falls <= 0, axis=1)
    falls = np.where(past, paraboloids[:, :, None], falls).mean(axis=2)
    # of a profile that is linear in t^2 in each step: its depth, and its load over 2 E* a
    root, steps = np.sqrt(1 - t**2), np.diff(t**2)
    depths = falls @ (np.diff(-2 * root) / steps)
    share = falls @ (np.diff(2 / 3 * root**3 - 2 * root) / steps) / depths
    return Spots(spots.heights, radii, depths, share / (1 - share), spots.E_star)
