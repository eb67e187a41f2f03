"""Figures of the two studies of a scene: its convergence test, and error against time."""

from itertools import groupby
from typing import Any

import numpy as np
from matplotlib.ticker import EngFormatter, NullLocator

from mcgw.figures.against_theory import residuals_panel
from mcgw.figures.data import FigureData, Panel, words
from mcgw.figures.style import BAND, HOMOGENEOUS, LEVEL, MONTE_CARLO, SEEN, THEORY, look, shown_title
from mcgw.statistics.checks import Slope
from mcgw.statistics.convergence import Convergence
from mcgw.statistics.tradeoff import Tradeoff
from mcgw.statistics.verdict import FALSE_ALARM
from mcgw.statistics.ways import SOLVE, WANTS, Way

_SURFACES, _ASPERITIES = "surfaces $M$", "asperities $N$"
_FLOOR, _LEAST = 1e-14, 1e-12  # errors and probabilities that are drawn
_TWO = 1.96  # standard errors that 95 of 100 keep
_TIME, _BOUND = "CPU time (s)", "error (95 % bound)"
_RULES: dict[str, dict[str, Any]] = {
    "theory": {"color": THEORY, "marker": "*"},
    "formula": {"color": THEORY, "marker": "*"},
    "exact law": {"color": HOMOGENEOUS, "marker": "P"},
    SOLVE: {"color": look("tail")["color"], "marker": "o"},
    "surfaces": {"color": look("tail")["color"], "marker": "s"},
    "boundary elements": {"color": HOMOGENEOUS, "marker": "D"},
}


def convergence_figure(found: Convergence) -> FigureData:
    """Slopes of the error, z-scores, and the probability of every check."""
    slopes = {curve.against: _slope_panel(curve) for curve in found.slopes}
    for name in {"M", "N"} - slopes.keys():
        slopes[name] = Panel("", "", "", paint=words(f"slope in {name}: too few contacts"))
    title = (
        f"{shown_title(found.scene, 'Scene')}\n"
        f"Statistical convergence {found.word}: p = {found.p:.3g} over "
        f"{len(found.checks)} checks (false alarms: 1 in {1 / FALSE_ALARM:.0f})"
    )
    few = Panel("", "", "", paint=words("z-scores: too few contacts"))
    scores = residuals_panel("z-scores", found.scores) if found.scores.size else few
    panels = (slopes["M"], slopes["N"], scores, checks_panel(found))
    return FigureData(title, "", panels)


def _slope_panel(curve: Slope) -> Panel:
    fit = np.exp(np.mean(np.log(curve.errors) + np.log(curve.sizes) / 2)) / np.sqrt(curve.sizes)
    of_m = curve.against == "M"

    def paint(axis: Any) -> None:
        bars = _TWO * curve.stderr * curve.errors
        axis.plot(curve.sizes, fit, color=THEORY, label="slope −1/2")
        look = SEEN | {"ms": 4, "fmt": "o", "label": "measured, 95 %"}
        axis.errorbar(curve.sizes, curve.errors, bars, **look)
        if not of_m:  # of less than a decade or two, with others named between
            axis.xaxis.set_minor_locator(NullLocator())
            axis.set_xticks(curve.sizes, [*map(EngFormatter(), curve.sizes)])

    title = f"slope {curve.value:.4f} ± {_TWO * curve.uncertainty:.4f}".replace("-", "−")
    ylabel = "rms error (standard deviations)" if of_m else "rms relative error"
    return Panel(title, _SURFACES if of_m else _ASPERITIES, ylabel, scales=("log", "log"), paint=paint)


def checks_panel(found: Convergence) -> Panel:
    """Return the probability of every check."""
    p = np.array([max(check.p, _LEAST) for check in found.checks])
    limit, rows = FALSE_ALARM / len(p), np.arange(len(p))[::-1]

    def paint(axis: Any) -> None:
        axis.axvspan(_LEAST / 10, limit, color=BAND, zorder=0)
        axis.hlines(rows, p, 1, color="0.7", lw=1)
        for some, color, marker in ((p > limit, THEORY, "o"), (p <= limit, MONTE_CARLO, "X")):
            axis.scatter(p[some], rows[some], color=color, marker=marker, s=28, zorder=3)
        axis.set(xlim=(_LEAST / 3, 2.5), ylim=(-0.7, len(p) - 0.3))
        axis.set_yticks(rows, [check.name for check in found.checks])

    label = "probability by chance; grey: fails (the far left stands for all below 10⁻¹²)"
    return Panel("", label, "", scales=("log", "linear"), paint=paint, wide=True)


