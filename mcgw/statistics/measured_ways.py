"""Every way to every answer of a scene, run and timed in turn with all others.

Each repeat has new surfaces and a separation moved by nothing that counts, so that no result is remembered.
Times are of the CPU, all cores together: what else a machine does changes the clock, and hardly these.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from time import process_time
from typing import Any

import numpy as np
from scipy.optimize import nnls

from analytic.arrays import Array
from analytic.at_load import specimen_moments
from mcgw.ensemble.intervals import laws_are_quick
from mcgw.ensemble.simulation import simulate
from mcgw.ensemble.solution import solutions
from mcgw.sampling.asperities import worst_of_values
from mcgw.sampling.expected import expected
from mcgw.scene.scene import Scene
from mcgw.statistics.ways import PROBABILITY, SOLVE, Way, drawn_by, of_one, wants_of

REPEATS = 16
_FEWEST = 3  # repeats of what draws nothing and takes long
_SHIFT = 1e-9  # of a separation, from repeat to repeat
_SURE = 5.0  # standard errors of a bias, by 16 repeats: a right way is taken for wrong once in 6000
_BY_CHANCE = (0.8687, 0.2603)  # mean and standard deviation of Kolmogorov's law
_FEWEST_FOR_QUANTILE, _LEVELS = 2000, np.arange(1, 200) / 200  # surfaces; probabilities that are compared
_MOST_LISTED, _LISTED = 3e6, 4  # asperities of a surface that are summed by themselves; surfaces
_HERTZ, _OTHERS, _LAW = 1e-13, 1e-9, 1e-6  # errors that theory and exact laws are tested to

Errors = dict[str, float]


@dataclass(frozen=True)
class Point:
    """One way to an answer from so many surfaces, 0 where none is drawn."""

    way: str
    want: str
    n_surfaces: int
    rms: float  # root mean square of its error over the repeats
    stderr: float  # standard error of this
    bias: float  # its mean error if that cannot be chance, else 0
    seconds: float  # median CPU time
    repeats: int


@dataclass(frozen=True)
class Task:
    """A way at a size: a timed call on the scene of each repeat, and the errors of what it returns."""

    way: str
    n_surfaces: int
    call: Callable[[Scene], Any]
    compare: Callable[[Any], Errors]
    errors: list[Errors] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)

    def run(self, scene: Scene, limit: float = np.inf) -> None:
        """Run it once; a long one that draws nothing not again once it has spent its limit of seconds."""
        if not self.n_surfaces and len(self.seconds) >= _FEWEST and sum(self.seconds) > limit:
            return
        start = process_time()
        found = self.call(scene)
        self.seconds.append(max(process_time() - start, 1e-9))  # seconds: less than any clock tells
        self.errors.append(self.compare(found))

    def points(self) -> Iterator[Point]:
        """One for each answer."""
        for want in self.errors[0]:
            e, n = np.array([errors[want] for errors in self.errors]), self.n_surfaces
            rms, r = float(np.sqrt(np.mean(e**2))), len(e)
            stderr = float(np.std(e**2) / (2 * rms * np.sqrt(r))) if rms > 0 else 0.0
            usual, spread = _BY_CHANCE if want == "distribution" else (0.0, float(e.std(ddof=1)) * n**0.5)
            sure = abs(e.mean()) * n**0.5 > usual + _SURE * spread / r**0.5
            bias = abs(float(e.mean())) if sure else 0.0
            yield Point(self.way, want, n, rms, stderr, bias, float(np.median(self.seconds)), r)


class Answers:
    """Answers of a scene of one separation by theory and exact laws, which samples are held against."""

    def __init__(self, scene: Scene) -> None:
        self.q, self.h, theory = scene.quantities[0], scene.separations[0], scene.theory
        self.load, self.scene, self.at = float(theory.mean("load", self.h)), scene, np.empty(0)
        self.known = {name: float(getattr(theory, name)(self.q, self.h)) for name in ("mean", "std")}
        if not self.known["mean"]:
            raise ValueError(
                f"mean {self.q} at d/sigma = {self.h:g} is 0: a relative error needs a mean that is not; "
                "change separations"
            )
        with suppress(KeyError, ValueError):
            law = theory.distribution(self.q, self.h)
            self.at = np.array(law.ppf(_LEVELS))
            self.levels, self.known["quantile"] = np.array(law.cdf(self.at)), float(law.ppf(PROBABILITY))
        if laws_are_quick(scene):
            with suppress(KeyError, ValueError, IndexError):
                self.known["conductance"] = self._by_law(scene)

    def _load(self, scene: Scene) -> float:
        """Return the load, moved as the scene of a repeat is."""
        return self.load * (1 + scene.separations[0] - self.h)

    def _by_law(self, scene: Scene) -> float:
        return specimen_moments(scene.theory, "load", self._load(scene), ["conductance"]).mean["conductance"]

    def _by_theory(self, scene: Scene) -> float:
        h = scene.theory.separation_at("load", self._load(scene))
        return float(scene.theory.mean("conductance", h))

    def _by_solving(self, n_surfaces: int, scene: Scene) -> float:
        (found,) = solutions(scene.replace(n_surfaces=n_surfaces), "load", [self._load(scene)], draw=True)
        return float(found.surfaces["conductance"].mean())

    def _by_drawing(self, name: str, n_surfaces: int, scene: Scene) -> Array:
        return simulate(scene, sampler=name, n_surfaces=n_surfaces)[self.q][:, 0]

    def _at_load(self, value: float) -> Errors:
        """Error of a conductance; where the mean over specimens is not known, theory's by its order 1/N."""
        known = self.known.get("conductance")
        return {"conductance": of_one(self.scene, "conductance") ** 2 if known is None else value / known - 1}

    def of_sample(self, x: Array) -> Errors:
        """Errors of the answers that a sample of surfaces gives."""
        found = {"mean": float(x.mean()), "std": float(x.std(ddof=1))}
        if x.size >= _FEWEST_FOR_QUANTILE and "quantile" in self.known:
            found["quantile"] = float(np.quantile(x, PROBABILITY))
        errors = {want: value / self.known[want] - 1 for want, value in found.items()}
        if self.at.size:
            below = np.searchsorted(np.sort(x), self.at, side="right") / x.size
            errors["distribution"] = float(np.abs(below - self.levels).max())
        return errors

    def without_surfaces(self) -> Iterator[Task]:
        """Ways that draw nothing; their errors are those that tests hold them to."""

        def task(way: str, want: str, call: Callable[[Scene], Any]) -> Task:
            return Task(way, 0, call, lambda _: {want: 0.0})

        def law(scene: Scene) -> Any:
            return scene.theory.distribution(self.q, scene.separations[0])

        yield task("theory", "mean", lambda s: s.theory.mean(self.q, s.separations[0]))
        yield task("theory", "std", lambda s: s.theory.std(self.q, s.separations[0]))
        yield Task("theory", 0, self._by_theory, self._at_load)
        if "conductance" in self.known and self.scene.touching < _MOST_LISTED:
            yield task("exact law", "conductance", self._by_law)
        if self.at.size:
            yield task("exact law", "quantile", lambda s: law(s).ppf(PROBABILITY))
            yield task("exact law", "distribution", lambda s: law(s).cdf(self.at))

    def sampled(self, name: str, n_surfaces: int) -> Task:
        """Return a way that draws so many surfaces: at the separation, or at the load."""
        if name == SOLVE:
            return Task(name, n_surfaces, partial(self._by_solving, n_surfaces), self._at_load)
        return Task(name, n_surfaces, partial(self._by_drawing, name, n_surfaces), self.of_sample)


