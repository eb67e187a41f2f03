"""Electrical or thermal contact through spots with a film, and how spots crowd each other."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.surface import Surface

__all__ = ["crowding_factor", "film_conductance", "film_parameter"]

Array = NDArray[np.float64]


def film_parameter(surface: Surface, *, film_resistance: float, resistivity: float) -> float:
    """Radius of a spot at which film and constriction resist alike: ``b = 4 r_f/(pi rho sqrt(R sigma))``.

    Parameters
    ----------
    surface : Surface
        Its R and sigma.
    film_resistance : float
        r_f, of a unit area of film: ohm m^2, or m^2 K/W.
    resistivity : float
        rho, the sum of the two bodies' resistivities: ohm m, or m K/W.

    Returns
    -------
    float
        In units of sqrt(R sigma).

    Raises
    ------
    ValueError
        If a resistance is not a number > 0 (the film's may be 0).
    """
    if not 0 <= film_resistance < math.inf:
        raise ValueError(f"film_resistance = {film_resistance!r}: give a finite number >= 0, in ohm m^2")
    if not 0 < resistivity < math.inf:
        raise ValueError(f"resistivity = {resistivity!r}: give a finite number > 0, in ohm m")
    return 4 * film_resistance / (math.pi * resistivity * math.sqrt(surface.radius * surface.sigma))


def film_conductance(radius: Array, b: float) -> Array:
    """Conductance of a spot over 4 sqrt(R sigma)/rho, ``a^2/(a + b)``.

    In series: ``1/C = rho/(4 a) + r_f/(pi a^2)``.

    Parameters
    ----------
    radius : ndarray
        Radius a of the spot over sqrt(R sigma), not 0; -a and complex numbers go on analytically, up to
        the pole at -b.
    b : float
        As from `film_parameter`; 0 without a film.

    Returns
    -------
    ndarray
        In the shape of `radius`. Where the radius is the root of the penetration, the formula is analytic
        up to a penetration of b^2.

    Notes
    -----
    Source: R. Holm, Electric Contacts (1967). For Sharvin's (or Knudsen's) resistance with the mean free
    path l, add ``16 l/(3 pi sqrt(R sigma))`` to b.
    """
    return radius * (radius / (radius + b))


def crowding_factor(area_fraction: ArrayLike) -> Array:
    """Factor ``psi = (1 - sqrt(A/A_n))^1.5`` by which the conductance of a surface is to be divided.

    It couples the spots through the area of their own surface: for sums over a surface, never for one
    contact.

    Parameters
    ----------
    area_fraction : array_like
        Real over nominal area of each surface, from 0 to below 1.

    Returns
    -------
    ndarray
        In its shape.

    Raises
    ------
    ValueError
        If an area fraction is out of range.

    Notes
    -----
    Source: M. G. Cooper, B. B. Mikic, M. M. Yovanovich, Int. J. Heat Mass Transf. 12 (1969) 279.
    """
    fraction = np.asarray(area_fraction, dtype=np.float64)
    if not np.all((fraction >= 0) & (fraction < 1)):
        worst = float(fraction.flat[int(np.argmax(np.abs(fraction - 0.5)))])
        raise ValueError(f"area_fraction = {worst:g}: real over nominal area must be from 0 to below 1")
    return np.asarray((1 - np.sqrt(fraction)) ** 1.5)
