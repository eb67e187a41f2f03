"""Error against time of one scene on this machine: which answer, how exact, at what cost."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, fields
from itertools import groupby
from operator import attrgetter
from time import monotonic
from typing import Any

from analytic import MeasuredHeights, MeasuredRadii
from mcgw.ensemble.drawing import in_words
from mcgw.ensemble.half_space import scene_alone
from mcgw.formats.table import Column, Shown, Table
from mcgw.machine.progress import Progress, told
from mcgw.machine.terminal import plotted
from mcgw.scene.arguments import argument, check_object
from mcgw.scene.scene import Scene
from mcgw.statistics.ladder import Ladder, ladder_of
from mcgw.statistics.measured_ways import REPEATS, Answers, Point, moved, prices, sized
from mcgw.statistics.prices import PROBABILITY, TARGETS, WANTS, Advice, Needs, Way, advise, sampled_ways

SECONDS = 60.0
_SHOWN = (1e-2,)
_EXACT = 1e-12  # error of values that are right to the last digits
WORDS = {
    "mean": "mean {}", "std": "standard deviation", "quantile": f"{PROBABILITY:.0%} quantile",
    "distribution": "distribution", "conductance": "conductance at its load", "values": "values of surfaces",
}  # fmt: skip


@dataclass(frozen=True, repr=False)
class Tradeoff(Shown):
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
    ladder : Ladder
        Whole errors, of surfaces and of the model, from one formula to boundary elements.
    seconds : float
        How long the study took.
    """

    scene: Scene
    load: float
    points: tuple[Point, ...]
    ways: tuple[Way, ...]
    ladder: Ladder
    seconds: float

    def advice(self, want: str, target: float) -> Advice:
        """Choose the cheapest way to one of `prices.WANTS` within a relative error, a 95 % bound."""
        return advise(want, target, list(self.ways), Needs(self.scene))

    def words(self, want: str) -> str:
        """Name of an answer."""
        return WORDS[want].format(self.scene.quantities[0])

    def plot(self, ax: Any = None, *, want: str = "mean") -> Any:
        """Draw error against time of one of the answers.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; default: new ones.
        want : str, optional
            "mean", "std", "quantile", "distribution", "conductance" or "values".

        Returns
        -------
        matplotlib.axes.Axes
            With labels and a legend.
        """
        if want not in WANTS:
            raise ValueError(f"want = {want!r}: give one of {', '.join(WANTS)}")
        return plotted(self, ax, want=want)

    @property
    def sentence(self) -> str:
        """What to do for the mean and the quantile, in one sentence."""
        parts = []
        for want in ("mean", "quantile"):
            found = self.advice(want, 1e-3)
            if found.way is None:
                parts.append(f"the {self.words(want)} is out of reach")
            elif found.way.draws:
                n = f"{found.n_surfaces} surfaces by {found.way.name}, {in_words(found.seconds)}"
                parts.append(f"the {self.words(want)} to 0.1 % takes {n}")
            else:
                parts.append(f"the {self.words(want)} needs no surfaces: {in_words(found.seconds)}")
        text = "; ".join(parts)
        return f"{text[0].upper()}{text[1:]}."

    def sheet(self, targets: Sequence[float] = _SHOWN) -> Table:
        """Return what to run for each answer; targets with one and the same way in one row."""
        scene = self.scene
        facts = [
            ("at", f"d/sigma = {scene.separations[0]:g}; an error is a 95 % bound, 1.96 standard errors"),
            ("do", self.sentence),
            ("model", self.ladder.sentence),
        ]
        table = self._rows(targets, ("want", "way", "n_surfaces"))
        return Table(table.columns[: None if len(targets) > 1 else -1], "Speed and accuracy", facts)

    def table(self) -> Table:
        """For each answer and error the cheapest way, its surfaces, its time, and what to type."""
        return self._rows(TARGETS, ("want", "target"))

    def _rows(self, targets: Sequence[float], alike: tuple[str, ...]) -> Table:
        found = [self.advice(want, target) for want in WANTS for target in targets]
        groups = [[*group] for _, group in groupby(found, attrgetter(*alike))]
        first = [group[0] for group in groups]
        drawn = [f"{x.n_surfaces:d}" if x.way and x.way.draws else "" for x in first]
        columns = (
            Column("want", [self.words(x.want) for x in first]),
            Column("error_95", [_errors(group) for group in groups], "95 %"),
            Column("way", ["none" if x.way is None else x.way.name for x in first], "cheapest"),
            Column("n_surfaces", drawn),
            Column("cpu_s", [x.seconds for x in first], "CPU (s)", form=".2g", missing=""),
            Column("type", [x.code(self.scene, self.load) for x in first]),
        )
        return Table(columns)

    def measurements(self) -> Table:
        """Errors and times of every way at every size."""
        names = [each.name for each in fields(Point)]
        return Table(tuple(Column(x, [getattr(p, x) for p in self.points], form=".3g") for x in names))


def _errors(group: list[Advice]) -> str:
    """Targets of a row; "exact" where values are right to the last digits."""
    ends = " ... ".join(f"{x.target:g}" for x in (group[0], group[-1])[: len(group)])
    way = group[0].way
    return "exact" if group[0].want == "values" and way and way.floor <= _EXACT else ends


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
    whole = _refused(scene.replace(**changes))
    h = sorted(whole.separations)[(len(whole.separations) - 1) // 2] if separation is None else separation
    scene = scene_alone(whole).replace(
        separations=(float(h),), quantities=whole.quantities[:1], keep="sums",
        rel_err=None, max_seconds=None,
    )  # fmt: skip
    answers, names = Answers(scene), sampled_ways(scene)
    with told(progress, "s") as tell, warnings.catch_warnings():
        tell(0, limit)
        warnings.simplefilter("ignore", UserWarning)  # of ways that take long, which is what is asked
        tasks = [*answers.without_surfaces()]
        for name in names:
            tasks += sized(answers, name, scene, limit / (2 * len(names)))
        number = 0
        while number < REPEATS or monotonic() - started < limit:
            number += 1
            for task in tasks:
                task.run(moved(scene, number), limit / REPEATS)
            tell(min(monotonic() - started, limit), limit)
        points = tuple(point for task in tasks for point in task.points())
        ways = prices(scene, points, names)
    ladder = ladder_of(whole, scene, answers.load, ways)
    return Tradeoff(scene, answers.load, points, tuple(ways), ladder, monotonic() - started)


def _refused(scene: Scene) -> Scene:
    """Return the scene, if its answers can be traded off."""
    if isinstance(scene.summits, MeasuredRadii):
        raise ValueError("summits: listed summits are summed or drawn, and have no other method")
    if isinstance(scene.heights, MeasuredHeights):
        raise ValueError("heights: measured heights are summed exactly; no answer is traded off")
    return scene
