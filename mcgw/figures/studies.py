"""Figures of the two studies of a scene: its convergence test, and error against time."""

from pathlib import Path
from textwrap import wrap
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from mcgw.figures.panels import write_around
from mcgw.figures.style import (
    BAND,
    HOMOGENEOUS,
    LEVEL,
    MONTE_CARLO,
    SAMPLE,
    STYLE,
    THEORY,
    look,
    save_figure,
    shown_title,
)
from mcgw.statistics.checks import Slope
from mcgw.statistics.convergence import Convergence
from mcgw.statistics.measured_ways import Point
from mcgw.statistics.prices import SOLVE, WANTS
from mcgw.statistics.tradeoff import Tradeoff
from mcgw.statistics.verdict import FALSE_ALARM

_TITLES = {"M": "surfaces $M$", "N": "asperities $N$"}
_FLOOR = 1e-14
_TWO = 1.96  # standard errors that 95 of 100 keep
_KINDS = ("cells", "tail", "aggregate", "direct")
_COLOURS = {kind: look(kind)["color"] for kind in _KINDS}
_MARKERS = {kind: look(kind)["marker"] for kind in _KINDS}
_RULES: dict[str, dict[str, Any]] = {
    "theory": {"color": THEORY, "marker": "*"},
    "exact law": {"color": HOMOGENEOUS, "marker": "P"},
    SOLVE: {"color": _COLOURS["tail"], "marker": "o"},
}
_LADDER = {
    "formula": (THEORY, "*"), "surfaces": (_COLOURS["tail"], "s"), "boundary elements": (HOMOGENEOUS, "D"),
}  # fmt: skip


def save_convergence(found: Convergence, path: str | Path) -> None:
    """Draw a convergence test.

    Parameters
    ----------
    found : Convergence
        From `mcgw.statistics.convergence.converge`.
    path : str or Path
        The ending chooses the format: .png, .pdf, .svg.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10, 7), layout="constrained")
        parts: Any = figure.subfigures(2, 1, height_ratios=[1.1, 1])
        top, bottom = parts
        axes = dict(zip("MNz", top.subplots(1, 3), strict=True))
        drawn = {curve.against for curve in found.slopes}
        for curve in found.slopes:
            _draw_slope(axes[curve.against], curve)
        for name in {"M", "N"} - drawn:
            _say(axes[name], f"slope in {name}: too few contacts")
        _draw_scores(axes["z"], found.scores)
        draw_checks(bottom.subplots(), found)
        write_around(
            figure,
            f"{shown_title(found.scene, 'Scene')}\n"
            f"Statistical convergence {found.word}: p = {found.p:.3g} over "
            f"{len(found.checks)} checks (false alarms: 1 in {1 / FALSE_ALARM:.0f})",
        )
        save_figure(figure, path)


def _say(axis: Any, text: str) -> None:
    axis.text(0.5, 0.5, text, ha="center", va="center", transform=axis.transAxes)
    axis.set_axis_off()


def _draw_slope(axis: Any, curve: Slope) -> None:
    fit = np.exp(np.mean(np.log(curve.errors) + np.log(curve.sizes) / 2)) / np.sqrt(curve.sizes)
    axis.loglog(curve.sizes, fit, color=THEORY, label="slope −1/2")
    axis.errorbar(
        curve.sizes, curve.errors, 1.96 * curve.stderr * curve.errors, fmt="o", ms=4, mfc="none",
        color=MONTE_CARLO, label="measured, 95 %",
    )  # fmt: skip
    axis.set_xlabel(_TITLES[curve.against])
    axis.set_ylabel("rms error (standard deviations)" if curve.against == "M" else "rms relative error")
    slope = f"{curve.value:.4f}".replace("-", "−")
    axis.set_title(f"slope {slope} ± {1.96 * curve.uncertainty:.4f}", loc="left")
    axis.legend(loc="lower left")


def _draw_scores(axis: Any, z: np.ndarray) -> None:
    if not z.size:
        _say(axis, "z-scores: too few contacts")
        return
    edges = np.linspace(-4, 4, 25)
    axis.hist(np.clip(z, -4, 4), edges, density=True, color=SAMPLE, label=f"{z.size} means")
    x = np.linspace(-4, 4, 201)
    axis.plot(x, np.exp(-(x**2) / 2) / np.sqrt(2 * np.pi), color=THEORY, label="standard normal")
    axis.set_ylim(0, 0.58)
    axis.set(xlabel="error of a mean (exact standard errors)", ylabel="density")
    axis.set_title("z-scores", loc="left")
    axis.legend(loc="upper center", ncols=2, handlelength=1.2, columnspacing=1)


def draw_checks(axis: Any, found: Convergence) -> None:
    """The probability of every check."""
    floor = 1e-12
    names = [check.name for check in found.checks]
    p = np.array([max(check.p, floor) for check in found.checks])
    limit = FALSE_ALARM / len(p)
    rows = np.arange(len(p))[::-1]
    axis.axvspan(floor / 10, limit, color=BAND, zorder=0)
    axis.hlines(rows, p, 1, color="0.7", lw=1)
    failed = p <= limit
    for some, color, marker in ((~failed, THEORY, "o"), (failed, MONTE_CARLO, "X")):
        axis.scatter(p[some], rows[some], color=color, marker=marker, s=28, zorder=3)
    axis.set_xscale("log")
    axis.set_xlim(floor / 3, 2.5)
    axis.set_yticks(rows, names, fontsize=8)
    axis.set_ylim(-0.7, len(names) - 0.3)
    axis.grid(visible=False, axis="y")
    axis.set_xlabel("probability by chance; grey: fails (the far left stands for all below 10⁻¹²)")


def save_tradeoff(found: Tradeoff, path: str | Path) -> None:
    """Draw error against time, a panel for each answer, and the ladder of models below.

    Parameters
    ----------
    found : Tradeoff
        From `mcgw.statistics.tradeoff.tradeoff`.
    path : str or Path
        The ending chooses the format: .png, .pdf, .svg.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10, 10.5), layout="constrained")
        parts: Any = figure.subfigures(2, 1, height_ratios=[2, 1.1])
        top, bottom = parts
        axes = top.subplots(2, 3, sharex=True)
        for axis, want in zip(axes.flat, WANTS, strict=True):
            draw_errors(axis, found, want)
        handles = {h.get_label(): h for axis in axes.flat for h in axis.get_legend_handles_labels()[0]}
        top.legend(handles=[*handles.values()], loc="outside lower center", ncols=6, fontsize=8)
        write_around(top, f"{shown_title(found.scene, 'Speed and accuracy')}\n{found.sentence}")
        draw_ladder(bottom.subplots(), found)
        bottom.suptitle(_wrapped(found.ladder.sentence), fontsize=10)
        save_figure(figure, path)


