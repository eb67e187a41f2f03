"""Our own files of maps: an array with a JSON sidecar, HDF5, or SDF for other programs."""

import json
import struct
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from mcgw.formats.files import together, whole_file
from mcgw.formats.gate import open_h5
from mcgw.formats.named_files import loads_json, open_npy, read_bytes
from mcgw.machine.terminal import one_line
from mcgw.maps.raw import ForeignError, Given, Raw
from mcgw.maps.synthetic import Asperities
from mcgw.maps.topography import XYZ, Topography, checked_shape

FILETYPE = "mcgw-surface"
WRITTEN = (".npy", ".h5", ".sdf")
_HEADER = struct.Struct("<8s10s12s12sHHddddBBB")
_DOUBLE = 7
_MOST_JSON = 2**16
_MOST_POINTS = 65535  # along each axis: 16 bits


def sidecar_of(path: Path) -> Path:
    """File of the pixel size of an array: ``map.json`` beside ``map.npy``."""
    return path.with_suffix(".json")


def write_npy(topography: Topography, path: Path) -> None:
    """Write an array and its sidecar."""
    facts: dict[str, Any] = {"filetype": FILETYPE, "pixel": topography.pixel, "unit": "m"}
    facts |= {"periodic": topography.periodic, "axes": ["y", "x"]}
    with together(), whole_file(path) as unfinished, whole_file(sidecar_of(path)) as beside:
        with open(unfinished, "wb") as file:
            np.save(file, topography.heights)
        beside.write_text(json.dumps(facts, indent=2) + "\n", encoding="utf-8")


def read_npy(path: Path, given: Given) -> Raw:
    """Read an array; its pixel size and the unit of its heights from the sidecar, unless a pixel is given."""
    array = open_npy(path)
    if array.ndim == 1:
        return Raw(array)
    if array.ndim != 2:
        raise ValueError(f"{path}: holds {array.ndim} dimension(s); a map has rows and columns")
    checked_shape(*array.shape)
    if array.shape[1] == XYZ < len(array):  # no map is three pixels wide
        raise ValueError(
            f"{path}: three numbers a line, {len(array)} lines: single points with x, y and z are not a map; "
            "give rows of heights on a grid"
        )
    if given.pixel is not None:
        return Raw(array)
    beside = sidecar_of(path)
    if not beside.is_file():
        raise ValueError(f"{path}: there is no {beside.name} with the size of a pixel; give --pixel")
    data = read_bytes(beside, _MOST_JSON)
    try:
        facts: Any = loads_json(data)
        pixel, periodic, unit = facts["pixel"], facts.get("periodic", False), facts.get("unit")
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise ValueError(f'{beside}: must hold "pixel": [dx, dy] in m: {error}') from None
    if unit not in (None, "m"):
        raise ValueError(f"{beside}: unit = {unit!r}: must be 'm'")
    return Raw(array, unit, *_facts(beside, pixel, periodic), lateral="m")


