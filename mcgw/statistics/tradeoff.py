"""Error against time for one scene on this machine, and what to run: a work-precision study in bounded time.

Two frontiers: of the mean of its first quantity, by every method there is; and of the values of single
surfaces, by every pair of sampler and accuracy (`mcgw.statistics.wishes`).
"""

from dataclasses import dataclass, replace
from functools import partial
from time import monotonic, perf_counter, process_time
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.half_space import scene_alone
from mcgw.formats.sheet import Sheet, Shown
from mcgw.formats.table import Column, Table
from mcgw.machine.memory import peak_growth
from mcgw.machine.progress import Progress, told
from mcgw.machine.terminal import plotted
from mcgw.scene.arguments import argument, check_object
from mcgw.scene.scene import Scene
from mcgw.statistics.methods import Method, methods_for
from mcgw.statistics.wishes import Advice, Way, advise, ways_for

SECONDS = 60.0
_MOST_ROUNDS, _ROUNDS = 24, 6
_FEWEST_SIZES = 3
_SHORTEST = 2e-3  # faster calls are repeated until they take this long


@dataclass(frozen=True)
class Point:
    """One method at one size.

    Parameters
    ----------
    method, unit : str
        Name of the method, and what its size counts.
    size : float
        Its size, in that unit.
    rms : ndarray
        Root mean square relative error over the seeds, shape (separations,).
    rms_stderr : float
        Relative uncertainty of `rms`; 0 where nothing is random.
    cpu, wall : float
        Median seconds: CPU time of all cores together, and wall-clock time.
    peak : float
        Bytes of additional memory; nan where the system does not report it.
    seeds : int
        How many runs.
    """

    method: str
    unit: str
    size: float
    rms: Array
    rms_stderr: float
    cpu: float
    wall: float
    peak: float
    seeds: int


@dataclass(frozen=True, repr=False)
class Tradeoff(Shown):
    """Result of the study.

    Parameters
    ----------
    scene : Scene
        As studied.
    separations : tuple of float
        Where errors were taken, of the scene's first quantity.
    points : tuple of Point
        Every method at every size.
    methods : tuple of Method
        All of them.
    ways : tuple of Way
        Pairs of sampler and accuracy: time and error of the values of single surfaces.
    advice : tuple of Advice
        What to run for a mean, a quantile, or values; the first two at the last of the separations.
    seconds : float
        How long the study took.
    """

    scene: Scene
    separations: tuple[float, ...]
    points: tuple[Point, ...]
    methods: tuple[Method, ...]
    ways: tuple[Way, ...]
    advice: tuple[Advice, ...]
    seconds: float

    def of(self, method: str) -> list[Point]:
        """Points of one method, by size."""
        return [point for point in self.points if point.method == method]

    def plot(self, ax: Any = None, *, separation: float | None = None) -> Any:
        """Draw error against time.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; default: new ones.
        separation : float, optional
            One of `separations`; default: the last.

        Returns
        -------
        matplotlib.axes.Axes
            With labels and a legend.

        Raises
        ------
        ValueError
            If no errors were taken at that separation.
        """
        h = self.separations[-1] if separation is None else separation
        if h not in self.separations:
            raise ValueError(
                f"separation = {h:g}: give one of {', '.join(f'{x:g}' for x in self.separations)}"
            )
        return plotted(self, ax, k=self.separations.index(h))

    def sheet(self) -> Sheet:
        """What to run for each goal."""
        quantity, h = self.scene.quantities[0], f"{self.separations[-1]:g}"
        facts = [("mean, quantile", f"of the {quantity} at d/sigma = {h}, in 95 of 100 ensembles")]
        a = self.advice
        asked = [x.scene.sampler for x in a]
        columns = (
            Column("wish", [x.wish.text for x in a], "wanted, relative error"),
            Column(
                "sampler",
                [s if s == x.sampler else f"{s}: {x.sampler}" for s, x in zip(asked, a, strict=True)],
            ),
            Column("accuracy", [x.scene.accuracy for x in a], form="g"),
            Column("law_error", [x.scene.law_error for x in a], form="g"),
            Column("n_surfaces", [x.scene.n_surfaces for x in a], form="d"),
            Column("seconds", [x.seconds for x in a], form=".2g"),
        )
        return Sheet("Recommended", facts, Table(columns))

    def table(self) -> Table:
        """Errors and time of every method at every size."""
        p = self.points
        errors = (
            Column(f"rms_relative_error_at_h_{h:g}", [x.rms[k] for x in p], f"at {h:g}", form=".2e")
            for k, h in enumerate(self.separations)
        )
        title = f"root mean square relative error of the mean {self.scene.quantities[0]} at d/sigma"
        columns = (
            Column("method", [x.method for x in p]),
            Column("size", [x.size for x in p], form=".3g"),
            Column("size_counts", [x.unit for x in p], "of"),
            *errors,
            Column("rms_uncertainty", [x.rms_stderr for x in p], "+-", form=".0%"),
            Column("cpu_s", [x.cpu for x in p], "CPU (s)", form=".2e"),
            Column("wall_s", [x.wall for x in p], "wall (s)", form=".2e"),
            Column("peak_growth_bytes", [x.peak for x in p], "memory (B)", form=".2g"),
            Column("seeds", [x.seeds for x in p], form="d"),
        )
        return Table(columns, title)

    def ways_table(self) -> Table:
        """Time and error of the values of single surfaces, for every pair of sampler and accuracy."""
        w = self.ways
        columns = (
            Column("sampler", [x.sampler for x in w]),
            Column("accuracy", [x.scene.accuracy for x in w], form="g"),
            Column("law_error", [x.scene.law_error for x in w], form="g"),
            Column("error", [x.error for x in w], form=".1e"),
            Column("s_per_surface", [x.each for x in w], "s a surface", form=".2e"),
            Column("set_up_s", [x.set_up for x in w], "s before", form=".2g"),
        )
        title = "values of single surfaces (largest relative error of a few surfaces, seconds by the clock)"
        return Table(columns, title)


