"""A table of named columns: printed, as HTML, as CSV and as a DataFrame; and numbers as people write them."""

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from analytic.arrays import Ints
from mcgw.errors import extra
from mcgw.formats.files import whole_file
from mcgw.machine.terminal import brief, drawers, listed, one_line

SEPARATION = "d/sigma"  # over a column of separations
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_POWER, _MINUS = re.compile(r"(?<=\d)e([+-]\d+)\b"), re.compile(r"(?<![\w⁻])-(?=[\d.])")
_PRINTED = {"d/sigma": "d/σ", "gap/sigma": "gap/σ", "^2": "²", "+-": "±", " ... ": " … "}


@dataclass(frozen=True)
class Column:
    """Numbers or texts of one kind, one for each row."""

    name: str  # in a CSV file or a DataFrame
    values: Any
    words: str = ""  # its heading; default: its name
    unit: str = ""
    form: str = ".6g"  # of a number for a reader; files have all digits
    missing: str = "nan"  # text in place of nan
    # Text between it and the column before it, in whose cell it stands, such as an error or the end of an
    # interval; where it is nan, the other stands alone. Default: it has cells of its own.
    between: str = ""
    error: Any = None  # of each number, which is shown to the second digit of its error

    @property
    def suffix(self) -> str:
        """Its unit behind a name."""
        return f" ({self.unit})" if self.unit not in ("", "1") else ""

    def at(self, k: Sequence[int]) -> "Column":
        """Return some of its rows, by number."""
        error = None if self.error is None else np.asarray(self.error)[list(k)]
        return replace(self, values=[self.values[i] for i in k], error=error)

    def cells(self) -> list[str]:
        """Return the displayed text of each row."""
        errors = np.broadcast_to(np.nan if self.error is None else self.error, len(self.values))
        return [self._shown(x, error) for x, error in zip(self.values, errors, strict=True)]

    def _shown(self, x: float | str, error: float) -> str:
        if isinstance(x, str):
            return x
        if np.isnan(x):
            return self.missing
        return format(x, f".{digits_of(x, error)}g" if 0 < error < np.inf and x else self.form)


@dataclass(frozen=True)
class Table:
    """Columns of one length under a title and facts, each a name and a text.

    >>> Table((Column("h", [0.0, 1.0], SEPARATION, form="g"), Column("load", [77.8, 13.5], unit="N")))
      d/sigma  load (N)
      0            77.8
      1            13.5
    """

    columns: tuple[Column, ...] = ()
    title: str = ""
    facts: Sequence[tuple[str, str]] = ()

    def __len__(self) -> int:
        return len(self.columns[0].values) if self.columns else 0

    def under(self, title: str, facts: Sequence[tuple[str, str]] = ()) -> "Table":
        """Return the same under a title and facts."""
        return replace(self, title=title, facts=facts)

    def only(self, *names: str) -> "Table":
        """Return some of its columns, in this order."""
        by_name = {column.name: column for column in self.columns}
        return replace(self, columns=tuple(by_name[name] for name in names))

    def rows(self, most: int = 9) -> "Table":
        """At most this many rows, evenly spaced, with the first and the last."""
        return self.at(evenly(len(self), most).tolist())

    def at(self, k: Sequence[int]) -> "Table":
        """Return some of its rows, by number."""
        return replace(self, columns=tuple(column.at(k) for column in self.columns))

    def cells(self) -> list[list[str]]:
        """Return what is displayed, column by column, each under its heading (a unit of the title once)."""
        shown: list[list[str]] = []
        for column in self.columns:
            if not column.between:
                unit = "" if column.suffix in self.title else column.suffix
                shown.append([(column.words or column.name) + unit, *column.cells()])
                continue
            for k, (x, cell) in enumerate(zip(column.values, column.cells(), strict=True), 1):
                shown[-1][k] += "" if np.isnan(x) else f"{column.between}{cell}"
        return shown

    def text(self, whole: bool = False) -> str:
        """Plain text: texts are aligned left, numbers right; long facts are cut unless asked for `whole`."""
        lines = [one_line(self.title)] if self.title else []
        lines += listed((name, one_line(text) if whole else brief(text)) for name, text in self.facts)
        cells = self.cells()
        widths = [max(map(len, column)) for column in cells]
        values = [column.values for column in self.columns if not column.between]
        sides = [
            "<" if not k or any(isinstance(x, str) for x in some[:1]) else ">"
            for k, some in enumerate(values)
        ]
        for row in zip(*cells, strict=True):
            told = (f"{x:{side}{width}}" for x, side, width in zip(row, sides, widths, strict=True))
            lines.append(f"  {'  '.join(told)}".rstrip())
        return "\n".join(lines)

    __repr__ = text

    def _repr_html_(self) -> str:
        cells = "<tr><th>{}</th><td>{}</td></tr>".format
        facts = "".join(cells(escape(name), escape(brief(text))) for name, text in self.facts)
        facts = f"<table>{facts}</table>" if facts else ""
        return f"<b>{escape(one_line(self.title))}</b>{facts}{self.html()}"

    def html(self) -> str:
        """Return its columns as a ``table``: the cells of a terminal, typeset, every text escaped."""
        if not self.columns:
            return ""
        head, *rows = ([escape(typeset(cell)) for cell in row] for row in zip(*self.cells(), strict=True))
        above = "".join(f"<th>{cell}</th>" for cell in head)
        below = "".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in rows)
        return f"<table><thead><tr>{above}</tr></thead><tbody>{below}</tbody></table>"

    def write(self, path: str | Path, *, comment: str = "") -> None:
        """Write it as CSV, whole or not at all: a comment, names with units, then rows to the last bit."""
        with (
            whole_file(Path(path)) as unfinished,
            open(unfinished, "w", newline="", encoding="utf-8") as file,
        ):
            file.write(f"# {one_line(comment)}\n" if comment else "")
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow([column.name + column.suffix for column in self.columns])
            writer.writerows(zip(*(column.values for column in self.columns), strict=True))

    def to_dataframe(self) -> Any:
        """Return the same as a `pandas.DataFrame`."""
        pandas = optional("pandas", "to_dataframe")
        return pandas.DataFrame({column.name: column.values for column in self.columns})


