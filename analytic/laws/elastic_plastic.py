"""What the laws of asperities that yield have in common: penetrations in units of the critical one."""

import math
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from analytic.arrays import Array
from analytic.laws.law import ContactLaw
from analytic.laws.unloading import Unloading, derivative
from analytic.surface import Surface

Formula = Callable[[int, Any, Array], Any]

BRIDGE = 1.5  # a bridge ends at this multiple of the penetration of its jump


@dataclass(frozen=True)
class ElasticPlastic(ContactLaw):
    """A law in ``x = delta/delta_c``: Hertz's up to the first of its `starts`, then a fit.

    An asperity of modulus E*(s) yields at ``delta_c = critical/e^2``, because its hardness does not
    depend on its height. A fit gives the load and area of the contact as multiples of Hertz's at the same
    penetration.

    Parameters
    ----------
    critical : float, optional
        Critical penetration over sigma of an asperity of modulus E*.
    """

    _: KW_ONLY
    critical: float | None = None

    elastic: ClassVar[bool] = False
    yields: ClassVar[bool] = True
    of_radius: ClassVar[tuple[str, float]] = ("critical", 1.0)
    starts: ClassVar[tuple[float, ...]] = (1.0,)

    def __post_init__(self) -> None:
        self.check_constants()

    @property
    def edges(self) -> tuple[float, ...]:
        """Penetrations over the critical one at which pieces from 1 on begin."""
        return self.starts

    @property
    def _root_of_critical(self) -> Any:
        return np.sqrt(self.reduced)

    def delta_c(self, e: Array) -> Array:
        """Critical penetration, infinite where there is no stiffness; in the shape of `e`."""
        with np.errstate(divide="ignore", over="ignore"):
            return np.asarray((self._root_of_critical / np.asarray(e, dtype=np.float64)) ** 2)

    def x(self, y: Any, e: Array) -> Any:
        """``delta/delta_c``; 1 where there is no stiffness, as formulas beyond yield mean nothing there."""
        return np.where(np.asarray(e) > 0, np.square(y * e / self._root_of_critical), 1.0)

    def limits(self, e: Array) -> Array:
        """Penetrations at which the next piece begins, increasing; shape (pieces - 1, *e.shape)."""
        return np.asarray(np.multiply.outer(np.array(self.edges), self.delta_c(e)))

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Load of a contact, in the shape of `y` and `e`."""
        hertz = super().load(piece, y, e)
        if piece == 0:
            return hertz
        return hertz * self._of(self.load_over_hertz, 1.5, piece, self.x(y, e), e)

    def radius(self, piece: int, y: Any, e: Array) -> Any:
        """Radius of a contact; its square is the area over pi R sigma."""
        hertz = super().radius(piece, y, e)
        if piece == 0:
            return hertz
        return hertz * np.sqrt(self._of(self.area_over_hertz, 1.0, piece, self.x(y, e), e))

    def _of(self, fit: Formula, power: float, piece: int, x: Any, e: Array) -> Any:
        """A fit over Hertz's, which itself goes as x to this power."""
        return fit(piece, x, np.where(np.asarray(e) > 0, e, 1.0))

    def load_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """Load beyond the start of this fit, over Hertz's at the same penetration."""
        raise NotImplementedError

    def area_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """Area beyond the start of this fit, over Hertz's at the same penetration."""
        raise NotImplementedError


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

    in_si: ClassVar[tuple[str, str]] = ("hardness", "a hardness in Pa or a critical penetration over sigma")

    @property
    def yield_factor(self) -> float:
        """K, the greatest contact pressure at the onset of yield over the hardness."""
        raise NotImplementedError

    def reduced_on(self, surface: Surface) -> float:
        """delta_c of an asperity of modulus E*, over sigma."""
        assert self.hardness is not None
        strain = math.pi * self.yield_factor * self.hardness / (2 * surface.E_star)
        return strain * strain * surface.radius / surface.sigma  # inf where a power would raise


@dataclass(frozen=True)
class Bridgeable(ElasticPlastic):
    """A law whose published fits jump; cubic Hermite pieces may join them.

    The bridge over a jump at x_j runs from x_j, so that what is elastic stays Hertz's, to 1.5 x_j. There
    load and area are the cubics in the penetration which take over value and slope of the fits at both
    ends; both rise all the way. After the idea of Brake (2012), whose own formulas are not these.

    Parameters
    ----------
    bridge : {None, "hermite"}, optional
        Whether to join the fits.
    """

    _: KW_ONLY
    bridge: Literal["hermite"] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.bridge not in (None, "hermite"):
            raise ValueError(f"bridge = {self.bridge!r}: give 'hermite', or leave it out")

    @property
    def edges(self) -> tuple[float, ...]:
        """Penetrations over the critical one at which pieces from 1 on begin: of bridges and fits in turn."""
        if self.bridge is None:
            return self.starts
        return tuple(x for start in self.starts for x in (start, BRIDGE * start))

    def _of(self, fit: Formula, power: float, piece: int, x: Any, e: Array) -> Any:
        e = np.where(np.asarray(e) > 0, e, 1.0)
        if self.bridge is None:
            return fit(piece, x, e)
        after = (piece + 1) // 2
        if piece % 2 == 0:
            return fit(after, x, e)
        start = self.starts[after - 1]
        left = _end(fit, power, after - 1, start, e)
        right = _end(fit, power, after, BRIDGE * start, e)
        return _hermite(left, right, x) / x**power


def _end(fit: Formula, power: float, index: int, x: float, e: Array) -> tuple[float, Array, Array]:
    """Penetration, value and slope at an end of a bridge, of Hertz's or a fit."""

    def value(x: Any) -> Any:
        return x**power * (fit(index, x, e) if index else 1.0)

    return x, np.asarray(value(x)), derivative(value, np.array(x))


def _hermite(left: tuple[float, Array, Array], right: tuple[float, Array, Array], x: Any) -> Any:
    """The cubic with these values and slopes at both ends."""
    width, rise = right[0] - left[0], right[1] - left[1]
    t = (x - left[0]) / width
    start, end = width * left[2] - rise, rise - width * right[2]
    return left[1] + t * rise + t * (1 - t) * ((1 - t) * start + t * end)


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
        return self.loading.load(piece, np.sqrt(deepest), e) * self._share(y, piece, deepest, e) ** power

    def radius(self, piece: int, y: Any, deepest: Any, e: Array) -> Any:
        """Radius of a contact; its square is the area over pi R sigma."""
        if piece == 0:
            return super().radius(piece, y, deepest, e)
        power = self._x(deepest, e) ** -0.12 / 2
        return self.loading.radius(piece, np.sqrt(deepest), e) * self._share(y, piece, deepest, e) ** power

    def stiffness(self, piece: int, y: Array, deepest: Array, e: Array) -> Array:
        """Stiffness of a spot over 2 E* sqrt(R sigma)."""
        return np.asarray(e * self.radius(piece, y, deepest, e))

    def _x(self, deepest: Any, e: Array) -> Any:
        """Deepest penetration over the critical one."""
        return self.loading.x(np.sqrt(deepest), e)

    def _share(self, y: Any, piece: int, deepest: Any, e: Array) -> Any:
        """How much is left of the penetration that springs back."""
        return y * y / (deepest - self.residual(piece, deepest, e))