class _Task:
    """A method at a size, with its runs."""

    def __init__(self, method: Method, size: float, peak: float, repeat: int) -> None:
        self.method, self.size, self.peak, self.repeat = method, size, peak, repeat
        self.errors: list[Array] = []
        self.cpu: list[float] = []
        self.wall: list[float] = []

    def run(self, seed: int) -> None:
        cpu, wall = process_time(), perf_counter()
        for _ in range(self.repeat):
            errors = self.method.errors(self.size, seed)
        self.cpu.append((process_time() - cpu) / self.repeat)
        self.wall.append((perf_counter() - wall) / self.repeat)
        self.errors.append(errors)

    def point(self) -> Point:
        random = float(np.ptp(np.array(self.errors), axis=0).max()) > 0
        rms = np.sqrt(np.mean(np.square(self.errors), axis=0))
        spread = 1 / np.sqrt(2 * len(self.errors)) if random else 0.0
        cpu, wall = float(np.median(self.cpu)), float(np.median(self.wall))
        n = len(self.errors)
        return Point(self.method.name, self.method.unit, self.size, rms, spread, cpu, wall, self.peak, n)


def tradeoff(
    scene: Scene, *, seconds: float | str | None = None, progress: Progress = None, **changes: Any
) -> Tradeoff:
    """Measure error against time of every method for the first quantity of a scene.

    Everything is warmed up, then all methods and sizes run in turn, with a new seed each round, until
    the time is used up; medians over the rounds are given.

    Parameters
    ----------
    scene : Scene
        What to simulate.
    seconds : float or str, optional
        Bound of the whole study, s or text such as "5 min", default: 60; it is kept to within the last run.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) seconds.
    **changes
        Fields of the scene to change: see `mcgw.Scene.replace`.

    Returns
    -------
    Tradeoff
        Points and advice.

    Raises
    ------
    SceneError, TypeError
        If `seconds` is not positive; and as from `mcgw.Scene.replace`.
    ValueError
        If summits are located.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> study = mcgw.tradeoff(mcgw.Scene(surface, separations=[0, 1], seed=1), seconds=0.1)
    >>> study.advice[0].wish.text
    'a mean to 0.1'
    """
    limit = argument("seconds", SECONDS if seconds is None else seconds, "s")
    started = monotonic()
    check_object("tradeoff", scene, Scene)
    scene = scene_alone(replace(scene.replace(**changes), rel_err=None, max_seconds=None))
    chosen = _chosen(scene)
    methods = methods_for(scene, chosen)
    with told(progress, "s") as tell:

        def note() -> None:
            tell(min(monotonic() - started, limit), limit)

        ways = []
        for way in ways_for(scene):
            ways.append(way)
            note()
            if monotonic() - started > limit / 2:
                break
        tasks: list[_Task] = []
        for method in methods:
            note()
            tasks += _sized(method, limit / (2 * _ROUNDS * len(methods)), scene.seed)
        for number in range(1, _MOST_ROUNDS + 1):
            for task in tasks:
                if monotonic() - started < limit or not task.errors:
                    task.run((scene.seed + 7919 * number + 104729) % 2**64)
            note()
    points = tuple(task.point() for task in tasks)
    h = tuple(scene.separations[k] for k in chosen)
    advice = advise(scene, h[-1], ways)
    ways.sort(key=lambda way: (way.sampler, way.scene.accuracy, way.scene.law_error))
    return Tradeoff(scene, h, points, methods, tuple(ways), advice, monotonic() - started)


def _chosen(scene: Scene) -> tuple[int, ...]:
    """The lowest, a middle and the highest separation that any of 1e9 asperities reaches."""
    order = np.argsort(scene.separations, kind="stable")
    share = scene.heights.sf(np.array(scene.separations))[order]
    reached = order[share > 1e-9] if (share > 1e-9).any() else order[:1]
    return tuple(int(k) for k in dict.fromkeys(reached[[0, len(reached) // 2, -1]]))


def _sized(method: Method, longest: float, seed: int) -> list[_Task]:
    """Sizes within the time limit, each run once to warm up and to measure its memory."""
    tasks: list[_Task] = []
    before = 0.0
    for size in method.sizes:
        if len(tasks) >= _FEWEST_SIZES and before > longest:
            break
        method.errors(size, seed)
        start = perf_counter()
        peak = peak_growth(partial(method.errors, size, seed))
        before = perf_counter() - start
        tasks.append(_Task(method, size, peak, max(1, min(100, int(_SHORTEST / before)))))
    return tasks
