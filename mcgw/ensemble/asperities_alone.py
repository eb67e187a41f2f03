"""The asperities of interacting surfaces by themselves: at effective separations nothing else is random."""

from dataclasses import dataclass, replace

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Held, Results
from mcgw.scene.scene import Scene


@dataclass(frozen=True)
class _Alone(Results):
    """Results without the half-space that stiffnesses are in series with."""

    whole: Held
    compliance: float
    names: tuple[str, ...]

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of a dataset."""
        from analytic.interacting import is_stiffness  # every comparison imports this file
        from analytic.interaction import in_series

        values = self.whole.read(name, start, stop)
        if name in self.names and is_stiffness(name):
            return np.asarray(in_series(values, -self.compliance))
        return values

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


def _without_stiffness(scene: Scene) -> Scene:
    """Of which statistics are those of the asperities: of stiffnesses only each surface's would tell."""
    from analytic.interacting import is_stiffness

    rest = tuple(name for name in scene.quantities if not is_stiffness(name))
    if not rest:
        raise ValueError(
            'keep = "statistics": of stiffnesses in series with the half-space theory gives no mean; ask for '
            "another quantity besides"
        )
    return replace(scene, quantities=rest)


def asperities_alone(ensemble: Ensemble) -> Ensemble:
    """The ensemble of the sums of the asperities, where its separations are effective ones.

    Of one that keeps statistics alone those that are no stiffnesses.

    Raises
    ------
    ValueError
        As from `scene_alone`.
    """
    scene = ensemble.scene
    if scene.keep == "statistics":
        return replace(ensemble, scene=scene_alone(_without_stiffness(scene), "this"))
    sums = _Alone(ensemble.sums, scene.compliance, scene.quantities)
    return replace(ensemble, scene=scene_alone(scene, "this"), sums=sums)
