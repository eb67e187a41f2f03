"""Systems of units that finite-element models are written in."""

from dataclasses import dataclass

__all__ = ["UNIT_SYSTEMS", "UnitSystem"]


@dataclass(frozen=True)
class UnitSystem:
    """Factors from SI, and names.

    Parameters
    ----------
    length, pressure, stiffness, conductance : tuple of (float, str)
        What a value in m, Pa, Pa/m and W/(m^2 K), or S/m^2, is multiplied by, and the unit it is in then.
    """

    length: tuple[float, str]
    pressure: tuple[float, str]
    stiffness: tuple[float, str]
    conductance: tuple[float, str]


# Of mm, N and s the unit of power is N mm/s = mW, so that 1 W/(m^2 K) = 1e3 mW / (1e6 mm^2 K). With volts
# that of currents is mW/V = mA.
UNIT_SYSTEMS = {
    "SI": UnitSystem((1.0, "m"), (1.0, "Pa"), (1.0, "Pa/m"), (1.0, "W/(m^2 K), or S/m^2")),
    "mm-N-s": UnitSystem((1e3, "mm"), (1e-6, "MPa"), (1e-9, "MPa/mm"), (1e-3, "mW/(mm^2 K), or mA/(mm^2 V)")),
}
