"""Asperities whose modulus grows with depth as a power."""

from dataclasses import dataclass, replace
from math import cos, gamma, pi, sin, sqrt
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from analytic.laws.law import ContactLaw
from analytic.laws.poisson import checked_poisson
from analytic.laws.positive import is_positive
from analytic.surface import Surface

__all__ = ["PowerLawGraded"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PowerLawGraded(ContactLaw):
    """Elastic half-spaces of modulus ``E = E0 (z/c0)^k`` at the depth z below their own surface.

    With ``c_N = H E0/((1 - nu^2) c0^k)``: ``delta = a^2/((1 + k) R)``,
    ``P = 4 c_N a^(3 + k)/((1 + k)^2 (3 + k) R)``; so load goes as ``delta^((3 + k)/2)``, stiffness as
    ``delta^((1 + k)/2)``, and the area is ``(1 + k) delta``. The surface's E* is E0/(1 - nu^2), that at
    the depth c0 (against a rigid plane), and a grading over heights multiplies it. k = 0 is Hertz.

    Valid for frictionless elastic contacts small against R, 0 <= k < 1. Nothing is known to be wrong
    with it, but that the modulus is 0 right at the surface.

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

    name: ClassVar[str] = "power-law-graded"
    root: ClassVar[bool] = False
    half_space: ClassVar[bool] = True
    of_radius: ClassVar[tuple[str, float]] = ("reduced_c0", -0.5)

    k: float
    c0: float | None = None
    poisson: float = 0.3
    reduced_c0: float | None = None

    def __post_init__(self) -> None:
        if not 0 <= self.k < 1:
            raise ValueError(f"k = {self.k!r}: give an exponent of the depth from 0 to below 1")
        checked_poisson(self.poisson)
        if (self.c0 is None) == (self.reduced_c0 is None):
            raise ValueError(
                f"c0 = {self.c0!r}, reduced_c0 = {self.reduced_c0!r}: give one of them, "
                "a depth in m or over sqrt(R sigma)"
            )
        for name in ("c0", "reduced_c0"):
            value = getattr(self, name)
            if value is not None and not is_positive(value):
                raise ValueError(f"{name} = {value!r}: give a depth > 0")

    def on(self, surface: Surface) -> Self:
        """The law on this surface, in reduced units: with `reduced_c0` in place of `c0`."""
        if self.c0 is None:
            return self
        return replace(self, c0=None, reduced_c0=self.c0 / sqrt(surface.radius * surface.sigma))

    @property
    def H(self) -> float:  # noqa: N802
        """Factor of the normal stiffness, a function of k and Poisson's ratio alone."""
        k, nu = self.k, self.poisson
        b = sqrt((1 + k) * (1 - k * nu / (1 - nu)))
        c = 2 ** (1 + k) * gamma((3 + k + b) / 2) * gamma((3 + k - b) / 2) / (pi * gamma(2 + k))
        above = 2 * (1 + k) * cos(k * pi / 2) * gamma(1 + k / 2)
        return above / (sqrt(pi) * c * b * sin(b * pi / 2) * gamma((1 + k) / 2))

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Load of a contact, in the shape of `y` and `e`."""
        factor = 3 * (1 + self.k) ** ((self.k - 1) / 2) / (3 + self.k)
        return factor * self._scale * e * y ** (3 + self.k)

    def radius(self, piece: int, y: Any, e: Array) -> Any:
        """Radius of a contact; its square is the area over pi R sigma."""
        return sqrt(1 + self.k) * (y + 0.0 * e)

    def stiffness(self, piece: int, y: Array, e: Array) -> Array:
        """Stiffness of a spot over 2 E* sqrt(R sigma)."""
        return np.asarray((1 + self.k) ** ((self.k - 1) / 2) * self._scale * e * y ** (1 + self.k))

    @property
    def _scale(self) -> Any:
        if self.reduced_c0 is None:
            raise ValueError(f"{self}: put it on a surface first, law.on(surface), or give `reduced_c0`")
        return self.H / self.reduced_c0**self.k
