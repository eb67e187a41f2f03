"""Adhesive elastic contacts: Derjaguin, Muller and Toporov (DMT), and Johnson, Kendall and Roberts (JKR)."""

import math
from copy import copy
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from analytic.arrays import Array, hold
from analytic.laws.law import ContactLaw
from analytic.surface import Surface


@dataclass(frozen=True, kw_only=True)
class _Adhesive(ContactLaw):
    """A law with a work of adhesion, or D, the stretch of an asperity of modulus E* that breaks it off."""

    of_radius: ClassVar[dict[str, float]] = {"pull_off": 1 / 3}
    in_si = "work", "one of them, a work of adhesion in J/m^2 or a stretch over sigma"

    work: float | None = None
    pull_off: float | None = None

    def reduced_on(self, surface: Surface, value: float) -> dict[str, float]:
        """Return D, over sigma."""
        stretch: float = 0.75 * (math.pi**2 * value**2 * surface.radius / surface.E_star**2) ** (1 / 3)
        return {"pull_off": stretch / surface.sigma}


@dataclass(frozen=True, kw_only=True)
class DerjaguinMullerToporov(_Adhesive):
    """Derjaguin, Muller and Toporov (DMT): Hertz's contact, pulled by ``2 pi w R`` while it touches.

    For small, stiff asperities and weak adhesion (Tabor's parameter below 0.1). The attraction of asperities
    that do not touch is neglected, so the load jumps at first touch.

    Parameters
    ----------
    work : float, optional
        Work of adhesion w, J/m^2.
    pull_off : float, optional
        As of `JohnsonKendallRoberts`. Give it, or `work`.

    Raises
    ------
    ValueError
        If not exactly one of them is given, or it is not a finite number > 0.

    Notes
    -----
    Source: B. V. Derjaguin, V. M. Muller, Y. P. Toporov, J. Colloid Interface Sci. 53 (1975) 314 [mem].

    Examples
    --------
    >>> law = DerjaguinMullerToporov(pull_off=0.05)
    >>> float(law.load(0, np.sqrt(0.5), np.array(1.0)).round(6))
    0.327734
    """

    name = "derjaguin-muller-toporov"

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Return Hertz's load minus a constant: adhesion does not depend on the modulus."""
        return super().load(piece, y, e) - 12 * (self.reduced("pull_off") / 3) ** 1.5


@dataclass(frozen=True, kw_only=True)
class JohnsonKendallRoberts(_Adhesive):
    """Johnson, Kendall and Roberts (JKR): contacts that snap in, adhere, and break off under tension.

    With z, the square root of the contact radius over that at break-off, and D_e = D/e^(2/3) ::

        delta = (D_e/3) (z^4 - 4 z)        p = e (D_e/3)^1.5 (z^6 - 6 z^3)        radius = sqrt(D_e/3) z^2

    A contact forms at delta = 0, where z^3 = 4 and the load jumps to ``-(4/3) pi w R``, and breaks off at
    delta = -D_e, z = 1, with ``-(5/6) pi w R``. The load is not monotone: at one load there can be several
    separations. For large, soft asperities (Tabor's parameter above 5).

    On unloading, the stiffness of a contact tends to -infinity where it breaks off. Its mean exists but its
    variance does not, so it is refused.

    Parameters
    ----------
    work : float, optional
        Work of adhesion w, J/m^2.
    pull_off : float, optional
        ``D = (3/4) (pi^2 w^2 R/E*^2)^(1/3)/sigma``, how far an asperity of modulus E* is stretched before it
        breaks off under a given displacement. Give it, or `work`.

    Raises
    ------
    ValueError
        If not exactly one of them is given, or it is not a finite number > 0.

    Notes
    -----
    Source: K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301 [mem]. Over Gaussian
    heights it is the model of K. N. G. Fuller, D. Tabor, Proc. R. Soc. A 345 (1975) 327.

    Examples
    --------
    >>> law = JohnsonKendallRoberts(pull_off=0.5)
    >>> law.load(0, np.array([0.0, 1.0]), np.ones(2)).round(6)
    array([-0.544331,  0.542015])
    """

    name = "johnson-kendall-roberts"
    elastic = False
    stiff = False
    pulled: ClassVar[bool] = False  # true of the law of contacts that formed and are pulled

    def stretch(self, e: Array) -> Array:
        """Return D_e, in the shape of `e`; infinite without stiffness."""
        with np.errstate(divide="ignore"):
            return np.asarray(self.reduced("pull_off") * np.asarray(e, dtype=np.float64) ** (-2 / 3))

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Return the load of a contact, in the shape of `y` and `e`."""
        z = self._z(y, e)
        return e * (self.stretch(e) / 3) ** 1.5 * (z**6 - 6 * z**3)

    def radius(self, piece: int, y: Any, e: Array) -> Any:
        """Return the radius of a contact; its square is the area over pi R sigma."""
        z = self._z(y, e)
        return np.sqrt(self.stretch(e) / 3) * z * z

    def stiffness(self, piece: int, y: Array, e: Array) -> Array:
        """Return the stiffness of a spot over 2 E* sqrt(R sigma): ``dP/d delta``."""
        z = self._z(y, e)
        return np.asarray(e * np.sqrt(self.stretch(e) / 3) * z * z * (z**3 - 3) / (z**3 - 1))

    def unloading(self, deepest: Any) -> Self:
        """Return the law by which a contact holds until it is stretched by D_e: ``y = sqrt(delta + D_e)``."""
        pulled = copy(self)
        hold(pulled, pulled=True)
        return pulled

    def left(self, above: Array, e: Array) -> Any:
        """Return the penetration left until contact is lost."""
        return above + self.stretch(e) if self.pulled else above

    def _z(self, y: Any, e: Array) -> Any:
        q = y * np.sqrt(3 / self.stretch(e))
        return _root(q if self.pulled else np.sqrt(3 + q * q))


def _root(q: Any) -> Any:
    """Root z of ``z^4 - 4 z = q^2 - 3`` by Ferrari: the larger one, or for q < 0 the smaller one."""
    p = q * q / 3  # ``m^3 + (q^2 - 3) m = 2`` by Cardano, no terms of which cancel
    t = (1 + np.sqrt(3 * p * (1 - p + p * p / 3))) ** (1 / 3)
    m = 2 / (t * t + (p - 1) + ((p - 1) / t) ** 2)
    return np.sqrt(m / 2) + q / (2 * (m + 1)) * np.sqrt((m * m + 2 * m + 4) / (np.sqrt(2 / m) + m / 2))
