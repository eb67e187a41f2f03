"""Summits of an isotropic Gaussian surface from its spectral moments (Nayak 1971; McCool 1986)."""

import math
from dataclasses import dataclass

__all__ = ["SpectralMoments"]

# Variance of the summit heights is (1 - 0.8968/alpha) m0 (Bush, Gibson and Thomas 1975).
_SPREAD = 1 + 16 / math.pi - 3 * math.sqrt(3)


@dataclass(frozen=True, slots=True)
class SpectralMoments:
    """Mean squares of height, slope and second derivative of a profile.

    Parameters
    ----------
    m0, m2, m4 : float
        m^2, 1, 1/m^2; positive.

    Raises
    ------
    ValueError
        If one is not a positive finite number.
    """

    m0: float
    m2: float
    m4: float

    def __post_init__(self) -> None:
        for name in ("m0", "m2", "m4"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise ValueError(f"{name} = {value!r}: give a finite number > 0")

    @property
    def alpha(self) -> float:
        """Bandwidth ``m0 m4/m2^2``: at least 1.5 for an isotropic surface."""
        return self.m0 * self.m4 / self.m2**2

    @property
    def eta(self) -> float:
        """Summits per area, ``m4/(6 sqrt(3) pi m2)``, 1/m^2."""
        return self.m4 / (6 * math.sqrt(3) * math.pi * self.m2)

    @property
    def radius(self) -> float:
        """Inverse of the mean summit curvature, ``3 sqrt(pi)/(8 sqrt(m4))``, m."""
        return 3 * math.sqrt(math.pi) / (8 * math.sqrt(self.m4))

    @property
    def sigma(self) -> float:
        """Standard deviation of the summit heights, ``sqrt((1 - 0.8968/alpha) m0)``, m."""
        return math.sqrt(max(1 - _SPREAD / self.alpha, 0.0) * self.m0)

    @property
    def mean_height(self) -> float:
        """Of the summits above the mean plane, ``4 sqrt(m0/(pi alpha))``, m."""
        return 4 * math.sqrt(self.m0 / (math.pi * self.alpha))
