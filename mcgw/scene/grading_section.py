"""The table [grading] of a scene: E*(s)/E*, and what to do where it is negative."""

import csv
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from analytic import Exponential, Grading, Homogeneous, PiecewiseSeries, Surface, Table
from mcgw.formats.named_files import read_text
from mcgw.formats.units import signed
from mcgw.scene.section import Section
from mcgw.scene.series_section import read_series, series_table

__all__ = ["NEGATIVE", "grading_table", "grading_values", "read_grading"]

NEGATIVE = ("error", "clip", "allow")
_MOST_BYTES = 2**24  # of a grading as CSV
_COLUMNS = {"s": "1", "z": "m", "ratio": "1", "E_star": "Pa"}
_NAMED = re.compile(r"\s*(\w+)\s*(?:[(\[/ ]\s*([^()\[\]]*?)\s*[)\]]?)?\s*")  # z, z (um), z [um], z / um, z um


def grading_values(section: Section, surface: Surface | None, folder: Path) -> dict[str, Any]:
    """Read the table; mistakes are noted in the section, and give a homogeneous one."""
    laws = ("homogeneous", "exponential", "table", "series")
    law = section.choice("law", "exponential" if "gamma" in section else "homogeneous", laws)
    negative = section.choice("negative", "error", NEGATIVE)
    grading: Grading = Homogeneous()
    if law == "exponential":
        gamma = section.number("gamma", positive=False)
        if math.isfinite(gamma):
            grading = Exponential(gamma)
    elif law == "table":
        grading = _table(section, surface, folder) or grading
    elif law == "series":
        grading = read_series(section) or grading
    return {"grading": grading, "negative": negative}


def _table(section: Section, surface: Surface | None, folder: Path) -> Table | None:
    """Points in the scene itself, or in a CSV file beside it."""
    file, s, ratio = section.take("file"), section.take("s"), section.take("ratio")
    try:
        if file is None:
            return Table(s or (), ratio or ())
        return read_grading(folder / file, surface) if surface else None
    except (TypeError, ValueError) as error:
        key, given = ("s", s) if file is None else ("file", file)
        section.fail(key, given, f"give a CSV file, or lists s and ratio; {error}")
        return None


def read_grading(path: Path, surface: Surface) -> Table:
    """A grading from a CSV file of bounded length, as `analytic.Table.from_csv` reads it.

    Units may stand behind the names, as ``z (um), E_star (GPa)``, or behind numbers, as ``61.2 GPa``.

    Raises
    ------
    ValueError
        If it cannot be read, or is not such a table.
    """
    lines = read_text(path, _MOST_BYTES).splitlines()
    try:
        return Table.from_lines(_in_si(lines), sigma=surface.sigma, E_star=surface.E_star)
    except (ValueError, csv.Error) as error:
        raise ValueError(f"{path}: {error}") from None


def _in_si(lines: list[str]) -> Iterator[str]:
    """The lines of a table with its units worked in; what is no number with a unit stays, to be refused."""
    header, *rows = [row for row in csv.reader(lines) if row] or [[]]
    named = [
        (match[1], match[2] or "") if (match := _NAMED.fullmatch(name)) else (name, "") for name in header
    ]
    known = [name in _COLUMNS and not math.isnan(signed(f"1{unit}", _COLUMNS[name])) for name, unit in named]
    if not all(known):
        raise ValueError(
            "the first line must be s or z, a comma, then ratio or E_star, as z (um),E_star (GPa)"
        )
    yield ",".join(name for name, _ in named)
    for row in rows:
        cells = [_cell(text, *column) for text, column in zip(row, named, strict=False)]
        yield ",".join([*cells, *row[len(named) :]])


def _cell(text: str, name: str, unit: str) -> str:
    """A number in the unit of its column, unless it has one of its own."""
    for written in (f"{text}{unit}", text):
        if math.isfinite(value := signed(written, _COLUMNS[name])):
            return repr(value)
    return text.replace(",", " ")


def grading_table(grading: Grading) -> dict[str, Any]:
    """The table [grading] of one that is data, read again the same."""
    match grading:
        case Homogeneous():
            return {"law": "homogeneous"}
        case Exponential():
            return {"law": "exponential", "gamma": float(grading.gamma)}
        case Table():
            return {"law": "table", "s": list(grading.s), "ratio": list(grading.ratio)}
        case PiecewiseSeries():
            return series_table(grading)
    raise AssertionError(grading)  # `storable` leaves no other
