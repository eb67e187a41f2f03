"""From the hardness of a body to the penetration at which its asperities yield."""

import math
from dataclasses import KW_ONLY, dataclass, replace
from typing import Self

from analytic.laws.elastic_plastic import ElasticPlastic
from analytic.laws.positive import is_positive
from analytic.surface import Surface

__all__ = ["FromHardness", "kogut_etsion_factor"]


def kogut_etsion_factor(poisson: float) -> float:
    """Greatest contact pressure at the onset of yield, over hardness: ``K = 0.454 + 0.41 nu`` [mem]."""
    return 0.454 + 0.41 * poisson


@dataclass(frozen=True)
class FromHardness(ElasticPlastic):
    """A law that yields at ``delta_c = (pi K H/(2 E*))^2 R``, where the contact pressure reaches K H.

    Parameters
    ----------
    hardness : float, optional
        H of the softer body, Pa. Give it, or `critical`.
    """

    _: KW_ONLY
    hardness: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.hardness is None) == (self.critical is None):
            raise ValueError(
                f"hardness = {self.hardness!r}, critical = {self.critical!r}: give one of them, "
                "a hardness in Pa or a critical penetration over sigma"
            )
        if self.hardness is not None and not is_positive(self.hardness):
            raise ValueError(f"hardness = {self.hardness!r}: give a hardness > 0 Pa, as a number")

    @property
    def yield_factor(self) -> float:
        """K, the greatest contact pressure at the onset of yield over the hardness."""
        raise NotImplementedError

    def on(self, surface: Surface) -> Self:
        """The law on this surface, in reduced units: with `critical` in place of `hardness`."""
        if self.hardness is None:
            return self
        strain = math.pi * self.yield_factor * self.hardness / (2 * surface.E_star)
        return replace(self, hardness=None, critical=strain**2 * surface.radius / surface.sigma)
