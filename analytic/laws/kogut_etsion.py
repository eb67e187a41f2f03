"""Kogut and Etsion: powers fitted to finite elements."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from analytic.laws.bridge import Bridgeable
from analytic.laws.etsion_kligerman_kadin import EtsionKligermanKadin
from analytic.laws.hardness import FromHardness, kogut_etsion_factor
from analytic.laws.poisson import checked_poisson

__all__ = ["KogutEtsion"]

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class KogutEtsion(FromHardness, Bridgeable):
    """Kogut and Etsion (2002): powers of ``x = delta/delta_c``, then the hardness on ``2 pi R delta``.

    ==========  ========================  ========================
    x           load over that at yield   area over that at yield
    ==========  ========================  ========================
    0 to 1      x^1.5                     x
    1 to 6      1.03 x^1.425              0.93 x^1.136
    6 to 110    1.40 x^1.263              0.94 x^1.146
    above 110   3 x/K                     2 x
    ==========  ========================  ========================

    ``K = 0.454 + 0.41 nu``. Fitted for x up to 110, frictionless, no hardening, E/Y from 100 to 1000.

    Known defects: the load jumps, x 1.03 at 1, x 1.0168 at 6, x 1.0788 at 110 (nu = 0.3), and the area,
    x 0.93, x 1.0290, x 1.0712: at yield a contact *shrinks* by 7 %. ``bridge = "hermite"`` joins them.

    Parameters
    ----------
    critical : float, optional
        delta_c/sigma of an asperity of modulus E*. Give it, or `hardness`.
    hardness : float, optional
        H of the softer body, Pa.
    poisson : float, optional
        Its Poisson's ratio; it enters K, so also the load beyond x = 110.
    bridge : {None, "hermite"}, optional
        Whether jumps are bridged, each from its penetration to 1.5 times that.

    Raises
    ------
    ValueError
        If not exactly one of `critical` and `hardness` is given, or a value is out of range.

    Notes
    -----
    Source: L. Kogut, I. Etsion, J. Appl. Mech. 69 (2002) 657. [Load: constants compared with a public
    script; area, K: mem, recalled.]

    Examples
    --------
    >>> KogutEtsion(critical=0.05).limits(np.array(1.0)).round(12)
    array([0.05, 0.3 , 5.5 ])
    """

    name: ClassVar[str] = "kogut-etsion"
    starts: ClassVar[tuple[float, ...]] = (1.0, 6.0, 110.0)
    load_fits: ClassVar[tuple[tuple[float, float], ...]] = ((1.03, 1.425), (1.40, 1.263))
    area_fits: ClassVar[tuple[tuple[float, float], ...]] = ((0.93, 1.136), (0.94, 1.146))

    poisson: float = 0.3

    def __post_init__(self) -> None:
        super().__post_init__()
        checked_poisson(self.poisson)

    @property
    def yield_factor(self) -> float:
        """K, the greatest contact pressure at the onset of yield over the hardness."""
        return kogut_etsion_factor(self.poisson)

    def unloading(self) -> EtsionKligermanKadin:
        """Etsion, Kligerman and Kadin's, which was fitted for this law; with a bridge, from its load."""
        return EtsionKligermanKadin(self)

    def load_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """From the powers of x, or the hardness."""
        factor, power = self.load_fits[fit - 1] if fit < 3 else (3 / self.yield_factor, 1.0)
        return factor * x ** (power - 1.5)

    def area_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """From the powers of x; at last 2."""
        factor, power = self.area_fits[fit - 1] if fit < 3 else (2.0, 1.0)
        return factor * x ** (power - 1.0)
