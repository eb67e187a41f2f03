"""What values a rough surface has, so that a number in another unit is asked about."""

from dataclasses import dataclass

from mcgw.formats.units import parse
from mcgw.scene.scene import Scene
from mcgw.scene.surface import SURFACE_UNITS

__all__ = ["RANGES", "perhaps_other_units"]


@dataclass(frozen=True)
class Range:
    """Values that need no question, SI, why others do, and the units that were perhaps meant."""

    low: float
    high: float
    below: str
    above: str
    units: tuple[str, ...]


# Wide: from atoms to faults in rock, from gels to diamond.
RANGES = {
    "sigma": Range(
        1e-10, 1e-3, "is less than an atom", "is higher than the summits of any ground surface", ("um", "nm")
    ),
    "radius": Range(1e-10, 0.1, "is less than an atom", "is not a radius of a summit", ("um", "mm")),
    "eta": Range(
        1e4, 1e19, "is less than a summit a square centimetre", "is more than a summit an atom", ("/mm^2",)
    ),
    "nominal_area": Range(
        1e-17, 10.0, "is less than a hundred atoms", "is larger than two bodies in contact", ("mm^2", "um^2")
    ),
    "E_star": Range(1e3, 2e12, "is softer than any gel", "is stiffer than diamond", ("GPa", "MPa")),
}
_HARDLY_APART = 1e-3  # d/sigma: separations that all lie so close to 0 are lengths


def perhaps_other_units(scene: Scene) -> list[str]:
    """Values that are perhaps given in another unit, a line each with what was perhaps meant."""
    found = []
    for key, known in RANGES.items():
        value = float(getattr(scene.surface, key))
        if not known.low <= value <= known.high:
            unit = SURFACE_UNITS[key]
            why = known.below if value < known.low else known.above
            found.append(f"surface.{key} = {value:g}: {value:g} {unit} {why}; {_meant(value, known, unit)}")
    farthest = max(scene.separations, key=abs)
    if 0 < abs(farthest) < _HARDLY_APART:
        found.append(
            f"contact.separations: {farthest:g} sigma is hardly apart from 0; did you mean {farthest:g} m = "
            f"{farthest / scene.surface.sigma:.4g} sigma? Separations are d/sigma"
        )
    return found


def _meant(value: float, known: Range, si: str) -> str:
    for unit in known.units:
        meant = f"{value:g}{unit}" if unit[0] == "/" else f"{value:g} {unit}"
        if known.low <= parse(meant, si) <= known.high:
            return f"did you mean {meant} = {parse(meant, si):g}?"
    return f"did you mean {si}?"
