"""What the half-space makes of the sums of surfaces whose asperities press each other down.

And these asperities by themselves: nothing else is random. What gas in the gap adds
to the spots of surfaces, each at its own distance of mean planes.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from analytic import SEPARATIONS
from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Held, Results
from mcgw.scene.scene import Scene


def answered(scene: Scene, sums: dict[str, Any], names: Iterable[str], h: Any) -> dict[str, Any]:
    """Return sums of asperities, those of stiffness and conductance in series with the half-space; and more.

    Nominal separations follow from the load of each surface, without a search. Each surface of a joint is
    one network, ``1/h_j = 1/(h_spots + h_gas) + R_bodies A_n``: what passes the gas is constricted by the
    bodies as a whole like what passes the spots. The distance of the mean planes is the separation that the
    asperities feel, or the nominal one if it is measured from the mean plane itself.

    Parameters
    ----------
    scene : Scene
        Whose surfaces these are.
    sums : dict of str to ndarray
        Of the asperities, SI.
    names : iterable of str
        What is to be added, of `analytic.SEPARATIONS` and `analytic.JOINT`, in W/(m^2 K) or d/sigma.
    h : array_like
        Separations that the asperities feel.
    """
    from analytic.interaction import in_series  # for those scenes alone: every comparison imports this file

    filled: Any = scene.filled
    sunk = scene.compliance / scene.surface.sigma
    found = {name: in_series(x, scene.series(name)) for name, x in sums.items()}
    for name in names:
        back = "_unloading" * name.endswith("_unloading")
        nominal = h - sunk * sums[f"load{back}"] if scene.interaction else h
        if name in SEPARATIONS:
            found[name] = nominal
        else:
            apart = nominal if scene.from_mean_plane else h
            spots = found[f"conductance_si{back}"]
            if name.startswith("joint"):
                found[name] = joint_conductance(scene, spots, apart)
            else:
                found[name] = filled(apart) + 0 * spots
    return found


def joint_conductance(scene: Scene, spots: Any, apart: Any) -> Any:
    """Return what spots and gas conduct side by side, in series with the bodies, W/(m^2 K): see `answered`.

    Parameters
    ----------
    scene : Scene
        With a joint.
    spots : float or ndarray
        Conductance of the spots, and of the bodies in series with them, SI.
    apart : float or ndarray
        Distance of the mean planes, d/sigma.
    """
    from analytic.interaction import in_series  # as above

    assert scene.filled is not None
    assert scene.film is not None
    contact = spots / scene.surface.nominal_area
    bodies = 0.0 if scene.interaction is None else scene.interaction.bodies(scene.surface, scene.film.rho)
    return in_series(in_series(contact, -bodies) + scene.filled(apart), bodies)


@dataclass(frozen=True)
class _Alone(Results):
    """Results without the half-space that stiffness and conductance are in series with."""

    whole: Held
    scene: Scene

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of a dataset."""
        from analytic.interaction import in_series  # as above

        return np.asarray(in_series(self.whole.read(name, start, stop), -self.scene.series(name)))

    def rows(self) -> int:
        """Return the number of surfaces there are."""
        return self.whole.rows()


def asperities_alone(ensemble: Ensemble) -> Ensemble:
    """Return the ensemble of the sums of the asperities.

    Of one that keeps no values those that are not in series with the half-space.
    """
    scene, sums, quantities = ensemble.scene, ensemble.sums, ensemble.scene.quantities
    if isinstance(sums, Results):
        sums = _Alone(sums, scene)
    else:  # of what is in series only each surface's would tell
        quantities = tuple(name for name in quantities if not scene.series(name))  # the load at least
    return replace(ensemble, scene=scene.replace(quantities=quantities, interaction=None), sums=sums)
