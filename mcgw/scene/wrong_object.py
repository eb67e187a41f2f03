"""A call of the door that is given another object than it takes: told with what makes the right one."""

from pathlib import Path
from typing import Any

from mcgw.formats.sheet import brief

__all__ = ["check_object"]

_DRAWN = "mcgw.simulate(scene) draws one"
_MAKES = {
    "Scene": {
        "Surface": "mcgw.Scene(surface, separations=...) makes one of it",
        "Spectral": "mcgw.Scene(surface, separations=...) makes one of it",
        "path": "mcgw.load_scene(path) reads one",
        "Ensemble": "that of an ensemble is its .scene",
        "Fit": "mcgw.fitted_scene(fit) makes one of it",
        "ProfileFit": "mcgw.fitted_scene(fit) makes one of it",
    },
    "Ensemble": {"Scene": _DRAWN, "path": "mcgw.open_ensemble(path) opens one", "Surface": _DRAWN},
}


def check_object(call: str, value: Any, kind: type) -> None:
    """See to it that a call is given what it takes.

    Raises
    ------
    TypeError
        In one line, if it is not.
    """
    if isinstance(value, kind):
        return
    ways, name = _MAKES[kind.__name__], type(value).__name__
    way = ways.get("path" if isinstance(value, str | Path) else name) or next(iter(ways.values()))
    shown = f" {brief(repr(str(value)))}" if isinstance(value, str | Path) else ""
    raise TypeError(f"{call}: give a mcgw.{kind.__name__}, not {name}{shown}; {way}")
