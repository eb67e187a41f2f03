"""Mean load, area, stiffness, contacts and conductance of a graded rough surface (Eqs. 1-6, 10-15)."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.gradings import Grading
from analytic.heights import HeightLaw
from analytic.integrals import fn, fn_scaled
from analytic.quantities import QUANTITIES
from analytic.surface import Surface

__all__ = [
    "area",
    "area_per_load",
    "area_per_load_ratio",
    "barber_conductance",
    "conductance",
    "contacts",
    "load",
    "mean",
    "stiffness",
    "stiffness_ratio",
]

Array = NDArray[np.float64]


def mean(
    surface: Surface,
    quantity: str,
    h: ArrayLike,
    grading: Grading | None = None,
    *,
    law: HeightLaw | None = None,
) -> Array:
    """Mean of a quantity over all surfaces, at given separations.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    quantity : {"load", "area", "stiffness", "contacts", "conductance"}
        What is summed over the asperities.
    h : array_like
        Reduced separations d/sigma, any shape.
    grading : Grading, optional
        E*(s)/E*; left out: homogeneous.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        ``eta A_n scale F*_n(h)`` in the unit of the quantity, in the shape of `h`.

    Raises
    ------
    KeyError
        If there is no such quantity.
    """
    q = QUANTITIES[quantity]
    return (
        surface.n_asperities * q.scale(surface) * fn(q.exponent, h, grading if q.modulus else None, law=law)
    )


def load(
    surface: Surface, h: ArrayLike, grading: Grading | None = None, *, law: HeightLaw | None = None
) -> Array:
    """Normal load P, N: Eqs. (1b), (3), (5), (6).

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    h : array_like
        Reduced separations d/sigma, from the mean of the summit heights.
    grading : Grading, optional
        E*(s)/E*; left out: homogeneous.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        ``(4/3) A_n eta E* R^(1/2) sigma^(3/2) F*_{3/2}(h)``.
    """
    return mean(surface, "load", h, grading, law=law)


def area(surface: Surface, h: ArrayLike, *, law: HeightLaw | None = None) -> Array:
    """Real contact area A, m^2: Eq. (1a). The grading does not enter.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    h : array_like
        Reduced separations d/sigma.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        ``pi A_n eta sigma R F_1(h)``.
    """
    return mean(surface, "area", h, law=law)


def contacts(surface: Surface, h: ArrayLike, *, law: HeightLaw | None = None) -> Array:
    """Mean number of asperities in contact.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    h : array_like
        Reduced separations d/sigma.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        ``A_n eta F_0(h)``.
    """
    return mean(surface, "contacts", h, law=law)


def stiffness(
    surface: Surface, h: ArrayLike, grading: Grading | None = None, *, law: HeightLaw | None = None
) -> Array:
    """Normal stiffness K = -dP/dd, N/m.

    What Eqs. (14) and (15) of the paper call conductance is this, up to a factor.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    h : array_like
        Reduced separations d/sigma.
    grading : Grading, optional
        E*(s)/E*; left out: homogeneous.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        ``2 A_n eta E* (R sigma)^(1/2) F*_{1/2}(h)``.
    """
    return mean(surface, "stiffness", h, grading, law=law)


def conductance(surface: Surface, h: ArrayLike, *, rho: float = 1.0, law: HeightLaw | None = None) -> Array:
    """Contact conductance of the spots, each 4 a / rho.

    Barber's analogy holds spot by spot, ``C_i = 2 K_i/(E_i rho) = 4 a_i/rho`` with the spot's own
    modulus E_i, so at a given separation the conductance does not depend on the grading.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    h : array_like
        Reduced separations d/sigma.
    rho : float, optional
        Sum of the two resistivities: ohm m gives 1/ohm, m K/W gives W/K; 1 gives C rho in m.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        ``(4/rho) A_n eta (R sigma)^(1/2) F_{1/2}(h)``.
    """
    return mean(surface, "conductance", h, law=law) / rho


def barber_conductance(
    surface: Surface,
    h: ArrayLike,
    grading: Grading | None = None,
    *,
    rho: float = 1.0,
    law: HeightLaw | None = None,
) -> Array:
    """The paper's conductance, Eq. (14) corrected: the stiffness with the factor of a homogeneous body.

    Printed are ``-2 dP/d(d/sigma)``, which is a force, a stray ``1/sqrt(2 pi)`` in line 1, a wrong
    sign in line 2, and ``-8/3 F*_{1/2}`` in line 3 where ``dF*_{3/2}/dh = -(3/2) F*_{1/2}`` gives
    ``+4 F*_{1/2}``. Barber's relation is ``C = 2/(E* rho) |dP/dd|``. For a graded surface even this is
    no conductance (see `conductance`): it would need a resistivity proportional to 1/E*(s).

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    h : array_like
        Reduced separations d/sigma.
    grading : Grading, optional
        E*(s)/E*; left out: homogeneous.
    rho : float, optional
        Sum of the two resistivities, as in `conductance`.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        ``(4/rho) A_n eta (R sigma)^(1/2) F*_{1/2}(h)``.
    """
    return 2 * stiffness(surface, h, grading, law=law) / (surface.E_star * rho)


def area_per_load(
    surface: Surface, h: ArrayLike, grading: Grading | None = None, *, law: HeightLaw | None = None
) -> Array:
    """Real area per load A/P, m^2/N: Eq. (10), without a grading Eq. (11).

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    h : array_like
        Reduced separations d/sigma.
    grading : Grading, optional
        E*(s)/E*; left out: homogeneous.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        ``(3 pi/4) (R/sigma)^(1/2)/E* F_1(h)/F*_{3/2}(h)``, also where both underflow.
    """
    factor = 0.75 * np.pi * np.sqrt(surface.radius / surface.sigma) / surface.E_star
    return np.asarray(factor * fn_scaled(1, h, law=law) / fn_scaled(1.5, h, grading, law=law))


def area_per_load_ratio(h: ArrayLike, grading: Grading, *, law: HeightLaw | None = None) -> Array:
    """A/P of the graded surface relative to the homogeneous one at the same separation, Eq. (12).

    Parameters
    ----------
    h : array_like
        Reduced separations d/sigma.
    grading : Grading
        E*(s)/E*.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        ``F_{3/2}(h)/F*_{3/2}(h)``.
    """
    return fn_scaled(1.5, h, law=law) / fn_scaled(1.5, h, grading, law=law)


def stiffness_ratio(h: ArrayLike, grading: Grading, *, law: HeightLaw | None = None) -> Array:
    """Stiffness of the graded surface relative to the homogeneous one at the same separation, Eq. (15).

    The paper calls it the ratio of the conductances; that one is 1 (see `conductance`). At equal
    load even its trend is the opposite: see `analytic.ratio_at_equal_load`.

    Parameters
    ----------
    h : array_like
        Reduced separations d/sigma.
    grading : Grading
        E*(s)/E*.
    law : HeightLaw, optional
        Law of the heights; left out: Gaussian.

    Returns
    -------
    ndarray
        ``F*_{1/2}(h)/F_{1/2}(h)``.
    """
    return fn_scaled(0.5, h, grading, law=law) / fn_scaled(0.5, h, law=law)