def moved(scene: Scene, number: int) -> Scene:
    """Return the scene of one repeat."""
    seed = (scene.seed + 7919 * number + 104729) % 2**64
    return scene.replace(separations=(scene.separations[0] + _SHIFT * number,), seed=seed)


def sized(answers: Answers, name: str, share: float) -> Iterator[Task]:
    """Yield a way at all sizes of which 16 repeats fit into its share of seconds, each run before."""
    each = expected(drawn_by(answers.scene, name)).seconds
    for size in (10**k for k in range(1, 7)):
        if REPEATS * size * each > share:
            return
        task = answers.sampled(name, size)
        for number in (-2, -1):  # the first compiles
            task.run(moved(answers.scene, number))
        if size >= 100:  # surfaces, which tell how long ten times as many take
            each = task.seconds[-1] / size
        yield answers.sampled(name, size)


def prices(scene: Scene, points: Sequence[Point], names: Sequence[str]) -> Iterator[Way]:
    """Yield set-up and cost of a surface from the times of all sizes; floors from what is off."""
    tested = {"theory": _HERTZ if scene.hertzian and scene.summits is None else _OTHERS, "exact law": _LAW}
    for p in points:
        if p.way in tested:
            yield Way(p.way, p.want, max(tested[p.way], p.rms), p.seconds, 0.0)
    for name in names:
        asked = drawn_by(scene, name)
        rough = expected(asked)
        own = [p for p in points if p.way == name]
        timed = [p for p in own if p.want == ("conductance" if name == SOLVE else "mean")]
        price = _price(timed, rough.seconds) if timed else (0.0, rough.seconds)
        for want in wants_of(name) if timed or name != SOLVE else ():
            floor = ([0.0, *(p.bias for p in timed)] + [p.bias for p in own if p.want == want])[-1]
            if want == "values":
                floor = worst_of_values(asked, _LISTED) if rough.draws < _MOST_LISTED else 0.0
            yield Way(name, want, floor, *price, measured=bool(timed))


def _price(timed: Sequence[Point], rough: float) -> tuple[float, float]:
    """Seconds before the first surface, and of each: the line nearest in ratio to the times of all sizes."""
    sizes, seconds = np.array([(point.n_surfaces, point.seconds) for point in timed]).T
    if seconds[-1] < 2 * seconds[0]:  # most of it is set-up: the price of each by arithmetic
        return max(float(np.mean(seconds - rough * sizes)), 0.0), rough
    set_up, each = nnls(np.stack([1 / seconds, sizes / seconds], axis=1), np.ones(len(timed)))[0]
    return float(set_up), float(each)
