"""Kinds of values of keys, and arguments of such kinds: numbers with units, words, lists, tables."""

import math
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mcgw.formats.units import EXAMPLES, signed
from mcgw.machine.terminal import brief
from mcgw.scene.section import Key, Kind, SceneError, Section, mistake, nearest

MOST_WHOLE = 10**30  # so that no message has hundreds of digits


@dataclass(frozen=True, slots=True)
class Number(Kind):
    """A finite number; with a unit of `mcgw.formats.units` also a text such as "1.37 um"."""

    unit: str = ""
    low: float = 0.0
    high: float = math.inf
    zero: bool = False  # whether 0 is allowed if `low` is 0
    infinite: bool = False
    advice: str = ""  # what would do, by default by unit and range
    looks = (int, float, str)

    def read(self, path: str, value: Any) -> float:
        """Return the number."""
        number = math.nan
        if isinstance(value, str) and self.unit:
            number = signed(value, self.unit)
        elif isinstance(value, int | float) and not isinstance(value, bool):
            with suppress(OverflowError):
                number = float(value)
        inside = self.low <= number <= self.high and (number != 0 or self.zero or self.low != 0)
        if (inside and math.isfinite(number)) or (self.infinite and number == math.inf):
            return number
        above = (" >= 0" if self.zero else " > 0") if self.low == 0 else ""
        below = f" and at most {self.high:g}" if self.high < math.inf else ""
        if self.unit:
            below += f"{f' in {self.unit}' if self.unit != '1' else ''}, such as {EXAMPLES[self.unit]}"
        raise mistake(path, value, self.advice or f"give a finite number{above}{below}")


@dataclass(frozen=True, slots=True)
class Whole(Kind):
    """An integer: 1e6 is one, 1.5 and true are not."""

    low: int = 0
    high: int = MOST_WHOLE
    advice: str = ""

    def read(self, path: str, value: Any) -> int:
        """Return the integer; one that was left out stays so."""
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if number and self.low <= value <= self.high and value == int(value):
            return value if isinstance(value, int) else int(value)
        raise mistake(path, value, self.advice or f"give a whole number >= {self.low}")


@dataclass(frozen=True, slots=True)
class Word(Kind):
    """One of a few words, or what stands for one: an object that Python gives and a function `accepts`."""

    words: tuple[str, ...]
    advice: str = ""
    accepts: Callable[[Any], Any] | None = None
    objects: str = ""
    looks = str

    def read(self, path: str, value: Any) -> Any:
        """Return the word or the object."""
        advice, python = self.advice, ""
        try:
            if isinstance(value, str) and value in self.words:
                return value
            if self.accepts and not isinstance(value, str):
                if (found := self.accepts(value)) is not None:
                    return found
                python = f"; in Python, give {self.objects}"
        except (TypeError, ValueError) as error:
            advice = str(error)
        advice = advice or f"choose one of {', '.join(self.words)}{python}"
        raise mistake(path, value, f"{nearest(value, self.words)}{advice}")


@dataclass(frozen=True, slots=True)
class Plain(Kind):
    """A text, not empty unless it may be, or true and false."""

    type: type = str
    empty: bool = False
    advice: str = "give a text in quotes"

    def read(self, path: str, value: Any) -> Any:
        """Return what is of the type."""
        if isinstance(value, self.type) and (value or self.empty):
            return value
        raise mistake(path, value, self.advice)


FLAG = Plain(bool, True, "give true or false")


@dataclass(frozen=True, slots=True)
class List(Kind):
    """A list of values of one kind, with bounds on their number, perhaps without repeats."""

    item: Kind
    least: int = 1
    most: float = math.inf
    advice: str = "give a list of finite numbers"
    once: bool = False
    looks = list

    def read(self, path: str, value: Any) -> tuple[Any, ...]:
        """Read all values."""
        found: list[Any] = []
        few = "give at least one; " if value == [] and self.least == 1 else ""
        reason = ""
        try:
            if isinstance(value, list) and self.least <= len(value) <= self.most:
                found.extend(self.item.read(path, each) for each in value)
                if not self.once or len(set(found)) == len(found):
                    return tuple(found)
        except SceneError:
            if isinstance(self.item, Word):
                raise
            reason = f"; value {len(found) + 1} is {brief(repr(value[len(found)]))}"
        raise mistake(path, value, f"{few}{self.advice}{reason}")


