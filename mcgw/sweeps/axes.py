"""The axes of a sweep: which keys of a scene have which values."""

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic import is_data
from analytic.arrays import Array
from mcgw.ensemble.results import AXES, GROUP
from mcgw.machine.terminal import brief
from mcgw.scene.keys import TABLES
from mcgw.scene.kinds import as_toml
from mcgw.scene.section import SceneError
from mcgw.scene.writing import law_table

_SECTIONS = [name for name in TABLES if name not in ("", "fitted")]
_LISTED = 6
_FIXED = ("contact.separations", "contact.datum", "contact.quantities", "ensemble.keep")  # of all points


@dataclass(frozen=True)
class Axes:
    """Keys of a scene and their values.

    Parameters
    ----------
    values : dict of str to tuple
        The values of each key, as a scene file gives them.
    zipped : bool
        Whether values go in step: the first values of all keys make one point, the second ones another.
        Otherwise every value of one key is combined with every value of all others.
    """

    values: dict[str, tuple[Any, ...]]
    zipped: bool

    @classmethod
    def from_text(cls, text: str) -> "Axes":
        """Read axes that `text_of_all` wrote."""
        said = json.loads(text)
        return cls({key: tuple(values) for key, values in said["values"].items()}, bool(said["zipped"]))

    def text_of_all(self) -> str:
        """Axes as JSON."""
        return json.dumps({"values": self.values, "zipped": self.zipped})

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the scene that vary."""
        return tuple(self.values)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points along each dimension: one dimension for each key, or a single one if zipped."""
        lengths = tuple(map(len, self.values.values()))
        return lengths[:1] if self.zipped else lengths

    @property
    def names(self) -> dict[str, str]:
        """Name of the coordinate of each key: its last word, or the whole key if that word is taken."""
        last = [key.rpartition(".")[2] for key in self.keys]
        taken = {*AXES, GROUP, *(name for name in last if last.count(name) > 1)}
        return {key: key if name in taken else name for key, name in zip(self.keys, last, strict=True)}

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions: one for each key, or "point" if they are zipped."""
        return ("point",) if self.zipped else tuple(self.names.values())

    @property
    def size(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    def at(self, number: int) -> dict[str, Any]:
        """Return the value of each key at a point, by its number among all, the last dimension fastest."""
        point = np.unravel_index(number, self.shape)
        places = point * len(self.values) if self.zipped else point
        return {key: values[i] for (key, values), i in zip(self.values.items(), places, strict=True)}

    def text(self, number: int) -> str:
        """Return a point in words."""
        return brief(", ".join(f"{key} = {_short(value)}" for key, value in self.at(number).items()))

    def values_text(self, number: int) -> str:
        """Return the values in the order of the keys."""
        return brief(", ".join(map(_short, self.at(number).values())))

    def numbers(self, key: str) -> tuple[int, Array]:
        """Return the dimension that a key is along, and its values, of which neighbours are compared."""
        if key not in self.values:
            raise ValueError(f"{key!r} is no axis of this sweep; it has {', '.join(self.keys)}")
        values = self.values[key]
        numbers = all(isinstance(x, int | float) for x in values)
        if len(values) < 2 or not numbers or not np.diff(values).all():
            raise ValueError(f"{key}: slopes need at least two numbers, with no equal neighbours")
        return 0 if self.zipped else self.keys.index(key), np.array(values, dtype=np.float64)

    def summary(self, key: str) -> str:
        """Return the values of a key in words: how many, from the first to the last."""
        values = [_short(value) for value in self.values[key]]
        if len(values) <= _LISTED:
            return ", ".join(values)
        return f"{len(values)} from {values[0]} to {values[-1]}"

    def place(self, at: "Mapping[str, Any] | Sequence[int] | int") -> int:
        """Find the number of a point by the values of its keys, or by its index along each dimension."""
        if isinstance(at, Mapping):
            if unknown := [key for key in at if key not in self.values]:
                raise ValueError(f"{unknown[0]!r} is no axis of this sweep; it has {', '.join(self.keys)}")
            wanted = {key: _value(key, value) for key, value in at.items()}
            found = [i for i in range(self.size) if wanted.items() <= self.at(i).items()]
            if len(found) != 1:
                raise ValueError(f"{len(found)} points have {dict(at)}; give one value of each axis")
            return found[0]
        point = (at,) if isinstance(at, int) else tuple(at)
        if len(point) != len(self.shape) or not all(
            -n <= i < n for i, n in zip(point, self.shape, strict=True)
        ):
            raise ValueError(f"there is no point {point}; the sweep has the shape {self.shape}")
        return int(np.ravel_multi_index([i % n for i, n in zip(point, self.shape, strict=True)], self.shape))


def axes_of(over: Mapping[str, Any], *, zipped: bool, resolve: Callable[[Any], Any] | None = None) -> Axes:
    """Read the axes of a sweep and check them, with a line for each mistake.

    `resolve` turns a Python function that stands for a grading into a grading that is data.
    """
    problems = [] if over else ["sweep: give at least one key of a scene and its values"]
    values: dict[str, tuple[Any, ...]] = {}
    for key, given in over.items():
        section, _, name = key.partition(".")
        if section not in _SECTIONS or (not name and section in ("contact", "ensemble")):
            problems.append(f'sweep: {key!r}: give "section.key" of a scene file, such as "grading.gamma"')
        if key in _FIXED:
            problems.append(f"sweep: {key}: must be the same for all points; give it in the scene")
        listed = list(given) if hasattr(given, "__iter__") and not isinstance(given, str | Mapping) else []
        if not listed:
            problems.append(f"sweep: {key} = {given!r}: give a list of at least one value")
        values[key] = tuple(_value(key, value, resolve) for value in listed)
    if zipped and len({len(each) for each in values.values()}) > 1:
        lengths = ", ".join(f"{key} {len(each)}" for key, each in values.items())
        problems.append(f"sweep: zipped axes need the same number of values; these have {lengths}")
    if problems:
        raise SceneError(problems)
    return Axes(values, zipped)


def _value(key: str, value: Any, resolve: Callable[[Any], Any] | None = None) -> Any:
    """Return a value as in a scene file; a whole grading may be an object, or a function that is resolved."""
    if key == "grading" and callable(value):
        if resolve is not None:
            value = resolve(value)
        elif not is_data(value):
            raise ValueError("grading: a point that has a function is named by its indices")
        return law_table(value, "grading")
    return as_toml(value)


def label(value: Any) -> Any:
    """Return a value as the coordinate of an axis: a number or a text."""
    if isinstance(value, Mapping):
        return brief(", ".join(f"{key} = {inner}" for key, inner in value.items()))
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return brief(str(value))
    return value


def _short(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(label(value))
