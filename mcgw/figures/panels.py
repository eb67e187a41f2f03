"""The look of every figure, and the files it is written to."""

import math
import textwrap
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from mcgw.ensemble.intervals import TOO_FEW
from mcgw.figures.data import FigureData, Panel, Points, Series, figure_table
from mcgw.figures.style import BACK, BAND, LEVEL, PAPER, STYLE, look, plain, power_of_ten, save_figure

# Inches. Places are given, since finding them takes as long as drawing.
_WIDTH, _NARROWEST = 3.7, 4.4  # of a panel with its labels, and of a figure
_LEFT, _RIGHT = 0.85, 0.12  # labels and ticks beside a panel
_OVER, _HEIGHT, _BETWEEN, _RESIDUAL, _UNDER = 0.3, 2.4, 0.12, 0.7, 0.52
_TITLE, _CAPTION, _EDGE = 0.19, 0.14, 0.08  # line heights of texts, and their margins
_KEY, _THEORY = "Monte Carlo, 95 %", "theory"
_MARKS = look("Monte Carlo")
_WHITE: Any = {"ms": 4, "mfc": "white", "mew": 0.9}
_STEPS = (1, 2, 2.5, 5, 10)  # of ticks
_FEW, _FEWER = 1.5, 0.5  # decades below which ticks at 2 and 5 times powers of ten are added
_UNSEEN = 0.01  # share of the smallest mean: how far down theory is drawn


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
    columns = min(data.columns, len(data.panels))
    rows = -(-len(data.panels) // columns)
    below = _RESIDUAL + _BETWEEN if any(map(_has_errors, data.panels)) else 0.0
    row_height, width = _OVER + _HEIGHT + below + _UNDER, max(_WIDTH * columns, _NARROWEST)
    pitch = width / columns
    title, caption = _wrapped(data.title, int(10 * width)), _wrapped(data.caption, int(16 * width))
    head, foot = _EDGE + _TITLE * len(title), _EDGE + _CAPTION * len(caption)
    height = head + rows * row_height + foot
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(width, height))

        def axes(k: int, up: float, tall: float, beside: Any = None) -> Any:
            left = pitch * (k % columns) + _LEFT
            bottom = foot + row_height * (rows - 1 - k // columns) + _UNDER + up
            inches = left / width, bottom / height, (pitch - _LEFT - _RIGHT) / width, tall / height
            return figure.add_axes(inches, sharex=beside)

        for k, panel in enumerate(data.panels):
            checked = _has_errors(panel)
            axis = axes(k, below, _HEIGHT) if checked else axes(k, 0.0, below + _HEIGHT)
            draw_panel(axis, panel, keyed=k == 0)
            if checked:
                _draw_residuals(axes(k, 0.0, _RESIDUAL, axis), panel, labelled=k % columns == 0)
                axis.set_xlabel("")
                axis.tick_params(labelbottom=False)
        left = _EDGE / width
        figure.suptitle(
            "\n".join(title),
            fontsize=11,
            fontweight="bold",
            x=left,
            y=1 - _EDGE / height,
            ha="left",
            va="top",
        )
        figure.supxlabel(
            "\n".join(caption), fontsize=8, color=PAPER, x=left, y=_EDGE / height, ha="left", va="bottom"
        )
    return figure


def _wrapped(text: str, width: int) -> list[str]:
    return [line for part in text.splitlines() for line in textwrap.wrap(part, width)]


def _known(panel: Panel) -> list[tuple[int, Series, Points]]:
    """Series with points, and which of the panel they are."""
    return [(k, s, s.points) for k, s in enumerate(panel.series) if s.points is not None]


def draw_panel(axis: Any, panel: Panel, *, keyed: bool) -> None:
    """Draw lines, points on them and the legend; if `keyed`, it says what points are."""
    positive = [float(y[y > 0].min()) for y in (x.theory for x in panel.series) if np.any(y > 0)]
    logarithmic = panel.scales[1] == "log" and bool(positive)  # a log axis cannot show 0 alone
    yscale = "linear" if panel.scales[1] == "log" and not positive else panel.scales[1]
    axis.set(xlabel=panel.xlabel, ylabel=panel.ylabel, xscale=panel.scales[0], yscale=yscale)
    axis.set_title(panel.title, loc="left")
    if panel.level is not None:
        axis.axhline(panel.level, color=LEVEL, lw=0.8, zorder=1)
    for k, series in enumerate(panel.series):
        _draw_series(axis, series, k, logarithmic)
    means = [points.mean for *_, points in _known(panel)]
    if panel.ylim:
        axis.set_ylim(panel.ylim)
    elif logarithmic and any(np.any(mean > 0) and np.any(mean == 0) for mean in means):
        axis.set_ylim(bottom=_UNSEEN * min(mean[mean > 0].min() for mean in means if np.any(mean > 0)))
    elif logarithmic:
        axis.set_ylim(bottom=0.6 * min(positive))
    if keyed and means:
        plain_theory = len(panel.series) == 1 and panel.series[0].label == _THEORY
        color = _MARKS["color"] if plain_theory else BACK
        axis.plot([], [], _MARKS["marker"] if plain_theory else "o", color=color, label=_KEY, **_WHITE)
        if any(np.any((points.mean != 0) & ~np.isfinite(points.arms[0])) for *_, points in _known(panel)):
            axis.plot([], [], "x", color=color, label=TOO_FEW, **_WHITE)
    _set_ticks(axis.xaxis, axis.get_xscale(), *axis.get_xlim())
    _set_ticks(axis.yaxis, axis.get_yscale(), *axis.get_ylim())
    if keyed or len(panel.series) > 1:
        axis.legend(fontsize=8, handlelength=3)


def _set_ticks(ticks: Any, scale: str, low: float, high: float) -> None:
    """Set few ticks as plain text: formulas take a quarter of a second."""
    decades = math.log10(high / low) if scale == "log" else 0.0
    if decades > _FEWER:
        ticks.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if decades < _FEW else (1.0,), numticks=7))
        ticks.set_major_formatter(FuncFormatter(power_of_ten))
    else:
        ticks.set_major_locator(MaxNLocator(6, steps=_STEPS))
        ticks.set_major_formatter(FuncFormatter(plain))
    ticks.set_minor_formatter(NullFormatter())


