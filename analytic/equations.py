"""The theory as functions of a surface: its means by short names, and the ratios of the paper.

All take ``grading`` (E*(s)/E*, default: homogeneous) and ``heights`` (default: Gaussian); separations h
are reduced, d/sigma from the mean of the summit heights, any shape. Contacts that an elastic law describes
yield at the critical penetration delta_c of `analytic.KogutEtsion`.
"""

import math
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.gradings import Custom, Grading, Homogeneous
from analytic.heights import GAUSSIAN, HeightLaw
from analytic.integrals import quotient
from analytic.laws.elastic_plastic_laws import KogutEtsion
from analytic.model import Model
from analytic.surface import Surface

Weight = Literal["number", "area", "load"]
POISSON = 0.3  # of the body that yields, where nobody gives it


def mean(
    surface: Surface,
    quantity: str,
    h: ArrayLike,
    grading: Grading | None = None,
    *,
    heights: HeightLaw = GAUSSIAN,
) -> Array:
    """Return the mean of a quantity over all surfaces: `Model.mean`, in the shape of `h`."""
    grading = Homogeneous() if grading is None else grading
    return Model(surface, grading=grading, heights=heights).mean(quantity, h)


def load(
    surface: Surface, h: ArrayLike, grading: Grading | None = None, *, heights: HeightLaw = GAUSSIAN
) -> Array:
    """Return load P, N: Eqs. (1b), (3), (5), (6), ``(4/3) A_n eta E* R^(1/2) sigma^(3/2) F*_{3/2}(h)``."""
    return mean(surface, "load", h, grading, heights=heights)


def area(surface: Surface, h: ArrayLike, *, heights: HeightLaw = GAUSSIAN) -> Array:
    """Return the real contact area A, m^2: Eq. (1a), ``pi A_n eta sigma R F_1(h)``, whatever the grading."""
    return mean(surface, "area", h, heights=heights)


def contacts(surface: Surface, h: ArrayLike, *, heights: HeightLaw = GAUSSIAN) -> Array:
    """Return the mean number of asperities in contact, ``A_n eta F_0(h)``."""
    return mean(surface, "contacts", h, heights=heights)


def stiffness(
    surface: Surface, h: ArrayLike, grading: Grading | None = None, *, heights: HeightLaw = GAUSSIAN
) -> Array:
    """Return the normal stiffness K = -dP/dd, N/m, ``2 A_n eta E* (R sigma)^(1/2) F*_{1/2}(h)``.

    What Eqs. (14) and (15) of the paper call conductance is this, up to a factor.
    """
    return mean(surface, "stiffness", h, grading, heights=heights)


def conductance(surface: Surface, h: ArrayLike, *, rho: float = 1.0, heights: HeightLaw = GAUSSIAN) -> Array:
    """Return the conductance of the spots, each 4 a / rho: ``(4/rho) A_n eta (R sigma)^(1/2) F_{1/2}(h)``.

    Barber's analogy holds spot by spot, ``C_i = 2 K_i/(E_i rho) = 4 a_i/rho`` with the spot's own
    modulus E_i, so at a given separation the conductance does not depend on the grading.

    Parameters
    ----------
    rho : float, optional
        Sum of the two resistivities: ohm m gives 1/ohm, m K/W gives W/K; 1 gives C rho in m.
    """
    return mean(surface, "conductance", h, heights=heights) / rho


def barber_conductance(
    surface: Surface,
    h: ArrayLike,
    grading: Grading | None = None,
    *,
    rho: float = 1.0,
    heights: HeightLaw = GAUSSIAN,
) -> Array:
    """Return the paper's conductance, Eq. (14) corrected: stiffness times the factor of a homogeneous body.

    Printed are ``-2 dP/d(d/sigma)``, which is a force, a stray ``1/sqrt(2 pi)`` in line 1, a wrong
    sign in line 2, and ``-8/3 F*_{1/2}`` in line 3 where ``dF*_{3/2}/dh = -(3/2) F*_{1/2}`` gives
    ``+4 F*_{1/2}``. Barber's relation is ``C = 2/(E* rho) |dP/dd|``, with rho as in `conductance`. For a
    graded surface even this is no conductance: it would need a resistivity proportional to 1/E*(s).

    Parameters
    ----------
    surface, h, grading, rho, heights
        As for `mean` and `conductance`.

    Returns
    -------
    ndarray
        ``(4/rho) A_n eta (R sigma)^(1/2) F*_{1/2}(h)``.
    """
    return 2 * stiffness(surface, h, grading, heights=heights) / (surface.E_star * rho)


def area_per_load(
    surface: Surface, h: ArrayLike, grading: Grading | None = None, *, heights: HeightLaw = GAUSSIAN
) -> Array:
    """Return the real area per load A/P, m^2/N: Eq. (10), without a grading Eq. (11).

    ``(3 pi/4) (R/sigma)^(1/2)/E* F_1(h)/F*_{3/2}(h)``, also where both underflow.
    """
    factor = 0.75 * np.pi * np.sqrt(surface.radius / surface.sigma) / surface.E_star
    return np.asarray(factor * quotient(h, (1, None), (1.5, grading), heights))


