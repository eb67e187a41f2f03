"""Gases in the gap of a joint: their conductivity, and the temperature-jump distance at both walls.

At walls of accommodation coefficient a, a gas of mean free path L, ratio of specific heats g and Prandtl's
number Pr has the jump distance ``2 (2 - a)/a 2 g/((g + 1) Pr) L``, in proportion to T/p. Source: M. M.
Yovanovich, J. DeVaal, A. H. Hegazy, AIAA paper 82-0888 (1982); recalled, the paper was not at hand.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

ROOM, ATMOSPHERE = 293.15, 101325.0  # K, Pa
_AT = 288.0  # K, of the mean free paths


@dataclass(frozen=True, slots=True)
class Gas:
    """A gas in the gap.

    Parameters
    ----------
    conductivity : float
        W/(m K).
    jump : float
        Temperature-jump distance of both walls together, m.

    Raises
    ------
    ValueError
        If one is not a finite number > 0.
    """

    conductivity: float
    jump: float

    def __post_init__(self) -> None:
        for key, unit in (("conductivity", "W/(m K)"), ("jump", "m")):
            value = getattr(self, key)
            if not (math.isfinite(value) and value > 0):
                raise ValueError(f"gas.{key} = {value!r}: give a finite number > 0, in {unit}")


@dataclass(frozen=True, slots=True)
class _Kind:
    """Conductivity at T; accommodation at engineering surfaces; specific heats; Pr; mean free path, m."""

    conductivity: Callable[[float], float]
    accommodation: float
    heats: float
    prandtl: float
    path: float


def _power(at_300: float, exponent: float) -> Callable[[float], float]:
    return lambda t: at_300 * math.pow(t / 300, exponent)


def _of_air(t: float) -> float:
    """Sutherland's law of the U.S. Standard Atmosphere (1976)."""
    return 2.64638e-3 * math.pow(t, 1.5) / (t + 245.4 * math.pow(10, -12 / t))


# Conductivities: powers of T through 300 and 400 K of the CRC Handbook of Chemistry and Physics, which from
# 250 to 500 K are off by at most 3 %. Mean free paths: at 288 K and one atmosphere, from viscosities.
# Accommodation: M/(M + 6.8), M the molar mass in g/mol, times 1.4 where molecules have two atoms (S. Song,
# M. M. Yovanovich, 1987; recalled), and the usual value for air.
_KINDS = {
    "air": _Kind(_of_air, 0.87, 1.4, 0.71, 64e-9),
    "argon": _Kind(_power(0.0179, 0.81), 0.85, 5 / 3, 0.67, 66.9e-9),
    "helium": _Kind(_power(0.1567, 0.681), 0.37, 5 / 3, 0.67, 186e-9),
    "hydrogen": _Kind(_power(0.1869, 0.727), 0.29, 1.4, 0.69, 117.5e-9),
    "nitrogen": _Kind(_power(0.026, 0.754), 0.85, 1.4, 0.71, 62.9e-9),
}
GASES = tuple(_KINDS)


def gas_of(name: str, temperature: float = ROOM, pressure: float = ATMOSPHERE) -> Gas:
    """Return a gas between engineering surfaces.

    Parameters
    ----------
    name : {"air", "argon", "helium", "hydrogen", "nitrogen"}
        Which.
    temperature, pressure : float, optional
        K and Pa.

    Returns
    -------
    Gas
        Its conductivity, and its jump distance at two walls.

    Examples
    --------
    >>> gas = gas_of("helium", temperature=300.0)
    >>> gas.conductivity, round(gas.jump, 8)
    (0.1567, 3.18e-06)
    """
    kind = _KINDS[name]
    walls = 2 * (2 - kind.accommodation) / kind.accommodation
    jump = walls * 2 * kind.heats / ((kind.heats + 1) * kind.prandtl) * kind.path
    return Gas(kind.conductivity(temperature), jump * temperature / _AT * ATMOSPHERE / pressure)
