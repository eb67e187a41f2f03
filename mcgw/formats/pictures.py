"""Figures as files, in the formats that matplotlib writes."""

from pathlib import Path
from typing import IO, Any

import matplotlib as mpl
from matplotlib.backend_bases import FigureCanvasBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from mcgw.formats.files import whole_file

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
    """As ``figure.savefig``, in half of the time: laid out once, drawn once.

    As long as a figure has a layout engine, matplotlib draws it twice for each file. Afterwards this one has
    none: it keeps its layout, and is not to be drawn on any more.
    """
    engine = figure.get_layout_engine()
    if engine is not None:
        dpi = options.get("dpi", mpl.rcParams["savefig.dpi"])  # texts are measured in whole dots
        if dpi != "figure":
            figure.set_dpi(dpi)
        FigureCanvasAgg(figure)  # one for both: each reads and measures the formulas anew
        engine.execute(figure)
        figure.set_layout_engine(None)
    ending = file.suffix[1:].lower() if isinstance(file, Path) else ""
    undated = _UNDATED.get(options.get("format", ending))
    if undated:
        options["metadata"] = undated | (options.get("metadata") or {})
    with mpl.rc_context({"svg.hashsalt": "mcgw"}):
        figure.savefig(file, **options)
