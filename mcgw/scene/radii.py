"""Surfaces by their spectrum, and summits listed with their heights and radii."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from analytic import MeasuredHeights, Nayak, SpectralMoments, Surface
from analytic.arrays import Array
from mcgw.scene.files_beside import read_summits
from mcgw.scene.section import Section

LISTS = ("file", "heights", "radii", "ratios", "resample")
Listed = tuple[MeasuredHeights, Array, dict[str, float]]


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


def listed_of(section: Section, folder: Path) -> Listed | None:
    """Read listed summits; None if there are none, or mistakes, which are noted.

    Returns
    -------
    tuple
        Law of their heights; radii, m or over that of the surface, shape (summits,); and what they tell of
        their surface: their number ``eta`` on it and, if radii are in m, sigma and radius.
    """

    def listed(file: Any, heights: Any, radii: Any, ratios: Any, resample: Any) -> Listed:
        own = (heights, ratios if radii is None else radii)
        z, R = (np.asarray(x, np.float64) for x in (own if file is None else read_summits(folder / file)))
        if z.shape != R.shape:
            raise ValueError(f"there are {z.size} heights and {R.size} radii")
        for k in np.flatnonzero(~(np.isfinite(z) & np.isfinite(R) & (R > 0)))[:1]:
            has = f"summit {k + 1} has the height {z[k]:g} and the radius {R[k]:g}"
            raise ValueError(f"{has}; heights are finite, radii > 0")
        law = MeasuredHeights(z, resampled=bool(resample))
        in_metres = {"sigma": float(z.std()), "radius": float(1 / np.mean(1 / R))}
        told = {"eta": len(z)} | (in_metres if file is not None or radii else {})
        return law, R, told

    given = section.read_all(LISTS)
    if (given["file"] is None) is (given["heights"] is None or given["radii"] is given["ratios"]):
        return None
    made: Listed | None = section.made(listed, given)
    return made
