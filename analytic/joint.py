"""Thermal joints: gap conductance of a gas between the contact spots.

The gap conductance of two rough surfaces at the distance Y of their mean planes, over their rms height, is ::

    h_g = (k_g/rms) I(Y, M),    I = (2 pi)^(-1/2) int_0^inf exp(-(Y - x)^2/2)/(x + M) dx

M being the jump distance of temperature at both walls over the rms height. At walls of accommodation
coefficient a, a gas of mean free path L, ratio of specific heats g and Prandtl's number Pr has the jump
distance ``2 (2 - a)/a 2 g/((g + 1) Pr) L``, in proportion to T/p. Source: M. M. Yovanovich, J. DeVaal, A. H.
Hegazy, AIAA paper 82-0888 (1982); recalled, the paper was not at hand.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, hold
from analytic.nayak import Nayak
from analytic.piecewise import fitted
from analytic.quadrature import panelled
from analytic.surface import SUMMIT_SPREAD, SpectralMoments, Surface, check_positive

ROOM, ATMOSPHERE = 293.15, 101325.0  # K, Pa


@dataclass(frozen=True, slots=True)
class Gas:
    """A gas in the gap; what is no finite number > 0 is a ValueError."""

    conductivity: float  # W/(m K)
    jump: float  # temperature-jump distance of both walls together, m

    def __post_init__(self) -> None:
        check_positive("W/(m K)", **{"gas.conductivity": self.conductivity})
        check_positive("m", **{"gas.jump": self.jump})


def _power(at_300: float, exponent: float) -> Callable[[float], float]:
    return lambda t: at_300 * math.pow(t / 300, exponent)


def _of_air(t: float) -> float:
    """Sutherland's law of the U.S. Standard Atmosphere (1976)."""
    return 2.64638e-3 * math.pow(t, 1.5) / (t + 245.4 * math.pow(10, -12 / t))


# Of each gas the conductivity at T, accommodation, ratio of specific heats, Pr, and mean free path, m.
# Conductivities: powers of T through 300 and 400 K of the CRC Handbook of Chemistry and Physics, which from
# 250 to 500 K are off by at most 3 %. Mean free paths: at 288 K and one atmosphere, from viscosities.
# Accommodation: M/(M + 6.8), M the molar mass in g/mol, times 1.4 where molecules have two atoms (S. Song,
# M. M. Yovanovich, 1987; recalled), and the usual value for air.
_KINDS: dict[str, tuple[Callable[[float], float], float, float, float, float]] = {
    "air": (_of_air, 0.87, 1.4, 0.71, 64e-9),
    "argon": (_power(0.0179, 0.81), 0.85, 5 / 3, 0.67, 66.9e-9),
    "helium": (_power(0.1567, 0.681), 0.37, 5 / 3, 0.67, 186e-9),
    "hydrogen": (_power(0.1869, 0.727), 0.29, 1.4, 0.69, 117.5e-9),
    "nitrogen": (_power(0.026, 0.754), 0.85, 1.4, 0.71, 62.9e-9),
}
GASES = tuple(_KINDS)


@dataclass(frozen=True)
class Joint:
    """Gas in the gap of a thermal joint.

    Parameters
    ----------
    gas : {"air", "argon", "helium", "hydrogen", "nitrogen", "vacuum"}, Gas or mapping
        Gas in the gap, by name or by its conductivity and jump distance.
    rms : float, optional
        Root mean square height of the surface (not of its summits), m, where the scene does not know it.
    temperature, gas_pressure : float, optional
        Of a gas given by name, K and Pa. Default: 293.15 K and 101325 Pa.

    Raises
    ------
    ValueError
        If the gas is another word, or a number is not finite and > 0.

    Examples
    --------
    >>> helium = Joint("helium", temperature=300.0).held
    >>> helium.conductivity, round(helium.jump, 8)
    (0.1567, 3.18e-06)

    >>> import analytic
    >>> surface = analytic.Surface(sigma=0.9e-6, radius=1e-5, eta=1e10, nominal_area=1e-4, E_star=1e11)
    >>> gap = analytic.Joint("air", rms=1e-6).gap(surface, analytic.Gaussian())
    >>> float(gap(2.0).round(-1))  # W/(m^2 K) at d/sigma = 2
    9470.0
    """

    gas: Any
    rms: float | None = None
    temperature: float | None = None
    gas_pressure: float | None = None

    def __post_init__(self) -> None:
        if isinstance(self.gas, Mapping):
            hold(self, gas=Gas(**self.gas))
        if not isinstance(self.gas, Gas) and self.gas not in (*GASES, "vacuum"):
            names = ", ".join(GASES)
            raise ValueError(f"gas = {self.gas!r}: give one of {names}, vacuum, or {{conductivity, jump}}")
        for key, unit in (("rms", "m"), ("temperature", "K"), ("gas_pressure", "Pa")):
            value = getattr(self, key)
            check_positive(unit, **{key: value})
            if key != "rms" and value is not None and self.gas not in GASES:
                raise ValueError(f"{key} = {value!r}: it is only for a gas by name, as air; leave it out")

    @property
    def held(self) -> Gas | None:
        """The gas, one given by name between engineering surfaces; None for a vacuum."""
        if isinstance(self.gas, Gas):
            return self.gas
        if self.gas == "vacuum":
            return None
        conductivity, accommodation, heats, prandtl, path = _KINDS[self.gas]
        t, p = self.temperature or ROOM, self.gas_pressure or ATMOSPHERE
        walls = 2 * (2 - accommodation) / accommodation
        jump = walls * 2 * heats / ((heats + 1) * prandtl) * path
        return Gas(conductivity(t), jump * t / 288 * ATMOSPHERE / p)

    def gap(self, surface: Surface, heights: Any, moments: SpectralMoments | None = None) -> "Gap":
        """Return the gap conductance of a surface.

        Its rms height and the rise of its summits are those of Nayak's heights, or of the joint's `rms` with
        alpha from ``sigma^2 = (1 - .8968/alpha) rms^2``, or of spectral `moments`, in this order.

        Raises
        ------
        ValueError
            If its rms height is not known, not above that of its summits, or given twice.
        """
        gas, sigma, rms = self.held, surface.sigma, self.rms
        if gas is None:
            return Gap(None, sigma, sigma, 0.0)
        if isinstance(heights, Nayak) and rms is not None:
            raise ValueError(f"rms = {rms!r}: it follows from the heights; leave it out")
        if (found := above_surface(surface, heights, moments, rms)) is None:
            raise ValueError("rms: give the root mean square height of the surface (not of its summits), m")
        return Gap(gas, sigma, *found)


