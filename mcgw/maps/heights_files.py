"""Maps and profiles from files: readers by ending; arrays with a JSON sidecar, and HDF5."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np

from analytic.arrays import Array
from mcgw.formats.gate import open_h5
from mcgw.formats.named_files import loads_json, open_npy, read_bytes
from mcgw.machine.terminal import one_line
from mcgw.maps.foreign import ForeignError, read_foreign
from mcgw.maps.map_files import FILETYPE, sidecar_of
from mcgw.maps.profile import Profile, profile_at
from mcgw.maps.text_file import read_text
from mcgw.maps.topography import (
    FLATTEST,
    STEEPEST,
    XYZ,
    Raw,
    Topography,
    check_file,
    checked_shape,
    height_unit,
    in_metres,
)

_MOST_JSON = 2**16
_TEXT = (".txt", ".csv", ".asc", ".dat", ".tsv", ".prf", ".xy", ".xyz")


def read_heights(
    path: Path,
    *,
    pixel: tuple[float, float] | None = None,
    unit: str | None = None,
    missing: float | None = None,
) -> Topography | Profile:
    """Read a map, or a profile if the file has heights along a line.

    Parameters
    ----------
    path : Path
        ``.npy``, HDF5 of mcgw or text; any other (SDF, X3P, ...) goes to SurfaceTopography, where it is
        installed, whatever its ending.
    pixel : (float, float), optional
        Size of a pixel, m, for arrays and text that do not tell it; of a profile, the first of them is the
        distance between points, which have no x, or x without a unit, which then is not looked at.
    unit : str, optional
        Of the heights, for files that do not tell it; m if left out.
    missing : float, optional
        Number that stands for a missing point, in the unit of the file, such as -9999.

    Returns
    -------
    Topography or Profile
        Heights in m.

    Raises
    ------
    ValueError
        If the file is damaged or of an unknown kind, tells another pixel or unit than given, or tells no
        unit where m would make it too steep or too long.
    OSError
        If it cannot be read.
    """
    check_file(path)
    raw = _read(path, pixel, unit, missing)
    if raw.heights.ndim == 2 and 1 in raw.heights.shape:  # SDF and X3P hold a line as a map of one row
        raw, pixel = _along_line(raw), None
    metre, assumed = height_unit(path, raw.unit, unit)
    with np.errstate(over="ignore", invalid="ignore"):  # of scales: a map refuses what comes of it
        heights = np.ascontiguousarray(in_metres(path, raw.heights, metre, missing))
    if heights.ndim == 1:
        return _profile(path, raw, heights, assumed, pixel)
    return _map(path, Topography(heights, raw.pixel, raw.periodic, assumed or raw.assumed))


def read_map(
    path: Path,
    *,
    pixel: tuple[float, float] | None = None,
    unit: str | None = None,
    missing: float | None = None,
) -> Topography:
    """Read a map as `read_heights` does, and no profile."""
    found = read_heights(path, pixel=pixel, unit=unit, missing=missing)
    if isinstance(found, Profile):
        raise ValueError(f"{path}: is a profile along a line; a map has rows and columns")
    return found


def _along_line(raw: Raw) -> Raw:
    """Return a map of one row, or of one column, as a profile."""
    spacing = raw.pixel[int(raw.heights.shape[0] > 1)]
    places = spacing * np.arange(raw.heights.size, dtype=np.float64)
    return Raw(raw.heights.ravel(), raw.unit, places=places, unit_of_places="m")


def _map(path: Path, topography: Topography) -> Topography:
    slope = topography.steepness
    if slope == 0 or FLATTEST <= slope <= STEEPEST:
        return topography
    if topography.assumed_unit and slope > STEEPEST:
        raise ValueError(
            f"{path}: gives no unit of its heights, and in {topography.assumed_unit} their typical slope "
            f"would be {slope:.3g}; give --unit (um, nm, ...), or another --pixel"
        )
    raise ValueError(
        f"{path}: the typical slope of this map is {slope:.3g}, which no surface has ({FLATTEST:g} to "
        f"{STEEPEST:g}): its heights, or its pixel of {topography.pixel[0]:.3g} m, are in another unit"
    )


def _profile(
    path: Path, raw: Raw, heights: Array, assumed: str, pixel: tuple[float, float] | None
) -> Profile:
    if pixel is not None:
        if raw.unit_of_places is not None:
            raise ValueError(f"{path}: gives x in {raw.unit_of_places}; leave --pixel out")
        places = pixel[0] * np.arange(raw.heights.size, dtype=np.float64)
    elif raw.places is None:
        raise ValueError(f"{path}: does not give the distance between its points; give --pixel")
    else:
        of_x, assumed_x = height_unit(path, raw.unit_of_places, None)
        places, assumed = raw.places * of_x, assumed or assumed_x
    try:
        profile = profile_at(places, heights, assumed)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    if profile.doubtful:
        raise ValueError(
            f"{path}: does not give all units, and in {profile.assumed_unit} {profile.doubtful}; give --unit "
            "(um, nm, ...) of the heights, and --pixel, the distance between points"
        )
    return profile


def _read(path: Path, pixel: tuple[float, float] | None, unit: str | None, missing: float | None) -> Raw:
    """Read by our own readers, otherwise by SurfaceTopography.

    Since that skips text it does not know, text files must state their pixel.
    """
    ending = path.suffix.lower()
    text = ending in _TEXT
    if not text and ending not in (".npy", ".h5"):
        return read_foreign(path, pixel, unit, missing)
    try:
        if text:
            return read_text(path, pixel, unit)
        return _read_npy(path, pixel) if ending == ".npy" else _read_h5(path, pixel)
    except ForeignError as error:
        refused = error
    try:
        found = read_foreign(path, None if text else pixel, unit, missing)
    except ValueError as too:
        raise refused if text else ValueError(f"{refused}; {str(too).removeprefix(f'{path}: ')}") from None
    if text and pixel is not None:
        raise ValueError(f"{path}: gives the size of a pixel; leave --pixel out")
    return found


def _read_npy(path: Path, pixel: tuple[float, float] | None) -> Raw:
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
    if pixel is not None:
        return Raw(array, pixel=pixel)
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
    return Raw(array, unit, _pixel(beside, pixel), _periodic(beside, periodic))


def _pixel(path: Path, told: Any) -> tuple[float, float]:
    """Pixel size from a file, if it is two numbers; a text of two digits is not."""
    values = told.tolist() if isinstance(told, np.ndarray) else told
    if not (isinstance(values, list) and len(values) == 2 and all(type(p) in (int, float) for p in values)):
        raise ValueError(f"{path}: pixel = {told!r}: must be [dx, dy], two numbers in m")
    return float(values[0]), float(values[1])


def _periodic(path: Path, told: Any) -> bool:
    """Whether a file says that its map is periodic; texts do not count, since "no" is true in Python."""
    if not isinstance(told, bool | np.bool_):
        raise ValueError(f"{path}: periodic = {told!r}: must be true or false")
    return bool(told)


def _read_h5(path: Path, given: tuple[float, float] | None) -> Raw:
    """Read the map of such a file."""
    if not h5py.is_hdf5(path):
        raise ForeignError(f"{path}: is not a valid HDF5 file")
    try:
        with open_h5(path) as file:
            if file.attrs.get("filetype") != FILETYPE:
                raise ForeignError(f"{path}: is not a {FILETYPE} file; it was not written by mcgw surface")
            if given is not None:
                raise ValueError(f"{path}: gives the size of a pixel; leave --pixel out")
            data = file["height"]
            checked_shape(*data.shape, held=data.id.get_storage_size())
            pixel, periodic = _pixel(path, file.attrs["pixel"]), _periodic(path, file.attrs["periodic"])
            told = data.attrs.get("units")
            if data.size and not data.id.get_storage_size():
                raise ValueError(f"{path}: its heights were never written")
            return Raw(data[...], None if told is None else str(told), pixel, periodic)
    except (AttributeError, KeyError, OSError, RuntimeError, TypeError) as error:  # as HDF5 tells of damage
        raise ValueError(f"{path}: is a damaged {FILETYPE} file: {one_line(str(error))}") from None
