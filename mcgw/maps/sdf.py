"""Surface data files (SDF), ISO 25178-71, version ISO-1.0, for other programs: binary and ASCII.

Profiles (rows) follow one another, points (columns) run fastest; lengths are in m. Binary files are
little-endian, as Gwyddion and SurfaceTopography take them. Missing points are nan, in text too: Gwyddion's
reader (sdfile.c) takes it, and ends at a word.
"""

import math
import struct
from datetime import UTC, datetime
from pathlib import Path
from typing import BinaryIO

from mcgw.formats.files import whole_file
from mcgw.maps.topography import Topography

_HEADER = struct.Struct("<8s10s12s12sHHddddBBB")
_DOUBLE = 7
_MOST_POINTS = 65535  # along each axis: 16 bits in a binary file


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
