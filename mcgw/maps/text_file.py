"""Maps and profiles as plain text, a row a line, as instruments and spreadsheets of any country write it."""

import codecs
import math
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from analytic.arrays import Array
from mcgw.formats.units import METRES
from mcgw.maps.foreign import ForeignError
from mcgw.maps.grid_of_points import along_line, grid_of
from mcgw.maps.topography import XYZ, Raw, checked_shape, height_unit, metres_in

_MOST_LINE = 2**24
MOST_HEADER = 500  # lines
_LENGTH = re.compile(r"#\s*(Width|Height|Breite|Höhe)\s*:\s*(.*?)\s*$")
_SIZE = re.compile(r"([-+]?[.,\d]+(?:[eE][-+]?\d+)?)\s*([^\d\s.,+-]\S*)$")
_UNITS = {name: name for name in METRES} | {"Nanometer": "nm", "Micrometer": "um", "Millimeter": "mm"}
_UNIT_NAMES = "|".join(sorted(map(re.escape, _UNITS), key=len, reverse=True))
_UNIT = re.compile(
    rf"[\[(/]\s*({_UNIT_NAMES})\s*(?=[\])\s;,\t]|$)|\bin ({_UNIT_NAMES})\b"
    rf"|\w_({_UNIT_NAMES})$|^(?:Lateral|Raw) ({_UNIT_NAMES})$"
)
_ENGLISH = {"Breite": "Width", "Höhe": "Height"}
_VALUE_UNIT = re.compile(r"#\s*(?:Value units|Werteinheit(?:en)?|Einheit(?:en)? der Werte)\s*:\s*(\S+)\s*$")
_ENCODINGS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
_BLANKS = " \r\n\f\v"  # a tab parts two numbers, both of which may be missing
_COMMA_TOO = re.compile(r"[ \f\v]*[;,\t][ \f\v]*|[ \f\v]+")
_WITHOUT_COMMA = re.compile(r"[ \f\v]*[;\t][ \f\v]*|[ \f\v]+")
_COMMA_ALONE = re.compile(r"\s*[-+]?\d+(?:,\d+)?(?:[eE][-+]?\d+)?\s*")
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d*(?:[eE][-+]?\d+)?")
_MORE_COMMAS = re.compile(r"[-+.,\deE]*\d,+[-+.\d][-+.,\deE]*")
_MISSING = ("", "BAD", "---")


def read_text(path: Path, pixel: tuple[float, float] | None, unit: str | None) -> Raw:
    """Read a map or a profile: a matrix, a row a line; points x, y and z; or z, or x and z, of a profile.

    Numbers are separated by spaces, tabs, semicolons or commas. Where something else parts the numbers of a
    line, a comma inside one is its decimal mark. Lines that begin with # are comments; of those that
    Gwyddion writes, ``Width``, ``Height`` and ``Value units`` are understood, in German too. Points and
    profiles may have a header, from which units are taken where they stand in brackets, after a slash or
    alone. Lines like 1,25 are x and z if what stands before the comma rises, and heights with decimal commas
    otherwise. ``nan``, ``BAD``, ``---`` and nothing between two separators are missing points. The text is
    UTF-8, or UTF-16 with its mark. What no comment tells is given: the size of a pixel, m, and the unit of
    points, by default m.

    Raises
    ------
    ValueError
        If a row has another length than the first, a word is not a number, a comma may mean two things, no
        pixel size is known, or points are on no regular grid.
    """
    header, table = _lone_numbers(path) or table_of(path)
    along = along_line(table) if table.shape[1] == XYZ else None
    if not header.extent and (along is not None or table.shape[1] < XYZ):
        return _of_line(header, table, along)
    points = table.shape[1] == XYZ < len(table)
    if header.refused is not None and not (points and isinstance(header.refused, ForeignError)):
        raise header.refused
    if points:
        return _of_points(path, header, table, pixel, unit)
    if pixel is None:
        if set(header.extent) != {"Width", "Height"}:
            message = f"{path}: does not give the size of a pixel; give --pixel"
            raise ForeignError(message) if header.lines and not header.extent else ValueError(message)
        pixel = header.extent["Width"] / table.shape[1], header.extent["Height"] / table.shape[0]
    return Raw(table, header.unit, pixel)


