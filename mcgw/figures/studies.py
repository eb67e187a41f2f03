"""Figures of the two studies of a scene: its convergence test, and error against time."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from mcgw.figures.style import BACK, BAND, MONTE_CARLO, SAMPLE, STYLE, THEORY, look, save_figure, shown_title
from mcgw.statistics.checks import Slope
from mcgw.statistics.convergence import Convergence
from mcgw.statistics.tradeoff import Tradeoff
from mcgw.statistics.verdict import FALSE_ALARM

_TITLES = {"M": "surfaces $M$", "N": "asperities $N$"}
_FLOOR = 1e-16
_WIDE = 20  # times that are better told apart by their logarithms
_TWO = 1.96  # standard errors that 95 of 100 keep
_KINDS = ("cells", "tail", "aggregate", "direct")
_COLOURS = {kind: look(kind)["color"] for kind in _KINDS}
_MARKERS = {kind: look(kind)["marker"] for kind in _KINDS}
_CELLS, _CROWDS = _COLOURS["cells"], _COLOURS["aggregate"]


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
        figure.suptitle(
            f"{shown_title(found.scene, 'Scene')}\n"
            f"Statistical convergence {found.word}: p = {found.p:.3g} over "
            f"{len(found.checks)} checks (false alarms: 1 in {1 / FALSE_ALARM:.0f})",
            fontsize=10,
        )
        save_figure(figure, path)


def _say(axis: Any, text: str) -> None:
    axis.text(0.5, 0.5, text, ha="center", va="center", transform=axis.transAxes)
    axis.set_axis_off()


def _draw_slope(axis: Any, curve: Slope) -> None:
    fit = np.exp(np.mean(np.log(curve.errors) + np.log(curve.sizes) / 2)) / np.sqrt(curve.sizes)
    axis.loglog(curve.sizes, fit, color=THEORY, label="slope $-1/2$")
    axis.errorbar(
        curve.sizes, curve.errors, 1.96 * curve.stderr * curve.errors, fmt="o", ms=4, mfc="none",
        color=MONTE_CARLO, label="measured, 95 %",
    )  # fmt: skip
    axis.set_xlabel(_TITLES[curve.against])
    axis.set_ylabel("rms error (standard deviations)" if curve.against == "M" else "rms relative error")
    axis.set_title(f"slope {curve.value:.4f} ± {1.96 * curve.uncertainty:.4f}")
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
    axis.set_xlabel("error of a mean (exact standard errors)")
    axis.set_title("z-scores")
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
    axis.set_yticks(rows, [f"{c.name}: {c.seen}" for c in found.checks], fontsize=8)
    axis.set_ylim(-0.7, len(names) - 0.3)
    axis.grid(visible=False, axis="y")
    axis.set_xlabel("probability by chance; grey: fails (the far left stands for all below $10^{-12}$)")


def save_tradeoff(found: Tradeoff, path: str | Path) -> None:
    """Draw a work-precision study.

    Parameters
    ----------
    found : Tradeoff
        From `mcgw.statistics.tradeoff.tradeoff`.
    path : str or Path
        The ending chooses the format: .png, .pdf, .svg.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9.6, 5.6), layout="constrained")
        left, right = figure.subplots(1, 2)
        draw_ways(left, found)
        draw_methods(right, found, len(found.separations) - 1)
        figure.suptitle(shown_title(found.scene, "Work and precision"), fontsize=11)
        save_figure(figure, path)


def draw_ways(axis: Any, found: Tradeoff) -> None:
    """Accuracy of the values of a surface against the time of one."""
    cells = [way for way in found.ways if way.sampler == "cells"]
    if cells:
        times, asked = [1e3 * way.each for way in cells], [way.scene.accuracy for way in cells]
        axis.plot(times, asked, "o-", color=_CELLS, label="cells: accuracy asked")
        seen = [max(way.error, _FLOOR) for way in cells]
        axis.plot(times, seen, "o", color=_CELLS, mfc="none", label="cells: worst of a few surfaces")
    crowds = [way for way in found.ways if way.scene.law_error]
    for way in found.ways:
        if way not in (*cells, *crowds):  # far off to the right
            look = {"color": _COLOURS[way.sampler], "marker": _MARKERS[way.sampler], "ls": ""}
            axis.plot([], [], **look, label=f"{way.sampler}: to the last digit, {1e3 * way.each:.2g} ms")
    if crowds:
        times, spent = [1e3 * way.each for way in crowds], [way.scene.law_error for way in crowds]
        axis.plot(times, spent, "^--", color=_CROWDS, label="crowds: error of the law allowed")
    axis.set(yscale="log", ylim=(1e-15, 1))
    every = [1e3 * way.each for way in (*cells, *crowds)]
    if every and max(every) > _WIDE * min(every):
        axis.set_xscale("log")
    else:
        axis.set_xlim(0, 1.1 * max(every, default=1.0))
    axis.set_xlabel("time of a surface (ms)")
    axis.set_ylabel("relative error of a value of a surface")
    axis.set_title("Values of surfaces")
    _legend(axis, 1)


def draw_methods(axis: Any, found: Tradeoff, k: int) -> None:
    """Error of the mean against time of every method at one of the separations, each named at its end."""
    others = iter((("-", "P"), ("--", "X"), (":", "*")))
    for method in found.methods:
        points = found.of(method.name)
        time = np.array([p.wall for p in points])
        error = np.maximum([p.rms[k] for p in points], _FLOOR)
        kind = method.name.split(",")[0]
        line, marker = ("-", _MARKERS[kind]) if kind in _MARKERS else next(others, ("-", "."))
        law = {-0.5: r" (size$^{-1/2}$)", -1.5: r" (size$^{-3/2}$)"}.get(method.slope or 0.0, "")
        axis.errorbar(
            time, error, error * np.array([p.rms_stderr for p in points]), color=_COLOURS.get(kind, BACK),
            marker=marker, ms=4.5, lw=1.2, ls=line, label=f"{method.name}{law}",
        )  # fmt: skip
    axis.set(xscale="log", yscale="log", ylim=(_FLOOR / 5, 10))
    advised = [advice for advice in found.advice if advice.wish.of == "mean"]
    if k == len(found.separations) - 1 and advised:
        axis.plot(
            [a.seconds for a in advised], [a.wish.within / _TWO for a in advised], "*", ms=11, mfc="none",
            color="k", label="recommended for the next decades",
        )  # fmt: skip
    axis.set_xlabel("time (s)")
    axis.set_ylabel(f"rms relative error of the mean {found.scene.quantities[0]}")
    axis.set_title(f"Its mean at $d/\\sigma$ = {found.separations[k]:g}")
    _legend(axis, 2)


def _legend(axis: Any, columns: int) -> None:
    """Below the panel, where nothing is drawn."""
    axis.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=columns)
