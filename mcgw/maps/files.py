"""Which reader and writer a map's file needs: its ending says so."""

from pathlib import Path

import numpy as np

from mcgw.maps.array_files import read_h5, read_npy, sidecar_of, write_h5, write_npy
from mcgw.maps.asperities import Asperities
from mcgw.maps.foreign import ForeignError, UnreadableError, read_foreign
from mcgw.maps.height_unit import height_unit
from mcgw.maps.sdf import read_sdf, write_sdf
from mcgw.maps.text_file import read_text
from mcgw.maps.topography import STEEPEST, Topography
from mcgw.maps.x3p import read_x3p, write_x3p

__all__ = ["WRITTEN", "files_of_map", "read_map", "write_map"]

WRITTEN = (".sdf", ".ascii.sdf", ".x3p", ".npy", ".h5")
_READERS = {".sdf": read_sdf, ".x3p": read_x3p}  # of formats that tell the size of a pixel, and heights in m
_TEXT = (".txt", ".csv", ".asc", ".dat", ".tsv")


def files_of_map(path: Path) -> list[Path]:
    """Files of a map of this name: itself, and what lies beside it."""
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
            write_sdf(topography, path, text=path.name.lower().endswith(".ascii.sdf"))
        case ".x3p":
            write_x3p(topography, path)
        case ".npy":
            write_npy(topography, path)
        case ".h5":
            write_h5(topography, path, field, scene=scene)
        case _:
            raise ValueError(f"{path}: the ending chooses the format; give one of {', '.join(WRITTEN)}")
    return files_of_map(path)


def read_map(path: Path, *, pixel: tuple[float, float] | None = None, unit: str | None = None) -> Topography:
    """Read a map in the format of the file's ending.

    Parameters
    ----------
    path : Path
        SDF, X3P, ``.npy``, HDF5 of mcgw or text; any other goes to SurfaceTopography, where it is
        installed, whatever its ending.
    pixel : (float, float), optional
        Size of a pixel, m, for arrays and text that do not tell it.
    unit : str, optional
        Of the heights, for files that do not tell it; m if left out.

    Returns
    -------
    Topography
        Heights in m.

    Raises
    ------
    ValueError
        If the file is damaged or of an unknown kind, tells another pixel or unit than given, or tells no
        unit where m would make it too steep.
    OSError
        If it cannot be read.
    """
    if not path.is_file():
        raise ValueError(f"{path}: is not a regular file" if path.exists() else f"{path}: no such file")
    with np.errstate(over="ignore", invalid="ignore"):  # of scales: a map refuses what comes of it
        topography = _read(path, pixel, unit)
    if topography.assumed_unit and topography.steepness > STEEPEST:
        raise ValueError(
            f"{path}: tells no unit of its heights, and in {topography.assumed_unit} their usual slope is "
            f"{topography.steepness:.3g}; give --unit (um, nm, ...), or another --pixel"
        )
    return topography


def _read(path: Path, pixel: tuple[float, float] | None, unit: str | None) -> Topography:
    """By our own readers; what is none of their files by SurfaceTopography."""
    ending = path.suffix.lower()
    try:
        if ending == ".npy":
            return read_npy(path, pixel, unit)
        if ending in _TEXT:
            return read_text(path, pixel, unit)
        if ending == ".h5":
            return _told(path, pixel, read_h5(path, unit))
        if ending in _READERS:
            height_unit(path, "m", unit)
            return _told(path, pixel, _READERS[ending](path))
    except ForeignError as refused:
        return _otherwise(path, pixel, unit, refused)
    return read_foreign(path, pixel, unit)


def _otherwise(
    path: Path, pixel: tuple[float, float] | None, unit: str | None, refused: ForeignError
) -> Topography:
    """By SurfaceTopography; of text it skips what it does not know, so that has to tell its pixel too."""
    if path.suffix.lower() not in _TEXT:
        try:
            return read_foreign(path, pixel, unit)
        except UnreadableError as too:
            raise ValueError(f"{refused}; {str(too).removeprefix(f'{path}: ')}") from None
    try:
        found = read_foreign(path, None, unit)
    except ValueError:
        raise refused from None
    return _told(path, pixel, found)


def _told(path: Path, pixel: tuple[float, float] | None, found: Topography) -> Topography:
    """A map whose file told the size of a pixel."""
    if pixel is not None:
        raise ValueError(f"{path}: tells the size of a pixel itself; leave --pixel out")
    return found
