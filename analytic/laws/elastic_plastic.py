"""What laws of asperities that yield have in common: penetrations over the critical one, and unloading.

Where published fits jump, cubic Hermite pieces may join them (``bridge = "hermite"``). The bridge over a jump
at x_j runs from x_j, so that what is elastic stays Hertz's, to 1.5 x_j. There load and area are the cubics in
the penetration which take over value and slope of the fits at both ends; both rise all the way. After the
idea of Brake (2012), whose own formulas are not these.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar, NamedTuple

import numpy as np

from analytic.arrays import Array
from analytic.laws.law import NEXT_TO_0, ContactLaw, slope_in_root
from analytic.surface import Surface

Formula = Callable[[Any, Any, Any], Any]  # of the law, of u = sqrt(delta/delta_c), and of e = E*(s)/E*

BRIDGE = 1.5  # a bridge ends at this multiple of the penetration of its jump


class Piece(NamedTuple):
    """What holds from a penetration on: load and area over those at delta_c by Hertz's law."""

    start: float  # ``x = delta/delta_c`` where it begins
    # each is factor and exponent of a power of x, or a function of the law, ``u = sqrt(x)`` and e
    load: tuple[float, float] | Formula
    area: tuple[float, float] | Formula

    def value(self, what: str, law: Any, u: Any, e: Any) -> Any:
        """Its load or area."""
        formula = getattr(self, what)
        return formula(law, u, e) if callable(formula) else formula[0] * u ** (2 * formula[1])

    def bridge_to(self, right: "Piece", what: str, law: Any, u: Any, e: Any) -> Any:
        """Return the same on the way to another piece: a cubic in the penetration."""
        start, width = right.start, (BRIDGE - 1) * right.start
        first, last = np.sqrt(start), np.sqrt(start + width)
        left_at, right_at = (partial(piece.value, what, law, e=e) for piece in (self, right))
        begins = left_at(first)
        rise = right_at(last) - begins
        at_first = width * slope_in_root(left_at, first) - rise
        at_last = rise - width * slope_in_root(right_at, last)
        t = (u * u - start) / width
        return begins + t * rise + t * (1 - t) * ((1 - t) * at_first + t * at_last)


HERTZ = Piece(0.0, load=(1.0, 1.5), area=(1.0, 1.0))


