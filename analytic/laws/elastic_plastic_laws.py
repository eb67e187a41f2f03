"""Elastic-plastic asperities: Hertz's law up to the critical penetration, then a fit or an assumption."""
# ruff: noqa: ARG001, ARG005 - formulas of pieces take the same arguments

import math
from dataclasses import KW_ONLY, dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from analytic.laws.elastic_plastic import ElasticPlastic, EtsionKligermanKadin, FromHardness, Piece, yields_at
from analytic.surface import Surface

_FIRST_YIELD = 0.4  # k of Zhao, Maietta and Chang: mean pressure at first yield over hardness
_PLASTIC = 54.0  # their delta_2/delta_1


def _zhao_area(law: Any, u: Any, e: Any) -> Any:
    x = u * u
    t = (x - 1) / (_PLASTIC - 1)
    return x * (1 + t * t * (3 - 2 * t))


def _zhao_load(law: Any, u: Any, e: Any) -> Any:
    pressure = 1 - (1 - _FIRST_YIELD) * np.log(_PLASTIC / (u * u)) / math.log(_PLASTIC)
    return _zhao_area(law, u, e) * pressure / _FIRST_YIELD


@dataclass(frozen=True, kw_only=True)
class ChangEtsionBogy(FromHardness):
    """Chang, Etsion and Bogy (1987): beyond delta_c the volume is conserved and the mean pressure is K H.

    ``A = pi R (2 delta - delta_c)``, ``P = A K H``; in reduced units load
    ``(3/2) sqrt(delta_c) (2 delta - delta_c) e``, area ``2 delta - delta_c``. Meant for any
    penetration that is small against R.

    Known defects: the mean pressure stays at K H, 0.58 H for nu = 0.3, however plastic a spot is: real area
    and conductance of a metal at a load come out 1.6 to 1.7 times those of the other laws. The load jumps by
    the factor 1.5 at delta_c, from a mean pressure of (2/3) K H to K H; the area is continuous.
    ``bridge = "hermite"`` joins them.

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

    name = "chang-etsion-bogy"
    _fits: ClassVar = (
        Piece(1.0, load=lambda law, u, e: 3 * u * u - 1.5, area=lambda law, u, e: 2 * u * u - 1),
    )

    poisson: float | None = None
    bridge: Literal["hermite"] | None = None


@dataclass(frozen=True, kw_only=True)
class ZhaoMaiettaChang(FromHardness):
    """Zhao, Maietta and Chang (2000): Hertz up to delta_1, fully plastic beyond 54 delta_1.

    Yield begins at the mean pressure k H, k = 0.4: ``delta_1 = (3 pi k H/(4 E*))^2 R``. In between, with
    ``t = (delta - delta_1)/(delta_2 - delta_1)``, the area over pi R delta is ``1 + 3 t^2 - 2 t^3`` and
    the mean pressure over H ``1 - (1 - k) ln(delta_2/delta)/ln(delta_2/delta_1)``; beyond, these are 2
    and 1. Meant for any penetration that is small against R; delta_2 = 54 delta_1 is the
    smallest value that the paper allows, and the one it uses.

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

    name = "zhao-maietta-chang"
    _fits: ClassVar = (
        Piece(1.0, load=_zhao_load, area=_zhao_area),
        Piece(_PLASTIC, load=(2 / _FIRST_YIELD, 1.0), area=(2.0, 1.0)),
    )

    @property
    def yield_factor(self) -> float:
        """K, the greatest contact pressure at the onset of yield over the hardness: 1.5 k."""
        return 1.5 * _FIRST_YIELD


@dataclass(frozen=True, kw_only=True)
class KogutEtsion(FromHardness):
    """Kogut and Etsion (2002): powers of ``x = delta/delta_c``, then the hardness on ``2 pi R delta``.

    ==========  ========================  ========================
    x           load over that at yield   area over that at yield
    ==========  ========================  ========================
    0 to 1      x^1.5                     x
    1 to 6      1.03 x^1.425              0.93 x^1.136
    6 to 110    1.40 x^1.263              0.94 x^1.146
    above 110   3 x/K                     2 x
    ==========  ========================  ========================

    ``delta_c = (pi K H/(2 E*))^2 R`` with ``K = 0.454 + 0.41 nu``. Fitted for x up to 110, frictionless, no
    hardening, E/Y from 100 to 1000.

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
    Source: L. Kogut, I. Etsion, J. Appl. Mech. 69 (2002) 657, and of K W. R. Chang, I. Etsion, D. B. Bogy,
    J. Tribol. 110 (1988) 50. [Load: constants compared with a public script; area, K: mem, recalled.]

    Examples
    --------
    >>> KogutEtsion(critical=0.05).limits(np.array(1.0)).round(12)
    array([0.05, 0.3 , 5.5 ])
    """

    name = "kogut-etsion"
    _fits: ClassVar = (
        Piece(1.0, load=(1.03, 1.425), area=(0.93, 1.136)),
        Piece(6.0, load=(1.40, 1.263), area=(0.94, 1.146)),
        Piece(110.0, load=lambda law, u, e: 3 / law.yield_factor * u * u, area=(2.0, 1.0)),
    )

    poisson: float = 0.3
    bridge: Literal["hermite"] | None = None

    def unloading(self, deepest: Any) -> EtsionKligermanKadin:
        """Return the law of Etsion, Kligerman and Kadin; with a bridge, from the bridged load."""
        return EtsionKligermanKadin(self, deepest)


