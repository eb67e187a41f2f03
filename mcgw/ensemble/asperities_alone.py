"""The asperities of interacting surfaces by themselves: at effective separations nothing else is random."""

from dataclasses import dataclass, replace

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Held, Results
from mcgw.scene.scene import Scene


@dataclass(frozen=True)
class _Alone(Results):
    """Results without the half-space that stiffness and conductance are in series with."""

    whole: Held
    scene: Scene

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of a dataset."""
        from analytic.interaction import in_series  # every comparison imports this file

        values = self.whole.read(name, start, stop)
        other = self.scene.series(name) if name in self.scene.quantities else 0.0
        return np.asarray(in_series(values, -other)) if other else values

    def rows(self) -> int:
        """Number of surfaces there are."""
        return self.whole.rows()


def scene_alone(scene: Scene, what: str) -> Scene:
    """The scene without interaction.

    Parameters
    ----------
    scene : Scene
        Any.
    what : str
        What is asked of it, for the message.

    Raises
    ------
    ValueError
        If its surfaces each find their own balance: then no sum is one of independent asperities.
    """
    if scene.interaction is None:
        return scene
    if scene.interaction.nominal:
        raise ValueError(
            f'interaction.at = "nominal": {what} takes sums of independent asperities, and here each surface '
            'has a separation of its own; take at = "effective"'
        )
    return replace(scene, interaction=None)


def asperities_alone(ensemble: Ensemble) -> Ensemble:
    """The ensemble of the sums of the asperities, where its separations are effective ones.

    Of one that keeps no values those that are not in series with the half-space.

    Raises
    ------
    ValueError
        As from `scene_alone`.
    """
    scene = ensemble.scene
    if not isinstance(ensemble.sums, Results):  # of what is in series only each surface's would tell
        rest = tuple(name for name in scene.quantities if not scene.series(name))
        if not rest:
            raise ValueError(
                "of stiffness and conductance in series with the half-space theory gives no mean, and no "
                "values are kept; ask for another quantity besides"
            )
        return replace(ensemble, scene=scene_alone(replace(scene, quantities=rest), "this"))
    sums = _Alone(ensemble.sums, scene)
    return replace(ensemble, scene=scene_alone(scene, "this"), sums=sums)
