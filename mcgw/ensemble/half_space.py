"""What the half-space makes of the sums of surfaces whose asperities press each other down.

And these asperities by themselves: nothing else is random. What gas in the gap adds
to the spots of surfaces, each at its own distance of mean planes.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Held, Results
from mcgw.scene.scene import Scene


def with_interaction(scene: Scene, sums: dict[str, Any], others: Iterable[str], h: Any) -> dict[str, Any]:
    """Return sums of asperities, stiffness and conductance with the half-space, and nominal separations.

    These follow from the load of each surface, without a search.

    Parameters
    ----------
    scene : Scene
        With an interaction.
    sums : dict of str to ndarray
        Of the asperities, SI.
    others : iterable of str
        Of `analytic.SEPARATIONS`.
    h : array_like
        Separations that the asperities feel.
    """
    from analytic.interaction import in_series  # for those scenes alone: every comparison imports this file

    series, sunk = {name: scene.series(name) for name in sums}, scene.compliance / scene.surface.sigma
    found = {name: in_series(x, series[name]) if series[name] else x for name, x in sums.items()}
    for name in others:
        found[name] = h - sunk * sums["load_unloading" if name.endswith("_unloading") else "load"]
    return found


@dataclass(frozen=True)
class _Alone(Results):
    """Results without the half-space that stiffness and conductance are in series with."""

    whole: Held
    scene: Scene

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of a dataset."""
        from analytic.interaction import in_series  # as above

        values = self.whole.read(name, start, stop)
        other = self.scene.series(name) if name in self.scene.quantities else 0.0
        return np.asarray(in_series(values, -other)) if other else values

    def rows(self) -> int:
        """Return the number of surfaces there are."""
        return self.whole.rows()


def scene_alone(scene: Scene) -> Scene:
    """Return the scene without interaction."""
    return scene if scene.interaction is None else scene.replace(interaction=None)


def asperities_alone(ensemble: Ensemble) -> Ensemble:
    """Return the ensemble of the sums of the asperities.

    Of one that keeps no values those that are not in series with the half-space.
    """
    scene = ensemble.scene
    if not isinstance(ensemble.sums, Results):  # of what is in series only each surface's would tell
        rest = tuple(name for name in scene.quantities if not scene.series(name))  # the load at least
        return replace(ensemble, scene=scene_alone(scene.replace(quantities=rest)))
    sums = _Alone(ensemble.sums, scene)
    return replace(ensemble, scene=scene_alone(scene), sums=sums)


def with_joint(scene: Scene, found: dict[str, Any], names: Iterable[str], h: Any) -> dict[str, Any]:
    """Conductances of the joint, W/(m^2 K), of what surfaces have besides.

    Each surface is one network, ``1/h_j = 1/(h_spots + h_gas) + R_bodies A_n``: what passes the gas is
    constricted by the bodies as a whole like what passes the spots. The distance of the mean planes is the
    separation that the asperities feel, or the nominal one if that is measured from the mean plane itself
    (`reference = "mean-plane"`).

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
    from analytic.interaction import in_series  # as above

    assert scene.filled is not None
    assert scene.film is not None
    bodies = 0.0 if scene.interaction is None else scene.interaction.bodies(scene.surface, scene.film.rho)
    answers = {}
    for name in names:
        way = "_unloading" * name.endswith("_unloading")
        contact = found[f"conductance_si{way}"] / scene.surface.nominal_area  # spots, and bodies in series
        apart = found[f"nominal_separation{way}"] if scene.from_mean_plane else h
        gas = scene.filled(apart) + 0 * contact
        if name.startswith("joint"):
            answers[name] = in_series(in_series(contact, -bodies) + gas, bodies)
        else:
            answers[name] = gas
    return answers
