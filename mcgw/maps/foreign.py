"""Maps and profiles in the many formats that SurfaceTopography reads, where it is installed.

Its readers believe what a file declares, so a file passes the gate first (`mcgw.formats.gate`), and what a
reader has found is bounded by the size of the file before any height is read. It is imported once, in this
process, by the first file that needs it.
"""

import warnings
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from mcgw.formats.gate import check_archive, open_h5
from mcgw.maps.raw import Given, Raw
from mcgw.maps.topography import checked_shape

_MOST_TEXT = 2**26  # bytes of a text, which it takes in whole
_LARGEST = 3.4e38  # in the numbers of a file, which mark a missing point by the least of their type
_MAGIC = 64  # bytes that tell a text
_PRINTABLE = bytes(range(32, 127)) + b"\t\r\n"


def read_foreign(path: Path, given: Given) -> Raw:
    """Read a map or a profile by SurfaceTopography: the first channel of heights. Its unit is that of x too.

    Raises
    ------
    ValueError
        If it is not installed or cannot read the file, or the file holds no heights, or a file of this size
        cannot hold so many.
    """
    channel = _channel(path)
    points = tuple(int(n) for n in channel.nb_grid_pts)
    try:
        checked_shape(*(*points, 1)[1::-1], held=path.stat().st_size)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    told = None if channel.unit is None else str(channel.unit)
    sized = {} if channel.dim == 1 or channel.physical_sizes is not None else {"physical_sizes": points}
    with _one_line_errors(path):
        found = channel.topography(**sized)
        if channel.dim == 1:
            x, z = found.positions_and_heights()
            return Raw(np.ma.filled(z, np.nan), told, places=x, lateral=told or given.unit)
        z = np.ma.filled(np.ma.masked_invalid(found.heights()), np.nan).T
    if given.missing is None:
        z[np.abs(z) > _LARGEST * abs(channel.height_scale_factor or 1.0)] = np.nan
    dx, dy = found.pixel_size
    pixel = None if sized else (float(dx), float(dy))
    return Raw(z, told, pixel, bool(found.is_periodic), lateral=told or given.unit)


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
            start = file.read(_MAGIC)
        if not start.strip(_PRINTABLE):
            raise ValueError(f"{path}: a text longer than {_MOST_TEXT} bytes; save it as .npy")


def _channel(path: Path) -> Any:
    """Return the first channel of heights, of which nothing but facts is read."""
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
        channel.dim, channel.nb_grid_pts, channel.physical_sizes  # noqa: B018  # tells damage here
    if not channels:
        raise ValueError(
            f"{path}: holds no heights: its channels are "
            + ", ".join(f"{c.name} in {c.data_unit or c.unit or 'no unit'}" for c in reader.channels)[:120]
        )
    return channel


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
