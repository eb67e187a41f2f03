"""Maps and profiles as plain text, a row a line, as instruments and spreadsheets of any country write it."""

import codecs
import math
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array
from mcgw.formats.units import METRES, parse
from mcgw.maps.topography import XYZ, ForeignError, Given, Raw, checked_shape, metres_in

_MOST_LINE = 2**24
MOST_HEADER = 500  # lines
_LENGTH = re.compile(r"#\s*(Width|Breite|Height|Höhe)\s*:\s*(.*[^\s\d.,])\s*$")
_ALONG = {"Width": "width", "Breite": "width", "Height": "height", "Höhe": "height"}
_UNITS = {name: name for name in METRES} | {"Nanometer": "nm", "Micrometer": "um", "Millimeter": "mm"}
_UNIT_NAMES = "|".join(sorted(map(re.escape, _UNITS), key=len, reverse=True))
_UNIT = re.compile(
    rf"[\[(/]\s*({_UNIT_NAMES})\s*(?=[\])\s;,\t]|$)|\bin ({_UNIT_NAMES})\b"
    rf"|\w_({_UNIT_NAMES})$|^(?:Lateral|Raw) ({_UNIT_NAMES})$"
)
_VALUE_UNIT = re.compile(r"#\s*(?:Value units|Werteinheit(?:en)?|Einheit(?:en)? der Werte)\s*:\s*(\S+)\s*$")
_BLANKS = " \r\n\f\v"  # a tab parts two numbers, both of which may be missing
_COMMA_TOO = re.compile(r"[ \f\v]*[;,\t][ \f\v]*|[ \f\v]+")
_WITHOUT_COMMA = re.compile(r"[ \f\v]*[;\t][ \f\v]*|[ \f\v]+")
_COMMA_ALONE = re.compile(r"\s*[-+]?\d+(?:,\d+)?(?:[eE][-+]?\d+)?\s*")
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d*(?:[eE][-+]?\d+)?")
_MORE_COMMAS = re.compile(r"[-+.,\deE]*\d,+[-+.\d][-+.,\deE]*")


def read_text(path: Path, given: Given) -> Raw:
    """Read a map or a profile: a matrix, a row a line; points x, y and z; or z, or x and z, of a profile.

    Numbers are separated by spaces, tabs, semicolons or commas. Where something else parts the numbers of a
    line, a comma inside one is its decimal mark. Lines that begin with # are comments; of those that
    Gwyddion writes, ``Width``, ``Height`` and ``Value units`` are understood, in German too. Points and
    profiles may have a header, from which units are taken where they stand in brackets, after a slash or
    alone. Lines like 1,25 are x and z if what stands before the comma rises, and heights with decimal commas
    otherwise. ``nan``, ``BAD``, ``---`` and nothing between two separators are missing points. The text is
    UTF-8, or UTF-16 with its mark. A given pixel counts more than what a comment tells.
    """
    table, header, refused = table_of(path)
    rows, columns = table.shape
    told = _units(header, columns)
    lengths = {k: match for k, line in header.items() if (match := _LENGTH.match(line))}
    extent = {
        _ALONG[match[1]]: parse(match[2].replace(",", "."), "m", f"{path}: line {k}: {match[1]}")
        for k, match in lengths.items()
    }
    if columns == XYZ and not extent:
        for along, across in ((0, 1), (1, 0)):
            if np.ptp(table[:, across]) == 0 < np.ptp(table[:, along]):
                return Raw(table[:, 2], told[2], table[:, along], told[along])
    if columns == 2 and not extent:
        return Raw(table[:, 1], told[1], table[:, 0], told[0])
    if columns == 1 and not extent:
        return Raw(table[:, 0], told[0])
    points = columns == XYZ < rows
    if refused is not None and not (points and isinstance(refused, ForeignError)):
        raise refused
    if points:
        return _of_points(path, table, told, given)
    unit = next((found[1] for line in header.values() if (found := _VALUE_UNIT.match(line))), None)
    if given.pixel is not None:
        return Raw(table, unit)
    if set(extent) != {"width", "height"}:
        message = f"{path}: does not give the size of a pixel; give --pixel"
        raise (ForeignError if header and not extent else ValueError)(message)
    return Raw(table, unit, (extent["width"] / columns, extent["height"] / rows), "m")


