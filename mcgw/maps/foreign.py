"""Maps in the many formats that SurfaceTopography reads, where it is installed."""

from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from mcgw.maps.height_unit import height_unit
from mcgw.maps.topography import Topography, checked_shape

__all__ = ["ForeignError", "UnreadableError", "read_foreign"]

_MOST_TEXT = 2**28  # bytes


class ForeignError(ValueError):
    """A file that is none of ours: it may be one of the many others."""


class UnreadableError(ValueError):
    """A file that SurfaceTopography refuses, or would if it were there."""


def read_foreign(path: Path, pixel: tuple[float, float] | None = None, unit: str | None = None) -> Topography:
    """Read a map by SurfaceTopography; text with decimal commas too.

    Parameters
    ----------
    path : Path
        Of any format that it knows.
    pixel : (float, float), optional
        Size of a pixel, m, where the file does not tell it.
    unit : str, optional
        Of all lengths, where the file tells none; m if left out.

    Raises
    ------
    ValueError
        If it is not installed or cannot read the file, or the file holds a profile, or tells another unit
        or the size of a pixel that was given, or none that was not.
    """
    try:
        library = import_module("SurfaceTopography")
    except ImportError:
        raise UnreadableError(
            f"{path}: {path.suffix or 'no ending'} is not read here; install SurfaceTopography "
            "(the extra mcgw[maps]), or save the map as SDF, X3P, .npy or text"
        ) from None
    try:
        return _read(library, path, pixel, unit, path)
    except UnreadableError as error:
        with TemporaryDirectory() as folder:
            points = _with_points(path, Path(folder))
            if points is not None:
                try:
                    return _read(library, points, pixel, unit, path)
                except UnreadableError:
                    pass
        raise UnreadableError(f"{path}: SurfaceTopography cannot read it: {error}") from None


def _read(
    library: Any, file: Path, pixel: tuple[float, float] | None, unit: str | None, path: Path
) -> Topography:
    """A file, which errors call by its own path."""
    try:
        channel = library.open_topography(str(file)).default_channel
        told = channel.dim != 2 or channel.physical_sizes is not None
        sizes = {} if told else {"physical_sizes": channel.nb_grid_pts}
        found = channel.topography(**sizes)
        heights = np.ma.filled(np.ma.masked_invalid(found.heights()), np.nan).T
    except Exception as error:  # its readers raise errors of many kinds
        raise UnreadableError(" ".join(str(error).split())[:160]) from None
    if found.dim != 2:
        raise ValueError(f"{path}: is a profile along a line; a map has rows and columns")
    columns, rows = found.nb_grid_pts
    checked_shape(rows, columns)
    metre, assumed = height_unit(path, found.unit, unit)  # of lengths along x and y too
    if told and pixel is not None:
        raise ValueError(f"{path}: tells the size of a pixel itself; leave --pixel out")
    if not told and pixel is None:
        raise ValueError(f"{path}: does not tell the size of a pixel; give --pixel")
    dx, dy = pixel or (float(p) * metre for p in found.pixel_size)
    return Topography(np.ascontiguousarray(heights * metre), (dx, dy), bool(found.is_periodic), assumed)


def _with_points(path: Path, folder: Path) -> Path | None:
    """A copy of a text with points for its decimal commas; None if it has none, or another meaning."""
    if path.stat().st_size > _MOST_TEXT:
        return None
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return None
    if "," not in text or "." in text or "\0" in text:
        return None
    copy = folder / path.name
    copy.write_text(text.replace(",", ".").replace(";", "\t"), encoding="utf-8")
    return copy