def area_per_load_ratio(h: ArrayLike, grading: Grading, *, heights: HeightLaw = GAUSSIAN) -> Array:
    """Return A/P of the graded surface over that of the homogeneous one at the same separation, Eq. (12).

    ``F_{3/2}(h)/F*_{3/2}(h)``, in the shape of `h`.
    """
    return quotient(h, (1.5, None), (1.5, grading), heights)


def stiffness_ratio(h: ArrayLike, grading: Grading, *, heights: HeightLaw = GAUSSIAN) -> Array:
    """Return the stiffness of the graded over that of the homogeneous surface at equal separation, Eq. (15).

    The paper calls it the ratio of the conductances; that one is 1 (see `conductance`). At equal
    load even its trend is the opposite: see `analytic.ratio_at_equal_load`.

    ``F*_{1/2}(h)/F_{1/2}(h)``, in the shape of `h`.
    """
    return quotient(h, (0.5, grading), (0.5, None), heights)


def mean_modulus(
    h: ArrayLike, grading: Grading, *, weight: Weight = "load", heights: HeightLaw = GAUSSIAN
) -> Array:
    """Return the mean of E*(s)/E* over the asperities in contact.

    Parameters
    ----------
    weight : {"number", "area", "load"}, optional
        What each contact counts for.

    Returns
    -------
    ndarray
        ``F*_0/F_0``, ``F*_1/F_1``, or the integral of ``(s-h)^{3/2} (E*(s)/E*)^2`` over F*_{3/2}.

    Raises
    ------
    KeyError
        If there is no such weight.

    Examples
    --------
    >>> import analytic
    >>> float(analytic.mean_modulus(0.0, analytic.Exponential(2.0)).round(3))
    1.727
    """
    if weight == "load":
        squared = Custom(lambda s: np.square(grading(s)), grading.breaks, grading.smooth)
        return quotient(h, (1.5, squared), (1.5, grading), heights)
    n = {"number": 0.0, "area": 1.0}[weight]
    return quotient(h, (n, grading), (n, None), heights)


def plasticity_index(modulus: ArrayLike, *, E_star: float, slope: float, hardness: float) -> Array:
    """Return the plasticity index of Sridhar and Yovanovich, ``psi = H_e/H_v``: Eq. (13).

    The paper reads it at the just-touching height, s = d/sigma (its Fig. 4); that is
    ``modulus = grading(h)``. What the load rests on is ``modulus = mean_modulus(h, grading)``: at
    h = 0 and gamma = 2 it is 1.727, not 1. In the order in which the paper lists them, its two
    pressures would give H_v/H_e, the inverse of the index it then uses.

    Parameters
    ----------
    modulus : array_like
        E*(s)/E* at a height, or its mean over the contacts.
    E_star : float
        Composite modulus of the homogeneous surface, Pa.
    slope : float
        Mean absolute slope m of the profiles.
    hardness : float
        Vickers hardness H_v, Pa.

    Returns
    -------
    ndarray
        ``modulus * E* m/(sqrt(2) H_v)``; plastic deformation prevails above 1.
    """
    return np.asarray(np.multiply(modulus, E_star * slope / (np.sqrt(2) * hardness)), dtype=np.float64)


def summit_plasticity_index(surface: Surface, hardness: float, poisson: float = POISSON) -> float:
    """Return the plasticity index of the summits, ``psi = sqrt(sigma/delta_c)``.

    Below about 0.6 hardly any contact yields, above 1 most do, whatever the load.

    Parameters
    ----------
    surface : Surface
        With the radius R and the modulus E*.
    hardness : float
        H of the softer body, Pa.
    poisson : float, optional
        Its Poisson's ratio.

    Raises
    ------
    ValueError
        If a number is out of range.

    Notes
    -----
    Source: J. A. Greenwood, J. B. P. Williamson, Proc. R. Soc. Lond. A 295 (1966) 300, whose
    ``(E*/H) sqrt(sigma/R)`` is this times pi K/2, about 0.9; as here W. R. Chang, I. Etsion, D. B. Bogy,
    J. Tribol. 109 (1987) 257 [mem: recalled].

    Examples
    --------
    >>> steel = Surface(sigma=1e-7, radius=1e-4, eta=1e9, nominal_area=1e-6, E_star=110e9)
    >>> round(summit_plasticity_index(steel, 7e9), 3)
    0.548
    """
    return 1 / math.sqrt(KogutEtsion(hardness=hardness, poisson=poisson).on(surface).reduced("critical"))


def yielding_share(model: Model, h: ArrayLike, hardness: float, poisson: float = POISSON) -> Array:
    """Return the share of the contacts that are past first yield, in the shape of `h`.

    Parameters
    ----------
    model : Model
        The surface, under any law: a contact counts if its penetration exceeds that at which Hertz's contact
        of its own modulus E*(s) and radius yields.
    h : array_like
        Reduced separations; `Model.separation_at` finds that of a load.
    hardness, poisson
        As for `summit_plasticity_index`.

    Returns
    -------
    ndarray
        From 0 to 1; nan where nothing touches.

    Examples
    --------
    >>> import analytic
    >>> surface = Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=80e9)
    >>> model = analytic.Model(surface, heights=analytic.ExponentialHeights())
    >>> float(yielding_share(model, 1.0, 1.2e9).round(6))  # exp(-delta_c/sigma)
    0.998153
    """
    law = KogutEtsion(hardness=hardness, poisson=poisson)
    return np.asarray(1 - replace(model.alone, law=law, unload_from=None, film=None).share(0, h))
