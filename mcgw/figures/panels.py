"""The look of every figure, and the files it is written to."""

import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, LogLocator, MaxNLocator

from mcgw.figures.data import FigureData, Panel, Points, Series, figure_table
from mcgw.figures.style import BACK, BAND, LEVEL, PAPER, STYLE, look
from mcgw.formats.pictures import save_figure

__all__ = ["draw", "draw_residual", "figure_files", "save_figure_files"]

_WIDTH, _HEIGHT, _RESIDUAL = 3.7, 2.9, 0.8  # of a panel, and of the residuals below it; inches
_KEY = "Monte Carlo, 95 %"
_STEPS = (1, 2, 2.5, 5, 10)  # of ticks


def draw(data: FigureData) -> Figure:
    """Draw the panels of a figure beside and below each other.

    Under a panel with Monte-Carlo points are their distances from theory in standard errors: five decades,
    or a scale of ten to one, hide what matters.

    Parameters
    ----------
    data : FigureData
        Its numbers.

    Returns
    -------
    matplotlib.figure.Figure
        With title and caption.
    """
    with mpl.rc_context(STYLE):
        columns = min(data.columns, len(data.panels))
        rows = -(-len(data.panels) // columns)
        below = _RESIDUAL if any(map(_has_errors, data.panels)) else 0.0
        width = max(_WIDTH * columns, 4.4)
        figure = Figure(figsize=(width, (_HEIGHT + below) * rows + 1.0), layout="constrained")
        grid = figure.add_gridspec(2 * rows, columns, height_ratios=[_HEIGHT, max(below, 1e-3)] * rows)
        for k, panel in enumerate(data.panels):
            row, column = divmod(k, columns)
            if _has_errors(panel):
                axis = figure.add_subplot(grid[2 * row, column])
                lower = figure.add_subplot(grid[2 * row + 1, column], sharex=axis)
            else:
                axis, lower = figure.add_subplot(grid[2 * row : 2 * row + 2, column]), None
            _draw_panel(axis, panel, keyed=k == 0)
            if lower is not None:
                _draw_residuals(lower, panel, labelled=column == 0)
                axis.set_xlabel("")
                axis.tick_params(labelbottom=False)
        title = textwrap.fill(data.title, int(width * 10))
        figure.suptitle(title, fontsize=11, fontweight="bold", x=0.01, ha="left")
        caption = textwrap.fill(data.caption, int(width * 16))
        figure.supxlabel(caption, fontsize=8, color=PAPER, x=0.01, ha="left")
    return figure


def _known(panel: Panel) -> list[tuple[int, Series, Points]]:
    """Series with points, and which of the panel they are."""
    return [(k, s, s.points) for k, s in enumerate(panel.series) if s.points is not None]


def _draw_panel(axis: Any, panel: Panel, *, keyed: bool) -> None:
    positive = [float(y[y > 0].min()) for y in (x.theory for x in panel.series) if np.any(y > 0)]
    logarithmic = panel.scales[1] == "log" and bool(positive)  # such an axis has no place for 0 alone
    yscale = "linear" if panel.scales[1] == "log" and not positive else panel.scales[1]
    axis.set(xlabel=panel.xlabel, ylabel=panel.ylabel, xscale=panel.scales[0], yscale=yscale)
    axis.set_title(panel.title, loc="left")
    if panel.level is not None:
        axis.axhline(panel.level, color=LEVEL, lw=0.8, zorder=1)
    for k, series in enumerate(panel.series):
        _draw_series(axis, series, look(series.label, k), panel)
    if panel.ylim:
        axis.set_ylim(panel.ylim)
    elif logarithmic:
        axis.set_ylim(bottom=0.6 * min(positive))
    if keyed and _known(panel):
        axis.plot([], [], "o", color=BACK, ms=4, mfc="white", mew=0.9, label=_KEY)
    for ticks, scale in ((axis.xaxis, axis.get_xscale()), (axis.yaxis, axis.get_yscale())):
        ticks.set_major_locator(LogLocator(numticks=7) if scale == "log" else MaxNLocator(6, steps=_STEPS))
    axis.legend(fontsize=8, handlelength=3)


def _draw_series(axis: Any, series: Series, look: dict[str, Any], panel: Panel) -> None:
    line = {"color": look["color"], "linestyle": look["linestyle"]}
    if series.points is None:
        axis.plot(series.x, series.theory, label=series.label, **line)
    else:
        axis.plot(series.x, series.theory, **line)
        axis.plot([], [], label=series.label, marker=look["marker"], ms=4, mfc="white", **line)
        _draw_points(axis, series.points, look, panel.scales[1] == "log")
    if series.shaded:
        low, high = panel.ylim or (0.0, 1.0)
        axis.fill_between(
            series.x,
            low if series.shaded == "below" else series.theory,
            series.theory if series.shaded == "below" else high,
            color=look["color"],
            alpha=0.18,
            lw=0,
        )


def _draw_points(axis: Any, points: Points, look: dict[str, Any], logarithmic: bool) -> None:
    low = high = 1.96 * points.stderr
    if logarithmic:  # an interval that reaches zero has no end on such an axis
        low = np.minimum(low, 0.95 * points.mean)
    axis.errorbar(
        points.x,
        points.mean,
        [low, high],
        fmt=look["marker"],
        color=look["color"],
        ms=4,
        mfc="white",
        mew=0.9,
        elinewidth=0.9,
        capsize=1.5,
        zorder=3,
    )


def _has_errors(panel: Panel) -> bool:
    """Whether there are points with an error: means of stratified surfaces have none that is known."""
    return any(bool((points.stderr > 0).any()) for *_, points in _known(panel))


def _draw_residuals(axis: Any, panel: Panel, *, labelled: bool) -> None:
    reach = 4.0
    for k, series, points in _known(panel):
        found = look(series.label, k)
        varies = points.stderr > 0
        z = (points.mean - points.exact)[varies] / points.stderr[varies]
        axis.plot(points.x[varies], z, found["marker"], color=found["color"], ms=3, mfc="white", mew=0.8)
        reach = max(reach, 1.1 * float(np.abs(z).max(initial=0.0)))
    draw_residual(axis, reach)
    axis.set_xlabel(panel.xlabel)
    if labelled:
        axis.set_ylabel("residual\n(std. errors)", fontsize=8)


def draw_residual(axis: Any, reach: float) -> None:
    """What is behind residuals in standard errors: zero, and the band in which 95 % of them lie."""
    axis.axhspan(-2, 2, color=BAND, zorder=0)
    axis.axhline(0, color=LEVEL, lw=0.8, zorder=1)
    axis.set_ylim(-reach, reach)
    axis.yaxis.set_major_locator(FixedLocator([-2, 0, 2]) if reach < 8 else MaxNLocator(4, symmetric=True))


def figure_files(folder: Path, name: str, *, csv: bool) -> list[Path]:
    """Files of the figure of this name."""
    return [folder / f"{name}.{ending}" for ending in ("png", "pdf", "svg", *(["csv"] if csv else []))]


def save_figure_files(data: FigureData, folder: Path, *, csv: bool = False) -> Iterator[Path]:
    """Write a figure as PNG, PDF and SVG.

    Parameters
    ----------
    data : FigureData
        What to draw.
    folder : Path
        Where; made if it is not there.
    csv : bool, optional
        Also write its numbers.

    Yields
    ------
    Path
        Of each file as it is there.
    """
    folder.mkdir(parents=True, exist_ok=True)
    figure = draw(data)
    for path in figure_files(folder, data.name, csv=csv):
        if path.suffix == ".csv":
            figure_table(data).write(path)
        else:
            with mpl.rc_context(STYLE):
                save_figure(figure, path)
        yield path
