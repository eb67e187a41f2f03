"""Files beside a scene: moduli against height, heights, summits with radii."""

import csv
import math
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from analytic import Surface, Table
from analytic.arrays import Array
from mcgw.formats.named_files import open_npy, read_text
from mcgw.formats.units import signed

_MOST_BYTES, _MOST_OF_MODULI = 2**28, 2**24
_COLUMNS = {"s": "1", "z": "m", "ratio": "1", "E_star": "Pa"}
_SUMMITS = ("height", "radius")
_NAMED = re.compile(r"\s*(\w+)\s*(?:[(\[/ ]\s*([^()\[\]]*?)\s*[)\]]?)?\s*")  # z, z (um), z [um], z / um, z um


def read_grading(path: Path, surface: Surface) -> Table:
    """Return a grading from a CSV file of bounded length, as `analytic.Table.from_csv` reads it.

    Units may follow the names, ``z (um), E_star (GPa)``, or the numbers, ``61.2 GPa``.

    Raises
    ------
    ValueError
        If it cannot be read, or is not such a table.
    """
    lines = read_text(path, _MOST_OF_MODULI).splitlines()
    try:
        return Table.from_lines(_in_si(lines), sigma=surface.sigma, E_star=surface.E_star)
    except (ValueError, csv.Error) as error:
        raise ValueError(f"{path}: {error}") from None


def _in_si(lines: list[str]) -> Iterator[str]:
    """Lines of a table in SI; text that is no number stays, to be refused later."""
    header, *rows = [row for row in csv.reader(lines) if row] or [[]]
    named = [
        (match[1], match[2] or "") if (match := _NAMED.fullmatch(name)) else (name, "") for name in header
    ]
    known = [name in _COLUMNS and not math.isnan(signed(f"1{unit}", _COLUMNS[name])) for name, unit in named]
    if not all(known):
        raise ValueError(
            "the first line must be s or z, a comma, and ratio or E_star, such as z (um),E_star (GPa)"
        )
    yield ",".join(name for name, _ in named)
    for row in rows:
        cells = [_cell(text, *column) for text, column in zip(row, named, strict=False)]
        yield ",".join([*cells, *row[len(named) :]])


def _cell(text: str, name: str, unit: str) -> str:
    """Return a number in its own unit or in that of its column."""
    for written in (f"{text}{unit}", text):
        if math.isfinite(value := signed(written, _COLUMNS[name])):
            return repr(value)
    return text.replace(",", " ")


def read_heights(path: Path) -> Array:
    """Heights from ``.npy`` or text with one a line (# begins a comment), in any unit; shape (heights,).

    Raises
    ------
    ValueError
        If the file cannot be read, is longer than 256 MB, or does not hold numbers; nothing of what stands
        there is quoted.
    """
    if path.suffix == ".npy":
        array = open_npy(path)
        if array.nbytes > _MOST_BYTES:
            raise ValueError(f"{path}: longer than {_MOST_BYTES} bytes; give fewer heights")
        return np.asarray(array, dtype=np.float64).ravel()
    lines = read_text(path, _MOST_BYTES).splitlines()
    try:
        return np.loadtxt(lines, dtype=np.float64, delimiter=",", ndmin=1).ravel()
    except ValueError:
        raise ValueError(
            f"{path}: give one height per line, or the same number on each line, separated by commas"
        ) from None


def read_summits(path: Path) -> tuple[list[float], ...]:
    """Columns height and radius of a CSV file with a line of names; # begins a comment.

    Raises
    ------
    ValueError
        If the file cannot be read, or lacks a column or a number; nothing of what stands there is quoted.
    """
    lines = [line for line in read_text(path, _MOST_BYTES).splitlines() if line.strip()]
    rows = csv.reader(line for line in lines if not line.startswith("#"))
    names = [name.strip() for name in next(rows, [])]
    missing = [name for name in _SUMMITS if name not in names]
    if missing:
        raise ValueError(f"{path}: has no column {' and no column '.join(missing)}")
    where = [names.index(name) for name in _SUMMITS]
    table: list[tuple[float, ...]] = []
    for row in rows:
        try:
            table.append(tuple(float(row[k]) for k in where))
        except (ValueError, IndexError):
            what = f"summit {len(table) + 1} has no number as {' or '.join(_SUMMITS)}"
            raise ValueError(f"{path}: {what}") from None
    return tuple([row[k] for row in table] for k in range(len(_SUMMITS)))
