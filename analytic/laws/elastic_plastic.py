"""What laws of asperities that yield have in common: penetrations over the critical one, and unloading.

Where published fits jump, cubic Hermite pieces may join them (``bridge = "hermite"``). The bridge over a jump
at x_j runs from x_j, so that what is elastic stays Hertz's, to 1.5 x_j. There load and area are the cubics in
the penetration which take over value and slope of the fits at both ends; both rise all the way. After the
idea of Brake (2012), whose own formulas are not these.
"""

import math
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from itertools import chain, pairwise
from typing import Any, ClassVar, NamedTuple

import numpy as np

from analytic.arrays import Array
from analytic.laws.law import NEXT_TO_0, ContactLaw, slope_in_root
from analytic.surface import Surface

Formula = Callable[[Any, Any, Any], Any]  # of the law, of u = sqrt(delta/delta_c), and of e = E*(s)/E*

BRIDGE = 1.5  # a bridge ends at this multiple of the penetration of its jump


class Piece(NamedTuple):
    """What holds from a penetration on: load and area over those at delta_c by Hertz's law.

    Each is factor and exponent of a power of x, or a function of the law, ``u = sqrt(x)`` and e.
    """

    start: float  # ``x = delta/delta_c`` where it begins
    load: tuple[float, float] | Formula
    area: tuple[float, float] | Formula

    def value(self, what: str, law: Any, u: Any, e: Any) -> Any:
        """Its load or area."""
        formula = getattr(self, what)
        return formula(law, u, e) if callable(formula) else formula[0] * u ** (2 * formula[1])

    def bridge_to(self, right: "Piece") -> "Piece":
        """Return the piece that leads on to another one."""
        start, width = right.start, (BRIDGE - 1) * right.start

        def cubic(what: str) -> Formula:
            def formula(law: Any, u: Any, e: Any) -> Any:
                first, last = np.sqrt(start), np.sqrt(start + width)
                begins = self.value(what, law, first, e)
                rise = right.value(what, law, last, e) - begins
                at_first = width * slope_in_root(lambda u: self.value(what, law, u, e), first) - rise
                at_last = rise - width * slope_in_root(lambda u: right.value(what, law, u, e), last)
                t = (u * u - start) / width
                return begins + t * rise + t * (1 - t) * ((1 - t) * at_first + t * at_last)

            return formula

        return Piece(start, cubic("load"), cubic("area"))


@dataclass(frozen=True)
class ElasticPlastic(ContactLaw):
    """A law in ``x = delta/delta_c``: Hertz's, then the pieces of a fit.

    An asperity of modulus E*(s) yields at ``delta_c = critical/e^2``, because its hardness does not
    depend on its height.
    """

    _: KW_ONLY
    critical: float | None = None  # penetration over sigma of an asperity of modulus E*

    elastic: ClassVar[bool] = False
    yields: ClassVar[bool] = True
    of_radius: ClassVar[tuple[str, float]] = ("critical", 1.0)
    _fits: ClassVar[tuple[Piece, ...]] = ()
    _begins_as_hertz: ClassVar[bool] = True

    def __post_init__(self) -> None:
        self.check_constants()
        bridge = getattr(self, "bridge", None)
        if bridge not in (None, "hermite"):
            raise ValueError(f"bridge = {bridge!r}: give 'hermite', or leave it out")

    @property
    def yield_factor(self) -> float:
        """The greatest contact pressure at the onset of yield over the hardness, or the yield strength."""
        raise NotImplementedError

    def _critical_at(self, strain: float, surface: Surface) -> float:
        """delta_c over sigma, of an asperity of so many times less hardness, or strength, than modulus."""
        root = math.pi * self.yield_factor * strain / 2
        return root * root * surface.radius / surface.sigma  # inf where a power would raise

    @property
    def _pieces(self) -> tuple[Piece, ...]:
        """All of them: Hertz's law first, then fits, or bridges and fits in turn."""
        fits = (Piece(0.0, load=(1.0, 1.5), area=(1.0, 1.0)), *self._fits)
        if not getattr(self, "bridge", None):
            return fits
        pairs = [(a.bridge_to(b), b._replace(start=BRIDGE * b.start)) for a, b in pairwise(fits)]
        return (fits[0], *chain.from_iterable(pairs))

    @property
    def edges(self) -> tuple[float, ...]:
        """Penetrations over the critical one at which pieces from 1 on begin."""
        return tuple(piece.start for piece in self._pieces[1:])

    def delta_c(self, e: Array) -> Array:
        """Critical penetration, infinite where there is no stiffness; in the shape of `e`."""
        with np.errstate(divide="ignore", over="ignore"):
            return np.asarray(self.reduced / np.square(np.asarray(e, dtype=np.float64)))

    def u(self, y: Any, e: Array) -> Any:
        """``sqrt(delta/delta_c)``; 1 where no stiffness is: formulas beyond yield mean nothing there."""
        return np.where(np.asarray(e) > 0, y * e / np.sqrt(self.reduced), 1.0)

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
        if piece == 0 and self._begins_as_hertz:
            return 1.0
        u = self.u(y, e)
        if piece == 0:
            u = np.where(np.abs(u) < NEXT_TO_0, NEXT_TO_0, u)
        return self._value(what, piece, u, e) / (u * u * u if what == "load" else u * u)

    def _value(self, what: str, piece: int, u: Any, e: Array) -> Any:
        return self._pieces[piece].value(what, self, u, np.where(np.asarray(e) > 0, e, 1.0))


@dataclass(frozen=True)
class FromHardness(ElasticPlastic):
    """A law that yields at ``delta_c = (pi K H/(2 E*))^2 R``, where the contact pressure reaches K H."""

    _: KW_ONLY
    hardness: float | None = None  # H of the softer body, Pa; or `critical`

    in_si: ClassVar[tuple[str, str]] = ("hardness", "a hardness in Pa or a critical penetration over sigma")

    def reduced_on(self, surface: Surface) -> float:
        """delta_c of an asperity of modulus E*, over sigma."""
        assert self.hardness is not None
        return self._critical_at(self.hardness / surface.E_star, surface)


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
        return np.square(self.loading.u(np.sqrt(self.deepest), e))

    def _share(self, y: Any, e: Array) -> Any:
        """How much is left of the penetration that springs back."""
        return y * y / (self.deepest - self.residual(e))
