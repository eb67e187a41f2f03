"""Electrical or thermal contact through spots with a film, and how spots crowd each other."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.laws.law import is_positive
from analytic.surface import Surface

__all__ = ["Film", "SpotConductance", "crowding_factor", "film_conductance", "film_parameter"]

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
    Film(resistivity, film_resistance)  # refuses what is no resistance
    return 4 * film_resistance / (math.pi * resistivity * math.sqrt(surface.radius * surface.sigma))


def film_conductance(radius: Array, b: Any) -> Array:
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
    return np.asarray(radius * (radius / (radius + b)))


@dataclass(frozen=True)
class Film:
    """What spots conduct through.

    Parameters
    ----------
    resistivity : float
        Sum of the two bodies' resistivities: ohm m, or m K/W.
    film_resistance : float, optional
        Of a unit area of film: ohm m^2, or m^2 K/W; 0 without a film.

    Raises
    ------
    ValueError
        If one is no finite number, the first one not > 0, or the second one negative.

    Examples
    --------
    A film of 1e-14 ohm m^2 on spots of copper resists as the constriction does at a radius of 0.37 um:

    >>> surface = Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e11)
    >>> film = Film(resistivity=3.4e-8, film_resistance=1e-14)
    >>> round(film.on(surface).parameter * (1e-5 * 1e-6) ** 0.5 * 1e6, 3)
    0.374
    """

    resistivity: float
    film_resistance: float = 0.0

    def __post_init__(self) -> None:
        if not is_positive(self.resistivity):
            raise ValueError(f"resistivity = {self.resistivity!r}: give a finite number > 0, in ohm m")
        if not 0 <= self.film_resistance < math.inf:
            raise ValueError(
                f"film_resistance = {self.film_resistance!r}: give a finite number >= 0, in ohm m^2"
            )

    def on(self, surface: Surface) -> "SpotConductance":
        """In the reduced units of a surface."""
        parameter = film_parameter(
            surface, film_resistance=self.film_resistance, resistivity=self.resistivity
        )
        return SpotConductance(parameter, self.resistivity)


@dataclass(frozen=True)
class SpotConductance:
    """Conductance of a spot, of its radius.

    Parameters
    ----------
    parameter : float
        Radius over sqrt(R sigma) of a spot whose film and constriction resist alike.
    resistivity : float
        As that of `Film`.
    """

    parameter: Any
    resistivity: float

    @property
    def finest(self) -> float:
        """How far above first touch it is analytic: radii that go on to negative ones meet a pole."""
        parameter = float(np.min(self.parameter))
        return parameter**2 if parameter > 0 else math.inf

    def with_radii(self, ratios: Array) -> "SpotConductance":
        """In the units of summits whose radii are these multiples of the surface's."""
        return replace(self, parameter=self.parameter / np.sqrt(ratios))

    def of_some(self, which: NDArray[Any]) -> "SpotConductance":
        """That of some of these summits; as it is where all have one radius."""
        return replace(self, parameter=self.parameter[which]) if np.ndim(self.parameter) else self

    def __call__(self, radius: Array) -> Array:
        """Conductance over 4 sqrt(R sigma): 1/(ohm m), or W/(m K)."""
        return film_conductance(radius, self.parameter) / self.resistivity


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