class Header:
    """What a text says above and between its numbers."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.extent: dict[str, float] = {}
        self.unit: str | None = None
        self.refused: ValueError | None = None  # why the first line that is not numbers is none

    def add(self, path: Path, number: int, line: str) -> None:
        """Understand a comment."""
        self.lines.append(line.lstrip("# "))
        if found := _LENGTH.match(line):
            if not (size := _SIZE.match(found[2])):
                raise ValueError(
                    f"{path}: line {number}: {found[1]} = {found[2]!r}: give one length, as 4 um"
                )
            length = _numbers_of(path, number, [size[1].replace(",", ".")])[0]
            self.extent[_ENGLISH.get(found[1], found[1])] = float(length) * metres_in(path, size[2])
        elif found := _VALUE_UNIT.match(line):
            self.unit = found[1]


def table_of(path: Path) -> tuple[Header, Array]:
    """Return the header of a text and its rows of numbers, as a matrix.

    Columns at its left or right end in which no row has anything are those beyond a separator.

    Raises
    ------
    ValueError
        If a row has another length than the first, or is no numbers; or there is none.
    """
    header, total = Header(), 0
    rows: list[Array] = []
    first, last = 1, 0  # columns that hold anything
    for number, line in lines_of(path):
        if line.startswith("#"):
            header.add(path, number, line)
            continue
        try:
            words = _words_of(path, number, line)
            row = _numbers_of(path, number, words)
        except ValueError as error:
            if rows:  # a matrix, which a wrong word makes no file of another program
                raise (ValueError(str(error)) if rows[0].size > XYZ else error) from None
            header.refused = header.refused or error
            header.lines.append(line)
            if len(header.lines) > MOST_HEADER:
                told = f"{path}: the first {MOST_HEADER} lines are not numbers; is it a map or a profile?"
                raise ForeignError(told) from None
            continue
        rows.append(row)
        first, last = min(first, int(not words[0])), max(last, _filled(words))
        if row.size != rows[0].size:
            told = f"{path}: line {number} has {row.size} numbers, the first row {rows[0].size}"
            raise ForeignError(told) if header.refused else ValueError(told)
        total += row.size
        checked_shape(1, total)
    if not rows:
        raise header.refused or ForeignError(f"{path}: holds no numbers")
    table = np.array(rows)
    del rows
    return header, table[:, first : max(last, first + 1)]


def _filled(words: list[str]) -> int:
    """Return the number of words up to the last one that is not empty."""
    return next((k for k in range(len(words), 0, -1) if words[k - 1]), 0)


def _of_points(
    path: Path, header: Header, points: Array, pixel: tuple[float, float] | None, unit: str | None
) -> Raw:
    """Return a map of points x, y and z."""
    if pixel is not None:
        raise ValueError(f"{path}: three numbers a line are points with x, y and z; leave --pixel out")
    *of_places, told = header_units(header.lines, XYZ)
    (dx, assumed), (dy, _) = (height_unit(path, x, unit if x is None else None) for x in of_places)
    heights, size = grid_of(path, points * [dx, dy, 1])
    return Raw(heights, told, size, assumed=assumed)


def _of_line(header: Header, table: Array, along: int | None) -> Raw:
    """Return a profile: z alone, x and z, or points along x (0) or y (1)."""
    told = header_units(header.lines, table.shape[1])
    if table.shape[1] == 1:
        return Raw(table[:, 0], told[0])
    x = along or 0
    return Raw(table[:, -1], told[-1], places=table[:, x], unit_of_places=told[x])


def _lone_numbers(path: Path) -> tuple[Header, Array] | None:
    """Header and heights with decimal commas, if all lines are like 1,25 and not x and z."""
    header = Header()
    lines: list[str] = []
    for _, line in lines_of(path):
        if _COMMA_ALONE.fullmatch(line):
            lines.append(line)
        elif (lines and not line.startswith("#")) or len(header.lines) == MOST_HEADER:
            return None
        else:
            header.lines.append(line.lstrip("# "))
    x, _, z = zip(*(line.partition(",") for line in lines), strict=True) if lines else ((), (), ())
    steps = np.diff([int(text) if text.isdigit() else math.nan for text in x])
    if not lines or (all(z) and (np.all(steps > 0) or np.all(steps < 0))):
        return None
    return header, np.array([[float(line.replace(",", "."))] for line in lines])


def lines_of(path: Path) -> Iterator[tuple[int, str]]:
    """Lines that are not blank, with their numbers."""
    with open(path, "rb") as file:
        start = file.read(3)
    encoding = next((name for mark, name in _ENCODINGS.items() if start.startswith(mark)), "utf-8")
    with open(path, encoding=encoding, errors="replace") as file:
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
    if len(words) > 1 and any(_DECIMAL_COMMA.fullmatch(word) for word in words):
        if all(_DECIMAL_COMMA.fullmatch(word) for word in words if "," in word):
            return [word.replace(",", ".") for word in words]
        raise ValueError(
            f"{path}: line {number}: commas are both inside and between numbers; separate the numbers by "
            "semicolons or tabs"
        )
    if len(words) > 1 and any(_MORE_COMMAS.fullmatch(word) for word in words):
        raise ValueError(
            f"{path}: line {number}: numbers are separated by commas and by something else; use one separator"
        )
    words = _COMMA_TOO.split(line)
    if any(re.fullmatch(r"[-+]?0\d+", word) for word in words):
        raise ValueError(
            f"{path}: line {number}: a number begins with 0; if commas are decimal marks, separate the "
            "numbers by semicolons or tabs"
        )
    return words


def _numbers_of(path: Path, number: int, words: list[str]) -> Array:
    """Return what `_words_of` found, nan where points are missing."""
    try:
        row = np.array([float("nan" if word in _MISSING else word) for word in words])
    except ValueError as error:
        raise ForeignError(f"{path}: line {number}: {str(error)[:80]}") from None
    if np.any(np.isinf(row)):
        raise ValueError(f"{path}: line {number}: a height is infinite")
    return row


def header_units(header: list[str], columns: int) -> list[str | None]:
    """Return the unit of each column, from the last header line with units and no digits."""
    for line in reversed([line for line in header if not re.search(r"\d", line)]):
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