def above_surface(
    surface: Surface, heights: Any, moments: SpectralMoments | None = None, rms: float | None = None
) -> tuple[float, float] | None:
    """Return the rms height of the surface, m, and how far above its mean plane that of its summits lies.

    The latter is ``4 sqrt(m0/(pi alpha))/sigma``. By Nayak's heights, a given rms height, or moments, in this
    order; None if none of them tells m0 and alpha.

    Examples
    --------
    >>> import analytic
    >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e10, nominal_area=1e-4, E_star=1e11)
    >>> [round(x, 7) for x in above_surface(surface, analytic.Gaussian(), rms=1.1e-6)]
    [1.1e-06, 1.0920575]
    """
    sigma = surface.sigma
    if isinstance(heights, Nayak):
        return sigma / heights.std, heights.mean / heights.std
    if rms is None:
        return None if moments is None else (math.sqrt(moments.m0), moments.mean_height / sigma)
    if rms <= sigma:
        raise ValueError(
            f"rms = {rms!r}: give more than sigma = {sigma:g} m, which is that of the summits alone"
        )
    alpha = SUMMIT_SPREAD / (1 - (sigma / rms) ** 2)
    return rms, 4 * rms / math.sqrt(math.pi * alpha) / sigma


@dataclass(frozen=True)
class Gap:
    """Gap conductance of a surface, W/(m^2 K), at separations from the mean plane of its summits."""

    gas: Gas | None  # None: a vacuum, which conducts nothing
    sigma: float  # standard deviation of the summits' heights, m
    rms: float  # root mean square height of the surface, m
    rise: float  # height of the mean plane of the summits above that of the surface, over sigma

    def __call__(self, h: ArrayLike) -> Array:
        """At distances of the mean planes over sigma, between deformed surfaces."""
        h = np.asarray(h, dtype=np.float64)
        if self.gas is None:
            return np.zeros(h.shape)
        found = gap_integral((h + self.rise) * self.sigma / self.rms, self.gas.jump / self.rms)
        return self.gas.conductivity / self.rms * found


def gap_integral(y: ArrayLike, m: float) -> Array:
    """I(Y, M) to 1e-13, in the shape of Y."""
    once, back = np.unique(np.asarray(y, dtype=np.float64), return_inverse=True)
    if once.size <= 512:
        found = _integrals(once, m)
    else:  # to 1e-13
        edges = np.linspace(once[0], once[-1], math.ceil((once[-1] - once[0]) / 0.5) + 1)
        found = fitted(partial(_integrals, m=m), edges, 18)(once)
    return np.reshape(found[back], np.shape(y))


def _integrals(y: Array, m: float) -> Array:
    """Each by Gauss-Legendre rules in panels: as fine as M from 0 on, and about Y."""
    near = m * 4.0 ** np.arange(math.ceil(-math.log(m, 4))) if m < 1 else np.empty(0)
    about = np.maximum(y, 0.0) + np.linspace(-10, 10, 5)[:, None]  # standard deviations
    fine = np.maximum(np.append(0.0, near)[:, None], np.maximum(about[0], 0.0))
    x, w = panelled(np.sort(np.append(fine, np.maximum(about, 0.0), axis=0), axis=0))
    return np.asarray((w / (x + m) * np.exp(-((x - y) ** 2) / 2)).sum(axis=0) / math.sqrt(2 * math.pi))