def draw_errors(axis: Any, found: Tradeoff, want: str) -> None:
    """95 % bounds against time: measured points, lines of the expected slope, and ways without draws."""
    axis.set(xscale="log", yscale="log", ylim=(_FLOOR / 3, 3), ylabel="error (95 % bound)")
    axis.set_xlabel("CPU time (s)")
    kept = [way for way in found.ways if way.want == want and way.measured]
    for way in kept:
        own = _look_of(way.name)
        if not way.draws or want == "values":
            seconds, floor = way.seconds(found.scene.n_surfaces), max(way.floor, _FLOOR)
            axis.plot(seconds, floor, ls="", ms=6, label=way.name, **own)
            if not way.draws:
                axis.axhline(floor, color=own["color"], lw=0.8, ls=":")
        else:
            points = [p for p in found.points if (p.way, p.want) == (way.name, want) and p.n_surfaces]
            _draw_points(axis, points, own, way.name)
    if not kept:
        some = any(way.want == want for way in found.ways)
        why = "takes longer than the study" if some else "no way to it"
        axis.text(0.5, 0.5, why, ha="center", va="center", transform=axis.transAxes)
    title = found.words(want)
    axis.set_title(f"{title} ({found.scene.n_surfaces})" if want == "values" else title)


def _draw_points(axis: Any, points: list[Point], own: dict[str, Any], name: str) -> None:
    """Measured errors of growing numbers of surfaces, and the line that falls with the root of these."""
    if not points:
        return
    seconds, size = [p.seconds for p in points], np.array([p.n_surfaces for p in points])
    error, bars = [_TWO * p.rms for p in points], [_TWO**2 * p.stderr for p in points]
    of_one = np.exp(np.mean(np.log(error) + np.log(size) / 2))
    axis.plot(seconds, of_one / np.sqrt(size), color=own["color"], lw=1)
    axis.errorbar(seconds, error, bars, ls="", ms=4, label=name, **own)


def _look_of(name: str) -> dict[str, Any]:
    """Colour and marker of a way."""
    if name in _RULES:
        return _RULES[name]
    return {"color": _COLOURS[name], "marker": _MARKERS[name]}


def draw_ladder(axis: Any, found: Tradeoff) -> None:
    """Whole errors of the conductance at a load against time, model by model; their parts as thin lines."""
    for k, name in enumerate(dict.fromkeys(rung.name for rung in found.ladder.rungs)):
        rungs = [rung for rung in found.ladder.rungs if rung.name == name]
        time, many = [r.seconds for r in rungs], len(rungs) > 1
        known = not np.isnan(rungs[0].model)
        whole = [r.whole if known else r.drawn for r in rungs]
        color, marker = _LADDER[name]
        axis.plot(time, whole, color=color, marker=marker, ms=5, ls="-" if many else "", label=name)
        if many and known:
            axis.plot(time, [r.drawn for r in rungs], color=color, lw=0.8, ls=":")
        for r in rungs if many else ():
            axis.annotate(
                f"{r.n_surfaces:g}", (r.seconds, r.whole if known else r.drawn), (0, 5),
                textcoords="offset points", fontsize=7, ha="center",
            )  # fmt: skip
        if k == 0 and known:
            axis.axhline(rungs[0].model, color=LEVEL, lw=1, label="error of the model")
    axis.set(xscale="log", yscale="log", xlabel="CPU time (s)", ylabel="whole error (95 % bound)")
    axis.set_title(
        "Conductance at its load, by numbers of surfaces or maps; dotted: without the model", fontsize=9
    )
    axis.legend(loc="center left", bbox_to_anchor=(1, 0.5), fontsize=8)


def _wrapped(sentence: str) -> str:
    """Lines of a title."""
    return "\n".join(wrap(sentence, 120)).replace("$", r"\$")
