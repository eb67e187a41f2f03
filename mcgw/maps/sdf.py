"""Surface data files (SDF), ISO 25178-71, version ISO-1.0, binary, for other programs.

Profiles (rows) follow one another, points (columns) run fastest; lengths are in m, numbers little-endian, as
Gwyddion and SurfaceTopography take them. Missing points are nan.
"""

import struct
from datetime import UTC, datetime
from pathlib import Path

from mcgw.formats.files import whole_file
from mcgw.maps.topography import Topography

_HEADER = struct.Struct("<8s10s12s12sHHddddBBB")
_DOUBLE = 7
_MOST_POINTS = 65535  # along each axis: 16 bits


def write_sdf(topography: Topography, path: Path) -> None:
    """Write a map of at most 65535 points along each axis, with every digit.

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