def _marks(series: Series, k: int) -> dict[str, Any]:
    """Look of points: where a single theory is beside them, it has another colour than they have."""
    return _MARKS if series.label == _THEORY else look(series.label, k)


def _draw_series(axis: Any, series: Series, k: int, logarithmic: bool) -> None:
    found = look(series.label, k)
    line = {"color": found["color"], "linestyle": found["linestyle"]}
    alone = series.points is None or series.label == _THEORY
    axis.plot(series.x, series.theory, label=series.label if alone else None, **line)
    if not alone:
        axis.plot([], [], label=series.label, marker=found["marker"], ms=4, mfc="white", **line)
    if series.points is not None:
        _draw_points(axis, series.points, _marks(series, k), logarithmic)
    if series.band is not None:
        axis.fill_between(series.x, *series.band, color=found["color"], alpha=0.18, lw=0)


def _draw_points(axis: Any, points: Points, found: dict[str, Any], logarithmic: bool) -> None:
    low, high = points.arms
    if logarithmic:  # an interval that reaches zero has no end on such an axis
        low = np.minimum(low, 0.95 * points.mean)
    shown = (points.mean > 0) if logarithmic else np.isfinite(points.mean)
    marks = {"color": found["color"], "zorder": 3, **_WHITE}
    some = shown & np.isfinite(low)
    columns = (x[some] for x in (points.x, points.mean))
    bars = [low[some], high[some]]
    axis.errorbar(*columns, bars, fmt=found["marker"], elinewidth=0.9, capsize=1.5, **marks)
    few = shown & ~some
    if few.any():
        axis.plot(points.x[few], points.mean[few], "x", **marks)


def _has_errors(panel: Panel) -> bool:
    """Whether there are points with an error."""
    return any(bool((points.stderr > 0).any()) for *_, points in _known(panel))


def _draw_residuals(axis: Any, panel: Panel, *, labelled: bool) -> None:
    reach = 4.0
    for k, series, points in _known(panel):
        found = _marks(series, k)
        varies = points.stderr > 0
        z = (points.mean - points.exact)[varies] / points.stderr[varies]
        axis.plot(points.x[varies], z, found["marker"], color=found["color"], ms=3, mfc="white", mew=0.8)
        reach = max(reach, 1.1 * float(np.abs(z).max(initial=0.0)))
    draw_residual(axis, reach)
    axis.set_xlabel(panel.xlabel)
    if labelled:
        axis.set_ylabel("residual\n(std. errors)", fontsize=8, labelpad=0)


def draw_residual(axis: Any, reach: float) -> None:
    """What is behind residuals in standard errors: zero, and the band in which 95 % of them lie."""
    axis.axhspan(-2, 2, color=BAND, zorder=0)
    axis.axhline(0, color=LEVEL, lw=0.8, zorder=1)
    axis.set_ylim(-reach, reach)
    axis.yaxis.set_major_locator(FixedLocator([-2, 0, 2]) if reach < 8 else MaxNLocator(4, symmetric=True))
    axis.yaxis.set_major_formatter(FuncFormatter(plain))


def figure_files(folder: Path, name: str, formats: Sequence[str], *, csv: bool) -> list[Path]:
    """Files of the figure of this name."""
    return [folder / f"{name}.{ending}" for ending in (*formats, *(["csv"] if csv else []))]


def save_figure_files(
    data: FigureData, folder: Path, formats: Sequence[str] = ("png",), *, csv: bool = False
) -> Iterator[Path]:
    """Write a figure in each of the formats.

    Parameters
    ----------
    data : FigureData
        What to draw.
    folder : Path
        Where; made if it is not there.
    formats : sequence of str, optional
        Endings of names, of those that matplotlib writes.
    csv : bool, optional
        Also write its numbers.

    Yields
    ------
    Path
        Of each file as it is there.
    """
    folder.mkdir(parents=True, exist_ok=True)
    figure = draw(data)
    for path in figure_files(folder, data.name, formats, csv=csv):
        if path.suffix == ".csv":
            figure_table(data).write(path)
        else:
            with mpl.rc_context(STYLE):
                save_figure(figure, path)
        yield path
