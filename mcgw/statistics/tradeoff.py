"""Error against time of one scene on this machine: which answer, how exact, at what cost.

Beside the conductance (C rho, or the stiffness) at a load stands the measured error of the model against
elasticity, beyond which more surfaces do not help.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from itertools import groupby
from math import ceil, isnan, log10, nan, sqrt
from operator import attrgetter
from time import monotonic
from typing import Any
from warnings import catch_warnings, simplefilter

from analytic import MeasuredHeights, MeasuredRadii
from mcgw.ensemble.simulation import MOST_SURFACES, in_words
from mcgw.formats.table import Column, Drawn, Table
from mcgw.machine.progress import Progress, told
from mcgw.scene.kinds import argument, check_object
from mcgw.scene.scene import Scene
from mcgw.statistics.measured_ways import REPEATS, Answers, Point, moved, prices, sized
from mcgw.statistics.ways import TARGETS, WANTS, Advice, Way, of_one, sampled_ways, surfaces_for
from mcgw.validity.model_error import percent

_FASTER = 1.5  # a way must be so much faster than one named before it
_EXACT = 1e-12  # error of values that are right to the last digits
_ENOUGH = 1.05  # times the error of the model, together with that of surfaces: more are not worth it


@dataclass(frozen=True, repr=False)
class Tradeoff(Drawn):
    """Result of the study.

    Parameters
    ----------
    scene : Scene
        As studied: of one separation and one quantity.
    load : float
        Mean load there, N.
    points : tuple of Point
        What was measured.
    ways : tuple of Way
        Prices of all ways to all answers.
    model : float
        Measured error of the model against elasticity, of the conductance at its load; nan if not known.
    worth : str
        Where more surfaces stop to help.
    seconds : float
        How long the study took.
    """

    scene: Scene
    load: float
    points: tuple[Point, ...]
    ways: tuple[Way, ...]
    model: float
    worth: str
    seconds: float

    def advice(self, want: str, target: float) -> Advice:
        """Choose the cheapest way to one of `ways.WANTS` within a relative error, a 95 % bound."""
        best = Advice(want, target, None, 0, nan)
        for way in (way for way in self.ways if way.want == want and way.floor <= target):
            n = surfaces_for(self.scene, want, target - way.floor) if way.draws else 0
            seconds = way.seconds(n)
            if n <= MOST_SURFACES and (best.way is None or seconds * _FASTER < best.seconds):
                best = Advice(want, target, way, int(n), seconds)
        return best

    def words(self, want: str) -> str:
        """Name of an answer."""
        if want not in WANTS:
            raise ValueError(f"want = {want!r}: give one of {', '.join(WANTS)}")
        return WANTS[want].format(self.scene.quantities[0])

    def sheet(self, targets: Sequence[float] = (1e-2,)) -> Table:
        """Return what to run for each answer; targets with one and the same way in one row."""
        scene = self.scene
        facts = [
            ("at", f"d/sigma = {scene.separations[0]:g}; an error is a 95 % bound, 1.96 standard errors"),
            ("model", self.worth),
        ]
        table = self._rows(targets, ("want", "way", "n_surfaces"))
        return Table(table.columns[: None if len(targets) > 1 else -1], "Speed and accuracy", facts)

    def table(self) -> Table:
        """For each answer and error the cheapest way, its surfaces, its time, and what to type."""
        return self._rows(TARGETS, ("want", "target"))

    def _rows(self, targets: Sequence[float], alike: tuple[str, ...]) -> Table:
        found = [self.advice(want, target) for want in WANTS for target in targets]
        groups = [[*group] for _, group in groupby(found, attrgetter(*alike))]
        first, errors = [group[0] for group in groups], []
        for x, last in zip(first, (group[-1].target for group in groups), strict=True):
            exact = x.want == "values" and x.way and x.way.floor <= _EXACT
            span = f"{x.target:g}" if x.target == last else f"{x.target:g} ... {last:g}"
            errors.append("exact" if exact else span)
        drawn = [x.way is not None and x.way.draws for x in first]
        columns = (
            Column("want", [self.words(x.want) for x in first]),
            Column("error_95", errors, "95 %"),
            Column("way", [x.way.name if x.way else "none" for x in first], "cheapest"),
            Column("n_surfaces", [f"{x.n_surfaces:d}" * some for x, some in zip(first, drawn, strict=True)]),
            Column("cpu_s", [x.seconds for x in first], "CPU (s)", form=".2g", missing=""),
            Column("type", [x.code(self.scene, self.load) for x in first]),
        )
        return Table(columns)

    def measurements(self) -> Table:
        """Errors and times of every way at every size."""
        names = [each.name for each in fields(Point)]
        return Table(tuple(Column(x, [getattr(p, x) for p in self.points], form=".3g") for x in names))


def tradeoff(
    scene: Scene,
    *,
    seconds: float | str | None = None,
    progress: Progress = None,
    **changes: Any,
) -> Tradeoff:
    """Measure what each answer of a scene costs on this machine, and how exact it is.

    Parameters
    ----------
    scene : Scene
        What to simulate; its first quantity is studied, at the middle one of its separations.
    seconds : float or str, optional
        Time of the study, s or text such as "5 min", default: 60. Sizes are chosen for it; 16 repeats of the
        smallest are made even if that takes longer.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) seconds.
    **changes
        Fields of the scene to change: see `mcgw.Scene.replace`.

    Returns
    -------
    Tradeoff
        Prices, what to run, and where more surfaces stop to help.

    Raises
    ------
    SceneError, TypeError
        If `seconds` is not positive; and as from `mcgw.Scene.replace`.
    ValueError
        If summits are used as measured, or the mean is 0.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> study = mcgw.tradeoff(mcgw.Scene(surface, separations=1, seed=1), seconds=0.1)
    >>> study.advice("mean", 1e-3).way.name
    'theory'
    """
    limit = argument("seconds", 60.0 if seconds is None else seconds, "s")
    started = monotonic()
    check_object("tradeoff", scene, Scene)
    whole = scene.replace(**changes)
    if isinstance(whole.summits, MeasuredRadii):
        raise ValueError("summits: listed summits are summed or drawn, and have no other method")
    if isinstance(whole.heights, MeasuredHeights):
        raise ValueError("heights: measured heights are summed exactly; no answer is traded off")
    h = sorted(whole.separations)[(len(whole.separations) - 1) // 2]
    scene = whole.replace(
        separations=(float(h),), quantities=whole.quantities[:1], keep="sums",
        interaction=None, rel_err=None, max_seconds=None,
    )  # fmt: skip
    answers, names = Answers(scene), sampled_ways(scene)
    with told(progress, "s") as tell, catch_warnings():
        tell(0, limit)
        simplefilter("ignore", UserWarning)  # of ways that take long, which is what is asked
        tasks = [*answers.without_surfaces()]
        for name in names:
            tasks += sized(answers, name, limit / (2 * len(names)))
        number = 0
        while number < REPEATS or monotonic() - started < limit:
            number += 1
            for task in tasks:
                task.run(moved(scene, number), limit / REPEATS)
            tell(min(monotonic() - started, limit), limit)
        points = tuple(point for task in tasks for point in task.points())
        ways = tuple(prices(scene, points, names))
    known = whole.validity([h])
    model = float(known.error["stiffness"][0])
    theory = next(way for way in ways if (way.name, way.want) == ("theory", "conductance"))
    said = worth(scene, theory, model, known.unknown or "not measured")
    return Tradeoff(scene, answers.load, points, ways, model, said, monotonic() - started)


def worth(scene: Scene, theory: Way, model: float, unknown: str) -> str:
    """Say where more surfaces stop to help the conductance, or why the error of the model is not known.

    Of a scene of one separation, where the model is so far off, and its conductance by theory.
    """
    if isnan(model):
        return f"The error of the model is not known here: {unknown}."
    said, enough = f"The model is off by {percent(model)}", model * sqrt(_ENOUGH**2 - 1)
    if theory.floor <= enough:
        return f"{said}; theory, {in_words(theory.seconds(0))}, is as good as any number of surfaces."
    decades = ceil(2 * log10(of_one(scene, "conductance") / enough))
    return f"{said}; more than {10**decades} surfaces do not help."
