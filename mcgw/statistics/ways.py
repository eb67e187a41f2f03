"""Ways to answers: what each gives, how many surfaces an error takes, what it costs, and the cheapest.

An error is a 95 % bound: 1.96 standard errors of a mean, a standard deviation or a quantile over the answer,
and for a whole distribution the largest difference of a probability, which Kolmogorov's law bounds.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import ceil, inf, nan, sqrt

from scipy.special import ndtri

from mcgw.ensemble.forecast import MOST_SURFACES, forecast, surfaces_at_load
from mcgw.ensemble.intervals import CONFIDENCE
from mcgw.sampling.expected import expected
from mcgw.scene.ensemble import PROMISES
from mcgw.scene.scene import Scene
from mcgw.scene.section import SceneError

PROBABILITY = 0.99  # of the quantile
WANTS = {
    "mean": "mean {}", "std": "standard deviation", "quantile": f"{PROBABILITY:.0%} quantile",
    "distribution": "distribution", "conductance": "conductance at its load", "values": "values of surfaces",
}  # fmt: skip
TARGETS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
SOLVE = "solve"  # surfaces drawn one by one, each at its own separation
_FASTER = 1.5  # a way must be so much faster than one named before it
_BOUND = float(ndtri((1 + CONFIDENCE) / 2))
_FEWEST = {"std": 30, "quantile": 2000, "distribution": 1}  # 20 of 2000 lie beyond the quantile


@dataclass(frozen=True)
class Way:
    """One way to one answer."""

    name: str  # "theory", "exact law", "solve", or a sampler
    want: str  # one of `WANTS`
    floor: float  # error that more surfaces do not reduce
    set_up: float  # CPU seconds before the first surface
    each: float  # CPU seconds of each surface; 0 where none is drawn
    measured: bool = True  # whether it was timed; otherwise its price is arithmetic (`expected`)

    @property
    def draws(self) -> bool:
        """Whether it draws surfaces."""
        return self.each > 0

    def seconds(self, n_surfaces: float) -> float:
        """CPU time of an answer from so many surfaces."""
        return self.set_up + n_surfaces * self.each


def drawn_by(scene: Scene, way: str) -> Scene:
    """Return the scene with the sampler by which a way draws."""
    return scene.replace(sampler="tail" if way == SOLVE else way)


def sampled_ways(scene: Scene) -> list[str]:
    """Names of the ways that draw surfaces of a scene, first the one that ``auto`` takes."""
    first, found = expected(scene.replace(sampler="auto")).name, []
    for name in dict.fromkeys((first, "cells", "tail", "direct", "aggregate", SOLVE)):
        with suppress(SceneError):
            sampler = drawn_by(scene, name).sampler
            if scene.summits is None or PROMISES[sampler].one_by_one:
                found.append(name)
    return found


def wants_of(name: str) -> tuple[str, ...]:
    """Return what a way that draws can give: no law of surfaces by a sampler whose laws are off."""
    if name == SOLVE:
        return ("conductance",)
    laws = ("quantile", "distribution", "values") if PROMISES[name].one_by_one else ()
    return ("mean", "std", *laws)


def of_one(scene: Scene, want: str) -> float:
    """Bound of the error from one surface, by exact theory; it falls with the root of their number."""
    h, q = scene.separations[0], scene.quantities[0]
    if want == "distribution":
        return 1.3581  # sqrt(n) times the largest difference of probabilities, in 95 of 100 samples
    if want == "conductance":  # at the load of this separation
        alone = float(scene.theory.asperities_for("conductance", h, 1.0, given="load"))
        return _BOUND * sqrt(alone / scene.n_asperities)
    if want == "std":  # by the fourth moment of the sum over asperities, about 0 or about the mean
        return _BOUND * sqrt(max(2 + float(scene.theory.cumulants(q, h).excess_kurtosis), 0.0) / 4)
    law = scene.theory.distribution(q, h)  # of a quantile by the density there (order statistics)
    value = float(law.ppf(PROBABILITY))
    density = value * float(law.pdf(value))
    return _BOUND * sqrt(PROBABILITY * (1 - PROBABILITY)) / density if density > 0 else inf


def surfaces_for(scene: Scene, want: str, target: float) -> float:
    """Surfaces for which 1.96 standard errors are at most the target; infinite if none are enough."""
    if not target > 0:
        return inf
    if want == "values":
        return float(scene.n_surfaces)
    if want == "mean":
        found = forecast(scene.replace(rel_err=target, n_surfaces=MOST_SURFACES))
        return inf if found.out_of_reach else float(found.surfaces)
    if want == "conductance":
        return surfaces_at_load(scene, scene.separations[0], {"conductance": target})
    return float(max(ceil((of_one(scene, want) / target) ** 2), _FEWEST[want]))


@dataclass(frozen=True)
class Advice:
    """What to run for one of `WANTS` within a target: a way, or None, its surfaces (0: none) and seconds."""

    want: str
    target: float
    way: Way | None
    n_surfaces: int
    seconds: float

    def code(self, scene: Scene, load: float) -> str:
        """Python that carries it out, for a scene of one separation and one quantity, and the load there."""
        if self.way is None:
            return ""
        h, q, n = scene.separations[0], scene.quantities[0], self.n_surfaces
        if self.want == "conductance" and self.way.name == "theory":
            return f'scene.theory.mean("conductance", scene.theory.separation_at("load", {load:.6g}))'
        if self.want == "conductance":
            value = '.surfaces["conductance"].mean()' if self.way.draws else '.value["conductance"]'
            return f"mcgw.solve(scene, load={load:.6g}, n_surfaces={max(n, 2)}){value}"
        if self.way.draws:
            return f"mcgw.simulate(scene, separations={h!r}, sampler={self.way.name!r}, n_surfaces={n})"
        name = "distribution" if self.want == "quantile" else self.want
        asked = f".ppf({PROBABILITY})" if self.want == "quantile" else ""
        return f'scene.theory.{name}("{q}", {h:g}){asked}'


def advise(want: str, target: float, ways: Sequence[Way], scene: Scene) -> Advice:
    """Choose the cheapest way; of those that cost about the same, the one named first."""
    best = Advice(want, target, None, 0, nan)
    for way in (way for way in ways if way.want == want and way.floor <= target):
        n = surfaces_for(scene, want, target - way.floor) if way.draws else 0
        seconds = way.seconds(n)
        if n <= MOST_SURFACES and (best.way is None or seconds * _FASTER < best.seconds):
            best = Advice(want, target, way, int(n), seconds)
    return best