def tradeoff_figure(found: Tradeoff) -> FigureData:
    """Error against time, a panel for each answer, and the ladder of models below."""
    title = f"{shown_title(found.scene, 'Speed and accuracy')}\n{found.sentence}"
    n, ways = found.scene.n_surfaces, found.ways
    times = [p.seconds for p in found.points]
    times += [way.seconds(n) for way in ways if way.want == "values" or not way.draws]
    within = min(times) / 2, 2 * max(times)
    panels = (*(errors_panel(found, want, xlim=within) for want in WANTS), _ladder_panel(found))
    return FigureData(title, found.worth, panels)


def errors_panel(found: Tradeoff, want: str, **limits: Any) -> Panel:
    """95 % bounds against time: measured points, lines of the expected slope, and ways without draws."""
    kept = [way for way in found.ways if way.want == want and way.measured]
    title = found.words(want) + f" ({found.scene.n_surfaces})" * (want == "values")
    if not kept:
        some = any(way.want == want for way in found.ways)
        why = "takes longer than the study" if some else "no way to it"
        return Panel(title, _TIME, _BOUND, paint=words(why))

    def paint(axis: Any) -> None:
        for way in kept:
            _draw_way(axis, way, found)
        axis.set(ylim=(_FLOOR / 3, 3), **limits)

    return Panel(title, _TIME, _BOUND, scales=("log", "log"), paint=paint)


def _draw_way(axis: Any, way: Way, found: Tradeoff) -> None:
    own = _RULES.get(way.name) or {key: look(way.name)[key] for key in ("color", "marker")}
    points = [p for p in found.points if (p.way, p.want) == (way.name, way.want) and p.n_surfaces]
    floor = max(way.floor, _FLOOR)
    if not way.draws or way.want == "values":
        axis.plot(way.seconds(found.scene.n_surfaces), floor, ls="", ms=6, label=way.name, **own)
    elif points:  # of growing numbers of surfaces, and the line that falls with the root of these
        columns = [(p.seconds, p.n_surfaces, p.rms, p.stderr) for p in points]
        time, size, error, stderr = np.array(columns).T
        of_one = np.exp(np.mean(np.log(_TWO * error) + np.log(size) / 2))
        axis.plot(time, of_one / np.sqrt(size), color=own["color"], lw=1)
        axis.errorbar(time, _TWO * error, _TWO**2 * stderr, ls="", ms=4, label=way.name, **own)
    if not way.draws:
        axis.axhline(floor, color=own["color"], lw=0.8, ls=":")


def _ladder_panel(found: Tradeoff) -> Panel:
    """Whole errors of the conductance at a load against time, model by model; their parts as thin lines."""
    model = found.ladder[0].model
    known = not np.isnan(model)

    def paint(axis: Any) -> None:
        if known:
            axis.axhline(model, color=LEVEL, lw=1, label="error of the model")
        for name, group in groupby(found.ladder, lambda rung: rung.name):
            rungs, own = [*group], _RULES[name]
            time, whole = [r.seconds for r in rungs], [r.whole if known else r.drawn for r in rungs]
            axis.plot(time, whole, **own, ms=5, ls="-" * (len(rungs) > 1), label=name)
            if len(rungs) == 1:
                continue
            if known:
                axis.plot(time, [r.drawn for r in rungs], color=own["color"], lw=0.8, ls=":")
            for r, *at in zip(rungs, time, whole, strict=True):
                text = f"{r.n_surfaces:g}"
                axis.annotate(text, at, (0, 5), textcoords="offset points", fontsize=7, ha="center")

    title = "conductance at its load, by numbers of surfaces or maps; dotted: without the model"
    whole_error = "whole error (95 % bound)"
    return Panel(title, _TIME, whole_error, scales=("log", "log"), paint=paint, wide=True)
