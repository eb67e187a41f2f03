"""Tangential contact by the theorem of Ciavarella and Jaeger: a difference of two normal loads."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, hold
from analytic.laws.law import check_poisson
from analytic.surface import Surface


@dataclass(frozen=True)
class Tangential:
    """Tangential loading of a surface that is pressed on first, with partial slip.

    Each contact slips from its rim inwards (Cattaneo, Mindlin), and under elastic half-spaces of one
    Poisson's ratio its tangential load is friction times the difference of two normal loads, at its own
    penetration and at one that is less by ``c u/friction``, with ``c = 2 (1 - nu)/(2 - nu)``. That shift is
    the same for all contacts, so for the surface

    ``T(u) = friction [P(d) - P(d + c u/friction)]``.

    It holds for Hertz's law and for the graded half-space, but not where asperities yield or are coated. It
    is exact for a graded E*(s) if Poisson's ratio is the same everywhere.

    Parameters
    ----------
    friction : float
        Coefficient of friction.
    poisson : float
        Poisson's ratio of both bodies.
    displacements : array_like
        Tangential displacements u >= 0, m.

    Raises
    ------
    ValueError
        If a value is out of range, or no displacement is given.

    Notes
    -----
    Source: J. Jaeger, Arch. Appl. Mech. 65 (1995) 478; M. Ciavarella, Int. J. Solids Struct. 35 (1998)
    2349 [mem].

    Examples
    --------
    >>> surface = Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
    >>> pushed = Tangential(friction=0.3, poisson=0.3, displacements=[0.0, 1e-7])
    >>> pushed.shifts(surface).round(4)
    array([0.    , 0.2745])
    """

    friction: float
    poisson: float
    displacements: tuple[float, ...]

    def __init__(self, friction: float, poisson: float, displacements: ArrayLike) -> None:
        places = tuple(np.ravel(displacements).astype(np.float64).tolist())
        hold(self, friction=friction, poisson=poisson, displacements=places)
        if not 0 < friction < math.inf:
            raise ValueError(f"friction = {friction!r}: give a coefficient of friction > 0")
        check_poisson(poisson)
        if not self.displacements:
            raise ValueError("displacements = []: give at least one, in m")
        wrong = [u for u in self.displacements if not 0 <= u < math.inf]
        if wrong:
            raise ValueError(f"displacements: {wrong[0]!r} is not a displacement; give numbers >= 0, in m")

    @property
    def ratio(self) -> float:
        """Tangential over normal stiffness of a contact that does not slip (Mindlin)."""
        return 2 * (1 - self.poisson) / (2 - self.poisson)

    def shifts(self, surface: Surface) -> Array:
        """Shift of the separation to that of the second normal load, d/sigma, shape (displacements,)."""
        return self.ratio * np.array(self.displacements) / (self.friction * surface.sigma)

    def load(self, load: Array, shifted: Array) -> Array:
        """Tangential loads from the normal load and the normal loads at the shifted separations."""
        return np.asarray(self.friction * (load - shifted))


def masing(virgin: ArrayLike) -> Array:
    """Tangential load on unloading from the last displacement, by Masing's rule.

    Parameters
    ----------
    virgin : array_like
        Tangential loads of a surface that is pushed for the first time, at equal steps of the
        displacement, 0 to the last one; shape (..., 2 n + 1).

    Returns
    -------
    ndarray
        ``T(u_m) - 2 T((u_m - u)/2)`` at the displacements ``u_m - 2 k u_m/(2 n)``, k = 0 ... 2 n, from u_m
        down to -u_m: shape (..., 2 n + 1).

    Examples
    --------
    >>> masing([0.0, 3.0, 5.0])
    array([ 5., -1., -5.])
    """
    loads = np.asarray(virgin, dtype=np.float64)
    return np.asarray(loads[..., -1:] - 2 * loads)