@dataclass(frozen=True, kw_only=True)
class ElasticPlastic(ContactLaw):
    """A law in ``x = delta/delta_c``: Hertz's, then the pieces of a fit.

    An asperity of modulus E*(s) yields at ``delta_c = critical/e^2``, because its hardness does not
    depend on its height.
    """

    critical: float | None = None  # penetration over sigma of an asperity of modulus E*

    elastic = False
    yields = True
    of_radius: ClassVar[dict[str, float]] = {"critical": 1.0}
    _fits: ClassVar[tuple[Piece, ...]] = ()  # beyond Hertz's law, if that holds where contact begins

    def __post_init__(self) -> None:
        super().__post_init__()
        bridge = getattr(self, "bridge", None)
        if bridge not in (None, "hermite"):
            raise ValueError(f"bridge = {bridge!r}: give 'hermite', or leave it out")

    @property
    def edges(self) -> tuple[float, ...]:
        """Penetrations over the critical one at which pieces from 1 on begin."""
        ends = (1.0, BRIDGE) if getattr(self, "bridge", None) else (1.0,)
        return tuple(fit.start * end for fit in self._fits for end in ends)

    def delta_c(self, e: Array) -> Array:
        """Critical penetration, infinite where there is no stiffness; in the shape of `e`."""
        with np.errstate(divide="ignore", over="ignore"):
            return np.asarray(self.reduced("critical") / np.square(np.asarray(e, dtype=np.float64)))

    def u(self, y: Any, e: Array) -> Any:
        """``sqrt(delta/delta_c)``; 1 where no stiffness is: formulas beyond yield mean nothing there."""
        u = y * e / np.sqrt(self.reduced("critical"))
        return np.where(np.asarray(e) > 0, np.where(np.abs(u) < NEXT_TO_0, NEXT_TO_0, u), 1.0)

    def limits(self, e: Array) -> Array:
        """Penetrations at which the next piece begins, increasing; shape (pieces - 1, *e.shape)."""
        return np.asarray(np.multiply.outer(np.array(self.edges), self.delta_c(e)))

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Load of a contact, in the shape of `y` and `e`."""
        return super().load(piece, y, e) * self._over_hertz("load", piece, y, e)

    def radius(self, piece: int, y: Any, e: Array) -> Any:
        """Radius of a contact; its square is the area over pi R sigma."""
        return super().radius(piece, y, e) * np.sqrt(self._over_hertz("area", piece, y, e))

    def _over_hertz(self, what: str, piece: int, y: Any, e: Array) -> Any:
        if piece == 0 and self._fits:
            return 1.0
        u = self.u(y, e)
        value = self._value(what, piece, u, np.where(np.asarray(e) > 0, e, 1.0))
        return value / (u * u * u if what == "load" else u * u)

    def _value(self, what: str, piece: int, u: Any, e: Array) -> Any:
        """Load or area of a piece over that at delta_c by Hertz's law."""
        step = 2 if getattr(self, "bridge", None) else 1  # bridges lie between fits
        left, right = ((HERTZ, *self._fits)[number // step] for number in (piece, piece + step - 1))
        if left is right:
            return left.value(what, self, u, e)
        return left.bridge_to(right, what, self, u, e)


@dataclass(frozen=True, kw_only=True)
class FromHardness(ElasticPlastic):
    """A law that yields at ``delta_c = (pi K H/(2 E*))^2 R``, where the contact pressure reaches K H."""

    hardness: float | None = None  # H of the softer body, Pa; or `critical`

    in_si = "hardness", "one of them, a hardness in Pa or a critical penetration over sigma"

    @property
    def yield_factor(self) -> float:
        """K, the greatest contact pressure at the onset of yield over the hardness."""
        poisson = getattr(self, "poisson", None)
        return 0.6 if poisson is None else 0.454 + 0.41 * poisson

    def reduced_on(self, surface: Surface, value: float) -> dict[str, float]:
        """Return delta_c of an asperity of modulus E*, over sigma."""
        return {"critical": yields_at(surface, self.yield_factor, value)}


def yields_at(surface: Surface, factor: float, strength: float) -> float:
    """Penetration over sigma at which the greatest pressure by Hertz's law is a factor times a strength."""
    root = math.pi * factor * (strength / surface.E_star) / 2
    return root * root * surface.radius / surface.sigma  # inf where a power would raise


class EtsionKligermanKadin(ContactLaw):
    """Unloading after Etsion, Kligerman and Kadin (2005), fitted to the finite elements of Kogut and Etsion.

    With ``x_m = delta_max/delta_c > 1``, contact is lost at ::

        delta_res = delta_max (1 - x_m^-0.28) (1 - x_m^-0.69)

    and down to there load and area are those at delta_max times
    ``[(delta - delta_res)/(delta_max - delta_res)]`` to the powers ``1.5 x_m^-0.0331`` and
    ``x_m^-0.12``. An asperity that has not yielded unloads as Hertz's. Fitted for x_m up to 170.

    Known defects: the fit of loading jumps up by 3 % at delta_c, and unloading starts from there: up to
    x_m = 1.248 a loading loop releases more work than it took, by up to 3 %. With ``bridge = "hermite"``
    unloading starts from the bridged load, and the gain is at most 0.13 %, at x_m = 1.11. Source: I. Etsion,
    Y. Kligerman, Y. Kadin, Int. J. Solids Struct. 42 (2005) 3716 [mem: constants recalled].
    """

    def __init__(self, loading: Any, deepest: Any) -> None:
        self.loading, self.deepest = loading, deepest

    def left(self, above: Array, e: Array) -> Any:
        """Return the penetration left until contact is lost, exact where little or nearly all stays."""
        log = np.log(np.maximum(self._x(e), 1.0))
        stays = self.deepest * np.expm1(-0.28 * log) * np.expm1(-0.69 * log)  # delta_res
        return np.where(stays < self.deepest / 2, above - stays, above - self.deepest + self._springs_back(e))

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Return the load of a contact."""
        return super().load(0, y, e) if piece == 0 else self._left("load", 1.5, -0.0331, piece, y, e)

    def radius(self, piece: int, y: Any, e: Array) -> Any:
        """Return the radius of a contact; its square is the area over pi R sigma."""
        return super().radius(0, y, e) if piece == 0 else self._left("radius", 0.5, -0.12, piece, y, e)

    def _springs_back(self, e: Array) -> Any:
        """Return what of the deepest penetration does: delta_max - delta_res, to all its digits."""
        log = np.log(np.maximum(self._x(e), 1.0))
        a, b = np.exp(-0.28 * log), np.exp(-0.69 * log)
        return self.deepest * (a + b - a * b)

    def _x(self, e: Array) -> Any:
        """Deepest penetration over the critical one."""
        return np.square(self.loading.u(np.sqrt(self.deepest), e))

    def _left(self, what: str, power: float, fall: float, piece: int, y: Any, e: Array) -> Any:
        """Return what is left of that at the deepest penetration: a power of the share that springs back."""
        share = y * y / self._springs_back(e)
        most = getattr(self.loading, what)(piece, np.sqrt(self.deepest), e)
        return most * share ** (power * self._x(e) ** fall)
