"""What values a rough surface has, so that a number in another unit is asked about."""

import warnings
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from analytic import Surface, Table
from mcgw.formats.units import parse
from mcgw.scene.keys import SURFACE_UNITS

if TYPE_CHECKING:
    from mcgw.scene.fields import Fields


# Values that need no question, what others are, and units that were perhaps meant. Wide: from atoms to faults
# in rock, from gels to diamond.
RANGES = {
    "sigma": (1e-10, 1e-3, "less than an atom", "higher than the summits of any ground surface", "um nm"),
    "radius": (1e-10, 0.1, "less than an atom", "too large for the radius of a summit", "um mm"),
    "eta": (1e4, 1e19, "less than one summit per square centimetre", "more than one per atom", "/mm^2"),
    "nominal_area": (1e-17, 10.0, "less than a hundred atoms", "larger than any contact", "mm^2 um^2"),
    "E_star": (1e3, 2e12, "softer than any gel", "stiffer than diamond", "GPa MPa"),
}
_HARDLY_APART = 1e-3  # d/sigma: separations that all lie so close to 0 are lengths
_A_CONTACT = 4.4e-9  # s: drawing 1e10 asperities, half of which touch, took 22 s


def warn_of_units(doubts: Iterable[str]) -> None:
    """Ask a caller in Python, once for each text; commands tell them as notes."""
    for line in doubts:
        warnings.warn(line, UserWarning, stacklevel=1)


def perhaps_other_units(scene: "Fields") -> list[str]:
    """Values that are perhaps in another unit, each with what was perhaps meant."""
    found = surface_in_other_units(scene.surface)
    farthest = max(scene.separations, key=abs)
    if 0 < abs(farthest) < _HARDLY_APART:
        found.append(
            f"contact.separations: {farthest:g} sigma is almost 0; did you mean {farthest:g} m = "
            f"{farthest / scene.surface.sigma:.4g} sigma? Separations are d/sigma"
        )
    if isinstance(scene.grading, Table):
        from mcgw.scene.moduli import doubts_of_table  # for those scenes alone

        found += doubts_of_table(scene.grading, scene)
    return found


def takes_hours(scene: "Fields") -> Iterator[str]:
    """Return a line if `auto` would draw the scene for more than an hour, and the remedy."""
    if scene.sampler != "auto" or scene.accuracy or scene.rel_err is not None or scene.max_seconds:
        return
    touching = scene.n_asperities * float(scene.heights.sf(np.array(min(scene.separations))))
    hours = touching * scene.n_surfaces * _A_CONTACT / 3600
    if hours >= 1:
        yield (
            f"ensemble: {scene.n_surfaces:g} surfaces, each of {touching:.3g} asperities that touch, take "
            f"about {hours:.2g} hours; give fewer, as by surface.nominal_area, or sampler = "
            '"aggregate", which takes no longer for many'
        )


def surface_in_other_units(surface: Surface) -> list[str]:
    """Return the same of a surface alone."""
    found = []
    for key, (low, high, below, above, units) in RANGES.items():
        value, si = float(getattr(surface, key)), SURFACE_UNITS[key]
        if not low <= value <= high:
            meant = next(text for text in _written(value, units) if low <= parse(text, si) <= high)
            found.append(
                f"surface.{key} = {value:g}: {value:g} {si} is {below if value < low else above}; "
                f"did you mean {meant} = {parse(meant, si):g}?"
            )
    return found


def _written(value: float, units: str) -> Iterator[str]:
    """Write these digits as people do, from 0.01 to 9999, in each of these units."""
    while value < 1e-2:
        value *= 1e3
    while value >= 1e4:
        value /= 1e3
    return (f"{value:.6g}{unit}" if unit[0] == "/" else f"{value:.6g} {unit}" for unit in units.split())
