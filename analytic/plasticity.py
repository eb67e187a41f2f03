"""Plasticity index of a graded surface, at a height and averaged over the contacts (Eq. 13)."""

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.gradings import Grading, Squared
from analytic.heights import GAUSSIAN, HeightLaw
from analytic.integrals import quotient

__all__ = ["mean_modulus", "plasticity_index"]

Array = NDArray[np.float64]


def mean_modulus(
    h: ArrayLike,
    grading: Grading,
    *,
    weight: Literal["number", "area", "load"] = "load",
    heights: HeightLaw = GAUSSIAN,
) -> Array:
    """Mean of E*(s)/E* over the asperities in contact.

    Parameters
    ----------
    h : array_like
        Reduced separations d/sigma.
    grading : Grading
        E*(s)/E*.
    weight : {"number", "area", "load"}, optional
        What each contact counts for.
    heights : HeightLaw, optional
        Law of the heights.

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
        return quotient(h, (1.5, Squared(grading)), (1.5, grading), heights)
    n = {"number": 0.0, "area": 1.0}[weight]
    return quotient(h, (n, grading), (n, None), heights)


def plasticity_index(modulus: ArrayLike, *, E_star: float, slope: float, hardness: float) -> Array:
    """Plasticity index of Sridhar and Yovanovich, ``psi = H_e/H_v``: Eq. (13).

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
