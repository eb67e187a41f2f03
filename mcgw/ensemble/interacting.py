"""What the half-space makes of the sums of surfaces whose asperities press each other down."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic.interacting import in_series
from mcgw.scene.scene import Scene

__all__ = ["at_loads", "with_interaction"]


def with_interaction(scene: Scene, sums: dict[str, NDArray[Any]]) -> dict[str, Any]:
    """Sums of the asperities, with stiffnesses in series with the half-space, and the other separation.

    At effective separations the nominal one follows from the load of each surface, without a search; at
    nominal ones the sampler has found it.

    Parameters
    ----------
    scene : Scene
        With an interaction.
    sums : dict of str to ndarray
        Of the asperities, SI, shape (surfaces, separations).
    """
    assert scene.interaction is not None
    compliance = scene.interaction.compliance(scene.surface, float(scene.n_asperities))
    found: dict[str, Any] = {}
    for name, values in sums.items():
        stiff = name not in scene.other_separations and in_series(name)
        found[name] = values / (1 + compliance * values) if stiff else values
    h, sunk = np.array(scene.separations), compliance / scene.surface.sigma
    for name in scene.other_separations:
        if name not in sums:
            load = sums["load_unloading" if name.endswith("_unloading") else "load"]
            found[name] = h - sunk * load
    return found


def at_loads(scene: Scene, found: dict[str, Any]) -> dict[str, Any]:
    """The same of what holds at given loads: with "nominal_separation" after the separation that is felt."""
    assert scene.interaction is not None
    compliance = scene.interaction.compliance(scene.surface, float(scene.n_asperities))
    with_it: dict[str, Any] = {}
    for name, value in found.items():
        stiff = name != "separation" and in_series(name)
        with_it[name] = value / (1 + compliance * value) if stiff else value
        if name == "separation":
            with_it["nominal_separation"] = value - compliance / scene.surface.sigma * found["load"]
    return with_it
