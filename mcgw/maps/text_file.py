"""Maps as plain text, one row a line, as instruments and spreadsheets of any country write them."""

import codecs
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from analytic.arrays import Array
from mcgw.maps.foreign import ForeignError
from mcgw.maps.topography import XYZ, Topography, checked_shape, height_unit, metres_in, single_points

_MOST_LINE = 2**24
_LENGTH = re.compile(r"#\s*(Width|Height|Breite|Höhe)\s*:\s*([-+.,\deE]+)\s*(\S+)\s*$")
_ENGLISH = {"Breite": "Width", "Höhe": "Height"}
_UNIT = re.compile(r"#\s*(?:Value units|Werteinheit(?:en)?|Einheit(?:en)? der Werte)\s*:\s*(\S+)\s*$")
_ENCODINGS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
_BLANKS = " \r\n\f\v"  # a tab parts two numbers, both of which may be missing
_COMMA_TOO = re.compile(r"[ \f\v]*[;,\t][ \f\v]*|[ \f\v]+")
_WITHOUT_COMMA = re.compile(r"[ \f\v]*[;\t][ \f\v]*|[ \f\v]+")
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d*(?:[eE][-+]?\d+)?")
_MORE_COMMAS = re.compile(r"[-+.,\deE]*\d,+[-+.\d][-+.,\deE]*")
_MISSING = ("", "BAD", "---")


def read_text(path: Path, pixel: tuple[float, float] | None = None, unit: str | None = None) -> Topography:
    """Read a matrix of numbers, a row a line, separated by spaces, tabs, semicolons or commas; heights in m.

    Where something else parts the numbers of a line, a comma inside one is its decimal mark. Lines that
    begin with # are comments; of those that Gwyddion writes, ``Width``, ``Height`` and ``Value units``
    are understood, in German too. ``nan``, ``BAD``, ``---`` and nothing between two separators are missing
    points. The text is UTF-8, or UTF-16 with its mark. What no comment tells is given: the size of a pixel,
    m, and the unit of the heights, by default m.

    Raises
    ------
    ValueError
        If a row has another length than the first, a word is not a number, a comma may mean two things, or
        no pixel size is known.
    """
    rows: list[Array] = []
    extent: dict[str, float] = {}
    told: str | None = None
    total, open_left, open_right = 0, True, True
    for number, line in lines_of(path):
        if line.startswith("#"):
            if found := _LENGTH.match(line):
                length = numbers_of(path, number, [found[2].replace(",", ".")])[0]
                extent[_ENGLISH.get(found[1], found[1])] = float(length) * metres_in(path, found[3])
            elif found := _UNIT.match(line):
                told = found[1]
            continue
        words = words_of(path, number, line)
        open_left, open_right = open_left and not words[0], open_right and not words[-1]
        try:
            rows.append(numbers_of(path, number, words))
        except ForeignError as error:
            if rows and rows[0].size > XYZ:  # a matrix, which a wrong word makes no file of another program
                raise ValueError(str(error)) from None
            raise
        if rows[-1].size != rows[0].size:
            raise ForeignError(
                f"{path}: line {number} has {rows[-1].size} numbers, the first row {rows[0].size}"
            )
        total += rows[-1].size
        checked_shape(1, total)
    if not rows:
        raise ForeignError(f"{path}: holds no numbers")
    if points := single_points(len(rows), rows[0].size):
        raise ForeignError(f"{path}: {points}")
    metre, assumed = height_unit(path, told, unit)
    heights = np.array(rows) * metre
    # every row begins or ends with a separator: there is no column beyond it
    heights = np.ascontiguousarray(heights[:, int(open_left) : heights.shape[1] - int(open_right)])
    if pixel is None:
        if set(extent) != {"Width", "Height"}:
            raise ForeignError(f"{path}: does not give the size of a pixel; give --pixel")
        checked_shape(*heights.shape)
        pixel = extent["Width"] / heights.shape[1], extent["Height"] / heights.shape[0]
    return Topography(heights, pixel, assumed_unit=assumed)


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


def words_of(path: Path, number: int, line: str) -> list[str]:
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


def numbers_of(path: Path, number: int, words: list[str]) -> Array:
    """What `words_of` found, nan where points are missing."""
    try:
        row = np.array([float("nan" if word in _MISSING else word) for word in words])
    except ValueError as error:
        raise ForeignError(f"{path}: line {number}: {str(error)[:80]}") from None
    if np.any(np.isinf(row)):
        raise ValueError(f"{path}: line {number}: a height is infinite")
    return row
