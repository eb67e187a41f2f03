"""Files of maps: ours are an array with a JSON sidecar or HDF5; SDF for other programs; and what they write.

The many other formats are read by SurfaceTopography, where it is installed. Its readers believe what a file
declares, so a file passes the gate first (`mcgw.formats.gate`), and what a reader has found is bounded by the
size of the file before any height is read. It is imported once, in this process, by the first file that needs
it.
"""

import json
import struct
import warnings
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from mcgw.formats.files import together, whole_file
from mcgw.formats.gate import check_archive, open_h5
from mcgw.formats.named_files import loads_json, open_npy, read_bytes
from mcgw.machine.terminal import one_line
from mcgw.maps.synthetic import Asperities
from mcgw.maps.topography import XYZ, ForeignError, Given, Raw, Topography, checked_shape

FILETYPE = "mcgw-surface"
WRITTEN = (".npy", ".h5", ".sdf")
_MOST_POINTS = 65535  # along each axis: 16 bits
_MOST_TEXT = 2**26  # bytes of a text, which it takes in whole


def sidecar_of(path: Path) -> Path:
    """File of the pixel size of an array: ``map.json`` beside ``map.npy``."""
    return path.with_suffix(".json")


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
    data = read_bytes(beside, 2**16)
    try:
        facts: Any = loads_json(data)
        pixel, periodic, unit = facts["pixel"], facts.get("periodic", False), facts.get("unit")
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise ValueError(f'{beside}: must hold "pixel": [dx, dy] in m: {error}') from None
    if unit not in (None, "m"):
        raise ValueError(f"{beside}: unit = {unit!r}: must be 'm'")
    return Raw(array, unit, *_facts(beside, pixel, periodic))


def _write_h5(topography: Topography, path: Path, field: Asperities | None, scene: str) -> None:
    """Write datasets ``height`` (y, x) and ``asperities/x``, ``y``, ``z``, all in m, and the scene."""
    pixel, periodic = topography.pixel, topography.periodic
    with h5py.File(path, "w", locking=False) as file:
        file.attrs.update(filetype=FILETYPE, format=[1, 0], pixel=pixel, periodic=periodic)
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
            facts = _facts(path, file.attrs["pixel"], file.attrs["periodic"])
            told = data.attrs.get("units")
            if data.size and not data.id.get_storage_size():
                raise ValueError(f"{path}: its heights were never written")
            return Raw(data[...], None if told is None else str(told), *facts)
    except (AttributeError, KeyError, OSError, RuntimeError, TypeError) as error:  # as HDF5 tells of damage
        raise ValueError(f"{path}: is a damaged {FILETYPE} file: {one_line(str(error))}") from None


def _facts(path: Path, pixel: Any, periodic: Any) -> tuple[tuple[float, float], str, bool]:
    """Pixel, its unit and periodicity, if they are two numbers and a truth: "no" is true in Python."""
    values = pixel.tolist() if isinstance(pixel, np.ndarray) else pixel
    if not (isinstance(values, list) and len(values) == 2 and all(type(p) in (int, float) for p in values)):
        raise ValueError(f"{path}: pixel = {pixel!r}: must be [dx, dy], two numbers in m")
    if not isinstance(periodic, bool | np.bool_):
        raise ValueError(f"{path}: periodic = {periodic!r}: must be true or false")
    return (float(values[0]), float(values[1])), "m", bool(periodic)


