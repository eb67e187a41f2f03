"""Unloading of contacts that have yielded."""

from typing import Any

import numpy as np

from analytic.arrays import Array
from analytic.laws.law import ContactLaw


class EtsionKligermanKadin(ContactLaw):
    """Unloading after Etsion, Kligerman and Kadin (2005), fitted to the finite elements of Kogut and Etsion.

    With ``x_m = delta_max/delta_c > 1``, contact is lost at ::

        delta_res = delta_max (1 - x_m^-0.28) (1 - x_m^-0.69)

    and down to there load and area are those at delta_max times
    ``[(delta - delta_res)/(delta_max - delta_res)]`` to the powers ``1.5 x_m^-0.0331`` and
    ``x_m^-0.12``. An asperity that has not yielded unloads as Hertz's. Fitted for x_m up to 170.

    Known defects: the fit of loading jumps up by 3 % at delta_c, and unloading starts from there: up to
    x_m = 1.248 a loading loop releases more work than it took, by up to 3 %. With ``bridge = "hermite"``
    unloading starts from the bridged load, and the gain is at most 0.13 %, at x_m = 1.11.

    Notes
    -----
    Source: I. Etsion, Y. Kligerman, Y. Kadin, Int. J. Solids Struct. 42 (2005) 3716 [mem: constants
    recalled].
    """

    def __init__(self, loading: Any, deepest: Any) -> None:
        self.loading, self.deepest = loading, deepest

    def residual(self, e: Array) -> Any:
        """Return the penetration at which contact is lost."""
        log = np.log(np.maximum(self._x(e), 1.0))
        return self.deepest * np.expm1(-0.28 * log) * np.expm1(-0.69 * log)

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Return the load of a contact."""
        if piece == 0:
            return super().load(piece, y, e)
        share = self._share(y, e) ** (1.5 * self._x(e) ** -0.0331)
        return self.loading.load(piece, np.sqrt(self.deepest), e) * share

    def radius(self, piece: int, y: Any, e: Array) -> Any:
        """Return the radius of a contact; its square is the area over pi R sigma."""
        if piece == 0:
            return super().radius(piece, y, e)
        share = self._share(y, e) ** (self._x(e) ** -0.12 / 2)
        return self.loading.radius(piece, np.sqrt(self.deepest), e) * share

    def _x(self, e: Array) -> Any:
        """Deepest penetration over the critical one."""
        return self.loading.x(np.sqrt(self.deepest), e)

    def _share(self, y: Any, e: Array) -> Any:
        """How much is left of the penetration that springs back."""
        return y * y / (self.deepest - self.residual(e))
