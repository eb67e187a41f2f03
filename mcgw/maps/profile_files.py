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
from mcgw.maps.topography import XYZ, Raw, check_file, height_unit

_LOOKED_AT = 20  # lines of numbers
_COMMA_ALONE = re.compile(r"\s*[-+]?\d+(?:,\d+)?(?:[eE][-+]?\d+)?\s*")
_TEXT = (".txt", ".csv", ".asc", ".dat", ".tsv", ".prf", ".xy", ".xyz")
_MAPS = (".sdf", ".x3p", ".h5")  # endings that hold no profiles


def _read_text(path: Path) -> Raw:
    """Read heights, or places x and heights z, one pair a line.

    Numbers are written as in maps (`mcgw.maps.text_file.read_text`). Lines above them that are not
    numbers are a header; units are taken from it where they stand in brackets, after a slash or alone: of
    heights in one column, of x and of z in two. Lines like 1,25 are x and z if what stands before the comma
    rises, and heights with decimal commas otherwise.
    """
    header, values = _lone_numbers(path) or _columns(path)
    told = header_units(header, values.shape[1])
    if values.shape[1] == XYZ and (along := along_line(values)) is not None:
        values, told = values[:, [along, 2]], [told[along], told[2]]
    if values.shape[1] > 2:
        raise ValueError(f"{path}: {values.shape[1]} numbers a line; a profile has z, or x and z")
    if values.shape[1] == 1:
        return Raw(values[:, 0], told[0])
    return Raw(values[:, 1], told[1], places=values[:, 0], unit_of_places=told[0])


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
        Between points, m, where the file has no x, or x without a unit, which then is not looked at.
    unit : str, optional
        Of the heights, where the file does not tell it; m if left out.

    Raises
    ------
    ValueError
        If it is no profile, is damaged, tells no distance between its points or another one than given, or
        tells no unit where m would make it too steep or too long.
    OSError
        If it cannot be read.
    """
    check_file(path)
    ending = path.suffix.lower()
    if ending in _TEXT:
        raw = _read_text(path)
    else:
        raw = _read_array(path) if ending == ".npy" else read_foreign_line(path, unit)
    metre, assumed = height_unit(path, raw.unit, unit)
    if spacing is not None:
        if raw.unit_of_places is not None:
            raise ValueError(f"{path}: gives x in {raw.unit_of_places}; leave --pixel out")
        places = spacing * np.arange(raw.heights.size, dtype=np.float64)
    elif raw.places is None:
        raise ValueError(f"{path}: does not give the distance between its points; give --pixel")
    else:
        of_x, assumed_x = height_unit(path, raw.unit_of_places, None)
        places, assumed = raw.places * of_x, assumed or assumed_x
    try:
        profile = profile_at(places, np.asarray(raw.heights * metre, dtype=np.float64), assumed)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    if profile.doubtful:
        raise ValueError(
            f"{path}: does not give all units, and in {profile.assumed_unit} {profile.doubtful}; give --unit "
            "(um, nm, ...) of the heights, and --pixel, the distance between points"
        )
    return profile


def _read_array(path: Path) -> Raw:
    z = open_npy(path)
    if z.ndim != 1:
        raise ValueError(f"{path}: holds {z.ndim} dimensions; a profile has one")
    return Raw(z.astype(np.float64))
