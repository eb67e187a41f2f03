"""Panels of a figure by their numbers, one way to draw them, and the files of a figure."""

import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, MaxNLocator

from analytic.arrays import Array
from mcgw.ensemble.intervals import TOO_FEW
from mcgw.figures.style import BAND, LEVEL, PAPER, STYLE, look, save_figure
from mcgw.formats.table import Column, Table
from mcgw.statistics.comparison import Points

GAMMA, SEPARATION, PRESSURE = "grading factor γ", "separation d/σ", "pressure $P/A_n$ (MPa)"
PANELS: Any = STYLE | {"axes.titlelocation": "left"}
_WIDTH, _NARROWEST = 3.7, 4.4  # inches, of a panel with its labels and of a figure
_TALL, _RESIDUAL, _TEXTS = 3.2, 0.8, 0.6  # inches, of a panel, residuals under it, title and caption
_KEY, _THEORY = "Monte Carlo, 95 %", "theory"
_MARKS = look("Monte Carlo")
_WHITE: Any = {"ms": 4, "mfc": "white", "mew": 0.9}
_UNSEEN = 0.01  # share of the smallest mean: how far down theory is drawn
_SMALL, _HANDLE, _LETTER = 8, 34.0, 4.4  # points, of a legend: text, line and gaps, letter
_FINE = 12  # places from which on a line has no kinks
_SAME = 0.25  # standard errors that markers of residuals cover


@dataclass(frozen=True)
class Series:
    """A line of theory, and points on it if it has a counterpart by Monte Carlo."""

    label: str
    x: Array
    theory: Array
    points: Points | None = None


def words(text: str, axis: Any, at: tuple[float, float] = (0.5, 0.5), **look: Any) -> None:
    """Write a text in place of axes."""
    axis.set_axis_off()
    axis.text(*at, text, transform=axis.transAxes, **({"ha": "center", "va": "center"} | look))


@dataclass(frozen=True)
class Panel:
    """One pair of axes."""

    title: str | None = None  # default: what it paints has one of its own
    xlabel: str = ""
    ylabel: str = ""
    series: tuple[Series, ...] = ()  # lines of theory and points
    scales: tuple[str, str] = ("linear", "linear")  # of x and y
    level: float | None = None  # a value of y worth a line of its own
    paint: Callable[[Any], None] = lambda _: (
        None
    )  # draws what else it shows, and sets other properties, on its axes
    wide: bool = False  # whether it takes all columns, below all others


@dataclass(frozen=True)
class FigureData:
    """A figure: its text and panels."""

    title: str
    caption: str
    panels: tuple[Panel, ...]


def figure_table(figure: FigureData) -> Table:
    """Every number of a figure."""
    rows: list[tuple[float | str, ...]] = []
    for panel, series in ((one, series) for one in figure.panels for series in one.series):
        about, p = (panel.title or "", series.label), series.points
        rows += [(*about, "line", *at, "", "") for at in zip(series.x, series.theory, strict=True)]
        if p:
            rows += [(*about, "point", *at) for at in zip(p.x, p.theory, p.mean, p.stderr, strict=True)]
    names = ("panel", "series", "kind", "x", "theory", "mean", "stderr")
    return Table(tuple(map(Column, names, zip(*rows, strict=True))))


def draw(data: FigureData) -> Figure:
    """Draw the panels of a figure beside and below each other, under one legend.

    Under a panel with points stand their residuals, which five decades, or a scale of ten to one, would hide.
    """
    narrow: list[Any] = [k for k, panel in enumerate(data.panels) if not panel.wide]
    columns = 2 if len(narrow) == 4 else min(len(narrow), 3)  # more are too small to read on a page
    narrow += ["."] * (-len(narrow) % columns)
    rows = [narrow[k : k + columns] for k in range(0, len(narrow), columns)]
    rows += [[k] * columns for k, panel in enumerate(data.panels) if panel.wide]
    checked = {k for k, panel in enumerate(data.panels) if any(p.varies.any() for _, p in _known(panel))}
    places = [line for row in rows for line in (row, [f"below {k}" if k in checked else k for k in row])]
    with mpl.rc_context(PANELS):
        size = max(_WIDTH * columns, _NARROWEST), len(rows) * (_TALL + bool(checked) * _RESIDUAL) + _TEXTS
        figure = Figure(figsize=size, layout="constrained")
        part: Any = figure.subfigures()  # its legend stands below the title of the figure
        axes = part.subplot_mosaic(places, height_ratios=[_TALL, _RESIDUAL] * len(rows))
        for k, panel in enumerate(data.panels):
            if below := axes.get(f"below {k}"):
                below.sharex(axes[k])  # before it has a scale, which is then that of both
            draw_panel(axes[k], panel)
            if below:
                _draw_residuals(below, panel, labelled=any(row[0] == k for row in rows))
                axes[k].set_xlabel("")
                axes[k].tick_params(labelbottom=False)
        if len(named := keys(part.axes)) > 1:  # above all panels, where no data are
            longest = _HANDLE + _LETTER * max(map(len, named))
            part.legend(
                named.values(), named.keys(), ncols=max(int(72 * size[0] / longest), 1), fontsize=_SMALL,
                loc="outside upper left", handlelength=2.5, columnspacing=1,
                handler_map={tuple: HandlerTuple(ndivide=None)},
            )  # fmt: skip
        side: Any = {"x": 0.01, "ha": "left"}
        figure.suptitle(_wrapped(data.title, int(10 * size[0])), fontsize=11, fontweight="bold", **side)
        if data.caption:
            figure.supxlabel(_wrapped(data.caption, int(16 * size[0])), fontsize=_SMALL, color=PAPER, **side)
    return figure


