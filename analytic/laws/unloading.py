"""Unloading of a contact from its deepest penetration: along the loading curve, or after yield."""

from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np

from analytic.arrays import Array

_STEP = 1e-30  # of the variable, into the complex plane
_NEXT_TO_0 = 1e-60  # stands for 0: cubes of it, times a step, are still numbers


def derivative(formula: Callable[[Any], Any], x: Array) -> Array:
    """``d formula/dx`` where x is not 0."""
    step = _STEP * np.abs(x)
    return np.asarray(np.imag(formula(x + 1j * step)) / step)


def slope_in_root(formula: Callable[[Any], Any], y: Array) -> Array:
    """``d formula/d(y^2)``, at y = 0 its limit."""
    y = np.where(y == 0, _NEXT_TO_0, y)
    return derivative(formula, y) / (2 * y)


class Unloading:
    """What a contact adds, on unloading along the loading curve; subclasses unload otherwise.

    The contact holds down to the penetration `residual`. Formulas take ``y = sqrt(penetration - residual)``,
    so that next to lift-off no digit is lost; `piece` is the piece of the law that holds at the deepest
    penetration, and `deepest` that penetration.

    Parameters
    ----------
    loading : ContactLaw
        In reduced units.

    Attributes
    ----------
    root : bool
        False if `load` and `radius` are no analytic functions of y next to y = 0, in pieces from 1 on.
    stiff : bool
        False if the stiffness of a contact has no variance, and so is refused.
    """

    root: ClassVar[bool] = True
    stiff: ClassVar[bool] = True

    def __init__(self, loading: Any) -> None:
        self.loading = loading

    def residual(self, deepest: Any, e: Array) -> Any:
        """Penetration at which contact is lost, in the shape of `deepest` and `e`."""
        return 0.0 * deepest

    def load(self, piece: int, y: Any, deepest: Any, e: Array) -> Any:
        """Load of a contact, in the shape of all."""
        return self.loading.load(piece, y, e)

    def radius(self, piece: int, y: Any, deepest: Any, e: Array) -> Any:
        """Radius of a contact; its square is the area over pi R sigma."""
        return self.loading.radius(piece, y, e)

    def stiffness(self, piece: int, y: Array, deepest: Array, e: Array) -> Array:
        """Stiffness of a spot over 2 E* sqrt(R sigma)."""
        return np.asarray(self.loading.stiffness(piece, y, e))

    def slope(self, piece: int, y: Array, deepest: Array, e: Array) -> Array:
        """Return the derivative of the load with respect to the penetration, at a given deepest one."""
        return slope_in_root(lambda v: self.load(piece, v, deepest, e), y)

    def added(self, quantity: str, piece: int, *at: Array) -> Array:
        """Return what a contact of this piece adds, as the piece's formula goes on beyond its ends.

        Parameters
        ----------
        quantity : str
            Its name: one of `analytic.QUANTITIES` or `analytic.LAW_QUANTITIES`.
        piece : int
            Which formula.
        *at : ndarray
            The root of the penetration that is left to lift-off, the deepest penetration, and the modulus
            E*(s)/E*; of any shapes that broadcast.

        Returns
        -------
        ndarray
            In their common shape, over the scale of the quantity.

        Raises
        ------
        KeyError
            If there is no such quantity.
        """
        shape = np.broadcast_shapes(*map(np.shape, at))
        known: dict[str, Callable[[], Any]] = {
            "load": lambda: self.load(piece, *at),
            "area": lambda: self.radius(piece, *at) ** 2,
            "stiffness": lambda: self.stiffness(piece, *at),
            "contacts": lambda: np.ones(shape),
            "conductance": lambda: self.radius(piece, *at),
            "load_slope": lambda: self.slope(piece, *at) * (2 / 3),
            "yielded": lambda: np.full(shape, float(piece > 0)),
        }
        return np.asarray(known[quantity]())


class EtsionKligermanKadin(Unloading):
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

    root: ClassVar[bool] = False

    def residual(self, deepest: Any, e: Array) -> Any:
        """Penetration at which contact is lost, in the shape of `deepest` and `e`."""
        log = np.log(np.maximum(self._x(deepest, e), 1.0))
        return deepest * np.expm1(-0.28 * log) * np.expm1(-0.69 * log)

    def load(self, piece: int, y: Any, deepest: Any, e: Array) -> Any:
        """Load of a contact, in the shape of all."""
        if piece == 0:
            return super().load(piece, y, deepest, e)
        power = 1.5 * self._x(deepest, e) ** -0.0331
        return self.loading.load(piece, np.sqrt(deepest), e) * self._share(y, deepest, e) ** power

    def radius(self, piece: int, y: Any, deepest: Any, e: Array) -> Any:
        """Radius of a contact; its square is the area over pi R sigma."""
        if piece == 0:
            return super().radius(piece, y, deepest, e)
        power = self._x(deepest, e) ** -0.12 / 2
        return self.loading.radius(piece, np.sqrt(deepest), e) * self._share(y, deepest, e) ** power

    def stiffness(self, piece: int, y: Array, deepest: Array, e: Array) -> Array:
        """Stiffness of a spot over 2 E* sqrt(R sigma)."""
        return np.asarray(e * self.radius(piece, y, deepest, e))

    def _x(self, deepest: Any, e: Array) -> Any:
        """Deepest penetration over the critical one."""
        return self.loading.x(np.sqrt(deepest), e)

    def _share(self, y: Any, deepest: Any, e: Array) -> Any:
        """How much is left of the penetration that springs back."""
        return y * y / (deepest - self.residual(deepest, e))
