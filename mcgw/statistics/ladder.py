"""The ladder of models: whole error against time, from one formula to boundary elements.

What is asked for is the conductance (C rho, or the stiffness) at a given load: its measured error against
elasticity is in the error budget of a solution, and `mcgw.elastic` gives it for surfaces with a spectrum.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import hypot, isnan

import numpy as np

from mcgw.ensemble.drawing import in_words
from mcgw.errors import RunError
from mcgw.scene.scene import Scene
from mcgw.statistics.ways import SOLVE, Way, of_one
from mcgw.validity.model_error import percent

_SIZES = (2, 10, 100, 1000, 10_000, 100_000)
_PILOT = 4  # maps on which levels are compared
_PIXELS = 0.02  # error of boundary elements on the maps of `mcgw.elastic`: see `mcgw.elasticity.sources`
_TARGETS = (0.1, 0.03, 0.01)
_ENOUGH = 1.05  # times the error of the model: more surfaces are not worth it


@dataclass(frozen=True)
class Rung:
    """One model with so many surfaces or maps; errors are relative 95 % bounds, nan where not known."""

    name: str
    n_surfaces: int
    seconds: float
    drawn: float
    model: float

    @property
    def whole(self) -> float:
        """Root of the sum of squares, as in an error budget."""
        return hypot(self.drawn, self.model)


def worth(ladder: Sequence[Rung], unknown: str) -> str:
    """Say where more surfaces stop to help, or why the error of the model is not known."""
    formula = ladder[0]
    if isnan(formula.model):
        return f"The error of the model is not known here: {unknown}."
    parts = [f"The model is off by {percent(formula.model)}"]
    enough = [r for r in ladder if r.name == "surfaces" and r.whole <= _ENOUGH * formula.model]
    if formula.whole <= _ENOUGH * formula.model:
        parts.append(f"theory, {in_words(formula.seconds)}, is as good as any number of surfaces")
    elif enough:
        parts.append(f"more than {enough[0].n_surfaces} surfaces do not help")
    dear = [r for r in ladder if r.name == "boundary elements" and r.whole < formula.whole]
    if dear:
        parts.append(f"`mcgw elastic` gets {percent(dear[-1].whole)} in {in_words(dear[-1].seconds)}")
    return f"{'; '.join(parts)}."


def ladder_of(scene: Scene, alone: Scene, load: float, ways: Sequence[Way], model: float) -> Iterator[Rung]:
    """Yield the rungs of a scene whose model is so far off; `alone`: its asperities at the separation."""
    by = {way.name: way for way in ways if way.want == "conductance"}
    theory = by["theory"]
    yield Rung("formula", 0, theory.seconds(0), theory.floor, model)
    for n in _SIZES if SOLVE in by else ():
        yield Rung("surfaces", n, by[SOLVE].seconds(n), of_one(alone, "conductance") / n**0.5, model)
    with suppress(ValueError, RunError):  # without a spectrum, or Tamaas, the ladder ends here
        yield from _of_maps(scene, load / scene.surface.nominal_area)


def _of_maps(scene: Scene, pressure: float) -> Iterator[Rung]:
    """Boundary elements: what means of `mcgw.elastic` within some errors take, by a few maps."""
    from mcgw.elasticity.levels import LEVELS  # for scenes with a spectrum alone
    from mcgw.elasticity.multilevel import design
    from mcgw.elasticity.solves import Solves
    from mcgw.elasticity.sources import maps_of

    solves = Solves(maps_of(scene), {"pressure": pressure}, scene.surface.E_star, 1, ["conductance"])
    rows = [solves.at(LEVELS, number) for number in range(_PILOT)]
    values, seconds = (np.array(part) for part in zip(*rows, strict=True))
    solve = float(np.median(seconds[:, -1]))
    for target in _TARGETS:
        planned = design(values, [level.cost for level in LEVELS], target)
        yield Rung("boundary elements", planned.maps[-1], planned.cost * solve, target, _PIXELS)
