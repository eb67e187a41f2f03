"""One table of a scene, read key by key; what is wrong is collected, not raised."""

import difflib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from mcgw.machine.terminal import one_line

_MOST_NAMED = 20  # unknown keys of a table: more say nothing new
_FROM_ROW: Any = object()


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


class Kind:
    """What a key may hold: its `unit`, if it is a number, and `advice` what to give."""

    advice: str = ""
    unit: str = ""

    def read(self, path: str, value: Any) -> Any:
        """Return the value of a key, or raise `SceneError`."""
        found = self.value(value)
        if found is None:
            raise mistake(path, value, self.wanted)
        return found

    def value(self, given: Any) -> Any:
        """Return the value, or None if it does not fit."""
        raise NotImplementedError

    @property
    def wanted(self) -> str:
        """What to give in place of a value that does not fit."""
        return self.advice


def mistake(path: str, value: Any, advice: str) -> SceneError:
    """Return the mistake of a value at a key, with what to give."""
    try:
        written = repr(value)
    except ValueError:
        written = "a number of more than 4000 digits"
    return SceneError([f"{path} = {shortened(written)}: {advice}"])


@dataclass(frozen=True, slots=True)
class Key:
    """A row of a table of keys."""

    name: str
    kind: Kind
    example: str = ""  # a right value, as TOML
    words: str = ""  # its meaning, as Markdown; empty: told by a docstring, or a key inside a value
    default: Any = None  # if it is left out
    required: bool = False  # whether it must be there, in a table that is asked for it
    needs: tuple[str, ...] = ()  # keys of its table of which one must be there too
    excludes: tuple[str, ...] = ()  # and of which none may


class Section:
    """The contents of a table by its keys, its `known` keys and tables, and a line for each mistake in it."""

    def __init__(self, name: str, table: Mapping[str, Any], rows: Mapping[str, Key]) -> None:
        self.name, self.table, self.rows = name, table, rows
        self.known = [*rows]
        self.problems: list[str] = []

    def section(self, name: str, rows: Mapping[str, Key], python: str = "") -> "Section":
        """Return a table inside this one, in place of which Python gives an object; empty if missing."""
        self.known.append(name)
        value = self.table.get(name, {})
        if not isinstance(value, dict):
            other = f", or in Python give {python}" if python else ""
            self.fail(name, value, f"must be a table: write [{name}] above its keys{other}")
            value = {}
        return Section(self.path(name), value, rows)

    def fail(self, name: str, value: Any, advice: str) -> None:
        """Note a mistake in the value of a key."""
        self.problems += mistake(self.path(name), value, advice).problems

    def __contains__(self, name: str) -> bool:
        """Whether the key is given."""
        return name in self.table

    def read(self, name: str, default: Any = _FROM_ROW) -> Any:
        """Read a key by its row; None if it is wrong, or left out without a default."""
        row = self.rows[name]
        if name in self.table:
            try:
                return row.kind.read(self.path(name), self.table[name])
            except SceneError as error:
                self.problems += error.problems
                return None
        if row.required and default is _FROM_ROW:
            unit = row.kind.unit
            cure = f"give it in {unit}" if unit not in ("", "1") else row.kind.advice or "give it"
            self.problems.append(f"{self.path(name)}: missing; {cure}")
        return row.default if default is _FROM_ROW else default

    def read_all(self, names: Iterable[str]) -> dict[str, Any]:
        """Read several keys."""
        return {name: self.read(name) for name in names}

    def made(self, make: Callable[..., Any], given: Mapping[str, Any]) -> Any:
        """Return what values of keys make; None if it cannot be made, or was wrong already.

        A mistake is noted at the key that it names, or at the first that is given.
        """
        if self.problems:
            return None
        try:
            return make(**given)
        except (TypeError, ValueError) as error:
            reason = str(error)
        key, _, advice = reason.partition(": ")
        at, there = key.partition(" = ")[0].partition(",")[0], [name for name in given if name in self]
        if at in there:
            self.fail(at, self.table[at], advice)
        elif at in self.rows or not there:
            self.problems.append(f"{self.name}{'.' if at in self.rows else ': '}{reason}")
        else:
            cure = self.rows["file"].kind.advice if there[0] == "file" else ""
            self.fail(there[0], self.table[there[0]], "; ".join(filter(None, (reason, cure))))
        return None

    def finish(self, moved: Callable[[str], str] = str) -> None:
        """Note unknown keys, whose tables `moved` may know, and those that do not go together."""
        unknown = [key for key in self.table if key not in self.known]
        for key in unknown[:_MOST_NAMED]:
            meant = nearest(key[:99], self.known) or f"known keys: {', '.join(self.known)}"
            if "." in (whole := moved(key)) and whole != self.path(key):
                meant = f"did you mean {whole}?"
            self.problems.append(f"{self.path(key)}: unknown key; {meant.removesuffix(' ')}")
        if len(unknown) > _MOST_NAMED:
            self.problems.append(f"[{self.name}]: {len(unknown) - _MOST_NAMED} more unknown keys")
        told = [line.partition(":")[0] for line in self.problems]  # a missing key is noted once
        for row in (row for row in self.rows.values() if row.name in self.table):
            value, needs = self.table[row.name], " or ".join(row.needs)
            if row.needs and not any(other in self.table or self.path(other) in told for other in row.needs):
                self.fail(row.name, value, f"give {needs} too, or leave it out")
            if others := [other for other in row.excludes if other in self.table]:
                self.fail(row.name, value, f"give it or {' or '.join(others)}, not both")

    def path(self, name: str) -> str:
        """Name of a key with its table."""
        shown = one_line(shortened(name))
        return f"{self.name}.{shown}" if self.name else shown


def shortened(text: str) -> str:
    """Shorten a text to 60 characters, with dots at its end."""
    return text if len(text) <= 60 else f"{text[:57]}..."


def nearest(value: Any, known: Iterable[str]) -> str:
    """Suggest the word that was meant, or nothing."""
    close = difflib.get_close_matches(str(value), list(known), n=1)
    return f"did you mean {close[0]}? " if close else ""
