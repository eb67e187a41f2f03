"""Files beside a scene: moduli against height, heights, summits with radii."""

import csv
import math
import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from analytic import Surface, Table
from analytic.arrays import Array
from mcgw.formats.named_files import open_npy, read_text
from mcgw.formats.units import signed

_MOST_BYTES, _MOST_OF_MODULI = 2**28, 2**24
_MODULI = {"s": "1", "z": "m", "ratio": "1", "E_star": "Pa"}  # columns and their units
_SUMMITS = {"height": "m", "radius": "m"}
_NAMED = re.compile(r"\s*(\w+)\s*(?:[(\[/ ]\s*([^()\[\]]*?)\s*[)\]]?)?\s*")  # z, z (um), z [um], z / um, z um


def _columns(path: Path, most: int, units: Mapping[str, str]) -> dict[str, list[float]]:
    """Return columns of a CSV file by name, in SI; nan where there is no number, empty those of other names.

    Units may follow the names, ``z (um), E_star (GPa)``, or the numbers, ``61.2 GPa``; # begins a comment.
    """
    lines = [line for line in read_text(path, most).splitlines() if line.strip() and line[0] != "#"]
    try:
        header, *rows = list(csv.reader(lines)) or [[]]
    except csv.Error as error:
        raise ValueError(f"{path}: is not a table: {error}") from None
    found: dict[str, list[float]] = {}
    for k, text in enumerate(header):
        match = _NAMED.fullmatch(text)
        name, unit = (match[1], match[2] or "") if match else (text, "")
        known = name in units and not math.isnan(signed(f"1{unit}", units[name]))
        cells = [row[k] if len(row) == len(header) else "" for row in rows if known]
        found[name if known else text] = [_number(cell, unit, units[name]) for cell in cells]
    return found


def _number(text: str, unit: str, si: str) -> float:
    """Return a number in its own unit or in that of its column; nan if it is none."""
    value = signed(f"{text}{unit}", si)
    value = value if math.isfinite(value) else signed(text, si)
    return value if math.isfinite(value) else math.nan


def read_grading(path: Path, surface: Surface) -> Table:
    """Return a grading from a CSV file: heights ``s`` or ``z`` (m), and ``ratio`` or ``E_star`` (Pa).

    Raises ValueError, as all here, if it cannot be read or is not such a table; no text of it is quoted.
    """
    found = _columns(path, _MOST_OF_MODULI, _MODULI)
    axes = {"s": 1.0, "z": surface.sigma}, {"ratio": 1.0, "E_star": surface.E_star}
    named = [[np.array(found[name]) / size for name, size in axis.items() if name in found] for axis in axes]
    if len(found) != 2 or not all(named):
        first = "s or z, a comma, and ratio or E_star, such as z (um),E_star (GPa)"
        raise ValueError(f"{path}: the first line must be {first}")
    (s,), (ratio,) = named
    if np.isnan([s, ratio]).any():
        raise ValueError(f"{path}: every line below the header must be two numbers, separated by a comma")
    order = np.argsort(s, kind="stable")
    try:
        return Table(s[order].tolist(), ratio[order].tolist())
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def read_heights(path: Path) -> Array:
    """Heights from ``.npy`` or text with one a line (# begins a comment), in any unit; at most 256 MB."""
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
    """Return the columns height and radius, m, of a CSV file."""
    found = _columns(path, _MOST_BYTES, _SUMMITS)
    if missing := [name for name in _SUMMITS if name not in found]:
        raise ValueError(f"{path}: has no column {' and no column '.join(missing)}")
    columns = tuple(found[name] for name in _SUMMITS)
    for k in np.flatnonzero(np.isnan(columns).any(axis=0))[:1]:
        raise ValueError(f"{path}: summit {k + 1} has no number as {' or '.join(_SUMMITS)}")
    return columns
