"""Surface data files (SDF), ISO 25178-71, version ISO-1.0: binary and ASCII.

Profiles (rows) follow one another, points (columns) run fastest; lengths are in m. Binary files are
little-endian, as Gwyddion and SurfaceTopography take them. Values that mean "not measured" are the
lowest number of signed types, floating ones too, the highest of unsigned ones, ``BAD`` in text, and nan. The
latter is written in text too: Gwyddion's reader (sdfile.c) takes it, and ends at a word.
"""

import math
import re
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array
from mcgw.formats.files import whole_file
from mcgw.maps.foreign import ForeignError
from mcgw.maps.topography import Topography, checked_shape

_HEADER = struct.Struct("<8s10s12s12sHHddddBBB")
_TYPES = ("u1", "<u2", "<u4", "<f4", "i1", "<i2", "<i4", "<f8")
_MISSING = {"<u2": 2**16 - 1, "<u4": 2**32 - 1, "<i2": -(2**15), "<i4": -(2**31)}
_DOUBLE = 7
_LOWEST = 0.999  # share of the lowest float: text may have rounded it
_MOST_POINTS = 65535  # along each axis: 16 bits in a binary file
_TEXT_HEADER = 4096  # bytes
_CHUNK = 2**20
_FIELDS = ("NumPoints", "NumProfiles", "Xscale", "Yscale", "Zscale", "DataType")


@dataclass(frozen=True)
class _Header:
    """Header of either form."""

    rows: int
    columns: int
    dx: float
    dy: float
    z_scale: float
    data_type: int

    def __post_init__(self) -> None:
        checked_shape(self.rows, self.columns)
        scales = (self.dx, self.dy, self.z_scale)
        if not all(math.isfinite(v) and v > 0 for v in scales):
            raise ValueError(f"Xscale, Yscale, Zscale = {scales}: all must be > 0")
        if not 0 <= self.data_type < len(_TYPES):
            raise ValueError(f"DataType = {self.data_type}: SDF knows 0 to {len(_TYPES) - 1}")

    @property
    def dtype(self) -> np.dtype[np.generic]:
        return np.dtype(_TYPES[self.data_type])


