"""What [surface], [heights] and [summits] of a scene say together."""

from collections.abc import Mapping
from pathlib import Path

from analytic import Gaussian, HeightLaw, MeasuredRadii, RandomCurvature, Surface
from mcgw.scene.heights_section import heights_law
from mcgw.scene.listed_summits import lists_summits, read_listed
from mcgw.scene.section import Section
from mcgw.scene.summits_section import curvature_of
from mcgw.scene.surface import MOMENTS, read_spectral, read_surface

__all__ = ["surface_and_summits"]

Read = tuple[Surface | None, HeightLaw, RandomCurvature | MeasuredRadii | None]


def surface_and_summits(sections: Mapping[str, Section], folder: Path) -> Read:
    """Read a surface, the law of its heights, and that of its radii where summits have their own.

    Parameters
    ----------
    sections : mapping
        With "surface", "heights" and "summits"; mistakes are noted in them.
    folder : Path
        Where the files lie that they name.

    Returns
    -------
    (Surface or None, HeightLaw, RandomCurvature or MeasuredRadii or None)
        A surface that was not understood is None.
    """
    if lists_summits(sections["summits"]):
        return _listed(sections, folder)
    if any(key in sections["surface"] for key in MOMENTS):
        return _of_spectrum(sections, folder)
    surface, heights = read_surface(sections["surface"]), heights_law(sections["heights"], folder)
    return surface, heights, curvature_of(sections["summits"], heights, surface, "mean")


def _of_spectrum(sections: Mapping[str, Section], folder: Path) -> Read:
    spectral = read_spectral(sections["surface"])
    if spectral is None or sections["heights"].table:
        heights = heights_law(sections["heights"], folder)
    else:
        heights = spectral.heights
    surface, default = (spectral.surface, "random") if spectral else (None, "mean")
    return surface, heights, curvature_of(sections["summits"], heights, surface, default)


def _listed(sections: Mapping[str, Section], folder: Path) -> Read:
    """Summits that are given one by one tell their heights, and what the surface leaves out."""
    surface, heights, summits = (sections[name] for name in ("surface", "heights", "summits"))
    surface.known(*MOMENTS)
    heights.known(*heights.table)
    if heights.table:
        heights.problems.append("heights: [summits] lists the heights of its summits; leave [heights] out")
    if given := [key for key in MOMENTS if key in surface]:
        surface.fail(
            given[0], surface.table[given[0]], "[summits] lists the summits themselves; leave it out"
        )
    listed = read_listed(summits, folder)
    if listed is None:
        surface.known(*surface.table)  # what it lacks, nobody can say
        return None, Gaussian(), None
    read = read_surface(surface, listed)
    return read, *((Gaussian(), None) if read is None else listed.laws(read))
