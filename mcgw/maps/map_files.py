"""Maps in files: readers and writers by ending; arrays with a JSON sidecar, and HDF5."""

import json
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from mcgw.formats.files import together, whole_file
from mcgw.formats.gate import open_h5
from mcgw.formats.named_files import loads_json, open_npy, read_bytes
from mcgw.machine.terminal import one_line
from mcgw.maps.foreign import ForeignError, read_foreign
from mcgw.maps.sdf import write_sdf
from mcgw.maps.synthetic import Asperities
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

_FILETYPE = "mcgw-surface"
_MOST_JSON = 2**16
WRITTEN = (".npy", ".h5", ".sdf")
_TEXT = (".txt", ".csv", ".asc", ".dat", ".tsv", ".xyz")


def sidecar_of(path: Path) -> Path:
    """File of the pixel size of an array: ``map.json`` beside ``map.npy``."""
    return path.with_suffix(".json")


def write_npy(topography: Topography, path: Path) -> None:
    """Write an array and its sidecar."""
    dx, dy = topography.pixel
    facts = {
        "filetype": _FILETYPE,
        "pixel": [dx, dy],
        "unit": "m",
        "periodic": topography.periodic,
        "axes": ["y", "x"],
    }
    with together(), whole_file(path) as unfinished, whole_file(sidecar_of(path)) as beside:
        with open(unfinished, "wb") as file:
            np.save(file, topography.heights)
        beside.write_text(json.dumps(facts, indent=2) + "\n", encoding="utf-8")


def _read_npy(path: Path, pixel: tuple[float, float] | None) -> Raw:
    """Read an array; its pixel size and the unit of its heights from the sidecar, unless a pixel is given."""
    array = open_npy(path)
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


def write_h5(topography: Topography, path: Path, field: Asperities | None = None, *, scene: str = "") -> None:
    """Write a map, and the asperities it was made of, as HDF5.

    Datasets ``height`` (y, x), and ``asperities/x``, ``y``, ``z``, all in m; attributes ``pixel``,
    ``periodic``, ``radius`` and ``scene`` (TOML).

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    with whole_file(path) as unfinished, h5py.File(unfinished, "w", locking=False) as file:
        file.attrs.update(
            filetype=_FILETYPE, format=[1, 0], pixel=topography.pixel, periodic=topography.periodic
        )
        data = file.create_dataset("height", data=topography.heights, compression="gzip", compression_opts=1)
        data.attrs.update(units="m", long_name="height above the mean of the summits", axes=["y", "x"])
        if field is not None:
            group = file.create_group("asperities")
            group.attrs.update(radius=field.radius, size=field.size, units="m")
            for name, values in (("x", field.x), ("y", field.y), ("z", field.z)):
                group.create_dataset(name, data=values).attrs["units"] = "m"
        file["scene"] = scene  # a dataset: an attribute ends at 64 kB


def _read_h5(path: Path) -> Raw:
    """Read the map of such a file."""
    if not h5py.is_hdf5(path):
        raise ForeignError(f"{path}: is not a valid HDF5 file")
    try:
        with open_h5(path) as file:
            if file.attrs.get("filetype") != _FILETYPE:
                raise ForeignError(f"{path}: is not a {_FILETYPE} file; it was not written by mcgw surface")
            data = file["height"]
            checked_shape(*data.shape, held=data.id.get_storage_size())
            pixel, periodic = _pixel(path, file.attrs["pixel"]), _periodic(path, file.attrs["periodic"])
            told = data.attrs.get("units")
            if data.size and not data.id.get_storage_size():
                raise ValueError(f"{path}: its heights were never written")
            return Raw(data[...], None if told is None else str(told), pixel, periodic)
    except (AttributeError, KeyError, OSError, RuntimeError, TypeError) as error:  # as HDF5 tells of damage
        raise ValueError(f"{path}: is a damaged {_FILETYPE} file: {one_line(str(error))}") from None


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
    match path.suffix.lower():
        case ".sdf":
            write_sdf(topography, path)
        case ".npy":
            write_npy(topography, path)
        case ".h5":
            write_h5(topography, path, field, scene=scene)
        case _:
            raise ValueError(f"{path}: the ending determines the format; give one of {', '.join(WRITTEN)}")
    return files_of_map(path)


def read_map(
    path: Path,
    *,
    pixel: tuple[float, float] | None = None,
    unit: str | None = None,
    missing: float | None = None,
) -> Topography:
    """Read a map in the format of the file's ending.

    Parameters
    ----------
    path : Path
        ``.npy``, HDF5 of mcgw or text; any other (SDF, X3P, ...) goes to SurfaceTopography, where it is
        installed, whatever its ending.
    pixel : (float, float), optional
        Size of a pixel, m, for arrays and text that do not tell it.
    unit : str, optional
        Of the heights, for files that do not tell it; m if left out.
    missing : float, optional
        Number that stands for a missing point, in the unit of the file, such as -9999.

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
    check_file(path)
    raw = _read(path, pixel, unit, missing)
    metre, assumed = height_unit(path, raw.unit, unit)
    with np.errstate(over="ignore", invalid="ignore"):  # of scales: a map refuses what comes of it
        heights = np.ascontiguousarray(in_metres(path, raw.heights, metre, missing))
    topography = Topography(heights, raw.pixel, raw.periodic, assumed or raw.assumed)
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


def _read(path: Path, pixel: tuple[float, float] | None, unit: str | None, missing: float | None) -> Raw:
    """Read by our own readers, otherwise by SurfaceTopography.

    Since that skips text it does not know, text files must state their pixel.
    """
    ending = path.suffix.lower()
    try:
        if ending == ".npy":
            return _read_npy(path, pixel)
        if ending in _TEXT:
            return read_text(path, pixel, unit)
        if ending == ".h5":
            return _told(path, pixel, _read_h5(path))
    except ForeignError as error:
        refused = error
    else:
        return read_foreign(path, pixel, unit, missing)
    try:
        found = read_foreign(path, None if ending in _TEXT else pixel, unit, missing)
    except ValueError as too:
        if ending in _TEXT:
            raise refused from None
        raise ValueError(f"{refused}; {str(too).removeprefix(f'{path}: ')}") from None
    return _told(path, pixel, found) if ending in _TEXT else found


def _told(path: Path, pixel: tuple[float, float] | None, found: Raw) -> Raw:
    """Require that the file of a map contains its pixel size."""
    if pixel is not None:
        raise ValueError(f"{path}: gives the size of a pixel; leave --pixel out")
    return found
