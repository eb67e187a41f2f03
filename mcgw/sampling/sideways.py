"""Tangential loads of surfaces, from their normal loads at the separations of a scene and shifted ones."""

import numpy as np

from analytic.arrays import Array
from mcgw.scene.scene import Scene


def tangential_loads(scene: Scene, loads: Array) -> Array:
    """Differences of normal loads.

    Parameters
    ----------
    scene : Scene
        Pushed sideways.
    loads : ndarray
        Normal loads at `scene.all_separations`, shape (surfaces, all separations).

    Returns
    -------
    ndarray
        N, shape (surfaces, separations, displacements).
    """
    assert scene.tangential is not None
    h = np.array(scene.separations)
    shifted = h[:, None] + scene.tangential.shifts(scene.surface)
    once = np.array(scene.all_separations)
    below, above = loads[:, np.searchsorted(once, h)], loads[:, np.searchsorted(once, shifted)]
    return scene.tangential.load(below[:, :, None], above)
