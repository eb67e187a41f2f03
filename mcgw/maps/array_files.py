"""Maps as NumPy arrays with a JSON sidecar, as HDF5 with the asperities, and as plain text."""

import json
import re
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from mcgw.maps.asperities import Asperities
from mcgw.maps.lengths import METRES
from mcgw.maps.topography import Topography, checked_shape
from mcgw.npy_file import open_npy
from mcgw.store.disk import whole_file

__all__ = ["read_h5", "read_npy", "read_text", "sidecar_of", "write_h5", "write_npy"]

_FILETYPE = "mcgw-surface"
_MOST_JSON = 2**16
_MOST_LINE = 2**24
_LENGTH = re.compile(r"#\s*(Width|Height)\s*:\s*([-+.\deE]+)\s*(\S+)\s*$")
_UNIT = re.compile(r"#\s*Value units\s*:\s*(\S+)\s*$")


def sidecar_of(path: Path) -> Path:
    """Where the pixel size of an array lies: ``map.json`` beside ``map.npy``."""
    return path.with_suffix(".json")


def write_npy(topography: Topography, path: Path) -> None:
    """Write an array and its sidecar.

    Raises
    ------
    OSError
        If a file cannot be written.
    """
    dx, dy = topography.pixel
    facts = {
        "filetype": _FILETYPE,
        "pixel": [dx, dy],
        "unit": "m",
        "periodic": topography.periodic,
        "axes": ["y", "x"],
    }
    with whole_file(path) as unfinished, whole_file(sidecar_of(path)) as beside:
        with open(unfinished, "wb") as file:
            np.save(file, topography.heights)
        beside.write_text(json.dumps(facts, indent=2) + "\n", encoding="utf-8")


def read_npy(path: Path, pixel: tuple[float, float] | None = None) -> Topography:
    """Read an array; its pixel size from the sidecar, unless given.

    Raises
    ------
    ValueError
        If it is no matrix of real numbers, or no pixel size is known.
    OSError
        If a file cannot be read.
    """
    array = open_npy(path)
    if array.ndim != 2:
        raise ValueError(f"{path}: holds {array.ndim} dimension(s); a map has rows and columns")
    checked_shape(*array.shape)
    periodic = False
    if pixel is None:
        pixel, periodic = _sidecar(path)
    return Topography(np.array(array, dtype=np.float64), pixel, periodic)


def _sidecar(path: Path) -> tuple[tuple[float, float], bool]:
    beside = sidecar_of(path)
    if not beside.is_file():
        raise ValueError(f"{path}: no {beside.name} beside it tells the size of a pixel; give --pixel")
    if beside.stat().st_size > _MOST_JSON:
        raise ValueError(f"{beside}: longer than {_MOST_JSON} bytes, which no sidecar is")
    try:
        facts: Any = json.loads(beside.read_text(encoding="utf-8"))
        dx, dy = (float(p) for p in facts["pixel"])
        if facts.get("unit", "m") != "m":
            raise ValueError(f"unit is {facts['unit']!r}, not 'm'")
        return (dx, dy), bool(facts.get("periodic", False))
    except (AttributeError, KeyError, RecursionError, TypeError, ValueError) as error:
        raise ValueError(f'{beside}: must hold "pixel": [dx, dy] in m: {error}') from None