def _jackson_area(law: Any, u: Any, e: Any) -> Any:
    x = u * u
    with np.errstate(over="ignore"):  # infinite where the fit has no meaning
        return x * (x / 1.9) ** (0.14 * np.exp(23 * law.yield_strain / e))


def _jackson_load(law: Any, u: Any, e: Any) -> Any:
    x = u * u
    at_yield = math.pi * law.yield_factor / 2 * law.yield_strain / e  # radius of contact over R
    radius = at_yield * np.sqrt(_jackson_area(law, u, e))
    hardness = -2.84 * np.expm1(-0.82 * radius**-0.7)  # over the yield strength
    yielded = -np.expm1(-(x ** (5 / 9)) / 25) * x
    return np.exp(-(x ** (5 / 12)) / 4) * u * x + 4 / law.yield_factor * hardness * yielded


@dataclass(frozen=True)
class JacksonGreen(ElasticPlastic):
    """Jackson and Green (2005): Hertz up to 1.9 delta_c, then exponentials with H_G(a/R).

    With ``C = 1.295 exp(0.736 nu)`` and ``e_y = S_y/E*(s)``, ``delta_c = (pi C e_y/2)^2 R``. Beyond
    ``x = delta/delta_c = 1.9`` the area over that at yield is ``x (x/1.9)^B``, ``B = 0.14 exp(23 e_y)``,
    and the load over that at yield ::

        exp(-x^(5/12)/4) x^1.5 + (4 H_G/(C S_y)) (1 - exp(-x^(5/9)/25)) x

    with ``H_G/S_y = 2.84 (1 - exp(-0.82 (a/R)^-0.7))`` at the radius of contact a. On a graded surface
    e_y = yield_strain/e enters delta_c, B and H_G. Fitted for steel-like materials, e_y from about 0.001
    to 0.01 and a/R up to about 0.4, without hardening.

    Known defects: at x = 1.9 the load jumps by 0.47 % (e_y = 0.004), and its slope is .9468 of what it
    was; ``bridge = "hermite"`` joins them. B grows rapidly where the modulus is low: a grading that
    raises e_y above 0.05 is far outside the range of the fit.

    Parameters
    ----------
    yield_strength : float, optional
        S_y of the softer body, Pa. Give it, or `yield_strain` and `critical`.
    poisson : float, optional
        Its Poisson's ratio.
    yield_strain, critical : float, optional
        S_y/E*, and delta_c/sigma of an asperity of modulus E*.
    bridge : {None, "hermite"}, optional
        Whether the jump is bridged, from 1.9 delta_c to 2.85 delta_c.

    Raises
    ------
    ValueError
        If neither or both are given, or a value is out of range.

    Notes
    -----
    Source: R. L. Jackson, I. Green, J. Tribol. 127 (2005) 343 [mem: constants recalled].

    Examples
    --------
    >>> surface = Surface(sigma=1e-6, radius=1e-3, eta=1e9, nominal_area=1e-6, E_star=100e9)
    >>> law = JacksonGreen(yield_strength=400e6, poisson=0.3).on(surface)
    >>> law.yield_strain, round(law.critical, 5)
    (0.004, 0.10296)
    """

    name = "jackson-green"
    of_radius: ClassVar[dict[str, float]] = {"yield_strain": 0.0, "critical": 1.0}
    in_si = "yield_strength", "a yield strength in Pa, or both of the other two"
    _fits: ClassVar = (Piece(1.9, load=_jackson_load, area=_jackson_area),)

    yield_strength: float | None = None
    poisson: float = 0.3
    _: KW_ONLY
    yield_strain: float | None = None
    bridge: Literal["hermite"] | None = None

    @property
    def yield_factor(self) -> float:
        """C, the greatest contact pressure at the onset of yield over the yield strength."""
        return 1.295 * math.exp(0.736 * self.poisson)

    def reduced_on(self, surface: Surface, value: float) -> dict[str, float]:
        """Return S_y over E*, and delta_c of an asperity of modulus E*, over sigma."""
        critical = yields_at(surface, self.yield_factor, value)
        return {"yield_strain": value / surface.E_star, "critical": critical}
