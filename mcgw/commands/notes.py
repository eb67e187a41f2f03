"""What a command says beside its answer, on standard error."""

import sys
from typing import TYPE_CHECKING

from mcgw.scene.cautions import cautions
from mcgw.scene.scene import Scene

if TYPE_CHECKING:
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.sweeps.sweep import Sweep

__all__ = ["cautions_of", "tell_notes"]


def tell_notes(source: "Scene | Ensemble | Sweep", *more: str) -> None:
    """Say where the model is strained, which units look wrong, and what else there is to say."""
    for line in (*cautions_of(source), *more):
        print(f"mcgw: note: {line}", file=sys.stderr)


def cautions_of(source: "Scene | Ensemble | Sweep") -> list[str]:
    """What a reader should know of a scene, that of an ensemble, or all points of a sweep."""
    if isinstance(source, Scene):
        return cautions(source)
    from mcgw.ensemble.ensemble import Ensemble  # with results, of which many commands have none

    if isinstance(source, Ensemble):
        return cautions(source.scene)
    from mcgw.sweeps.cautions import sweep_cautions

    return sweep_cautions(source)
