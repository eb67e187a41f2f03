"""Error against time of one scene on this machine: which answer, how exact, at what cost.

The ladder of models, from one formula to boundary elements, is of the conductance (C rho, or the stiffness)
at a given load: its measured error against elasticity is in the error budget of a solution, and
`mcgw.elastic` gives it for surfaces with a spectrum.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, fields
from itertools import groupby
from math import hypot, isnan
from operator import attrgetter
from time import monotonic
from typing import Any
from warnings import catch_warnings, simplefilter

import numpy as np

from analytic import MeasuredHeights, MeasuredRadii
from mcgw.ensemble.forecast import in_words
from mcgw.errors import RunError
from mcgw.formats.table import Column, Drawn, Table
from mcgw.machine.process import Progress, told
from mcgw.scene.kinds import argument, check_object
from mcgw.scene.scene import Scene
from mcgw.statistics.measured_ways import REPEATS, Answers, Point, moved, prices, sized
from mcgw.statistics.ways import SOLVE, TARGETS, WANTS, Advice, Way, advise, of_one, sampled_ways
from mcgw.validity.model_error import percent

SECONDS = 60.0
_EXACT = 1e-12  # error of values that are right to the last digits
_PIXELS = 0.02  # error of boundary elements on the maps of `mcgw.elastic`: see `mcgw.elasticity.sources`
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
    ladder : tuple of Rung
        Whole errors, of surfaces and of the model, from one formula to boundary elements.
    worth : str
        Where more surfaces stop to help.
    seconds : float
        How long the study took.
    """

    scene: Scene
    load: float
    points: tuple[Point, ...]
    ways: tuple[Way, ...]
    ladder: tuple[Rung, ...]
    worth: str
    seconds: float

    def advice(self, want: str, target: float) -> Advice:
        """Choose the cheapest way to one of `ways.WANTS` within a relative error, a 95 % bound."""
        return advise(want, target, self.ways, self.scene)

    def words(self, want: str) -> str:
        """Name of an answer."""
        if want not in WANTS:
            raise ValueError(f"want = {want!r}: give one of {', '.join(WANTS)}")
        return WANTS[want].format(self.scene.quantities[0])

    @property
    def sentence(self) -> str:
        """What to do for the mean and the quantile, in one sentence."""
        parts = []
        for want in ("mean", "quantile"):
            found, said = self.advice(want, 1e-3), "is out of reach"
            if found.way:
                drawn = f"to 0.1 % takes {found.n_surfaces} surfaces by {found.way.name}, "
                said = (drawn if found.way.draws else "needs no surfaces: ") + in_words(found.seconds)
            parts.append(f"the {self.words(want)} {said}")
        text = "; ".join(parts)
        return f"{text[0].upper()}{text[1:]}."

    def sheet(self, targets: Sequence[float] = (1e-2,)) -> Table:
        """Return what to run for each answer; targets with one and the same way in one row."""
        at = f"d/sigma = {self.scene.separations[0]:g}; an error is a 95 % bound, 1.96 standard errors"
        facts = [("at", at), ("do", self.sentence), ("model", self.worth)]
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
        columns = (
            Column("want", [self.words(x.want) for x in first]),
            Column("error_95", errors, "95 %"),
            Column("way", [x.way.name if x.way else "none" for x in first], "cheapest"),
            Column("n_surfaces", [str(x.n_surfaces or "") for x in first]),
            Column("cpu_s", [x.seconds for x in first], "CPU (s)", form=".2g", missing=""),
            Column("type", [x.code(self.scene, self.load) for x in first]),
        )
        return Table(columns)

    def measurements(self) -> Table:
        """Errors and times of every way at every size."""
        named = ((x.name, [getattr(point, x.name) for point in self.points]) for x in fields(Point))
        return Table(tuple(Column(name, values, form=".3g") for name, values in named))


def tradeoff(
    scene: Scene,
    *,
    separation: float | None = None,
    seconds: float | str | None = None,
    progress: Progress = None,
    **changes: Any,
) -> Tradeoff:
    """Measure what each answer of a scene costs on this machine, and how exact it is.

    Parameters
    ----------
    scene : Scene
        What to simulate; its first quantity is studied.
    separation : float, optional
        Where, d/sigma; default: the middle one of the scene's.
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
    limit = argument("seconds", SECONDS if seconds is None else seconds, "s")
    started = monotonic()
    check_object("tradeoff", scene, Scene)
    whole = scene.replace(**changes)
    if isinstance(whole.summits, MeasuredRadii):
        raise ValueError("summits: listed summits are summed or drawn, and have no other method")
    if isinstance(whole.heights, MeasuredHeights):
        raise ValueError("heights: measured heights are summed exactly; no answer is traded off")
    h = sorted(whole.separations)[(len(whole.separations) - 1) // 2] if separation is None else separation
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
    ladder = tuple(ladder_of(whole, scene, answers.load, ways, float(known.error["stiffness"][0])))
    said = worth(ladder, known.unknown or "not measured")
    return Tradeoff(scene, answers.load, points, ways, ladder, said, monotonic() - started)


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
    yield Rung("formula", 0, by["theory"].seconds(0), by["theory"].floor, model)
    for n in (2, 10, 100, 1000, 10_000, 100_000) if SOLVE in by else ():
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
    rows = [solves.at(LEVELS, number) for number in range(4)]  # maps on which levels are compared
    values, seconds = (np.array(part) for part in zip(*rows, strict=True))
    solve = float(np.median(seconds[:, -1]))
    for target in (0.1, 0.03, 0.01):
        planned = design(values, [level.cost for level in LEVELS], target)
        yield Rung("boundary elements", planned.maps[-1], planned.cost * solve, target, _PIXELS)
