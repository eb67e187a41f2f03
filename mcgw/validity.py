"""Where the model is asked beyond what it assumes: said, not forbidden."""

import numpy as np

from mcgw.plausible import unit_doubts
from mcgw.scene import Scene

__all__ = ["notes"]

_SHARE = 1e-3


def notes(scene: Scene) -> list[str]:
    """Remarks on a scene, one line each.

    Parameters
    ----------
    scene : Scene
        What is asked.

    Returns
    -------
    list of str
        Empty if there is nothing to say.
    """
    surface, law = scene.surface, scene.heights
    depth = surface.radius / surface.sigma
    touching = float(law.above(np.array(scene.lowest)))
    deep = float(law.above(np.array(scene.lowest + depth)))
    share = deep / touching if touching > 0 else 0.0
    found = unit_doubts(scene)
    if share > _SHARE or surface.sigma >= surface.radius:
        found.append(
            f"surface.radius = {surface.radius:g} m: at d/sigma = {scene.lowest:g} a share of {share:.2g} "
            "of the contacts is compressed by more than the radius, where Hertz does not hold"
        )
    return found
