"""Electrical and thermal contact conductance of spots with a film, and how spots crowd each other."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, hold
from analytic.laws.law import PerRadius, is_positive
from analytic.surface import Surface

if TYPE_CHECKING:
    from analytic.laws.layer import LayeredSpot


@dataclass(frozen=True)
class Layer:
    """A layer on one body, such as an oxide, a paint or a plating.

    Parameters
    ----------
    thickness : float
        m.
    conductivity : float
        W/(m K).

    Raises
    ------
    ValueError
        If one is not a finite number > 0.

    Examples
    --------
    For spots of 2 um on 10 um of oxide on aluminium, the resistance is nearly that of oxide throughout:

    >>> spot = Layer(10e-6, 1.3).between(200.0, 200.0, 1.0)
    >>> round(float(spot(2e-6)) * 1.3, 3)
    0.92
    """

    thickness: float
    conductivity: float

    def __post_init__(self) -> None:
        for key, unit in (("thickness", "m"), ("conductivity", "W/(m K)")):
            if not is_positive(getattr(self, key)):
                raise ValueError(f"{key} = {getattr(self, key)!r}: give a finite number > 0, in {unit}")

    def between(self, under: float, other: float, unit: float) -> "LayeredSpot":
        """Return spots between the layer, on a body of conductivity `under`, and `other`; radii in `unit`."""
        from analytic.laws.layer import LayeredSpot  # for those scenes alone

        return LayeredSpot(self.thickness / unit, self.conductivity, under, other)


@dataclass(frozen=True)
class Film:
    """What contact spots conduct through: the resistivities or thermal conductivities, and a film or layer.

    Parameters
    ----------
    resistivity : float, optional
        Sum of the two bodies' resistivities, ohm m.
    film_resistance : float, optional
        Resistance of a unit area of a film much thinner than the width of spots, ohm m^2 or m^2 K/W; 0
        without one.
    conductivities : (float, float), optional
        Instead of `resistivity`: thermal conductivities of both bodies, W/(m K).
    layer : Layer, optional
        A layer of any thickness on the first body; it needs `conductivities`.

    Raises
    ------
    ValueError
        If a number is not finite and > 0 (film: >= 0), or not exactly one of
        `resistivity` and `conductivities` is given.

    Examples
    --------
    On copper, a film of 1e-14 ohm m^2 resists as much as the constriction of a spot of radius 0.37 um:

    >>> surface = Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e11)
    >>> film = Film(resistivity=3.4e-8, film_resistance=1e-14)
    >>> round(film.on(surface).parameter * (1e-5 * 1e-6) ** 0.5 * 1e6, 3)
    0.374
    """

    resistivity: float | None = None
    film_resistance: float = 0.0
    conductivities: tuple[float, float] | None = None
    layer: Layer | None = None

    def __post_init__(self) -> None:
        if (self.resistivity is None) == (self.conductivities is None):
            raise ValueError("resistivity: give it in ohm m, or conductivities = (k1, k2) in W/(m K)")
        if self.resistivity is not None and not is_positive(self.resistivity):
            raise ValueError(f"resistivity = {self.resistivity!r}: give a finite number > 0, in ohm m")
        if self.conductivities is not None:
            if len(self.conductivities) != 2 or not all(map(is_positive, self.conductivities)):
                raise ValueError(f"conductivities = {self.conductivities!r}: give two numbers > 0 in W/(m K)")
            hold(self, conductivities=tuple(map(float, self.conductivities)))
        elif self.layer is not None:
            raise ValueError("layer: it needs conductivities = (k1, k2) of the bodies")
        if not 0 <= self.film_resistance < math.inf:
            raise ValueError(
                f"film_resistance = {self.film_resistance!r}: give a finite number >= 0, in ohm m^2"
            )

    @property
    def rho(self) -> float:
        """Sum of both bodies' resistivities, ohm m or m K/W."""
        return self.resistivity or sum(1 / k for k in self.conductivities or ())

    @property
    def thermal(self) -> bool:
        """Whether spots conduct heat, not current."""
        return self.conductivities is not None

    def on(self, surface: Surface) -> "SpotConductance":
        """Return the conductance of spots, in the reduced units of a surface."""
        unit = math.sqrt(surface.radius * surface.sigma)
        layered = None
        if self.layer is not None and self.conductivities is not None:
            layered = self.layer.between(*self.conductivities, unit)
        return SpotConductance(4 * self.film_resistance / (math.pi * self.rho * unit), self.rho, layered)


@dataclass(frozen=True)
class SpotConductance(PerRadius):
    """Conductance of a spot by its radius: constriction, also in a layer, in series with a film.

    ``1/C = rho/(4 a) + r_f/(pi a^2)``, so that C over 4 sqrt(R sigma)/rho is ``a^2/(a + b)``; over a layer
    rho depends on a.

    Parameters
    ----------
    parameter : float
        Radius over sqrt(R sigma) of a spot whose film and constriction resist alike,
        ``b = 4 r_f/(pi rho sqrt(R sigma))``.
    resistivity : float
        rho of `Film`.
    layered : LayeredSpot, optional
        What takes its place over a layer.

    Notes
    -----
    Source: R. Holm, Electric Contacts (1967). For Sharvin's (or Knudsen's) resistance with the mean free
    path l, add ``16 l/(3 pi sqrt(R sigma))`` to b.
    """

    of_radius: ClassVar[tuple[str, float]] = ("parameter", -0.5)

    parameter: Any
    resistivity: float
    layered: "LayeredSpot | None" = None

    @property
    def finest(self) -> float:
        """How far above first touch it is analytic: radii that go on to negative ones meet a pole."""
        parameter = float(np.min(self.parameter))
        if self.layered is not None:
            return self.layered.analytic_up_to(parameter * self.resistivity) ** 2
        return parameter**2 if parameter > 0 else math.inf

    def _with(self, change: Callable[[Any, float], Any]) -> Self:
        layered = None if self.layered is None else self.layered._with(change)
        return replace(super()._with(change), layered=layered)

    def __call__(self, radius: Array) -> Array:
        """Conductance over 4 sqrt(R sigma), in 1/(ohm m) or W/(m K), analytic in the radius up to -b."""
        if self.layered is not None:
            resists = radius * self.layered(radius) + self.parameter * self.resistivity
            return np.asarray(radius * np.divide(radius, resists, where=resists != 0, out=0 * resists))
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
