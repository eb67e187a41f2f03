"""What is imported only when it is asked for, because it is heavy, optional or lies in a layer above."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

__all__ = ["optional", "plotted", "without_help"]


@contextmanager
def without_help() -> Iterator[None]:
    """Import matplotlib for a command: without the help on each class, for whose text it takes 0.3 s."""
    import matplotlib.artist as artist

    kwdoc = artist.kwdoc
    artist.kwdoc = lambda _: ""  # type: ignore[assignment]
    try:
        yield
    finally:
        artist.kwdoc = kwdoc


def plotted(result: Any, ax: Any, **options: Any) -> Any:
    """Draw a result of any layer on axes, new ones if `ax` is None, and return them.

    Its class cannot import how it is drawn: figures lie above it, and know it. So this is the one call that
    goes up, and the only place that names `mcgw.figures.of_results`, where each class has its function.
    """
    return import_module("mcgw.figures.of_results").draw(result, ax, **options)


def optional(package: str, what: str) -> Any:
    """A package that mcgw does without.

    Raises
    ------
    ImportError
        If it is not installed; the message says what needs it and how to get it.
    """
    try:
        return import_module(package)
    except ImportError:
        raise ImportError(f'{what} needs {package}: pip install "mcgw[notebook]"', name=package) from None