class Shown:
    """Displays itself as a table with facts above it."""

    def sheet(self) -> Table:
        """Return what is shown, at most a dozen lines."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return self.sheet().text()

    def _repr_html_(self) -> str:
        return self.sheet()._repr_html_()


class Drawn(Shown):
    """Draws itself, too."""

    def plot(self, *given: Any, ax: Any = None, **options: Any) -> Any:
        """Draw it; returns the axes, with labels and a legend.

        Parameters
        ----------
        *given : str or matplotlib Axes, optional
            Of what has several quantities the name of one, default: the first; and `ax`, in either order.
        ax : matplotlib Axes, optional
            Axes to draw on; default: new ones.
        **options
            ``quantity``, as before; ``k`` of slopes, the number of a separation; ``want`` of error against
            time: "mean", "std", "quantile", "distribution", "conductance" or "values".
        """
        for each in given:
            options |= {"quantity": each} if isinstance(each, str) else {"ax": each}
        return drawers[0](self, options.pop("ax", ax), **options)


def stacked(tables: Mapping[str, Table], key: str, words: str = "") -> Table:
    """Stack tables with the same columns, after those of their keys and of their units, if there are any."""
    rows = [len(table) for table in tables.values()]
    units = [next((x.unit for x in table.columns if x.unit), "") for table in tables.values()]
    first = [Column(key, np.repeat([*tables], rows).tolist(), words)]
    if any(units):
        first.append(Column("unit", np.repeat(units, rows).tolist()))
    return Table((*first, *joined([*tables.values()]).columns))


def joined(tables: Sequence[Table]) -> Table:
    """Stack tables with the same columns; units and errors are those of columns that all have them."""
    columns = []
    for parts in zip(*(table.columns for table in tables), strict=True):
        values, errors = [part.values for part in parts], [part.error for part in parts]
        unit = parts[0].unit if len({part.unit for part in parts}) == 1 else ""
        error = None if any(x is None for x in errors) else np.concatenate(errors)
        columns.append(replace(parts[0], values=np.concatenate(values), unit=unit, error=error))
    return Table(tuple(columns))


def typeset(text: str) -> str:
    """Typeset plain text of a terminal: 1e-05, d/sigma, m^2, +-, ... and minus signs.

    >>> typeset("d/sigma = -1.5 +- 2e-05 m^2")
    'd/σ = −1.5 ± 2×10⁻⁵ m²'
    """
    text = _POWER.sub(lambda found: f"×10{str(int(found[1])).translate(RAISED)}", text)
    for plain, printed in _PRINTED.items():
        text = text.replace(plain, printed)
    return _MINUS.sub("−", text)


def digits_of(x: float, error: float) -> int:
    """Return the number of digits down to the second digit of the error, from two to seven."""
    return int(np.clip(np.floor(np.log10(abs(x))) - np.floor(np.log10(error)) + 2, 2, 7))


def with_error(x: float, error: float) -> str:
    """Return a number with its standard error, both to the second digit of that.

    >>> with_error(79.638, 2.95), with_error(1.2874e-10, 2.1e-12), with_error(3.0, float("nan"))
    ('79.6 +- 3', '1.287e-10 +- 2.1e-12', '3')
    """
    return f"{x:.{digits_of(x, error)}g} +- {error:.2g}" if 0 < error < np.inf and x else f"{x:.6g}"


def evenly(n: int, most: int) -> Ints:
    """Return the indices of at most `most` of `n` rows, rising."""
    return np.unique(np.linspace(0, n - 1, min(n, most)).round().astype(np.int64))


def optional(package: str, what: str) -> Any:
    """Import a package; the error of one that is not installed says what needs it and how to get it."""
    try:
        return import_module(package)
    except ImportError:
        raise ImportError(f"{what} needs {package}: {extra('notebook')}", name=package) from None
