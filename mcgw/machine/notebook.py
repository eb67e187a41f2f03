"""What results do in a notebook with the help of others: draw themselves, and become tables of pandas."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

__all__ = ["bind_drawing", "optional", "plotted"]

_bound: dict[str, Callable[..., Any]] = {}


def bind_drawing(draw: Callable[..., Any]) -> None:
    """Say how results are drawn: ``draw(result, ax, **options)``."""
    _bound["draw"] = draw


def plotted(result: Any, ax: Any, **options: Any) -> Any:
    """Draw a result on axes, new ones if `ax` is None, and return them.

    Figures lie above the results that they draw, so these cannot import them: `mcgw` itself binds them.
    """
    return _bound["draw"](result, ax, **options)


def optional(package: str, what: str) -> Any:
    """Import a package that mcgw does without.

    Raises
    ------
    ImportError
        If it is not installed; the message says what needs it and how to get it.
    """
    try:
        return import_module(package)
    except ImportError:
        raise ImportError(f'{what} needs {package}: pip install "mcgw[notebook]"', name=package) from None