def _wrapped(text: str, width: int) -> str:
    return "\n".join(line for part in text.splitlines() for line in textwrap.wrap(part, width))


def _known(panel: Panel) -> list[tuple[dict[str, Any], Points]]:
    """Points, series by series, and their look; beside a single theory they have another colour than it."""
    looks = (_MARKS if s.label == _THEORY else look(s.label, k) for k, s in enumerate(panel.series))
    return [(found, s.points) for found, s in zip(looks, panel.series, strict=True) if s.points is not None]


def draw_panel(axis: Any, panel: Panel) -> None:
    """Draw lines and the points on them; a logarithmic axis shows neither pulls nor 0 alone."""
    lines = np.concatenate([np.empty(0), *(x.theory for x in panel.series)])
    means = np.concatenate([np.empty(0), *(points.mean for _, points in _known(panel))])
    pulls = panel.scales[1] == "log" and bool(np.any(lines < 0) or np.any(means < 0))
    logarithmic = panel.scales[1] == "log" and bool(np.any(lines > 0)) and not pulls
    yscale = panel.scales[1] if logarithmic or not panel.series else "linear"
    axis.set(xlabel=panel.xlabel, ylabel=panel.ylabel, xscale=panel.scales[0], yscale=yscale)
    if (level := 0.0 if pulls else panel.level) is not None:
        axis.axhline(level, color=LEVEL, lw=0.8, zorder=1)
    for k, series in enumerate(panel.series):
        _draw_series(axis, series, k, logarithmic)
    if logarithmic:
        touches = np.any(means == 0) and np.any(means > 0)
        axis.set_ylim(bottom=_UNSEEN * means[means > 0].min() if touches else 0.6 * lines[lines > 0].min())
    panel.paint(axis)
    if panel.title is not None:
        axis.set_title(panel.title)


def keys(axes: Sequence[Any]) -> dict[str, Any]:
    """Return the handles of a legend by label: each line as it is drawn, and last the markers of points."""
    handles = [x for axis in axes for x in axis.get_legend_handles_labels()[0]]
    found = {x.get_label(): x for x in handles}
    marks = {x[0].get_marker(): x[0].get_color() for x in handles if x.get_label() == _KEY}
    if found.pop(_KEY, None):
        found[_KEY] = tuple(Line2D([], [], ls="", marker=m, color=c, **_WHITE) for m, c in marks.items())
    if found.pop(TOO_FEW, None):
        found[TOO_FEW] = Line2D([], [], ls="", marker="x", color=PAPER, **_WHITE)
    return found


def _draw_series(axis: Any, series: Series, k: int, logarithmic: bool) -> None:
    found, points = look(series.label, k), series.points
    marker = {"marker": found["marker"]}
    line = {"color": found["color"], "linestyle": found["linestyle"], "ms": 4}
    alone = {"label": series.label} if points is None or series.label == _THEORY else {}
    few = points is None and len(series.x) < _FINE  # a table: marked where it is known
    axis.plot(series.x, series.theory, **alone, **(marker if few else {}), **line)
    if not alone:
        axis.plot([], [], label=series.label, **marker, mfc="white", **line)
    if points is None:
        return
    found, (low, high) = _MARKS if alone else found, np.abs(np.array(points.interval) - points.mean)
    if logarithmic:  # an interval that reaches zero has no end on such an axis
        low = np.minimum(low, 0.95 * points.mean)
    shown = (points.mean > 0) if logarithmic else np.isfinite(points.mean)
    marks = {"color": found["color"], "zorder": 3, **_WHITE}
    some = shown & np.isfinite(low)
    columns = points.x[some], points.mean[some], [low[some], high[some]]
    axis.errorbar(*columns, fmt=found["marker"], elinewidth=0.9, capsize=1.5, label=_KEY, **marks)
    others = shown & ~some
    if others.any():
        axis.plot(points.x[others], points.mean[others], "x", label=TOO_FEW, **marks)


def _draw_residuals(axis: Any, panel: Panel, *, labelled: bool) -> None:
    """Draw residuals over the band in which 95 % of them lie."""
    reach = 4.0
    for found, points in _known(panel):
        x, z = points.x[points.varies], points.residual[points.varies]
        if panel.xlabel == GAMMA and z.size and np.ptp(z) < _SAME:  # of the same surfaces: one for all gamma
            axis.plot(x[[0, -1]], z[[0, -1]], color=found["color"], lw=0.8)
            x, z = x[[len(x) // 2]], z[[len(x) // 2]]
        axis.plot(x, z, found["marker"], color=found["color"], ms=3, mfc="white", mew=0.8)
        reach = max(reach, 1.1 * float(np.abs(z).max(initial=0.0)))
    axis.axhspan(-2, 2, color=BAND, zorder=0)
    axis.axhline(0, color=LEVEL, lw=0.8, zorder=1)
    axis.set(ylim=(-reach, reach), xlabel=panel.xlabel)
    axis.yaxis.set_major_locator(FixedLocator([-2, 0, 2]) if reach < 8 else MaxNLocator(4, symmetric=True))
    if labelled:
        axis.set_ylabel("residual\n(std. errors)", fontsize=_SMALL, labelpad=0)


def save(data: FigureData, *paths: Path) -> None:
    """Draw a figure into files, whose endings choose the format: .png, .pdf, .svg; .csv for its numbers."""
    figure = draw(data)
    with mpl.rc_context(STYLE):
        for path in paths:
            if path.suffix == ".csv":
                figure_table(data).write(path)
            else:
                save_figure(figure, path)
