"""The scene of a fit by its spectral moments: each summit with a radius of its own, as of Gaussian maps."""

import math

import numpy as np

from analytic import Nayak, RandomCurvature, SpectralMoments
from mcgw.scene.scene import Scene

__all__ = ["FITTED", "spectral_scene"]

FITTED = ("load", "area", "stiffness", "contacts", "conductance")  # what a fitted scene asks for


def spectral_scene(moments: SpectralMoments, area: float, modulus: float, title: str) -> Scene:
    """Make a scene of the isotropic Gaussian surface with these moments.

    Parameters
    ----------
    moments : SpectralMoments
        Of a map or of profiles.
    area : float
        What was looked at, m^2: no summit is flatter than that is long.
    modulus : float
        Composite modulus, Pa.
    title : str
        For people.

    Raises
    ------
    ValueError
        If no isotropic Gaussian surface has these moments.
    """
    heights, surface = Nayak(moments.alpha), moments.surface(area, modulus)
    return Scene(
        surface=surface,
        separations=np.linspace(0, 3, 31),
        heights=heights,
        curvature=RandomCurvature(heights.alpha, math.sqrt(area) / surface.radius),
        title=title,
        quantities=FITTED,
        seed=1,
    )