def write_h5(topography: Topography, path: Path, field: Asperities | None = None, *, scene: str = "") -> None:
    """Write a map, and the asperities it was made of, as HDF5.

    Datasets ``height`` (y, x), and ``asperities/x``, ``y``, ``z``, all in m; attributes ``pixel``,
    ``periodic``, ``radius`` and ``scene`` (TOML).

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    with whole_file(path) as unfinished, h5py.File(unfinished, "w", locking=False) as file:
        file.attrs.update(
            filetype=FILETYPE, format=[1, 0], pixel=topography.pixel, periodic=topography.periodic
        )
        data = file.create_dataset("height", data=topography.heights, compression="gzip", compression_opts=1)
        data.attrs.update(units="m", long_name="height above the mean of the summits", axes=["y", "x"])
        if field is not None:
            group = file.create_group("asperities")
            group.attrs.update(radius=field.radius, size=field.size, units="m")
            for name, values in (("x", field.x), ("y", field.y), ("z", field.z)):
                group.create_dataset(name, data=values).attrs["units"] = "m"
        file["scene"] = scene  # a dataset: an attribute ends at 64 kB


def read_h5(path: Path, given: Given) -> Raw:  # noqa: ARG001
    """Read the map of such a file."""
    if not h5py.is_hdf5(path):
        raise ForeignError(f"{path}: is not a valid HDF5 file")
    try:
        with open_h5(path) as file:
            if file.attrs.get("filetype") != FILETYPE:
                raise ForeignError(f"{path}: is not a {FILETYPE} file; it was not written by mcgw surface")
            data = file["height"]
            checked_shape(*data.shape, held=data.id.get_storage_size())
            pixel, periodic = _facts(path, file.attrs["pixel"], file.attrs["periodic"])
            told = data.attrs.get("units")
            if data.size and not data.id.get_storage_size():
                raise ValueError(f"{path}: its heights were never written")
            return Raw(data[...], None if told is None else str(told), pixel, periodic, lateral="m")
    except (AttributeError, KeyError, OSError, RuntimeError, TypeError) as error:  # as HDF5 tells of damage
        raise ValueError(f"{path}: is a damaged {FILETYPE} file: {one_line(str(error))}") from None


def _facts(path: Path, pixel: Any, periodic: Any) -> tuple[tuple[float, float], bool]:
    """Pixel and periodicity from a file, if they are two numbers and a truth: "no" is true in Python."""
    values = pixel.tolist() if isinstance(pixel, np.ndarray) else pixel
    if not (isinstance(values, list) and len(values) == 2 and all(type(p) in (int, float) for p in values)):
        raise ValueError(f"{path}: pixel = {pixel!r}: must be [dx, dy], two numbers in m")
    if not isinstance(periodic, bool | np.bool_):
        raise ValueError(f"{path}: periodic = {periodic!r}: must be true or false")
    return (float(values[0]), float(values[1])), bool(periodic)


def write_sdf(topography: Topography, path: Path) -> None:
    """Write ISO 25178-71, version ISO-1.0, binary, with every digit, as Gwyddion takes it.

    Rows follow one another, points run fastest; lengths are in m, numbers little-endian, missing points nan.

    Raises
    ------
    ValueError
        If the map is too large for the format.
    """
    rows, columns = topography.heights.shape
    if max(rows, columns) > _MOST_POINTS:
        raise ValueError(
            f"{columns} x {rows} points: SDF holds {_MOST_POINTS} along each axis; write .npy or .h5"
        )
    stamp = datetime.now(UTC).strftime("%d%m%Y%H%M").encode()
    scales = (*topography.pixel, 1.0, 0.0)  # of x, y and z, and the resolution of z
    head = (b"bISO-1.0", b"mcgw".ljust(10), stamp, stamp, columns, rows, *scales, 0, _DOUBLE, 0)
    with whole_file(path) as unfinished, open(unfinished, "wb") as file:
        file.write(_HEADER.pack(*head))
        for row in topography.heights:
            file.write(row.astype("<f8").tobytes())


def files_of_map(path: Path) -> list[Path]:
    """Files of a map of this name: the map and its sidecar."""
    return [path, sidecar_of(path)] if path.suffix.lower() == ".npy" else [path]


def write_map(
    topography: Topography, path: Path, field: Asperities | None = None, *, scene: str = ""
) -> list[Path]:
    """Write a map in the format of the file's ending, one of `WRITTEN`; returns all files that were written.

    The field of asperities and the text of the scene go into an HDF5 file with it.

    Raises
    ------
    ValueError
        If the ending is unknown or the map too large for the format.
    """
    match path.suffix.lower():
        case ".sdf":
            write_sdf(topography, path)
        case ".npy":
            write_npy(topography, path)
        case ".h5":
            write_h5(topography, path, field, scene=scene)
        case _:
            raise ValueError(f"{path}: the ending determines the format; give one of {', '.join(WRITTEN)}")
    return files_of_map(path)
