"""The look of every figure, and the files it is written to."""

import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.figure import Figure

from mcgw.figures.data import FIGURE_HEADER, FigureData, Panel, Points, Series, figure_rows
from mcgw.figures.style import STYLE
from mcgw.formats.csv_table import write_csv
from mcgw.formats.pictures import save_figure

__all__ = ["draw", "figure_files", "save_figures"]

_WIDTH, _HEIGHT = 3.7, 2.9  # of a panel, inches
# Told apart in grey print by dashes and markers, and by colour-blind readers by their lightness too.
_LOOKS = (
    cycler(color=["#0072B2", "#D55E00", "#009E73", "#AA4499", "#000000"])
    + cycler(linestyle=["-", (0, (6, 2)), (0, (3, 1, 1, 1)), (0, (1.2, 1.2)), (0, (8, 2, 1, 2))])
    + cycler(marker=["o", "s", "^", "D", "v"])
)
_HOMOGENEOUS = {"color": "#000000", "linestyle": "-", "marker": "v"}  # in every figure alike


def draw(data: FigureData) -> Figure:
    """Draw the panels of a figure beside and below each other.

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
        width = max(_WIDTH * columns, 4.4)
        figure = Figure(figsize=(width, _HEIGHT * rows + 1.0), layout="constrained")
        axes = figure.subplots(rows, columns, squeeze=False).ravel()
        for axis, panel in zip(axes, data.panels, strict=True):
            _draw_panel(axis, panel)
        figure.suptitle(data.title, fontsize=11, fontweight="bold", x=0.01, ha="left")
        caption = textwrap.fill(data.caption, int(width * 16))
        figure.supxlabel(caption, fontsize=8, color="0.25", x=0.01, ha="left")
    return figure


def _draw_panel(axis: Any, panel: Panel) -> None:
    positive = [float(y[y > 0].min()) for y in (x.theory for x in panel.series) if np.any(y > 0)]
    logarithmic = panel.scales[1] == "log" and bool(positive)  # such an axis has no place for 0 alone
    yscale = "linear" if panel.scales[1] == "log" and not positive else panel.scales[1]
    axis.set(xlabel=panel.xlabel, ylabel=panel.ylabel, xscale=panel.scales[0], yscale=yscale)
    axis.set_title(panel.title, loc="left")
    if panel.level is not None:
        axis.axhline(panel.level, color="0.55", lw=0.8, zorder=1)
    for series, look in zip(panel.series, _LOOKS, strict=False):
        _draw_series(axis, series, _HOMOGENEOUS if series.label == "γ = 1" else look, panel)
    if panel.ylim:
        axis.set_ylim(panel.ylim)
    elif logarithmic:
        axis.set_ylim(bottom=0.6 * min(positive))
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


def figure_files(folder: Path, name: str, *, csv: bool) -> list[Path]:
    """Files of the figure of this name."""
    return [folder / f"{name}.{ending}" for ending in ("png", "svg", *(["csv"] if csv else []))]


def save_figures(figures: list[FigureData], folder: Path, *, csv: bool = False) -> Iterator[Path]:
    """Write each figure as PNG and SVG.

    Parameters
    ----------
    figures : list of FigureData
        What to draw.
    folder : Path
        Where; made if it is not there.
    csv : bool, optional
        Also write the numbers of each.

    Yields
    ------
    Path
        Of each file as it is there.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for data in figures:
        figure = draw(data)
        for path in figure_files(folder, data.name, csv=csv):
            if path.suffix == ".csv":
                write_csv(path, FIGURE_HEADER, figure_rows(data))
            else:
                with mpl.rc_context(STYLE | {"svg.hashsalt": "mcgw"}):
                    save_figure(figure, path, metadata={"Date": None} if path.suffix == ".svg" else None)
            yield path