def table_of(path: Path) -> tuple[Array, dict[int, str], ValueError | None]:
    """Return the numbers of a text as a matrix; its other lines by number; and why the first of them is none.

    Columns at its left or right end in which no row has anything are those beyond a separator.
    """
    header: dict[int, str] = {}
    rows: list[Array] = []
    refused: ValueError | None = None
    total, first, last = 0, 1, 0  # numbers; columns that hold anything
    decimal = _are_heights(path)
    for number, line in _lines_of(path):
        if line.startswith("#"):
            header[number] = line
            continue
        try:
            words = [line.replace(",", ".")] if decimal else _words_of(path, number, line)
            row = _numbers_of(path, number, words)
        except ValueError as error:
            if rows:  # a matrix, which a wrong word makes no file of another program
                raise (ValueError(str(error)) if rows[0].size > XYZ else error) from None
            refused = refused or error
            header[number] = line
            if len(header) > MOST_HEADER:
                told = f"{path}: the first {MOST_HEADER} lines are not numbers; is it a map or a profile?"
                raise ForeignError(told) from None
            continue
        rows.append(row)
        filled = next((k for k in range(len(words), 0, -1) if words[k - 1]), 0)
        first, last = min(first, int(not words[0])), max(last, filled)
        if row.size != rows[0].size:
            told = f"{path}: line {number} has {row.size} numbers, the first row {rows[0].size}"
            raise ForeignError(told) if refused else ValueError(told)
        total += row.size
        checked_shape(1, total)
    if not rows:
        raise refused or ForeignError(f"{path}: holds no numbers")
    table = np.array(rows)
    del rows
    return table[:, first : max(last, first + 1)], header, refused


def _are_heights(path: Path) -> bool:
    """Whether all lines are like 1,25 and are heights with decimal commas, not x and z."""
    header, found = 0, []
    for _, line in _lines_of(path):
        if _COMMA_ALONE.fullmatch(line):
            found.append(line.partition(","))
        elif (found and not line.startswith("#")) or header == MOST_HEADER:
            return False
        else:
            header += 1
    steps = np.diff([int(x) if x.isdigit() else math.nan for x, _, _ in found])
    return bool(found) and not (all(z for *_, z in found) and bool(np.all(steps > 0) or np.all(steps < 0)))


def _lines_of(path: Path) -> Iterator[tuple[int, str]]:
    """Lines that are not blank, with their numbers."""
    with open(path, "rb") as file:
        wide = file.read(2) in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
    with open(path, encoding="utf-16" if wide else "utf-8-sig", errors="replace") as file:
        for number, line in enumerate(iter(lambda: file.readline(_MOST_LINE), ""), 1):
            if len(line) == _MOST_LINE:
                raise ValueError(f"{path}: line {number} has {_MOST_LINE} characters or more; is it a map?")
            if line.strip(_BLANKS):
                yield number, line.strip(_BLANKS)


def _words_of(path: Path, number: int, line: str) -> list[str]:
    """Numbers of a row as they stand, with decimal points."""
    words = _WITHOUT_COMMA.split(line)
    if "," not in line:
        return words
    commas = [word for word in words if "," in word]
    decimal = [word for word in commas if _DECIMAL_COMMA.fullmatch(word)]
    told = ""
    if len(words) > 1 and decimal == commas:
        return [word.replace(",", ".") for word in words]
    if len(words) > 1 and decimal:
        told = "commas are both inside and between numbers; separate the numbers by semicolons or tabs"
    elif len(words) > 1 and any(_MORE_COMMAS.fullmatch(word) for word in words):
        told = "numbers are separated by commas and by something else; use one separator"
    words = _COMMA_TOO.split(line)
    if not told and any(re.fullmatch(r"[-+]?0\d+", word) for word in words):
        told = (
            "a number begins with 0; if commas are decimal marks, separate the numbers by semicolons or tabs"
        )
    if told:
        raise ValueError(f"{path}: line {number}: {told}")
    return words


