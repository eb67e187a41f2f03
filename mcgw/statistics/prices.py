"""Prices of answers: what each way can give, its error, its time; and the cheapest for a wanted error.

What an error is, and how many surfaces it takes, is in `mcgw.ensemble.needed`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan
from typing import Any

from mcgw.ensemble.forecast import MOST_SURFACES
from mcgw.ensemble.needed import Needs
from mcgw.sampling.expected import expected
from mcgw.scene.promises import promise_of
from mcgw.scene.scene import Scene
from mcgw.scene.section import SceneError

WANTS = ("mean", "std", "quantile", "distribution", "conductance", "values")
TARGETS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
_COARSE = "cells, 0.001"  # cells whose values have this accuracy
_FASTER = 1.5  # a way must be so much faster than one named before it
SOLVE = "solve"  # surfaces drawn one by one, each at its own separation
_GIVES = {
    "theory": ("mean", "std", "conductance"), "exact law": ("quantile", "distribution", "conductance"),
    SOLVE: ("conductance",),
}  # fmt: skip


@dataclass(frozen=True)
class Way:
    """One way to one answer.

    Parameters
    ----------
    name : str
        "theory", "exact law", "solve", or a sampler, with its accuracy if that is not the finest.
    want : str
        One of `WANTS`.
    floor : float
        Error that more surfaces do not reduce.
    set_up, each : float
        Seconds by the clock: before the first surface, and of each; `each` is 0 where none is drawn.
    measured : bool
        Whether it was timed; otherwise its price is arithmetic (`mcgw.sampling.expected`).
    """

    name: str
    want: str
    floor: float
    set_up: float
    each: float
    measured: bool = True

    @property
    def draws(self) -> bool:
        """Whether it draws surfaces."""
        return self.each > 0

    def seconds(self, n_surfaces: float) -> float:
        """Time by the clock of an answer from so many surfaces."""
        return self.set_up + n_surfaces * self.each


def changes_of(name: str) -> dict[str, Any]:
    """Fields of a scene that draws by a way."""
    if name == SOLVE:
        return {"sampler": "tail"}
    sampler, _, accuracy = name.partition(", ")
    return {"sampler": sampler} | ({"accuracy": float(accuracy)} if accuracy else {})


def sampled_ways(scene: Scene) -> list[str]:
    """Names of the ways that draw surfaces of a scene, first the one that ``auto`` takes."""
    first = expected(scene.replace(sampler="auto")).name
    names = dict.fromkeys((first, "cells", "tail", _COARSE, "direct", "aggregate", SOLVE))
    return [name for name in names if _fits(scene, name)]


def _fits(scene: Scene, name: str) -> bool:
    try:
        scene.replace(**changes_of(name))
    except SceneError:
        return False
    return scene.curvature is None or promise_of(changes_of(name)["sampler"]).own_radii


def wants_of(name: str) -> tuple[str, ...]:
    """What a way can give: theory has no law of surfaces, nor has a sampler whose laws are a little off."""
    if name in _GIVES:
        return _GIVES[name]
    if promise_of(changes_of(name)["sampler"]).spends:
        return ("mean", "std")
    return ("mean", "std", "quantile", "distribution", "values")


@dataclass(frozen=True)
class Advice:
    """What to run for one of `WANTS` within a target: a way, or None, its surfaces (0: none) and seconds."""

    want: str
    target: float
    way: Way | None
    n_surfaces: int
    seconds: float


def advise(want: str, target: float, ways: Sequence[Way], needs: Needs) -> Advice:
    """Choose the cheapest way; of those that cost about the same, the one named first."""
    best = Advice(want, target, None, 0, nan)
    for way in (way for way in ways if way.want == want and way.floor <= target):
        n = needs.surfaces(want, target - way.floor) if way.draws else 0
        seconds = way.seconds(n)
        if n <= MOST_SURFACES and (best.way is None or seconds * _FASTER < best.seconds):
            best = Advice(want, target, way, int(n), seconds)
    return best
