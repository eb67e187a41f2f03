"""What the half-space makes of the sums of surfaces whose asperities press each other down."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic.interaction import in_series
from mcgw.scene.scene import Scene


def with_interaction(scene: Scene, sums: dict[str, NDArray[Any]]) -> dict[str, Any]:
    """Sums of the asperities, stiffness and conductance with the half-space, and the other separation.

    At effective separations the nominal one follows from the load of each surface, without a search; at
    nominal ones the sampler has found it.

    Parameters
    ----------
    scene : Scene
        With an interaction.
    sums : dict of str to ndarray
        Of the asperities, SI, shape (surfaces, separations).
    """
    found = {name: _answer(scene, name, values) for name, values in sums.items()}
    h, sunk = np.array(scene.separations), scene.compliance / scene.surface.sigma
    for name in scene.other_separations:
        if name not in sums:
            load = sums["load_unloading" if name.endswith("_unloading") else "load"]
            found[name] = h - sunk * load
    return found


def at_loads(scene: Scene, found: dict[str, Any]) -> dict[str, Any]:
    """The same of what holds at given loads: with "nominal_separation" after the separation that is felt."""
    felt = found["separation"]
    nominal = felt - scene.compliance / scene.surface.sigma * found["load"]
    rest = {name: _answer(scene, name, value) for name, value in found.items() if name != "separation"}
    return {"separation": felt, "nominal_separation": nominal, **rest}


def _answer(scene: Scene, name: str, value: Any) -> Any:
    """What becomes of a sum of the asperities."""
    other = scene.series(name)
    return in_series(value, other) if other else value