def _numbers_of(path: Path, number: int, words: list[str]) -> Array:
    """Return what `_words_of` found, nan where points are missing."""
    try:
        row = np.array([float("nan" if word in ("", "BAD", "---") else word) for word in words])
    except ValueError as error:
        raise ForeignError(f"{path}: line {number}: {str(error)[:80]}") from None
    if np.any(np.isinf(row)):
        raise ValueError(f"{path}: line {number}: a height is infinite")
    return row


def _units(header: dict[int, str], columns: int) -> list[str | None]:
    """Return the unit of each column, from the last header line with units and no digits."""
    for line in reversed([line.lstrip("# ") for line in header.values() if not re.search(r"\d", line)]):
        cells = [cell for cell in re.split(r"[;,\t]|\s{2,}", line) if cell.strip()]
        units = [_unit(cell) for cell in cells]
        if len(cells) == columns and any(units):
            return [unit[0] if unit else None for unit in units]
        found = [unit for cell in units for unit in cell]
        if found:
            return [*found[:columns]] if len(found) >= columns else [found[0]] * columns
    return [None] * columns


def _unit(cell: str) -> list[str]:
    """Units in a cell, or in a line of several with single spaces."""
    words = cell.split()
    if not all(word in _UNITS for word in words):
        words = [next(filter(None, found)) for found in _UNIT.findall(cell)]
    return [_UNITS[word] for word in words]


def _of_points(path: Path, points: Array, told: list[str | None], given: Given) -> Raw:
    """Return a map of points x, y and z, in any order, on a regular grid; nan where there is none."""
    if given.pixel is not None:
        raise ValueError(f"{path}: three numbers a line are points with x, y and z; leave --pixel out")
    if not np.isfinite(points[:, :2]).all():
        raise ValueError(f"{path}: a point lacks x or y")
    units = [unit or given.unit for unit in told[:2]]
    x, y = (points[:, k] * metres_in(path, unit or "m") for k, unit in enumerate(units))
    (columns, dx, i), (rows, dy, j) = _places(path, "x", x), _places(path, "y", y)
    if min(columns, rows) == 1:
        raise ValueError(f"{path}: all points lie on one line: a profile; give x and z alone")
    checked_shape(rows, columns)
    if rows * columns > 4 * len(points):  # points of the grid for each one that is there
        raise ValueError(
            f"{path}: {len(points)} points on a grid of {columns} x {rows}: scattered points are not a map; "
            "interpolate them to a grid first"
        )
    heights = np.full((rows, columns), np.nan)
    twice = np.bincount(j * columns + i, minlength=rows * columns)[j * columns + i] > 1
    if twice.any():
        raise ValueError(f"{path}: x = {x[twice][0]:g}, y = {y[twice][0]:g} has two heights")
    heights[j, i] = points[:, 2]
    return Raw(heights, told[2], (dx, dy), "m" if units[0] else None)


def _places(path: Path, name: str, values: Array) -> tuple[int, float, NDArray[np.intp]]:
    """Return the number of places along an axis, their distance, and which one each point has."""
    ordered, which = np.unique(values, return_inverse=True)
    steps = np.diff(ordered, prepend=ordered[0])
    places = np.cumsum(steps > 0.3 * steps.max())[which]  # places nearer than that are one
    centres = np.bincount(places, weights=values) / np.bincount(places)
    distance = float(f"{np.ptp(centres) / max(len(centres) - 1, 1):.12g}")  # as a text may give it
    off = np.abs(values - centres[0] - distance * places)
    if len(centres) > 1 and not np.all(off <= 0.05 * distance):  # of a step that a place may be off the grid
        raise ValueError(
            f"{path}: {name} of the points is not evenly spaced ({len(centres)} places from {ordered[0]:g} "
            f"to {ordered[-1]:g}); single points with x, y and z are a map only on a regular grid"
        )
    return len(centres), distance, places
