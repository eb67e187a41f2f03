"""Zhao, Maietta and Chang: from elastic to fully plastic by a template."""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from analytic.laws.hardness import FromHardness

__all__ = ["ZhaoMaiettaChang"]

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ZhaoMaiettaChang(FromHardness):
    """Zhao, Maietta and Chang (2000): Hertz up to delta_1, fully plastic beyond 54 delta_1.

    Yield begins at the mean pressure k H, k = 0.4: ``delta_1 = (3 pi k H/(4 E*))^2 R``. In between, with
    ``t = (delta - delta_1)/(delta_2 - delta_1)``, the area over pi R delta is ``1 + 3 t^2 - 2 t^3`` and
    the mean pressure over H ``1 - (1 - k) ln(delta_2/delta)/ln(delta_2/delta_1)``; beyond, these are 2
    and 1. Meant for any penetration that is small against R; delta_2 = 54 delta_1 is the least that the
    paper allows, and what it takes.

    Known defects: continuous, but the slope of the load has kinks: right over left it is .91736 at
    delta_1 and .86925 at delta_2.

    Parameters
    ----------
    critical : float, optional
        delta_1/sigma of an asperity of modulus E*. Give it, or `hardness`.
    hardness : float, optional
        H of the softer body, Pa.

    Raises
    ------
    ValueError
        If not exactly one of them is given, or it is not positive.

    Notes
    -----
    Source: Y. Zhao, D. M. Maietta, L. Chang, J. Tribol. 122 (2000) 86 [mem: constants recalled; names and
    inputs compared with a public script].

    Examples
    --------
    >>> ZhaoMaiettaChang(critical=0.05).limits(np.array(1.0)).round(12)
    array([0.05, 2.7 ])
    """

    name: ClassVar[str] = "zhao-maietta-chang"
    starts: ClassVar[tuple[float, ...]] = (1.0, 54.0)
    first_yield: ClassVar[float] = 0.4  # k: mean pressure at first yield over hardness

    @property
    def yield_factor(self) -> float:
        """K, the greatest contact pressure at the onset of yield over the hardness: 1.5 k."""
        return 1.5 * self.first_yield

    def load_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """Area times mean pressure: where x = 1, the pressure is k H."""
        pressure, k = 1.0, self.first_yield
        if fit == 1:
            pressure = 1 - (1 - k) * np.log(self.starts[1] / x) / math.log(self.starts[1])
        return self.area_over_hertz(fit, x, e) * pressure / (k * np.sqrt(x))

    def area_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """From 1 to 2, by the template."""
        if fit == 2:
            return 2.0 + 0 * x
        t = (x - 1) / (self.starts[1] - 1)
        return 1 + t * t * (3 - 2 * t)
