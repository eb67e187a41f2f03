"""Etsion, Kligerman and Kadin: the unloading of an asperity that yielded as Kogut and Etsion have it."""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from analytic.laws.elastic_plastic import ElasticPlastic
from analytic.laws.unloading import Unloading

__all__ = ["EtsionKligermanKadin"]

Array = NDArray[np.float64]


class EtsionKligermanKadin(Unloading):
    """Etsion, Kligerman and Kadin (2005), fitted to the finite elements of Kogut and Etsion.

    With ``x_m = delta_max/delta_c > 1`` the contact is lost at ::

        delta_res = delta_max (1 - x_m^-0.28) (1 - x_m^-0.69)

    and down to there load and area are those at delta_max times
    ``[(delta - delta_res)/(delta_max - delta_res)]`` to the powers ``1.5 x_m^-0.0331`` and
    ``x_m^-0.12``. An asperity that has not yielded unloads as Hertz's. Fitted for x_m up to 170.

    Known defects: the fit of loading jumps up by 3 % at delta_c, and unloading starts from there: up to
    x_m = 1.248 a loop gives out more work than it took, up to 3 % of it. With ``bridge = "hermite"``
    unloading starts from the bridged load; what is left of the gain is 0.13 %, at x_m = 1.11.

    Notes
    -----
    Source: I. Etsion, Y. Kligerman, Y. Kadin, Int. J. Solids Struct. 42 (2005) 3716 [mem: constants
    recalled].
    """

    root: ClassVar[bool] = False

    def __init__(self, loading: ElasticPlastic) -> None:
        super().__init__(loading)
        self.law = loading

    def residual(self, piece: int, deepest: Any, e: Array) -> Any:
        """Penetration at which contact is lost, in the shape of `deepest` and `e`."""
        if piece == 0:
            return super().residual(piece, deepest, e)
        log = np.log(self._x(deepest, e))
        return deepest * np.expm1(-0.28 * log) * np.expm1(-0.69 * log)

    def load(self, piece: int, y: Any, deepest: Any, e: Array) -> Any:
        """Load of a contact, in the shape of all."""
        if piece == 0:
            return super().load(piece, y, deepest, e)
        power = 1.5 * self._x(deepest, e) ** -0.0331
        return self.law.load(piece, np.sqrt(deepest), e) * self._share(y, piece, deepest, e) ** power

    def radius(self, piece: int, y: Any, deepest: Any, e: Array) -> Any:
        """Radius of a contact; its square is the area over pi R sigma."""
        if piece == 0:
            return super().radius(piece, y, deepest, e)
        power = self._x(deepest, e) ** -0.12 / 2
        return self.law.radius(piece, np.sqrt(deepest), e) * self._share(y, piece, deepest, e) ** power

    def stiffness(self, piece: int, y: Array, deepest: Array, e: Array) -> Array:
        """Stiffness of a spot over 2 E* sqrt(R sigma)."""
        return np.asarray(e * self.radius(piece, y, deepest, e))

    def _x(self, deepest: Any, e: Array) -> Any:
        """Deepest penetration over the critical one."""
        return self.law.x(np.sqrt(deepest), e)

    def _share(self, y: Any, piece: int, deepest: Any, e: Array) -> Any:
        """How much is left of the penetration that springs back."""
        return y * y / (deepest - self.residual(piece, deepest, e))
