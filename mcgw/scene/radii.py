"""Radii of summits: from the spectrum of the surface, or listed with their heights."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from analytic import (
    HeightLaw,
    MeasuredHeights,
    MeasuredRadii,
    Nayak,
    RandomCurvature,
    SpectralMoments,
    Surface,
)
from analytic.arrays import Array
from mcgw.scene.files_beside import read_summits
from mcgw.scene.section import Section

LISTS = ("file", "heights", "radii", "ratios", "resample")


@dataclass(frozen=True)
class Spectral:
    """An isotropic Gaussian surface.

    Parameters
    ----------
    moments : SpectralMoments
        Moments of its spectrum.
    surface : Surface
        Its summits, with the inverse of their mean curvature as radius.
    """

    moments: SpectralMoments
    surface: Surface

    @property
    def heights(self) -> Nayak:
        """Height law of its summits."""
        return Nayak(self.moments.alpha)


@dataclass(frozen=True, eq=False)
class ListedSummits:
    """Heights (m) and radii of summits.

    Parameters
    ----------
    heights : MeasuredHeights
        Their law.
    radii : ndarray
        m, or over that of the surface, shape (summits,).
    parameters : dict of str to float
        What they tell of their surface: their number ``eta`` on it and, if radii are in m, sigma and radius.
    """

    heights: MeasuredHeights
    radii: Array
    parameters: dict[str, float]

    def laws(self, surface: Surface) -> tuple[MeasuredHeights, MeasuredRadii]:
        """Laws of the heights and radii on this surface."""
        unit = surface.radius if "radius" in self.parameters else 1.0
        return self.heights, MeasuredRadii(self.heights, self.radii / unit)


def curvature_of(
    section: Section, heights: HeightLaw | None, surface: Surface | None, default: str
) -> RandomCurvature | None:
    """Read whether summits have their own radii; mistakes are noted and give None.

    Parameters
    ----------
    section : Section
        With ``curvature`` and ``largest_radius``.
    heights : HeightLaw or None
        Of the summits; None if they were not understood.
    surface : Surface or None
        Whose radius is the inverse of the mean curvature.
    default : {"random", "mean"}
        Where the section does not say.
    """
    word, largest = section.read("curvature", default), section.read("largest_radius")
    if word == "mean" and largest is not None:
        section.fail("largest_radius", section.table["largest_radius"], 'needs curvature = "random"')
    if word != "random" or surface is None or heights is None:
        return None
    if not isinstance(heights, Nayak):
        section.fail("curvature", word, 'needs heights.law = "nayak", or m0, m2, m4 under [surface]')
        return None
    try:
        return RandomCurvature(heights.alpha, math.inf if largest is None else largest / surface.radius)
    except ValueError as error:
        return section.fail("largest_radius", section.table.get("largest_radius", largest), str(error))


def datum_shift(section: Section, datum: str, heights: HeightLaw | None) -> float:
    """Shift to subtract from separations d/sigma measured from the plane named by ``datum``."""
    if datum != "surface" or heights is None:
        return 0.0
    if not isinstance(heights, Nayak):
        advice = 'needs heights.law = "nayak", which defines the mean plane of the surface'
        section.fail("datum", "surface", advice)
        return 0.0
    return heights.mean / heights.std


def listed_of(section: Section, folder: Path) -> ListedSummits | None:
    """Read listed summits; None if there are none, or mistakes, which are noted."""

    def listed(file: Any, heights: Any, radii: Any, ratios: Any, resample: Any) -> ListedSummits:
        own = (heights, ratios if radii is None else radii)
        z, R = _checked(*(own if file is None else read_summits(folder / file)))
        law = MeasuredHeights(z, resampled=bool(resample))
        in_metres = {"sigma": float(z.std()), "radius": float(1 / np.mean(1 / R))}
        return ListedSummits(law, R, {"eta": len(z)} | (in_metres if file is not None or radii else {}))

    given = section.read_all(LISTS)
    if (given["file"] is None) is (given["heights"] is None or given["radii"] is given["ratios"]):
        return None
    made: ListedSummits | None = section.made(listed, given)
    return made


def _checked(heights: Any, radii: Any) -> tuple[Array, Array]:
    """Return heights and radii as arrays.

    Raises
    ------
    ValueError
        If they are not as many, or one is impossible.
    """
    z, radius = (np.asarray(x, dtype=np.float64) for x in (heights, radii))
    if z.ndim != 1 or z.shape != radius.shape:
        raise ValueError(f"there are {z.size} heights and {radius.size} radii")
    for k in np.flatnonzero(~(np.isfinite(z) & np.isfinite(radius) & (radius > 0)))[:1]:
        has = f"summit {k + 1} has the height {z[k]:g} and the radius {radius[k]:g}"
        raise ValueError(f"{has}; heights are finite, radii > 0")
    return z, radius


def summits_table(
    curvature: RandomCurvature | MeasuredRadii, surface: Surface, file: str | None = None
) -> dict[str, Any]:
    """Write the table [summits] of summits with their own radii; it reads back the same.

    Measured ones are given by the name of their file, if they have one; else radii stand there over that of
    the surface, which has a last digit of its own.
    """
    if isinstance(curvature, MeasuredRadii):
        lists = {"heights": list(curvature.heights.heights), "ratios": list(curvature.ratios)}
        named = lists if file is None else {"file": file}
        return {**named, "resample": curvature.heights.resampled}
    bound = {} if math.isinf(curvature.largest) else {"largest_radius": curvature.largest * surface.radius}
    return {"curvature": "random", **bound}
