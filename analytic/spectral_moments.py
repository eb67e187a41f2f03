"""Summits of an isotropic Gaussian surface from its spectral moments (Nayak 1971; McCool 1986)."""

import math
from dataclasses import dataclass

from analytic.surface import Surface

__all__ = ["LEAST_ALPHA", "SUMMIT_SPREAD", "SpectralMoments"]

LEAST_ALPHA = 1.5  # of an isotropic surface: all its waves have one length
# Variance of the summit heights is (1 - 0.8968/alpha) m0 (Bush, Gibson and Thomas 1975), exactly:
SUMMIT_SPREAD = 1 + 16 / math.pi - 3 * math.sqrt(3)


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

    Examples
    --------
    >>> moments = SpectralMoments(1e-12, 1e-3, 5e6)
    >>> round(moments.alpha, 9)
    5.0
    >>> moments.surface(1e-6, 1e9).eta == moments.eta
    True
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
        return math.sqrt(max(1 - SUMMIT_SPREAD / self.alpha, 0.0) * self.m0)

    @property
    def mean_height(self) -> float:
        """Of the summits above the mean plane, ``4 sqrt(m0/(pi alpha))``, m."""
        return 4 * math.sqrt(self.m0 / (math.pi * self.alpha))

    def surface(self, nominal_area: float, E_star: float) -> Surface:
        """The rough surface with these summits.

        Parameters
        ----------
        nominal_area : float
            m^2.
        E_star : float
            Composite modulus, Pa.

        Returns
        -------
        Surface
            Its radius is the inverse of the mean summit curvature.

        Raises
        ------
        ValueError
            If no isotropic Gaussian surface has such moments.
        """
        if not self.alpha >= LEAST_ALPHA:
            raise ValueError(
                f"m0, m2, m4: alpha = m0 m4/m2^2 = {self.alpha:.4g}, and an isotropic Gaussian surface has "
                "at least 1.5; give a larger m0 or m4, or a smaller m2"
            )
        return Surface(self.sigma, self.radius, self.eta, nominal_area, E_star)
