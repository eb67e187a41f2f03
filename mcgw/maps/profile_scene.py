"""The scene of a fit of profiles: it runs as it is."""

import numpy as np

from analytic import Surface
from mcgw.maps.profile_fit import ProfileFit
from mcgw.maps.spectral_scene import FITTED, spectral_scene
from mcgw.scene.scene import Scene

__all__ = ["profile_scene"]


def profile_scene(fit: ProfileFit, modulus: float, title: str, *, nayak: bool = False) -> Scene:
    """Make a scene of the surface that profiles were taken from, on a square as long as they are.

    Parameters
    ----------
    fit : ProfileFit
        Of the profiles.
    modulus : float
        Composite modulus, which no profile tells, Pa.
    title : str
        For people.
    nayak : bool, optional
        Give each summit a radius of its own, as Gaussian surfaces have them.
    """
    m = fit.moments
    if nayak:
        return spectral_scene(m, fit.area, modulus, title)
    surface = Surface(m.sigma, m.radius, m.eta, fit.area, modulus)
    return Scene(surface, separations=np.linspace(0, 3, 31), title=title, quantities=FITTED, seed=1)