def write_h5(topography: Topography, path: Path, field: Asperities | None = None, *, scene: str = "") -> None:
    """Write a map, and the asperities it was made of, as HDF5.

    Datasets ``height`` (y, x), and ``asperities/x``, ``y``, ``z``, all in m; attributes ``pixel``,
    ``periodic``, ``radius`` and ``scene`` (TOML).

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    with whole_file(path) as unfinished, h5py.File(unfinished, "w") as file:
        file.attrs.update(
            filetype=_FILETYPE, format=[1, 0], pixel=topography.pixel, periodic=topography.periodic
        )
        data = file.create_dataset("height", data=topography.heights, compression="gzip", compression_opts=1)
        data.attrs.update(units="m", long_name="height above the mean of the summits", axes=["y", "x"])
        if field is not None:
            group = file.create_group("asperities")
            group.attrs.update(radius=field.radius, size=field.size, units="m")
            for name, values in (("x", field.x), ("y", field.y), ("z", field.z)):
                group.create_dataset(name, data=values).attrs["units"] = "m"
        file["scene"] = scene  # a dataset: an attribute ends at 64 kB


def read_h5(path: Path) -> Topography:
    """Read the map of such a file.

    Raises
    ------
    ValueError
        If it is none.
    OSError
        If it cannot be read.
    """
    try:
        with h5py.File(path, "r") as file:
            if file.attrs.get("filetype") != _FILETYPE:
                raise ValueError(f"{path}: is no {_FILETYPE} file; it was not written by mcgw surface")
            data = file["height"]
            checked_shape(*data.shape)
            dx, dy = (float(p) for p in file.attrs["pixel"])
            return Topography(data[...].astype(np.float64), (dx, dy), bool(file.attrs["periodic"]))
    except (KeyError, TypeError) as error:
        raise ValueError(f"{path}: is a damaged {_FILETYPE} file: {error}") from None


def read_text(path: Path, pixel: tuple[float, float] | None = None) -> Topography:
    """Read a matrix of numbers, one row a line, parted by spaces, tabs, commas or semicolons.

    Lines that begin with # are comments; of those that Gwyddion writes, ``Width``, ``Height`` and
    ``Value units`` are understood. Without a unit heights are in m.

    Parameters
    ----------
    path : Path
        The file.
    pixel : (float, float), optional
        Size of a pixel, m; needed where no comment tells the width and height of the map.

    Returns
    -------
    Topography
        Heights in m; ``nan``, ``BAD`` and ``---`` are missing points.

    Raises
    ------
    ValueError
        If a row has another length than the first, or a word is no number, or no pixel size is known.
    OSError
        If it cannot be read.
    """
    rows: list[NDArray[np.float64]] = []
    extent: dict[str, float] = {}
    unit, total = 1.0, 0
    with open(path, encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(iter(lambda: file.readline(_MOST_LINE), ""), 1):
            if not line.strip():
                continue
            if line.startswith("#"):
                if found := _LENGTH.match(line):
                    extent[found[1]] = float(found[2]) * _metres_in(path, found[3])
                elif found := _UNIT.match(line):
                    unit = _metres_in(path, found[1])
                continue
            rows.append(_row(path, number, line))
            if rows[-1].size != rows[0].size:
                raise ValueError(
                    f"{path}: line {number} has {rows[-1].size} numbers, the first row {rows[0].size}"
                )
            total += rows[-1].size
            checked_shape(1, total)
    if not rows:
        raise ValueError(f"{path}: holds no numbers")
    heights = np.array(rows) * unit
    if pixel is None:
        if set(extent) != {"Width", "Height"}:
            raise ValueError(f"{path}: does not tell the size of a pixel; give --pixel")
        pixel = extent["Width"] / heights.shape[1], extent["Height"] / heights.shape[0]
    return Topography(heights, pixel)


def _row(path: Path, number: int, line: str) -> NDArray[np.float64]:
    words = re.sub(r"[,;]", " ", line).split()
    words = ["nan" if word in ("BAD", "---") else word for word in words]
    try:
        row = np.array([float(word) for word in words])
    except ValueError as error:
        raise ValueError(f"{path}: line {number}: {str(error)[:80]}") from None
    if np.any(np.isinf(row)):
        raise ValueError(f"{path}: line {number}: a height is infinite")
    return row


def _metres_in(path: Path, unit: str) -> float:
    if unit not in METRES:
        raise ValueError(f"{path}: {unit!r} is no unit of length known here: {', '.join(METRES)}")
    return METRES[unit]
