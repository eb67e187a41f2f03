"""Whether a file holds a map or a profile, and profiles from files of all kinds."""

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from mcgw.formats.npy_file import open_npy
from mcgw.maps.height_unit import height_unit
from mcgw.maps.profile import Profile, profile_at
from mcgw.maps.profile_text import columns_of_text, read_profile_text

__all__ = ["holds_profile", "read_profile"]

_TEXT = (".txt", ".csv", ".asc", ".dat", ".tsv", ".prf", ".xy")
_MAPS = (".sdf", ".x3p", ".h5")  # which tell of no profiles


def holds_profile(path: Path) -> bool:
    """Whether a file holds heights along a line, by its shape: one or two columns, or one dimension.

    What cannot be read holds none: who reads the map says why.
    """
    ending = path.suffix.lower()
    try:
        if ending in _TEXT:
            return columns_of_text(path) in (1, 2)
        if ending == ".npy":
            return open_npy(path).ndim == 1
        if ending in _MAPS or not path.is_file():
            return False
        return bool(_of_surface_topography(path).dim == 1)
    except (OSError, ValueError):
        return False


def read_profile(path: Path, *, spacing: float | None = None, unit: str | None = None) -> Profile:
    """Read a profile: text, ``.npy`` of one dimension, or what SurfaceTopography reads as one.

    Parameters
    ----------
    path : Path
        The file.
    spacing : float, optional
        Between points, m, where the file does not tell it.
    unit : str, optional
        Of the heights, where the file does not tell it; m if left out.

    Raises
    ------
    ValueError
        If it is no profile, is damaged, or tells no unit where m would make it too steep or too long.
    OSError
        If it cannot be read.
    """
    if not path.is_file():
        raise ValueError(f"{path}: is not a regular file" if path.exists() else f"{path}: no such file")
    profile = _read(path, spacing, unit)
    if profile.doubtful:
        raise ValueError(
            f"{path}: tells not all of its units, and in {profile.assumed_unit} {profile.doubtful}; give "
            "--unit (um, nm, ...) of the heights, and --pixel, the distance of two points"
        )
    return profile


def _read(path: Path, spacing: float | None, unit: str | None) -> Profile:
    ending = path.suffix.lower()
    if ending in _TEXT:
        return read_profile_text(path, spacing, unit)
    if ending == ".npy":
        return _array(path, spacing, unit)
    if spacing is not None:
        raise ValueError(f"{path}: tells the distance of its points itself; leave --pixel out")
    found = _of_surface_topography(path)
    if found.dim != 1:
        raise ValueError(f"{path}: is a map, not a profile; leave --profile out")
    metre, assumed = height_unit(path, found.unit, unit)
    x, z = found.positions_and_heights()
    places, heights = np.array(x, dtype=np.float64), np.array(np.ma.filled(z, np.nan), dtype=np.float64)
    try:
        return profile_at(places * metre, heights * metre, assumed)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _array(path: Path, spacing: float | None, unit: str | None) -> Profile:
    z = np.array(open_npy(path), dtype=np.float64)
    if z.ndim != 1:
        raise ValueError(f"{path}: holds {z.ndim} dimensions; a profile has one")
    if spacing is None:
        raise ValueError(f"{path}: does not tell the distance of its points; give --pixel")
    metre, assumed = height_unit(path, None, unit)
    try:
        return profile_at(spacing * np.arange(z.size, dtype=np.float64), z * metre, assumed)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _of_surface_topography(path: Path) -> Any:
    """What that library makes of a file."""
    try:
        library = import_module("SurfaceTopography")
    except ImportError:
        raise ValueError(
            f"{path}: {path.suffix or 'no ending'} is not read here; install SurfaceTopography "
            "(the extra mcgw[maps]), or save the profile as text"
        ) from None
    try:
        return library.read_topography(str(path))
    except Exception as error:  # its readers raise errors of many kinds
        reason = " ".join(str(error).split())[:160]
        raise ValueError(f"{path}: SurfaceTopography cannot read it: {reason}") from None
