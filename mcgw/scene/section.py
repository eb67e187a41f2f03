"""A table of keys read by its rows; what is wrong is collected, not raised."""

import difflib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields
from functools import lru_cache
from inspect import Parameter, signature
from types import MappingProxyType
from typing import Any

from mcgw.machine.terminal import one_line

signature_of = lru_cache(64)(signature)
_MOST_NAMED = 20  # unknown keys of a table: more say nothing new


class SceneError(ValueError):
    r"""A scene that cannot be run; `problems` has one line for each mistake.

    Examples
    --------
    >>> import mcgw
    >>> try:
    ...     mcgw.Surface("1.37 m^2", "13 um", "300/mm^2", "1 cm^2", -78.6e9)
    ... except mcgw.SceneError as error:
    ...     print(*error.problems, sep="\n")
    surface.sigma = '1.37 m^2': give a finite number > 0 in m, such as 1.37um, 0.2 mm or 5e-6 (m)
    surface.E_star = -78600000000.0: give a finite number > 0 in Pa, such as 1MPa, 78.6 GPa or 1e6 (Pa)
    """

    def __init__(self, problems: list[str]) -> None:
        self.problems = problems
        super().__init__("\n".join(problems))


def mistake(path: str, value: Any, advice: str) -> SceneError:
    """Return the mistake of a value at a key, with what to give."""
    try:
        written = repr(value)
    except ValueError:
        written = "a number of more than 4000 digits"
    return SceneError([f"{one_line(path[:99])} = {shortened(written)}: {advice}"])


def shortened(text: str) -> str:
    """Shorten a text to 60 characters, with dots at its end."""
    return text if len(text) <= 60 else f"{text[:57]}..."


def close(value: Any, known: Iterable[str]) -> str:
    """Return the word that was meant, or nothing."""
    return next(iter(difflib.get_close_matches(str(value), list(known), n=1)), "")


def nearest(value: Any, known: Iterable[str]) -> str:
    """Suggest the word that was meant, or nothing."""
    return f"did you mean {meant}? " if (meant := close(value, known)) else ""


class Kind:
    """What a key may hold: its `unit`, if it is a number, and `advice` what to give."""

    advice: str = ""
    unit: str = ""
    looks: Any = object  # types of values that are read as of this kind

    def read(self, path: str, value: Any) -> Any:
        """Return the value of a key, or raise `SceneError`."""
        raise NotImplementedError


@dataclass(frozen=True, slots=True)
class Key:
    """A row of a table of keys."""

    name: str
    kind: Kind
    example: str = ""  # a right value, as TOML
    words: str = ""  # its meaning, as Markdown; empty: told by a docstring, or a key inside a value
    default: Any = None  # if it is left out
    required: bool = False  # whether it must be there, unless a key that excludes it is
    needs: tuple[str, ...] = ()  # keys of its table of which one must be there too
    excludes: tuple[str, ...] = ()  # and of which none may


def key(kind: Kind, example: str = "", default: Any = None, **others: Any) -> Any:
    """Return a field with its row in the table of its part."""
    row = {"kind": kind, "example": example, "default": default, **others}
    return field(metadata=row) if others.get("required") else field(default=default, metadata=row)


def rows_of(part: type) -> tuple[Key, ...]:
    """Return the rows of a part: its fields that are keys of a table."""
    return tuple(Key(each.name, **each.metadata) for each in fields(part) if each.metadata)


class Section:
    """A table read by its rows: the `values` of keys that are right, and a line for each mistake.

    It may have `tables` inside; keys of other tables stand `elsewhere`, each with its table.
    """

    def __init__(
        self,
        name: str,
        table: Mapping[str, Any],
        rows: Iterable[Key],
        tables: Iterable[str] = (),
        elsewhere: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        self.name, self.table, self.rows = name, table, {row.name: row for row in rows}
        self.path = f"{name}." if name else ""
        self.values: dict[str, Any] = {}
        self.problems: list[str] = []
        self.present = [row for row in self.rows.values() if row.name in table]
        for row in self.present:
            try:
                self.values[row.name] = row.kind.read(self.path + row.name, table[row.name])
            except SceneError as error:
                self.problems += error.problems
            if row.needs and not any(other in table for other in row.needs):
                self.fail(row.name, f"give {' or '.join(row.needs)} too, or leave it out")
            if others := [other for other in row.excludes if other in table]:
                self.fail(row.name, f"give it or {' or '.join(others)}, not both")
        known = [*self.rows, *tables]
        unknown = [key for key in table if key not in known]
        for key in unknown[:_MOST_NAMED]:
            short = key[:99]
            meant = elsewhere.get(key) or close(short, known) or elsewhere.get(close(short, elsewhere))
            advice = f"did you mean {meant}?" if meant else f"known keys: {', '.join(known)}"
            self.problems.append(f"{self.path}{one_line(shortened(key))}: unknown key; {advice}")
        if len(unknown) > _MOST_NAMED:
            self.problems.append(f"[{name}]: {len(unknown) - _MOST_NAMED} more unknown keys")

    def get(self, name: str) -> Any:
        """Return the value of a key, or its default."""
        return self.values.get(name, self.rows[name].default)

    def fail(self, name: str, advice: str) -> None:
        """Note a mistake in the value of a key."""
        self.problems += mistake(self.path + name, self.table[name], advice).problems

    def make(self, make: Callable[..., Any], why: str = "", **others: Any) -> Any:
        """Return what the values that `make` takes, and others, make; mistakes are noted and give None.

        They are noted at the key that they name, or at the first that is given; `why` the law needs it.
        """
        known = signature_of(make).parameters
        given = {name: value for name, value in (others | self.values).items() if name in known}
        told = {*given, *self.table, *(name for row in self.present for name in (*row.needs, *row.excludes))}
        for name in [x.name for x in known.values() if x.default is Parameter.empty and x.name not in told]:
            if name in self.rows:
                kind = self.rows[name].kind
                cure = f"give it in {kind.unit}" if kind.unit not in ("", "1") else kind.advice or "give it"
                self.problems.append(f"{self.path}{name}: missing; {why or cure}")
        if self.problems:
            return None
        try:
            return make(**given)
        except (TypeError, ValueError) as error:
            reason = str(error)
        key, _, advice = reason.partition(": ")
        at, there = key.partition(" = ")[0].partition(",")[0], [name for name in given if name in self.table]
        if at in there:
            self.fail(at, advice)
        elif at in self.rows or not there:
            self.problems.append(f"{self.name}{'.' if at in self.rows else ': '}{reason}")
        else:
            cure = self.rows["file"].kind.advice if there[0] == "file" else ""
            self.fail(there[0], "; ".join(filter(None, (reason, cure))))
        return None
