"""The table [summits] of a scene, and a surface that is told by its spectrum."""

import math
from dataclasses import dataclass
from typing import Any

from analytic import HeightLaw, MeasuredRadii, Nayak, RandomCurvature, SpectralMoments, Surface
from mcgw.scene.listed_summits import listed_table
from mcgw.scene.section import Section

__all__ = ["Spectral", "curvature_of", "datum_shift", "summits_table"]

_CURVATURES = ("random", "mean")


@dataclass(frozen=True)
class Spectral:
    """An isotropic Gaussian surface.

    Parameters
    ----------
    moments : SpectralMoments
        Of its spectrum.
    surface : Surface
        Its summits, all of the inverse of their mean curvature.
    """

    moments: SpectralMoments
    surface: Surface

    @property
    def heights(self) -> Nayak:
        """Law of the heights of its summits."""
        return Nayak(self.moments.alpha)


def curvature_of(
    section: Section, heights: HeightLaw, surface: Surface | None, default: str
) -> RandomCurvature | None:
    """Read whether summits have radii of their own; mistakes are noted, and give None.

    Parameters
    ----------
    section : Section
        With ``curvature`` and ``largest_radius``.
    heights : HeightLaw
        Of the summits.
    surface : Surface or None
        Whose radius is the inverse of the mean curvature; None if it was not understood.
    default : {"random", "mean"}
        Where the section does not say.
    """
    word = section.choice("curvature", default, _CURVATURES)
    largest = section.number("largest_radius", math.inf, unit="m")
    if word == "mean" or surface is None:
        if math.isfinite(largest):
            section.fail("largest_radius", section.table["largest_radius"], 'needs curvature = "random"')
        return None
    if not isinstance(heights, Nayak):
        section.fail("curvature", word, 'needs heights.law = "nayak", or m0, m2, m4 under [surface]')
        return None
    try:
        return RandomCurvature(heights.alpha, largest / surface.radius)
    except ValueError as error:
        section.fail("largest_radius", section.table.get("largest_radius", largest), str(error))
        return None


def datum_shift(section: Section, heights: HeightLaw) -> float:
    """What is to be taken off separations d/sigma that count from the plane that ``datum`` names."""
    if section.choice("datum", "summits", ("summits", "surface")) == "summits":
        return 0.0
    if not isinstance(heights, Nayak):
        section.fail(
            "datum", "surface", 'needs heights.law = "nayak", which knows the mean plane of the surface'
        )
        return 0.0
    return heights.mean / heights.std


def summits_table(
    curvature: RandomCurvature | MeasuredRadii | None, surface: Surface, file: str | None = None
) -> dict[str, Any]:
    """The table [summits], read again the same; empty where all summits have one radius.

    Measured ones are told by the name of their file, if they have one.
    """
    if curvature is None:
        return {}
    if isinstance(curvature, MeasuredRadii):
        return listed_table(curvature, file)
    bound = {} if math.isinf(curvature.largest) else {"largest_radius": curvature.largest * surface.radius}
    return {"curvature": "random", **bound}
