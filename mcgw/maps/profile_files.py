"""Profiles from files: text of one column or two, arrays, and what SurfaceTopography reads."""

import math
import re
from pathlib import Path

import numpy as np

from analytic.arrays import Array
from mcgw.formats.named_files import open_npy
from mcgw.maps.foreign import is_foreign_line, read_foreign_line
from mcgw.maps.grid_of_points import along_line
from mcgw.maps.profile import Profile, profile_at
from mcgw.maps.text_file import MOST_HEADER, header_units, lines_of, numbers_of, words_of
from mcgw.maps.topography import XYZ, height_unit

_MOST_POINTS = 2**26
_LOOKED_AT = 20  # lines of numbers
_COMMA_ALONE = re.compile(r"\s*[-+]?\d+(?:,\d+)?(?:[eE][-+]?\d+)?\s*")
_TEXT = (".txt", ".csv", ".asc", ".dat", ".tsv", ".prf", ".xy", ".xyz")
Lines = list[tuple[int, str]]  # with their numbers
_MAPS = (".sdf", ".x3p", ".h5")  # endings that hold no profiles


def read_profile_text(path: Path, spacing: float | None = None, unit: str | None = None) -> Profile:
    """Read heights, or places x and heights z, one pair a line; lengths in m.

    Numbers are written as in maps (`mcgw.maps.text_file.read_text`). Lines above them that are not
    numbers are a header; units are taken from it where they stand in brackets, after a slash or alone: of
    heights in one column, of x and of z in two. Lines like 1,25 are x and z if what stands before the comma
    rises, and heights with decimal commas otherwise.

    Parameters
    ----------
    path : Path
        The file.
    spacing : float, optional
        Between points, m, where the file has no x, or x without a unit, which then is not looked at.
    unit : str, optional
        Of the heights, where the file tells none; m if left out.

    Raises
    ------
    ValueError
        If there are more than two columns, a line is not numbers, no spacing is known, or x does not rise or
        fall.
    """
    header, lines = _table(path, _MOST_POINTS + 1)
    if len(lines) > _MOST_POINTS:
        raise ValueError(f"{path}: more than {_MOST_POINTS} lines; cut it first")
    values = _values(path, lines)
    told = header_units(header, values.shape[1])
    if values.shape[1] == XYZ:
        along = along_line(values)
        if along is None:
            raise ValueError(f"{path}: 3 numbers a line; a profile has z, or x and z")
        values, told = values[:, [along, 2]], [told[along], told[2]]
    metre, assumed = height_unit(path, told[-1], unit)
    if values.shape[1] == 1 and spacing is None:
        raise ValueError(f"{path}: has only a column of heights; give --pixel, the distance between points")
    if values.shape[1] > 1 and spacing is not None and told[0] is not None:
        raise ValueError(f"{path}: gives x in {told[0]}; leave --pixel out")
    if spacing is not None:
        places = spacing * np.arange(len(values), dtype=np.float64)
    else:
        of_x, assumed_x = height_unit(path, told[0], None)
        places, assumed = values[:, 0] * of_x, assumed or assumed_x
    return _profile(path, places, values[:, -1] * metre, assumed)


def _table(path: Path, most: int) -> tuple[list[str], Lines]:
    """Header of a file, and at most this many lines of numbers."""
    header: list[str] = []
    lines: Lines = []
    for number, line in lines_of(path):
        if line.startswith("#"):
            header += [] if lines else [line.lstrip("# ")]
        elif lines or _is_numbers(path, number, line):
            lines.append((number, line))
            if len(lines) == most:
                break
        else:
            header.append(line)
            if len(header) > MOST_HEADER:
                raise ValueError(f"{path}: the first {MOST_HEADER} lines are not numbers; is it a profile?")
    if not lines:
        raise ValueError(f"{path}: holds no numbers")
    return header, lines


def _columns(path: Path) -> int:
    """Number of columns on the first lines of numbers.

    Separators at the end of all of them, as a Dektak writes, make no column.
    """
    columns, (_, lines) = 0, _table(path, _LOOKED_AT)
    if _COMMA_ALONE.fullmatch(lines[0][1]):
        return 1
    for number, line in lines:
        words = words_of(path, number, line)
        columns = max(columns, _filled(words))
        if _filled(words) == len(words):
            break
    return columns


