"""Arguments given in Python: numbers with units, arrays and objects, with errors that say what to give."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from mcgw.machine.terminal import brief
from mcgw.scene.kinds import Number
from mcgw.scene.section import Key, Kind, SceneError, Section

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


def arguments(given: Mapping[str, Any], kinds: Mapping[str, Kind]) -> dict[str, Any]:
    """Read arguments of these kinds as a table of keys.

    Raises
    ------
    SceneError
        With one line for each mistake, which names the argument.
    """
    plain = {name: as_toml(value) for name, value in given.items()}
    section = Section("", plain, {name: Key(name, kind) for name, kind in kinds.items()})
    found = section.read_all(kinds)
    if section.problems:
        raise SceneError(section.problems)
    return found


def argument(name: str, value: Any, unit: str) -> float:
    """Read a positive number, or a text with its unit; errors as in `arguments`."""
    return float(arguments({name: value}, {name: Number(unit)})[name])


def as_toml(value: Any) -> Any:
    """Convert a Python value to what TOML gives: arrays, tuples and ranges to lists of plain numbers."""
    if isinstance(value, str | bytes | bool | int | float) or callable(value):
        return value.item() if isinstance(value, np.generic) else value
    if isinstance(value, Mapping):
        return {key: as_toml(inner) for key, inner in value.items()}
    if hasattr(value, "__array__"):
        return np.asarray(value).tolist()
    if isinstance(value, Iterable) and not isinstance(value, type):
        return [as_toml(inner) for inner in value]
    return value


def check_object(call: str, value: Any, kind: type) -> None:
    """Check the type of an argument.

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
