"""Chang, Etsion and Bogy: elastic, then at once fully plastic with conserved volume."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from analytic.laws.bridge import Bridgeable
from analytic.laws.hardness import FromHardness, kogut_etsion_factor
from analytic.laws.poisson import checked_poisson

__all__ = ["ChangEtsionBogy"]

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ChangEtsionBogy(FromHardness, Bridgeable):
    """Chang, Etsion and Bogy (1987): beyond delta_c the volume is conserved and the mean pressure is K H.

    ``A = pi R (2 delta - delta_c)``, ``P = A K H``; in reduced units load
    ``(3/2) sqrt(delta_c) (2 delta - delta_c) e``, area ``2 delta - delta_c``. Meant for any
    penetration that is small against R.

    Known defects: the load jumps by the factor 1.5 at delta_c, from a mean pressure of (2/3) K H to K H;
    the area is continuous. ``bridge = "hermite"`` joins them.

    Parameters
    ----------
    critical : float, optional
        delta_c/sigma of an asperity of modulus E*. Give it, or `hardness`.
    hardness : float, optional
        H of the softer body, Pa.
    poisson : float, optional
        Its Poisson's ratio, for ``K = 0.454 + 0.41 nu``; K = 0.6 if it is not given.
    bridge : {None, "hermite"}, optional
        Whether the jump is bridged, from delta_c to 1.5 delta_c.

    Raises
    ------
    ValueError
        If not exactly one of `critical` and `hardness` is given, or a value is out of range.

    Notes
    -----
    Source: W. R. Chang, I. Etsion, D. B. Bogy, J. Tribol. 109 (1987) 257 [mem: constants recalled].

    Examples
    --------
    >>> law = ChangEtsionBogy(critical=0.05)
    >>> law.limits(np.array(2.0))  # a stiffer asperity of the same hardness yields earlier
    array([0.0125])
    """

    name: ClassVar[str] = "chang-etsion-bogy"
    poisson: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.poisson is not None:
            checked_poisson(self.poisson)

    @property
    def yield_factor(self) -> float:
        """K, the greatest contact pressure at the onset of yield over the hardness."""
        return 0.6 if self.poisson is None else kogut_etsion_factor(self.poisson)

    def load_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """``1.5 (2 x - 1)/x^1.5``."""
        return 1.5 * self.area_over_hertz(fit, x, e) / np.sqrt(x)

    def area_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """``(2 x - 1)/x``."""
        return 2 - 1 / x
