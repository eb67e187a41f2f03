"""What a fit knew of a surface, the table ``[fitted]``: whether the measured errors are for it."""

import math
from dataclasses import dataclass

from analytic import SpectralMoments, Surface
from analytic.surface import SUMMIT_SPREAD

_SHOWN = 3  # cautions


@dataclass(frozen=True)
class Fitted:
    """What a fit knew of a surface besides its summits: by it `Scene.validity` tells whether it fits.

    Parameters
    ----------
    m0, m2, m4 : float
        Spectral moments, m^2, 1, 1/m^2: means over all directions.
    skewness, kurtosis : float
        Skewness and kurtosis of all heights: 0 and 3 of Gaussian ones.
    independent : float
        How many independent heights would tell m0 as well: few where long waves are.
    agreement : float or None
        Largest ratio, at least 1, between what moments and counted summits say of eta, R or sigma; of
        profiles between the peaks that are counted and those that follow from the moments. None: summits
        were too few to be counted.
    lay : float or None
        Mean square slope across the lay over that along it, at least 1; None: nobody saw it.
    area : float or None
        Area of the map, m^2; None: along lines only.
    cautions : tuple of str
        Warnings of `mcgw.fit`, the most serious first.
    """

    m0: float
    m2: float
    m4: float
    skewness: float
    kurtosis: float
    independent: float
    agreement: float | None = None
    lay: float | None = None
    area: float | None = None
    cautions: tuple[str, ...] = ()

    @property
    def moments(self) -> SpectralMoments:
        """m0, m2 and m4."""
        return SpectralMoments(self.m0, self.m2, self.m4)

    def off(self, surface: Surface) -> float:
        """Largest ratio, at least 1, of eta, R and sigma of a surface to those from the moments."""
        m = self.moments
        pairs = ((surface.eta, m.eta), (surface.radius, m.radius), (surface.sigma, m.sigma))
        return max(max(a, b) / min(a, b) if min(a, b) > 0 else math.inf for a, b in pairs)

    @property
    def gravest(self) -> list[str]:
        """The cautions to display, at most three."""
        shown, more = [f"fit: {line}" for line in self.cautions[:_SHOWN]], len(self.cautions) - _SHOWN
        if more > 0:
            shown[-1] += f" (and {more} more under [fitted] in the scene)"
        return shown

    def lines(self) -> tuple[str, str]:
        """Lines about the spectrum and other properties of the map."""
        lay = "" if self.lay is None else f", lay {self.lay:.3g}"
        apart = "" if self.agreement is None else f", estimates differ by a factor of {self.agreement:.3g}"
        return (
            f"alpha = {self.moments.alpha:.4g}, rms slope {math.sqrt(2 * self.m2):.3g}{lay}",
            f"skewness {self.skewness:.2f}, kurtosis {self.kurtosis:.2f}{apart}",
        )


def moments_of_nayak(surface: Surface, alpha: float) -> SpectralMoments:
    """Return the moments of the Gaussian surface with this alpha, sigma and R."""
    m0, m4 = surface.sigma**2 / (1 - SUMMIT_SPREAD / alpha), 9 * math.pi / (64 * surface.radius**2)
    return SpectralMoments(m0, math.sqrt(m0 * m4 / alpha), m4)
