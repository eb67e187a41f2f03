"""Figure of a work-precision study: error of values of surfaces, and of a mean, against their time."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from mcgw.figures.style import BACK, STYLE, look, shown_title
from mcgw.formats.pictures import save_figure
from mcgw.statistics.tradeoff import Tradeoff

__all__ = ["draw_methods", "draw_ways", "save_tradeoff"]

_FLOOR = 1e-16
_WIDE = 20  # times that are better told apart by their logarithms
_TWO = 1.96  # standard errors that 95 of 100 keep
_KINDS = ("cells", "tail", "aggregate", "direct", "stratified")
_COLOURS = {kind: look(kind)["color"] for kind in _KINDS}
_MARKERS = {kind: look(kind)["marker"] for kind in _KINDS}
_CELLS, _CROWDS = _COLOURS["cells"], _COLOURS["aggregate"]


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
            color="k", label="advised for the next decades",
        )  # fmt: skip
    axis.set_xlabel("time (s)")
    axis.set_ylabel(f"rms relative error of the mean {found.scene.quantities[0]}")
    axis.set_title(f"Its mean at $d/\\sigma$ = {found.separations[k]:g}")
    _legend(axis, 2)


def _legend(axis: Any, columns: int) -> None:
    """Below the panel, where nothing is drawn."""
    axis.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=columns)
