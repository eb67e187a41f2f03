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
from mcgw.maps.text_file import MOST_HEADER, header_units, lines_of, table_of
from mcgw.maps.topography import XYZ, height_unit

_LOOKED_AT = 20  # lines of numbers
_COMMA_ALONE = re.compile(r"\s*[-+]?\d+(?:,\d+)?(?:[eE][-+]?\d+)?\s*")
_TEXT = (".txt", ".csv", ".asc", ".dat", ".tsv", ".prf", ".xy", ".xyz")
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
    header, values = _lone_numbers(path) or _columns(path)
    told = header_units(header, values.shape[1])
    if values.shape[1] == XYZ and (along := along_line(values)) is not None:
        values, told = values[:, [along, 2]], [told[along], told[2]]
    if values.shape[1] > 2:
        raise ValueError(f"{path}: {values.shape[1]} numbers a line; a profile has z, or x and z")
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


def _columns(path: Path) -> tuple[list[str], Array]:
    header, values = table_of(path)
    return header.lines, values


def _lone_numbers(path: Path) -> tuple[list[str], Array] | None:
    """Header and heights with decimal commas, if all lines are like 1,25 and not x and z."""
    header: list[str] = []
    lines: list[str] = []
    for _, line in lines_of(path):
        if _COMMA_ALONE.fullmatch(line):
            lines.append(line)
        elif (lines and not line.startswith("#")) or len(header) == MOST_HEADER:
            return None
        else:
            header.append(line.lstrip("# "))
    x, _, z = zip(*(line.partition(",") for line in lines), strict=True) if lines else ((), (), ())
    steps = np.diff([int(text) if text.isdigit() else math.nan for text in x])
    if not lines or (all(z) and (np.all(steps > 0) or np.all(steps < 0))):
        return None
    return header, np.array([[float(line.replace(",", "."))] for line in lines])


def holds_profile(path: Path) -> bool:
    """Whether a file holds heights along a line, by its shape: one or two columns, or one dimension.

    What cannot be read holds none: who reads the map says why.
    """
    ending = path.suffix.lower()
    try:
        if ending in _TEXT:
            columns = table_of(path, _LOOKED_AT)[1].shape[1] if _lone_numbers(path) is None else 1
            return columns < XYZ or (columns == XYZ and along_line(table_of(path)[1]) is not None)
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
