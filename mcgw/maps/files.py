"""Which reader and writer a map's file needs: its ending says so."""

from importlib import import_module
from pathlib import Path

import numpy as np

from mcgw.maps.array_files import read_h5, read_npy, read_text, sidecar_of, write_h5, write_npy
from mcgw.maps.asperities import Asperities
from mcgw.maps.lengths import METRES
from mcgw.maps.sdf import read_sdf, write_sdf
from mcgw.maps.topography import Topography, checked_shape
from mcgw.maps.x3p import read_x3p, write_x3p

__all__ = ["WRITTEN", "check_ending", "read_map", "write_map"]

WRITTEN = (".sdf", ".ascii.sdf", ".x3p", ".npy", ".h5")
_TEXT = (".txt", ".csv", ".asc", ".dat", ".tsv")


def check_ending(path: Path) -> None:
    """See that a map can be written under this name.

    Raises
    ------
    ValueError
        If no writer has this ending.
    """
    if path.suffix.lower() not in WRITTEN:
        raise ValueError(f"{path}: the ending chooses the format; give one of {', '.join(WRITTEN)}")


def write_map(
    topography: Topography, path: Path, field: Asperities | None = None, *, scene: str = ""
) -> list[Path]:
    """Write a map in the format of the file's ending.

    Parameters
    ----------
    topography : Topography
        The map.
    path : Path
        Ending in one of `WRITTEN`.
    field : Asperities, optional
        Goes into an HDF5 file with it.
    scene : str, optional
        Text of the scene, for an HDF5 file.

    Returns
    -------
    list of Path
        What was written.

    Raises
    ------
    ValueError
        If the ending is unknown or the map too large for the format.
    OSError
        If it cannot be written.
    """
    check_ending(path)
    match path.suffix.lower():
        case ".sdf":
            write_sdf(topography, path, text=path.name.lower().endswith(".ascii.sdf"))
        case ".x3p":
            write_x3p(topography, path)
        case ".npy":
            write_npy(topography, path)
            return [path, sidecar_of(path)]
        case ".h5":
            write_h5(topography, path, field, scene=scene)
    return [path]


def read_map(path: Path, *, pixel: tuple[float, float] | None = None) -> Topography:
    """Read a map in the format of the file's ending.

    Parameters
    ----------
    path : Path
        SDF, X3P, ``.npy``, HDF5 of mcgw or text; any other goes to SurfaceTopography, where it is
        installed.
    pixel : (float, float), optional
        Size of a pixel, m, for arrays and text that do not tell it.

    Returns
    -------
    Topography
        Heights in m.

    Raises
    ------
    ValueError
        If the file is damaged or of an unknown kind.
    OSError
        If it cannot be read.
    """
    if not path.is_file():
        raise ValueError(f"{path}: is no regular file" if path.exists() else f"{path}: no such file")
    ending = path.suffix.lower()
    if ending == ".sdf":
        return read_sdf(path)
    if ending == ".x3p":
        return read_x3p(path)
    if ending == ".npy":
        return read_npy(path, pixel)
    if ending == ".h5":
        return read_h5(path)
    if ending in _TEXT:
        return read_text(path, pixel)
    return _from_surface_topography(path)


def _from_surface_topography(path: Path) -> Topography:
    """Any of the many formats that SurfaceTopography reads."""
    try:
        library = import_module("SurfaceTopography")
    except ImportError:
        raise ValueError(
            f"{path}: {path.suffix or 'no ending'} is not read here; install SurfaceTopography "
            "(the extra mcgw[maps]), or save the map as SDF, X3P, .npy or text"
        ) from None
    try:
        found = library.read_topography(str(path))
    except Exception as error:  # its readers raise errors of many kinds
        raise ValueError(f"{path}: SurfaceTopography cannot read it: {error}") from None
    if found.unit not in METRES or found.dim != 2:
        raise ValueError(f"{path}: its unit is {found.unit!r}; only maps in a unit of length are taken")
    columns, rows = found.nb_grid_pts
    checked_shape(rows, columns)
    metre = METRES[found.unit]
    heights = np.ma.filled(np.ma.masked_invalid(found.heights()), np.nan).T * metre
    dx, dy = (float(p) * metre for p in found.pixel_size)
    return Topography(np.ascontiguousarray(heights), (dx, dy), bool(found.is_periodic))
