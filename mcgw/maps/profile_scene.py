"""The scene of a fit of profiles: it runs as it is."""

import numpy as np

from analytic import Surface
from mcgw.maps.profile_fit import ProfileFit
from mcgw.scene.scene import Scene

__all__ = ["profile_scene"]


def profile_scene(fit: ProfileFit, modulus: float, title: str) -> Scene:
    """Make a scene of the surface that profiles were taken from, on a square as long as they are.

    Parameters
    ----------
    fit : ProfileFit
        Of the profiles.
    modulus : float
        Composite modulus, which no profile tells, Pa.
    title : str
        For people.
    """
    m = fit.moments
    surface = Surface(m.sigma, m.radius, m.eta, fit.area, modulus)
    return Scene(surface=surface, separations=tuple(np.linspace(0, 3, 31).tolist()), title=title, seed=1)