def _write_sdf(topography: Topography, path: Path) -> None:
    """Write ISO 25178-71, version ISO-1.0, binary: every digit, row by row, missing points nan."""
    rows, columns = topography.heights.shape
    if max(rows, columns) > _MOST_POINTS:
        raise ValueError(
            f"{columns} x {rows} points: SDF holds {_MOST_POINTS} along each axis; write .npy or .h5"
        )
    stamp = datetime.now(UTC).strftime("%d%m%Y%H%M").encode()
    scales = (*topography.pixel, 1.0, 0.0)  # of x, y and z, and the resolution of z
    head = (b"bISO-1.0", b"mcgw".ljust(10), stamp, stamp, columns, rows, *scales, 0, 7, 0)  # 7: a double
    with open(path, "wb") as file:
        file.write(struct.pack("<8s10s12s12sHHddddBBB", *head))
        np.asarray(topography.heights, "<f8").tofile(file)


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
    if (ending := path.suffix.lower()) not in WRITTEN:
        raise ValueError(f"{path}: the ending determines the format; give one of {', '.join(WRITTEN)}")
    with together(), whole_file(path) as unfinished:
        if ending == ".h5":
            _write_h5(topography, unfinished, field, scene)
        elif ending == ".sdf":
            _write_sdf(topography, unfinished)
        else:
            with open(unfinished, "wb") as file:
                np.save(file, topography.heights)
            facts: dict[str, Any] = {"filetype": FILETYPE, "pixel": topography.pixel, "unit": "m"}
            facts |= {"periodic": topography.periodic, "axes": ["y", "x"]}
            with whole_file(sidecar_of(path)) as beside:
                beside.write_text(json.dumps(facts, indent=2) + "\n", encoding="utf-8")
    return files_of_map(path)


def read_foreign(path: Path, given: Given) -> Raw:
    """Read a map or a profile by SurfaceTopography: the first channel of heights, in the unit of x."""
    if find_spec("SurfaceTopography") is None:
        raise ValueError(
            f"{path}: {path.suffix or 'no ending'} is read by SurfaceTopography, which is not installed (the "
            "extra maps: pip install SurfaceTopography); or save it as .npy, .h5 of mcgw or text"
        )
    _check(path)
    with _one_line_errors(path):
        from SurfaceTopography import (  # type: ignore[import-not-found, import-untyped, unused-ignore]
            open_topography,
        )

        reader = open_topography(str(path))
        channels = reader.height_channels
        channel = channels[0] if channels else reader.default_channel
        lengths, points = channel.physical_sizes, tuple(int(n) for n in channel.nb_grid_pts)
    if not channels:
        raise ValueError(
            f"{path}: holds no heights: its channels are "
            + ", ".join(f"{c.name} in {c.data_unit or c.unit or 'no unit'}" for c in reader.channels)[:120]
        )
    try:
        checked_shape(*(*points, 1)[1::-1], held=path.stat().st_size)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    told = None if channel.unit is None else str(channel.unit)
    sized = {} if channel.dim == 1 or lengths is not None else {"physical_sizes": points}
    with _one_line_errors(path):
        found = channel.topography(**sized)
        if channel.dim == 1:
            x, z = found.positions_and_heights()
            return Raw(np.ma.filled(z, np.nan), told, x, told or given.unit)
        z = np.ma.filled(np.ma.masked_invalid(found.heights()), np.nan).T
    if given.missing is None:  # files mark a missing point by the least number of their type
        z[np.abs(z) > 3.4e38 * abs(channel.height_scale_factor or 1.0)] = np.nan
    pixel = None if sized else tuple(map(float, found.pixel_size))
    return Raw(z, told, pixel, told or given.unit, bool(found.is_periodic))


def _check(path: Path) -> None:
    """Refuse a file that leads out of itself, or unpacks to far more than it is, before a reader sees it."""
    if h5py.is_hdf5(path):
        try:
            open_h5(path).close()
        except OSError as error:
            raise ValueError(f"{path}: is a damaged HDF5 file: {str(error)[:80]}") from None
    elif zipfile.is_zipfile(path):
        check_archive(path)
    elif path.stat().st_size > _MOST_TEXT:
        with open(path, "rb") as file:
            start = file.read(64)  # bytes that tell a text
        if not start.strip(bytes(range(32, 127)) + b"\t\r\n"):
            raise ValueError(f"{path}: a text longer than {_MOST_TEXT} bytes; save it as .npy")


@contextmanager
def _one_line_errors(path: Path) -> Iterator[None]:
    """Tell in one line what the readers of SurfaceTopography raise, of many kinds; mute their warnings."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except MemoryError:
        raise ValueError(f"{path}: needs more memory than there is") from None
    except Exception as error:
        said = " ".join(str(error).split())[:160] or type(error).__name__
        raise ValueError(f"{path}: SurfaceTopography cannot read it: {said}") from None
