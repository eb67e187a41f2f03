"""Figures as files, in the formats that matplotlib writes."""

from pathlib import Path
from typing import Any

from matplotlib.backend_bases import FigureCanvasBase
from matplotlib.figure import Figure

from mcgw.formats.files import whole_file

__all__ = ["figure_endings", "save_figure"]


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
        figure.savefig(unfinished, format=path.suffix[1:].lower(), **options)
