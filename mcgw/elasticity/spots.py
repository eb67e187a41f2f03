"""What single contacts do: load, slope and area of each from its penetration; and the field around one."""

import math
from dataclasses import dataclass

import numpy as np

from analytic import quantity_of
from analytic.arrays import Array, Marks
from mcgw.scene.scene import Scene

# Two summits at one place are in neutral balance, whichever of them carries how much, if their fields are
# those of a contact whose squared radius is this times the sum of theirs.
_NEUTRAL = 1.125


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


@dataclass(frozen=True)
class LawSpots:
    """Contacts under the law, the grading and the radii of a scene.

    Parameters
    ----------
    scene : Scene
        Only asperities are taken from it, on the way in.
    heights : ndarray
        Of the summits about their mean, m, shape (n,).
    ratios : ndarray or None
        Their radii over the surface's, where they have their own.
    """

    scene: Scene
    heights: Array
    ratios: Array | None

    @property
    def E_star(self) -> float:  # noqa: N802 - as above
        """Composite modulus of the half-space, Pa."""
        return self.scene.surface.E_star

    def load(self, penetration: Array) -> Array:
        """Load of each, N."""
        return self._each("load", penetration)

    def slope(self, penetration: Array) -> Array:
        """Derivative of the load by the penetration, N/m."""
        return self._each("load_slope", penetration)

    def squared_radius(self, penetration: Array) -> Array:
        """Squared radius of each contact, m^2."""
        return self._each("area", penetration) / math.pi

    def only(self, which: Marks) -> "LawSpots":
        """Some of them."""
        return LawSpots(self.scene, self.heights[which], None if self.ratios is None else self.ratios[which])

    def _each(self, name: str, penetration: Array) -> Array:
        surface = self.scene.surface
        s = self.heights / surface.sigma
        h, e = s - penetration / surface.sigma, self.scene.modulus(s)
        return quantity_of(name).scale(surface) * self.scene.ways.term(name, h, s, e, self.ratios)


Spots = HertzSpots | LawSpots  # contacts at places, none of which feels another one here


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