def _is_numbers(path: Path, number: int, line: str) -> bool:
    if _COMMA_ALONE.fullmatch(line):
        return True
    try:
        return bool(np.isfinite(numbers_of(path, number, words_of(path, number, line))).any())
    except ValueError:
        return False


def _values(path: Path, lines: Lines) -> Array:
    """Shape (points, columns), one or two of them."""
    if all(_COMMA_ALONE.fullmatch(line) for _, line in lines):  # each may be one number
        x, _, z = zip(*(line.partition(",") for _, line in lines), strict=True)
        steps = np.diff([int(text) if text.isdigit() else math.nan for text in x])
        if not (all(z) and (np.all(steps > 0) or np.all(steps < 0))):
            return np.array([[float(line.replace(",", "."))] for _, line in lines])
    cells = [(n, words_of(path, n, line)) for n, line in lines]
    width = max(_filled(words) for _, words in cells)
    rows = [numbers_of(path, n, words[: max(width, 1)]) for n, words in cells]
    widths = np.array([row.size for row in rows])
    other = np.nonzero(widths != widths[0])[0]
    if widths[0] > XYZ:
        raise ValueError(f"{path}: {widths[0]} numbers a line; a profile has z, or x and z")
    if other.size:
        number = lines[int(other[0])][0]
        raise ValueError(f"{path}: line {number} has {widths[other[0]]} numbers, the first {widths[0]}")
    return np.array(rows)


def _filled(words: list[str]) -> int:
    """Number of cells up to the last one that is not empty."""
    return max((k for k, word in enumerate(words, 1) if word), default=0)


def holds_profile(path: Path) -> bool:
    """Whether a file holds heights along a line, by its shape: one or two columns, or one dimension.

    What cannot be read holds none: who reads the map says why.
    """
    ending = path.suffix.lower()
    try:
        if ending in _TEXT:
            columns = _columns(path)
            return columns < XYZ or (
                columns == XYZ and along_line(_values(path, _table(path, _MOST_POINTS)[1])) is not None
            )
        if ending == ".npy":
            return open_npy(path).ndim == 1
        if ending in _MAPS or not path.is_file():
            return False
        return is_foreign_line(path)
    except (OSError, ValueError):
        return False


def read_profile(path: Path, *, spacing: float | None = None, unit: str | None = None) -> Profile:
    """Read a profile: text, ``.npy`` of one dimension, or what SurfaceTopography reads as one.

    Parameters
    ----------
    path : Path
        The file.
    spacing : float, optional
        Between points, m, where the file does not tell it.
    unit : str, optional
        Of the heights, where the file does not tell it; m if left out.

    Raises
    ------
    ValueError
        If it is no profile, is damaged, or tells no unit where m would make it too steep or too long.
    OSError
        If it cannot be read.
    """
    if not path.is_file():
        raise ValueError(f"{path}: is not a regular file" if path.exists() else f"{path}: no such file")
    ending = path.suffix.lower()
    if ending in _TEXT:
        profile = read_profile_text(path, spacing, unit)
    elif ending == ".npy":
        profile = _array(path, spacing, unit)
    elif spacing is not None:
        raise ValueError(f"{path}: gives the distance between its points; leave --pixel out")
    else:
        profile = _profile(path, *read_foreign_line(path, unit))
    if profile.doubtful:
        raise ValueError(
            f"{path}: does not give all units, and in {profile.assumed_unit} {profile.doubtful}; give --unit "
            "(um, nm, ...) of the heights, and --pixel, the distance between points"
        )
    return profile


def _array(path: Path, spacing: float | None, unit: str | None) -> Profile:
    z = np.array(open_npy(path), dtype=np.float64)
    if z.ndim != 1:
        raise ValueError(f"{path}: holds {z.ndim} dimensions; a profile has one")
    if spacing is None:
        raise ValueError(f"{path}: does not give the distance between its points; give --pixel")
    metre, assumed = height_unit(path, None, unit)
    return _profile(path, spacing * np.arange(z.size, dtype=np.float64), z * metre, assumed)


def _profile(path: Path, places: Array, heights: Array, assumed: str) -> Profile:
    """Make a profile; errors name the file."""
    try:
        return profile_at(places, heights, assumed)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
