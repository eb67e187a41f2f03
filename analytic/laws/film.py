"""Electrical or thermal contact through spots with a film, and how spots crowd each other."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.arrays import Array
from analytic.laws.law import is_positive
from analytic.surface import Surface


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
        scale = math.pi * self.resistivity * math.sqrt(surface.radius * surface.sigma)
        return SpotConductance(4 * self.film_resistance / scale, self.resistivity)


@dataclass(frozen=True)
class SpotConductance:
    """Conductance of a spot, of its radius: constriction and film in series.

    ``1/C = rho/(4 a) + r_f/(pi a^2)``, so that C over 4 sqrt(R sigma)/rho is ``a^2/(a + b)``.

    Parameters
    ----------
    parameter : float
        Radius over sqrt(R sigma) of a spot whose film and constriction resist alike,
        ``b = 4 r_f/(pi rho sqrt(R sigma))``.
    resistivity : float
        As that of `Film`.

    Notes
    -----
    Source: R. Holm, Electric Contacts (1967). For Sharvin's (or Knudsen's) resistance with the mean free
    path l, add ``16 l/(3 pi sqrt(R sigma))`` to b.
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
        """Conductance over 4 sqrt(R sigma), in 1/(ohm m) or W/(m K), analytic in the radius up to -b."""
        return np.asarray(radius * (radius / (radius + self.parameter))) / self.resistivity


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
