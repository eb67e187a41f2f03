"""One table of a TOML document, read key by key; what is wrong is collected, not raised."""

import difflib
import math
from collections.abc import Sequence
from typing import Any

from mcgw.formats.units import EXAMPLES, parse
from mcgw.machine.terminal import one_line

__all__ = ["SceneError", "Section", "nearest"]

_MISSING: Any = object()
_MOST_WHOLE = 10**30  # so that no message has hundreds of digits
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


class Section:
    """A table and the mistakes found in it.

    Parameters
    ----------
    name : str
        Its name, "" for the document.
    table : dict
        Its contents.
    problems : list of str
        Shared by all sections of a document; each mistake adds a line.
    """

    def __init__(self, name: str, table: dict[str, Any], problems: list[str]) -> None:
        self.name, self.table, self.problems = name, table, problems
        self._known: list[str] = []

    def section(self, name: str) -> "Section":
        """Read a table inside this one, empty if it is not there."""
        value = self._take(name, {})
        if not isinstance(value, dict):
            self.fail(name, value, f"must be a table: write [{name}] above its keys")
            value = {}
        return Section(name, value, self.problems)

    def fail(self, key: str, value: Any, advice: str) -> None:
        """Note a mistake."""
        shown = repr(value)
        shown = shown if len(shown) <= 60 else shown[:57] + "..."
        self.problems.append(f"{self._path(key)} = {shown}: {advice}")

    def __contains__(self, key: str) -> bool:
        """Whether the key is given."""
        return key in self.table

    def number(self, key: str, default: float = _MISSING, *, unit: str = "", positive: bool = True) -> float:
        """Read a finite number, by default a positive one; with a unit also a text, as "1.37 um"."""
        value = self._take(key, default, unit)
        if value is default:
            return float("nan") if value is _MISSING else value
        wanted = f"give a finite number{' > 0' if positive else ''}"
        if unit:
            wanted += f"{f' in {unit}' if unit != '1' else ''}, such as {EXAMPLES[unit]}"
        try:
            if unit and isinstance(value, str):
                return parse(value, unit)
            number = float(value) if _is_number(value) else math.nan
        except OverflowError:
            number = math.inf
        except ValueError:
            number = math.nan
        if not math.isfinite(number) or (positive and number <= 0):
            self.fail(key, value, wanted)
            return math.nan
        return number

    def whole(self, key: str, default: Any = _MISSING, *, least: int = 0) -> Any:
        """Read a whole number; 1e6 is one, 1.5 and true are not."""
        value = self._take(key, default)
        if value is default:
            return None if value is _MISSING else value
        whole = _is_number(value) and math.isfinite(value) and value == int(value) if _fits(value) else False
        if not whole or not least <= value <= _MOST_WHOLE:
            self.fail(key, value, f"give a whole number >= {least}")
            return None
        return int(value)

    def text(self, key: str, default: str) -> str:
        """Read a string."""
        value = self._take(key, default)
        if not isinstance(value, str):
            self.fail(key, value, "give a text in quotes")
            return default
        return value

    def choice(self, key: str, default: str, known: Sequence[str]) -> str:
        """Read one of a few words."""
        value = self._take(key, default)
        if value not in known:
            self.fail(key, value, f"{nearest(value, known)}choose one of {', '.join(known)}")
            return default
        return str(value)

    def take(self, key: str) -> Any:
        """Read any value, None if it is not there."""
        return self._take(key, None)

    def known(self, *keys: str) -> None:
        """Keys that are known here, read or not."""
        self._known += keys

    def finish(self) -> None:
        """Note every key that was not read."""
        unknown = [key for key in self.table if key not in self._known]
        for key in unknown[:_MOST_NAMED]:
            meant = nearest(key[:99], self._known) or f"known here: {', '.join(self._known)}"
            self.problems.append(f"{self._path(key)}: unknown key; {meant.removesuffix(' ')}")
        if len(unknown) > _MOST_NAMED:
            self.problems.append(f"[{self.name}]: {len(unknown) - _MOST_NAMED} more unknown keys")

    def _path(self, key: str) -> str:
        shown = one_line(key if len(key) <= 60 else f"{key[:57]}...")
        return f"{self.name}.{shown}" if self.name else shown

    def _take(self, key: str, default: Any, unit: str = "") -> Any:
        self._known.append(key)
        if key not in self.table and default is _MISSING:
            self.problems.append(f"{self._path(key)}: missing; {f'give it in {unit}' if unit else 'give it'}")
        return self.table.get(key, default)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _fits(value: Any) -> bool:
    """Whether a value can be compared as a float without overflow."""
    return not isinstance(value, float) or math.isfinite(value)


def nearest(value: Any, known: Sequence[str]) -> str:
    """A question for the word that was meant, or nothing."""
    close = difflib.get_close_matches(str(value), known, n=1)
    return f"did you mean {close[0]}? " if close else ""
