"""One surface of an ensemble as a field of asperities: where each one stands, and how high it is."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mcgw.sampling.asperities import summits
from mcgw.sampling.philox import POSITIONS, uniforms
from mcgw.scene.scene import Scene

__all__ = ["Asperities", "asperities_of"]

Array = NDArray[np.float64]

_X, _Y = 0, 1  # streams


@dataclass(frozen=True)
class Asperities:
    """Asperities of one surface.

    Parameters
    ----------
    x, y, z : ndarray
        Positions of the summits in the nominal area and heights about the mean of all summit heights,
        m, shape (asperities,). Those that touch at the scene's lowest separation come first.
    radii : ndarray
        Radius of each summit, m.
    radius : float
        Radius R of the surface, m: that of every summit, or the inverse of the mean curvature.
    size : (float, float)
        Extent of the nominal area along x and y, m.
    """

    x: Array
    y: Array
    z: Array
    radii: Array
    radius: float
    size: tuple[float, float]

    @property
    def number(self) -> int:
        """How many there are."""
        return len(self.z)


def asperities_of(scene: Scene, surface: int, *, width: float | None = None) -> Asperities:
    """Give the asperities of one surface of an ensemble their places, those that cannot touch included.

    The heights are the very ones whose loads are in the ensemble's file; the positions are uniform and
    independent, and a pure function of the seed and the surface. The nominal area is `width` m along x; it is
    a square if that is left out.

    Raises
    ------
    ValueError
        If there is no such surface, the width is not positive, or the sampler keeps no heights.
    """
    if not 0 <= surface < scene.n_surfaces:
        raise ValueError(f"surface = {surface}: the scene has surfaces 0 to {scene.n_surfaces - 1}")
    area = scene.surface.nominal_area
    width = math.sqrt(area) if width is None else width
    if not (math.isfinite(width) and width > 0):
        raise ValueError(f"width = {width}: give a length > 0 m")
    size = (width, area / width)
    s, ratios = summits(scene, surface)
    z, radius = scene.surface.sigma * s, scene.surface.radius
    radii = np.full(s.shape, radius) if ratios is None else radius * ratios
    x, y = (uniforms(scene.seed, POSITIONS, surface, stream, len(z)) for stream in (_X, _Y))
    return Asperities(size[0] * x, size[1] * y, z, radii, radius, size)
