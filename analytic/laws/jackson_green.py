"""Jackson and Green: finite elements with a hardness that falls as the contact grows."""

import math
from dataclasses import KW_ONLY, dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from analytic.laws.bridge import Bridgeable
from analytic.laws.poisson import checked_poisson
from analytic.laws.positive import is_positive
from analytic.surface import Surface

__all__ = ["JacksonGreen"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class JacksonGreen(Bridgeable):
    """Jackson and Green (2005): Hertz up to 1.9 delta_c, then exponentials with H_G(a/R).

    With ``C = 1.295 exp(0.736 nu)`` and ``e_y = S_y/E*(s)``, ``delta_c = (pi C e_y/2)^2 R``. Beyond
    ``x = delta/delta_c = 1.9`` the area over that at yield is ``x (x/1.9)^B``, ``B = 0.14 exp(23 e_y)``,
    and the load over that at yield ::

        exp(-x^(5/12)/4) x^1.5 + (4 H_G/(C S_y)) (1 - exp(-x^(5/9)/25)) x

    with ``H_G/S_y = 2.84 (1 - exp(-0.82 (a/R)^-0.7))`` at the radius of contact a. On a graded surface
    e_y = yield_strain/e enters delta_c, B and H_G. Fitted for steel-like materials, e_y from about 0.001
    to 0.01 and a/R up to about 0.4, without hardening.

    Known defects: at x = 1.9 the load jumps by 0.47 % (e_y = 0.004), and its slope is .9468 of what it
    was; ``bridge = "hermite"`` joins them. B explodes where the modulus is low: a grading that falls
    below e_y = 0.05 leaves the fit by far.

    Parameters
    ----------
    yield_strength : float, optional
        S_y of the softer body, Pa. Give it, or `yield_strain` and `critical`.
    poisson : float, optional
        Its Poisson's ratio.
    yield_strain : float, optional
        S_y/E*.
    critical : float, optional
        delta_c/sigma of an asperity of modulus E*.
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

    name: ClassVar[str] = "jackson-green"
    starts: ClassVar[tuple[float, ...]] = (1.9,)
    powers: ClassVar[tuple[float, float]] = (5 / 12, 5 / 9)

    yield_strength: float | None = None
    poisson: float = 0.3
    _: KW_ONLY
    yield_strain: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        checked_poisson(self.poisson)
        for name in ("yield_strength", "yield_strain"):
            value = getattr(self, name)
            if value is not None and not is_positive(value):
                raise ValueError(f"{name} = {value!r}: give a finite number > 0")
        reduced = (self.yield_strain is not None, self.critical is not None)
        if reduced[0] != reduced[1] or reduced[0] == (self.yield_strength is not None):
            raise ValueError(
                f"yield_strength = {self.yield_strength!r}, yield_strain = {self.yield_strain!r}, "
                f"critical = {self.critical!r}: give a yield strength in Pa, or both of the others"
            )

    @property
    def yield_factor(self) -> float:
        """C, the greatest contact pressure at the onset of yield over the yield strength."""
        return 1.295 * math.exp(0.736 * self.poisson)

    def on(self, surface: Surface) -> Self:
        """The law on this surface, in reduced units: without `yield_strength`."""
        if self.yield_strength is None:
            return self
        strain = self.yield_strength / surface.E_star
        critical = (math.pi * self.yield_factor * strain / 2) ** 2 * surface.radius / surface.sigma
        return replace(self, yield_strength=None, yield_strain=strain, critical=critical)

    def load_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """What is left of Hertz's, and the hardness on what has yielded."""
        left, gone = self.powers
        hardness = self._hardness(x, e) * (-np.expm1(-(x**gone) / 25)) / np.sqrt(x)
        return np.exp(-(x**left) / 4) + 4 / self.yield_factor * hardness

    def area_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """``(x/1.9)^B``."""
        with np.errstate(over="ignore"):  # infinite where the fit has no meaning
            return (x / self.starts[0]) ** (0.14 * np.exp(23 * self._strain(e)))

    def _hardness(self, x: Any, e: Array) -> Any:
        """H_G over the yield strength."""
        with np.errstate(over="ignore"):
            at_yield = math.pi * self.yield_factor / 2 * self._strain(e)  # radius of contact over R
            radius = at_yield * np.sqrt(x * self.area_over_hertz(1, x, e))
            return -2.84 * np.expm1(-0.82 * radius**-0.7)

    def _strain(self, e: Array) -> Array:
        assert self.yield_strain is not None  # `x` has said so
        return np.asarray(self.yield_strain / e)