@dataclass(frozen=True, slots=True)
class Table(Kind):
    """A table, or the object that its keys `make`, without which it is read as values.

    Its keys are its rows; or any names, some of `names`, if there are, each with a value like the `item`.
    """

    rows: tuple[Key, ...] = ()
    advice: str = ""
    make: Callable[..., Any] | None = None
    item: Kind | None = None
    names: tuple[str, ...] = ()
    words: str = ""
    required: bool = False

    @property
    def looks(self) -> Any:
        """A table, or what it makes."""
        return (Mapping, self.make) if isinstance(self.make, type) else Mapping

    def read(self, path: str, value: Any) -> Any:
        """Read its keys and make the object."""
        if isinstance(self.make, type) and isinstance(value, self.make):
            return value
        if not isinstance(value, Mapping):
            raise mistake(path, value, self.advice)
        rows = [Key(name, self.item) for name in value] if self.item else self.rows
        inner = Section(path, value, rows)
        made = inner.make(self.make) if self.make else inner.values
        if inner.problems:
            raise SceneError(inner.problems)
        return made


@dataclass(frozen=True, slots=True)
class Either(Kind):
    """A list, a table in braces, or a number or word: the kinds in this order."""

    kinds: tuple[Kind, ...]
    advice: str = ""

    def read(self, path: str, value: Any) -> Any:
        """Read it as the kind that it looks like."""
        for kind in self.kinds:
            if isinstance(value, kind.looks):
                return kind.read(path, value)
        raise mistake(path, value, self.advice)


def arguments(given: Mapping[str, Any], kinds: Mapping[str, Kind]) -> dict[str, Any]:
    """Read arguments of these kinds as a table of keys; raises `SceneError`, whose lines name them."""
    table = Table(tuple(Key(name, kind) for name, kind in kinds.items()))
    values: dict[str, Any] = table.read("", {name: as_toml(x) for name, x in given.items() if name in kinds})
    return values


def argument(name: str, value: Any, unit: str) -> float:
    """Read a positive number, or a text with its unit; errors as in `arguments`."""
    return float(arguments({name: value}, {name: Number(unit)})[name])


def as_toml(value: Any) -> Any:
    """Convert a Python value to what TOML gives: arrays, tuples and ranges to lists; None is left out."""
    if isinstance(value, np.random.SeedSequence):  # seeds, as what draws them
        return int(value.generate_state(1, np.uint64)[0])
    if isinstance(value, np.random.BitGenerator | np.random.Generator):
        return int(np.random.default_rng(value).integers(2**63))
    if isinstance(value, str | bytes | bool | int | float) or callable(value):
        return value.item() if isinstance(value, np.generic) else value
    if isinstance(value, Mapping):
        return {key: as_toml(inner) for key, inner in value.items() if inner is not None}
    if hasattr(value, "__array__"):
        return np.asarray(value).tolist()
    if isinstance(value, Iterable) and not isinstance(value, type):
        return [as_toml(inner) for inner in value]
    return value


_DRAWN = "mcgw.simulate(scene) draws one"
_MAKES = {
    "Scene": {
        **dict.fromkeys(("Surface", "Spectral"), "mcgw.Scene(surface, separations=...) makes one of it"),
        "path": "mcgw.load_scene(path) reads one",
        "Ensemble": "that of an ensemble is its .scene",
        **dict.fromkeys(("Fit", "ProfileFit"), "mcgw.fitted_scene(fit) makes one of it"),
    },
    "Ensemble": {"Scene": _DRAWN, "path": "mcgw.open_ensemble(path) opens one", "Surface": _DRAWN},
}


def check_object(call: str, value: Any, kind: type) -> None:
    """Check the type of an argument; raises `TypeError` in one line."""
    if isinstance(value, kind):
        return
    ways, name = _MAKES[kind.__name__], type(value).__name__
    way = ways.get("path" if isinstance(value, str | Path) else name) or next(iter(ways.values()))
    shown = f" {brief(repr(str(value)))}" if isinstance(value, str | Path) else ""
    raise TypeError(f"{call}: give a mcgw.{kind.__name__}, not {name}{shown}; {way}")
