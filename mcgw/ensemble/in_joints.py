"""What gas in the gap adds to the spots of surfaces, each at its own distance of mean planes."""

from collections.abc import Iterable
from typing import Any

from mcgw.scene.scene import Scene


def with_joint(scene: Scene, found: dict[str, Any], names: Iterable[str], h: Any) -> dict[str, Any]:
    """Conductances of the joint, W/(m^2 K), of what surfaces have besides.

    The distance of the mean planes is the separation that the asperities feel, or the nominal one if that
    counts from the mean plane itself (`reference = "mean-plane"`).

    Parameters
    ----------
    scene : Scene
        With a joint.
    found : dict of str to ndarray
        SI: "conductance_si", and separations where surfaces have their own, of the same shape.
    names : iterable of str
        Of `analytic.JOINT`.
    h : array_like
        Separations where surfaces have none of their own.
    """
    plane = "nominal_separation" if scene.from_mean_plane else "effective_separation"
    assert scene.filled is not None
    answers = {}
    for name in names:
        way = "_unloading" * name.endswith("_unloading")
        spots = found[f"conductance_si{way}"]
        gas = scene.filled(found.get(f"{plane}{way}", h))
        answers[name] = gas + (spots / scene.surface.nominal_area if name.startswith("joint") else 0 * spots)
    return answers
