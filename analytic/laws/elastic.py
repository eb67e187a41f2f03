"""Elastic asperities other than Hertz's: a modulus that grows with depth, and a coating."""

from dataclasses import dataclass
from math import cos, gamma, pi, sin, sqrt
from typing import Any, ClassVar

import numpy as np
import scipy

from analytic.arrays import Array
from analytic.laws.law import ContactLaw
from analytic.surface import check_positive


@dataclass(frozen=True)
class PowerLawGraded(ContactLaw):
    """Elastic half-spaces of modulus ``E = E0 (z/c0)^k`` at the depth z below their own surface.

    With ``c_N = H E0/((1 - nu^2) c0^k)``: ``delta = a^2/((1 + k) R)``,
    ``P = 4 c_N a^(3 + k)/((1 + k)^2 (3 + k) R)``; so load goes as ``delta^((3 + k)/2)``, stiffness as
    ``delta^((1 + k)/2)``, and the area is ``(1 + k) delta``. The surface's E* is E0/(1 - nu^2), that at
    the depth c0 (against a rigid plane), and a grading over heights multiplies it. k = 0 is Hertz.

    Valid for frictionless elastic contacts small against R, 0 <= k < 1. The only known
    defect is that the modulus is 0 right at the surface.

    Parameters
    ----------
    k : float
        Exponent of the depth.
    c0 : float, optional
        Depth at which the modulus is E0, m. Give it, or `reduced_c0`.
    poisson : float, optional
        Poisson's ratio.
    reduced_c0 : float, optional
        c0 over sqrt(R sigma).

    Raises
    ------
    ValueError
        If not exactly one of `c0` and `reduced_c0` is given, or a value is out of range.

    Notes
    -----
    Source: A. E. Giannakopoulos, S. Suresh, Int. J. Solids Struct. 34 (1997) 2393, and V. L. Popov,
    M. Hess, E. Willert, Handbook of Contact Mechanics (2019), ch. 9. [mem; H is 1 for k = 0 and
    pi/2 for k = 1, nu = 1/2 (Gibson), as it must be.]

    Examples
    --------
    >>> round(PowerLawGraded(0.5, reduced_c0=1.0).H, 12)
    1.141408652077
    """

    name = "power-law-graded"
    root = False
    of_radius: ClassVar[dict[str, float]] = {"reduced_c0": -0.5}
    in_si = "c0", "one of them, a depth in m or over sqrt(R sigma)"

    k: float
    c0: float | None = None
    poisson: float = 0.3
    reduced_c0: float | None = None

    def __post_init__(self) -> None:
        if not 0 <= self.k < 1:
            raise ValueError(f"k = {self.k!r}: give an exponent of the depth from 0 to below 1")
        super().__post_init__()

    @property
    def H(self) -> float:  # noqa: N802
        """Factor of the normal stiffness, a function of k and Poisson's ratio alone."""
        k, nu = self.k, self.poisson
        b = sqrt((1 + k) * (1 - k * nu / (1 - nu)))
        c = 2 ** (1 + k) * gamma((3 + k + b) / 2) * gamma((3 + k - b) / 2) / (pi * gamma(2 + k))
        above = 2 * (1 + k) * cos(k * pi / 2) * gamma(1 + k / 2)
        return above / (sqrt(pi) * c * b * sin(b * pi / 2) * gamma((1 + k) / 2))

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Return the load of a contact, in the shape of `y` and `e`."""
        factor = 3 * (1 + self.k) ** ((self.k - 1) / 2) / (3 + self.k)
        return factor * self.H / self.reduced("reduced_c0") ** self.k * e * y ** (3 + self.k)

    def radius(self, piece: int, y: Any, e: Array) -> Any:
        """Return the radius of a contact; its square is the area over pi R sigma."""
        return sqrt(1 + self.k) * (y + 0.0 * e)

    def stiffness(self, piece: int, y: Array, e: Array) -> Array:
        """Return the stiffness of a spot over 2 E* sqrt(R sigma)."""
        factor = (1 + self.k) ** ((self.k - 1) / 2) * self.H / self.reduced("reduced_c0") ** self.k
        return np.asarray(factor * e * y ** (1 + self.k))


@dataclass(frozen=True, kw_only=True)
class Coated(ContactLaw):
    """An elastic coating on elastic asperities: the stiffness of a spot is ``K = 2 E_eff(a) a``.

    ``E_eff = E* (1 + (ratio - 1) I0(t/a))`` at the radius of contact ``a = sqrt(R delta)``, with ::

        I0(x) = (2/pi) arctan(x) + [(1 - 2 nu) x ln(1 + 1/x^2) - x/(1 + x^2)]/(2 pi (1 - nu))

    which falls from 1 (a small: all coating) to 0 (a large: all substrate). The load is the integral of
    K, so that K = -dP/dd holds exactly; Hertz's load times E_eff(a) would break that. E* is that of the
    bare substrate, and a grading over heights multiplies both.

    I0 is a first-order perturbation: good for ratios from about 1/3 to 3 [mem]. Known defect: the
    radius of contact is Hertz's, though a coating changes it.

    Parameters
    ----------
    thickness : float, optional
        t, m. Give it, or `reduced_thickness`.
    ratio : float
        Modulus of the coating over that of the substrate.
    poisson : float, optional
        Poisson's ratio of the coating.
    reduced_thickness : float, optional
        t over sqrt(R sigma).

    Raises
    ------
    ValueError
        If not exactly one thickness is given, or a value is out of range.

    Notes
    -----
    Source of I0: H. Gao, C.-H. Chiu, J. Lee, Int. J. Solids Struct. 29 (1992) 2471 [mem: recalled; its
    limits 0 and 1 checked].

    Examples
    --------
    >>> bare = Coated(ratio=1.0, reduced_thickness=0.5)
    >>> float(bare.load(0, np.array(2.0), np.array(1.0)))
    8.0
    """

    name = "coated"
    of_radius: ClassVar[dict[str, float]] = {"reduced_thickness": -0.5}
    in_si = "thickness", "one of them, in m or over sqrt(R sigma)"

    thickness: float | None = None
    ratio: float
    poisson: float = 0.3
    reduced_thickness: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_positive("", ratio=self.ratio)

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Return the load of a contact, in the shape of `y` and `e`, as an integral of its stiffness."""
        t, nu = self.reduced("reduced_thickness"), self.poisson
        w = np.asarray(y) / t
        z, log = w * w, scipy.special.log1p(w * w)
        atan = w**3 / 3 * (pi / 2 - np.arctan(w)) + (z - log) / 6
        integral = 2 / pi * atan + ((1 - 2 * nu) * ((1 + z) * log - z) - (z - log)) / (4 * pi * (1 - nu))
        return e * (y * y * y + 3 * (self.ratio - 1) * t**3 * integral)

    def stiffness(self, piece: int, y: Array, e: Array) -> Array:
        """Return the stiffness of a spot over 2 E* sqrt(R sigma)."""
        w, nu = np.asarray(y) / self.reduced("reduced_thickness"), self.poisson
        z = w * w
        mixed = (1 - 2 * nu) * scipy.special.log1p(z) / np.where(w == 0, 1.0, w) - w / (1 + z)
        share = 1 - 2 / pi * np.arctan(w) + mixed / (2 * pi * (1 - nu))
        return np.asarray(e * (y * (1 + (self.ratio - 1) * share)))
