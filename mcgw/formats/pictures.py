"""Figures as files, in the formats that matplotlib writes."""

from pathlib import Path
from typing import IO, Any, cast

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backend_bases import FigureCanvasBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.markers import TICKDOWN, TICKLEFT
from matplotlib.ticker import Locator, LogLocator, NullLocator

from mcgw.formats.files import whole_file

__all__ = ["figure_endings", "save_figure", "write_figure"]

# The usual side of its ticks, the other, and how one is drawn.
_SIDES: dict[str, tuple[str, str, Any]] = {
    "xaxis": ("bottom", "top", TICKDOWN),
    "yaxis": ("left", "right", TICKLEFT),
}

# No file knows when it was written, so that the same figure gives the same bytes.
_UNDATED: dict[str, dict[str, Any]] = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}


def figure_endings() -> tuple[str, ...]:
    """Endings of the formats that matplotlib writes."""
    return tuple(f".{name}" for name in FigureCanvasBase.get_supported_filetypes())


def save_figure(figure: Figure, path: str | Path, **options: Any) -> None:
    """Write a figure whole or not at all, in the format of the ending; options are those of ``savefig``.

    Raises
    ------
    ValueError
        If matplotlib does not write this format.
    OSError
        If the file cannot be written.
    """
    path = Path(path)
    with whole_file(path) as unfinished:
        write_figure(figure, unfinished, format=path.suffix[1:].lower(), **options)


def write_figure(figure: Figure, file: str | Path | IO[Any], **options: Any) -> None:
    """As ``figure.savefig``, in less than half of the time: laid out once, drawn once, its minor ticks lines.

    As long as a figure has a layout engine, matplotlib draws it twice for each file. Afterwards this one has
    none: it keeps its layout, and is not to be drawn on any more.
    """
    engine = figure.get_layout_engine()
    minor_ticks = _take_minor_ticks(figure)
    if engine is not None:
        dpi = options.get("dpi", mpl.rcParams["savefig.dpi"])  # texts are measured in whole dots
        if dpi != "figure":
            figure.set_dpi(dpi)
        FigureCanvasAgg(figure)  # one for both: each reads and measures the formulas anew
        engine.execute(figure)
        figure.set_layout_engine(None)
    for axes, which, locator in minor_ticks:  # how many there are depends on the length of the axis
        axes.add_artist(_as_line(axes, which, locator))
    ending = file.suffix[1:].lower() if isinstance(file, Path) else ""
    undated = _UNDATED.get(options.get("format", ending))
    if undated:
        options["metadata"] = undated | (options.get("metadata") or {})
    with mpl.rc_context({"svg.hashsalt": "mcgw"}):
        figure.savefig(file, **options)


def _take_minor_ticks(figure: Figure) -> list[tuple[Axes, str, Locator]]:
    """Take the minor ticks, eight a decade, from logarithmic axes where they have no labels.

    Matplotlib makes five objects of each: half of the time of a figure.
    """
    sharing: dict[Locator, list[tuple[Axes, str, Locator]]] = {}  # axes that share ticks lose them together
    for axes in figure.axes:
        for which in _SIDES:
            locator = getattr(axes, which).get_minor_locator()
            sharing.setdefault(locator, []).append((axes, which, locator))
    taken = []
    for locator, places in sharing.items():
        if isinstance(locator, LogLocator) and all(_plain(axes, which) for axes, which, _ in places):
            taken += places
    for axes, which, _ in taken:
        getattr(axes, which).set_minor_locator(NullLocator())
    return taken


def _plain(axes: Axes, which: str) -> bool:
    """Whether the minor ticks of an axis are on its usual side alone, and have no labels."""
    axis = getattr(axes, which)
    sides = axis.get_tick_params(which="minor")
    usual, other = _SIDES[which][:2]
    labels = axis.get_minor_formatter().format_ticks(axis.get_minorticklocs())
    return bool(axes.axison and sides.get(usual) and not sides.get(other)) and not any(labels)


def _as_line(axes: Axes, which: str, locator: Locator) -> Line2D:
    """The minor ticks of an axis as markers of one line."""
    low, high = sorted(getattr(axes, which).get_view_interval())
    at = np.array([x for x in locator() if low <= x <= high])
    edge, kind, style = np.zeros(at.size), f"{which[0]}tick", cast(Any, mpl.rcParams)
    return Line2D(
        *((at, edge) if which == "xaxis" else (edge, at)),
        transform=getattr(axes, f"get_{which}_transform")("tick1"),
        marker=_SIDES[which][2],
        markersize=style[f"{kind}.minor.size"],
        markeredgewidth=style[f"{kind}.minor.width"],
        color=style[f"{kind}.color"],
        linestyle="none",
        clip_on=False,
    )
