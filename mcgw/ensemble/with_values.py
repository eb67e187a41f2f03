"""Values of single surfaces for what needs them: of an ensemble that keeps none, the first ones anew."""

from dataclasses import replace

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.drawn_by import drawn_by

__all__ = ["with_values"]

_DRAWS = 1e9  # numbers drawn for it: a second or two
_FEWEST = 20


def with_values(ensemble: Ensemble, most: int) -> Ensemble:
    """The ensemble itself; or if it keeps statistics alone, so many of its first surfaces, drawn again."""
    if ensemble.scene.keep != "statistics":
        return ensemble
    scene = replace(drawn_by(ensemble.scene, ensemble.sampler), keep="sums")
    fitting = int(_DRAWS / (sampler_of(scene).draws + 1))
    return simulate(replace(scene, n_surfaces=min(ensemble.n_surfaces, most, max(fitting, _FEWEST))))
