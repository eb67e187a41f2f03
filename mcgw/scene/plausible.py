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
_FARTHEST = 50.0  # reduced heights of which no surface has one
_RATIOS = (1e-3, 50.0)  # from a gel on its rubber to diamond on its glue
_A_CONTACT = 4.4e-9  # s: drawing 1e10 asperities, half of which touch, took 22 s
_UNTOLD = 0.1  # share of the contacts at a separation that a table may leave to the value of its end


def warn_of_units(doubts: Iterable[str]) -> None:
    """Ask a caller in Python, once for each text; commands tell them as notes."""
    for line in doubts:
        warnings.warn(line, UserWarning, stacklevel=1)


def perhaps_other_units(scene: "Fields") -> list[str]:
    """Values that are perhaps given in another unit, a line each with what was perhaps meant."""
    found = surface_in_other_units(scene.surface)
    farthest = max(scene.separations, key=abs)
    if 0 < abs(farthest) < _HARDLY_APART:
        found.append(
            f"contact.separations: {farthest:g} sigma is almost 0; did you mean {farthest:g} m = "
            f"{farthest / scene.surface.sigma:.4g} sigma? Separations are d/sigma"
        )
    if isinstance(scene.grading, Table):
        found += _of_table(scene.grading, scene)
    return found


def takes_hours(scene: "Fields") -> list[str]:
    """Return a line if `auto` would draw the scene for more than an hour, and the remedy."""
    if scene.sampler != "auto" or scene.accuracy or scene.rel_err is not None or scene.max_seconds:
        return []
    touching = scene.n_asperities * float(scene.heights.sf(np.array(min(scene.separations))))
    hours = touching * scene.n_surfaces * _A_CONTACT / 3600
    if hours < 1:
        return []
    return [
        f"ensemble: {scene.n_surfaces:g} surfaces, each of {touching:.3g} asperities that touch, take about "
        f'{hours:.2g} hours; give fewer, as by surface.nominal_area, or sampler = "aggregate", which takes '
        "no longer for many"
    ]


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


def _of_table(table: Table, scene: "Fields") -> Iterator[str]:
    """Heights and moduli of a table in other units, and contacts beyond its ends."""
    farthest = max(table.s, key=abs)
    if abs(farthest) > _FARTHEST:
        yield (
            f"grading: a point lies at s = {farthest:.3g} sigma, where there are no summits; s is z/sigma, "
            "and z is in m unless the header of the file says z (um)"
        )
    ratios = [abs(ratio) for ratio in table.ratio if ratio != 0]
    if odd := [ratio for ratio in ratios if not _RATIOS[0] <= ratio <= _RATIOS[1]]:
        yield (
            f"grading: E*(s)/E* = {odd[0]:.3g} of surface.E_star = {scene.surface.E_star:g} Pa; a ratio "
            "should be near 1, and E_star is in Pa unless the header of the file says E_star (GPa)"
        )
    low, high = min(scene.separations), max(scene.separations)
    touch, from_first, over_last = scene.heights.sf(np.maximum(low, (low, table.s[0], table.s[-1])))
    share = float(touch - from_first + over_last) / float(touch) if touch > 0 else 0.0
    if share > _UNTOLD or high > table.s[-1]:
        where, share = (high, 1.0) if high > table.s[-1] else (low, share)
        fraction = "all" if share == 1 else f"{share:.0%} of the"
        yield (
            f"grading: {fraction} contacts at d/sigma = {where:g} are outside the table, which reaches from "
            f"s = {table.s[0]:.3g} to {table.s[-1]:.3g}; the modulus at its end is used for them"
        )