def write_sdf(topography: Topography, path: Path, *, text: bool = False) -> None:
    """Write a map of at most 65535 points along each axis, binary or as ASCII; both keep every digit.

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
    date = datetime.now(UTC).strftime("%d%m%Y%H%M")
    with whole_file(path) as unfinished, open(unfinished, "wb") as file:
        if text:
            _write_text(topography, file, date)
            return
        dx, dy = topography.pixel
        stamp = date.encode()
        scales = (dx, dy, 1.0, 0.0)  # of x, y and z, and the resolution of z
        head = (b"bISO-1.0", b"mcgw".ljust(10), stamp, stamp, columns, rows, *scales, 0, _DOUBLE, 0)
        file.write(_HEADER.pack(*head))
        for row in topography.heights:
            file.write(row.astype("<f8").tobytes())


def _write_text(topography: Topography, file: BinaryIO, date: str) -> None:
    rows, columns = topography.heights.shape
    dx, dy = topography.pixel
    values = {
        "ManufacID": "mcgw",
        "CreateDate": date,
        "ModDate": date,
        "NumPoints": columns,
        "NumProfiles": rows,
        "Xscale": repr(float(dx)),
        "Yscale": repr(float(dy)),
        "Zscale": "1.0",
        "Zresolution": "0.0",
        "Compression": 0,
        "DataType": _DOUBLE,
        "CheckType": 0,
    }
    lines = ["aISO-1.0", *(f"{key} = {value}" for key, value in values.items()), "*"]
    file.write("".join(f"{line}\r\n" for line in lines).encode("ascii"))
    for row in topography.heights:
        file.write((" ".join("nan" if math.isnan(z) else repr(z) for z in row.tolist()) + "\r\n").encode())
    file.write(b"*\r\n")


def read_sdf(path: Path) -> Topography:
    """Read a map, binary or ASCII: heights in m, missing points nan.

    Raises
    ------
    ValueError
        If the file is not SDF, is cut short, or declares what it does not hold. Nothing larger than
        the file's own contents is allocated.
    """
    with open(path, "rb") as file:
        magic = file.read(8)
        if magic == b"bISO-1.0":
            header, raw = _read_binary(path, file)
        elif magic == b"aISO-1.0":
            header, raw = _read_text(path, file)
        else:
            raise ForeignError(
                f"{path}: begins with {magic!r}, not with aISO-1.0 or bISO-1.0; it is not an SDF file"
            )
    heights = raw.astype(np.float64)
    if header.dtype.kind in "iu" and header.dtype.itemsize > 1:
        heights[raw == _MISSING[_TYPES[header.data_type]]] = np.nan
    elif header.dtype.kind == "f":
        heights[heights < _LOWEST * np.finfo(_TYPES[header.data_type]).min] = np.nan
    heights *= header.z_scale
    return Topography(heights.reshape(header.rows, header.columns), (header.dx, header.dy))


def _read_binary(path: Path, file: BinaryIO) -> tuple[_Header, NDArray[np.generic]]:
    rest = file.read(_HEADER.size - 8)
    if len(rest) < _HEADER.size - 8:
        raise ValueError(f"{path}: cut short inside the SDF header")
    columns, rows, dx, dy, z_scale, _, compression, data_type, _ = struct.unpack("<HHddddBBB", rest[34:])
    header = _checked(path, (rows, columns, dx, dy, z_scale, data_type), compression)
    wanted = rows * columns * header.dtype.itemsize
    held = path.stat().st_size - _HEADER.size
    if held < wanted:
        raise ValueError(
            f"{path}: declares {columns} x {rows} points of {header.dtype.itemsize} bytes = {wanted} bytes, "
            f"but holds {held}; it is cut short"
        )
    return header, np.fromfile(file, dtype=header.dtype, count=rows * columns)


def _checked(path: Path, header: tuple[int, int, float, float, float, int], compression: int) -> _Header:
    if compression:
        raise ValueError(f"{path}: compressed SDF files are not read; save it without compression")
    try:
        return _Header(*header)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _read_text(path: Path, file: BinaryIO) -> tuple[_Header, Array]:
    start = file.read(_TEXT_HEADER)
    end = re.search(rb"^\s*\*[ \t]*\r?$\n?", start, re.MULTILINE)
    if end is None:
        raise ValueError(f"{path}: no line with * after the SDF header")
    file.seek(8 + end.end())
    found = dict(re.findall(r"^[ \t]*(\w+)[ \t]*=?[ \t]*(\S+)", start[: end.start()].decode("latin-1"), re.M))
    missing = [key for key in _FIELDS if key not in found]
    if missing:
        raise ValueError(f"{path}: the SDF header lacks {', '.join(missing)}")
    try:
        rows, columns, data_type = (int(found[key]) for key in ("NumProfiles", "NumPoints", "DataType"))
        dx, dy, z_scale = (float(found[key]) for key in ("Xscale", "Yscale", "Zscale"))
        compression = int(found.get("Compression", "0"))
    except ValueError as error:
        raise ValueError(f"{path}: the SDF header is malformed: {error}") from None
    header = _checked(path, (rows, columns, dx, dy, z_scale, data_type), compression)
    wanted = header.rows * header.columns
    held = path.stat().st_size - 8 - end.end()
    if 2 * wanted > held + 1:  # a digit each, and spaces between them
        raise ValueError(
            f"{path}: declares {wanted} points, but {held} bytes cannot hold them; it is cut short"
        )
    values = np.empty(wanted)
    filled = 0
    for numbers in _numbers(path, file):
        if filled + numbers.size > wanted:
            raise ValueError(f"{path}: holds more than the {wanted} points it declares")
        values[filled : filled + numbers.size] = numbers
        filled += numbers.size
    if filled < wanted:
        raise ValueError(f"{path}: declares {wanted} points, but holds {filled}; it is cut short")
    return header, values


def _numbers(path: Path, file: BinaryIO) -> Iterator[Array]:
    """Numbers up to the next *, a megabyte of text at a time."""
    left = b""
    while chunk := file.read(_CHUNK):
        text, star, _ = (left + chunk).partition(b"*")
        cut = len(text) if star else max(text.rfind(b" "), text.rfind(b"\n"), text.rfind(b"\t")) + 1
        left = text[cut:]
        yield _parsed(path, text[:cut])
        if star:
            return
        if len(left) > _CHUNK:
            raise ValueError(f"{path}: a megabyte without a space is not a list of heights")
    yield _parsed(path, left)


def _parsed(path: Path, text: bytes) -> Array:
    words = [b"nan" if word == b"BAD" else word for word in text.replace(b",", b" ").split()]
    try:
        return np.array(words, dtype="S32").astype(np.float64)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
