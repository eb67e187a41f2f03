"""Electrical and thermal contact conductance of spots with a film, and how spots crowd each other."""

import math
from copy import copy
from dataclasses import dataclass, field
from functools import lru_cache
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, hold
from analytic.surface import Surface, check_positive

_ALTERNATING = 24  # terms of an alternating sum, whose error is 5.8 to that power


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

    >>> oxide = Layer(10e-6, 1.3)
    >>> spot = layered_resistivity(2e-6, oxide.thickness, oxide.conductivity, under=200.0, other=200.0)
    >>> round(float(spot) * oxide.conductivity, 3)
    0.92
    """

    thickness: float
    conductivity: float

    def __post_init__(self) -> None:
        check_positive("m", thickness=self.thickness)
        check_positive("W/(m K)", conductivity=self.conductivity)


@dataclass(frozen=True)
class Film:
    """What contact spots conduct through: the resistivities or thermal conductivities, and a film or layer.

    A spot of radius a constricts the flow, in series with a film: ``1/C = rho/(4 a) + r_f/(pi a^2)``, so that
    C over 4 sqrt(R sigma)/rho is ``a^2/(a + b)``; over a layer rho depends on a. For Sharvin's (or Knudsen's)
    resistance with the mean free path l, add ``16 l/(3 pi)`` to b.

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

    Notes
    -----
    Source: R. Holm, Electric Contacts (1967).

    Examples
    --------
    On copper, a film of 1e-14 ohm m^2 resists as much as the constriction of a spot of radius 0.37 um:

    >>> film = Film(resistivity=3.4e-8, film_resistance=1e-14)
    >>> round(film.alike * 1e6, 3)
    0.374
    """

    resistivity: float | None = None
    film_resistance: float = 0.0
    conductivities: tuple[float, float] | None = None
    layer: Layer | None = None
    unit: Any = field(default=None, init=False, repr=False)  # sqrt(R sigma) of its surface, m

    def __post_init__(self) -> None:
        if (self.resistivity is None) == (self.conductivities is None):
            raise ValueError("resistivity: give it in ohm m, or conductivities = (k1, k2) in W/(m K)")
        check_positive("ohm m", resistivity=self.resistivity)
        if self.conductivities is not None:
            given: tuple[Any, ...] = self.conductivities
            if len(given) != 2 or not all(isinstance(k, Real) and 0 < float(k) < math.inf for k in given):
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

    @property
    def alike(self) -> float:
        """Radius of a spot whose film and constriction resist alike, m: ``b = 4 r_f/(pi rho)``."""
        return 4 * self.film_resistance / (math.pi * self.rho)

    def on(self, surface: Surface) -> "Film":
        """Return it on this surface, for spots in reduced units."""
        reduced = copy(self)
        hold(reduced, unit=math.sqrt(surface.radius * surface.sigma))
        return reduced

    def conductance(self, radius: Array, ratios: Array | None = None) -> Array:
        """Return that of a spot over 4 sqrt(R sigma), R of its own summit by `ratios`: analytic to -b."""
        a = radius * (self.unit if ratios is None else self.unit * np.sqrt(ratios))
        resists = self._resists(a) + self.alike * self.rho
        return np.asarray(radius * np.divide(a, resists, where=resists != 0, out=np.zeros_like(resists)))

    def _resists(self, a: Array) -> Array:
        """Return what takes the place of rho, times the radius."""
        if self.layer is None or self.conductivities is None:
            return a * self.rho
        return a * layered_resistivity(a, self.layer.thickness, self.layer.conductivity, *self.conductivities)


def layered_resistivity(
    radius: Any, thickness: Any, conductivity: float, under: float, other: float
) -> Array:
    """Return what takes the place of both bodies' resistivities under a spot on a layer, of its radius.

    ``rho(a) = 4 a R_1(a) + 1/k_other``. With the flux of an isothermal spot, as ``1/sqrt(1 - r^2/a^2)``, over
    a layer of thickness t and conductivity k on a half-space the mean temperature gives ::

        4 k a R_1 = 1 + (8/pi) sum_n K^n G(2 n t/a),    K = (k - k_under)/(k + k_under)
        G(p) = int_0^inf exp(-p x) sin(x) J_1(x)/x^2 dx = Im [s (s - sqrt(1 + s^2)) - asinh s]/2,  s = p - i

    Thin layers of little conductivity add ``t/(pi k a^2)`` to the half-space, thick ones are a half-space.
    In m K/W; radii may be negative, and a small step into the complex plane gives the derivative.
    """
    radius, thickness = np.broadcast_arrays(radius, thickness)
    side = np.where(np.real(radius) < 0, -1.0, 1.0)
    smallest = 1e-100 * thickness
    over = 2 * thickness / np.where(np.abs(radius) > smallest, side * radius, smallest)
    series = _images((conductivity - under) / (conductivity + under))
    images = sum((weight * _image(n * over) for n, weight in series), np.zeros_like(over))
    return np.asarray((1 + side * (8 / math.pi) * images) / conductivity + 1 / other)


def _image(p: Any) -> Any:
    """G of what an image of the spot adds, to first order in the imaginary part of p, a small step."""
    s = np.real(p) - 1j
    half = s + np.sqrt(1 + s * s)
    value = -(s / half + np.arcsinh(s)).imag / 2
    return value - 1j * np.imag(p) * (1 / half).imag if np.iscomplexobj(p) else value


@lru_cache(64)
def _images(ratio: float) -> tuple[tuple[int, float], ...]:
    """Images and their weights, whose sum is that of all ``ratio^n``.

    By the transformation of van Wijngaarden into an alternating sum, and the acceleration of H. Cohen,
    F. Rodriguez Villegas, D. Zagier, Exp. Math. 9 (2000) 3, algorithm 1.
    """
    size, found = abs(ratio), dict[int, float]()
    total = ((3 + math.sqrt(8)) ** _ALTERNATING + (3 - math.sqrt(8)) ** _ALTERNATING) / 2
    b, c, m = -1.0, -total, _ALTERNATING
    for k in range(m):
        c = b - c
        b *= (k + m) * (k - m) / ((k + 0.5) * (k + 1))
        n, times = k + 1, 1.0
        while (weight := times * size**n) > 1e-18:
            found[n] = found.get(n, 0.0) + (c / total) * weight * (1.0 if ratio > 0 else -1.0)
            if ratio < 0:
                break
            n, times = 2 * n, 2 * times
    return tuple(found.items())


def crowding_factor(area_fraction: ArrayLike) -> Array:
    """Return ``psi = (1 - sqrt(A/A_n))^1.5``, by which the conductance of a surface is to be divided.

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
