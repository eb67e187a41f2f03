"""Maps and profiles from files: a reader for each format, and what files do not tell filled in."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array
from mcgw.maps.map_files import read_foreign, read_h5, read_npy
from mcgw.maps.text_file import read_text
from mcgw.maps.topography import ForeignError, Given, Profile, Raw, Topography, metres_in

READERS: dict[str, Callable[[Path, Given], Raw]] = {".npy": read_npy, ".h5": read_h5}
READERS |= dict.fromkeys((".txt", ".csv", ".asc", ".dat", ".tsv", ".prf", ".xy", ".xyz"), read_text)
_SENTINELS = (-9999.0, -99999.0, -32768.0, 32767.0, 1e30, -1e30, 1e10, -1e10, 3.4028235e38, -3.4028235e38)
_EVEN = 0.1  # share of a step that places may be off an even grid
_EQUAL = 1e-6  # relative, of a height and the number that stands for a missing one; beyond 1e30 a hundredth


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
    if not path.is_file():
        raise ValueError(f"{path}: is not a regular file" if path.exists() else f"{path}: no such file")
    raw = _read(path, Given(pixel, unit, missing))
    if unit is not None and raw.unit is not None and metres_in(path, unit) != metres_in(path, raw.unit):
        raise ValueError(
            f"{path}: heights are in {raw.unit} as the file says, not in {unit}; leave --unit out"
        )
    known = raw.unit or unit
    with np.errstate(over="ignore", invalid="ignore"):  # of scales: a map refuses what comes of it
        heights = np.ascontiguousarray(_in_metres(path, raw.heights, metres_in(path, known), missing))
    plane = heights.ndim == 2
    if pixel is not None and (raw.steps if plane else raw.lateral) is not None:
        what = "the size of a pixel" if plane else f"x in {raw.lateral}"
        raise ValueError(f"{path}: gives {what}; leave --pixel out")
    if pixel is None and raw.steps is None:
        what = "size of a pixel" if plane else "distance between its points"
        raise ValueError(f"{path}: does not give the {what}; give --pixel")
    lateral = np.asarray(pixel or metres_in(path, raw.lateral) * np.asarray(raw.steps))
    assumed = "" if known and (pixel or raw.lateral) else "m"
    if plane and 1 not in heights.shape:
        dx, dy = lateral.tolist()
        found = Topography(heights, (dx, dy), raw.periodic, assumed)
        if doubt := found.doubtful:
            raise ValueError(f"{path}: {doubt}")
        return found
    if plane or pixel is not None:  # SDF and X3P hold a line as a map of one row
        lateral = lateral[int(plane and len(heights) > 1)] * np.arange(heights.size)
    try:
        profile = _profile_at(lateral, heights.ravel(), assumed)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    if profile.doubtful:
        raise ValueError(
            f"{path}: does not give all units, and in {profile.assumed_unit} {profile.doubtful}; give --unit "
            "(um, nm, ...) of the heights, and --pixel, the distance between points"
        )
    return profile


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


def _read(path: Path, given: Given) -> Raw:
    """Read by our own readers, otherwise by SurfaceTopography.

    Since that skips text it does not know, text files must state their pixel.
    """
    reader = READERS.get(path.suffix.lower(), read_foreign)
    try:
        return reader(path, given)
    except ForeignError as error:
        refused = error
    try:
        found = read_foreign(path, given)
    except ValueError as too:
        if reader is read_text:
            raise refused from None
        raise ValueError(f"{refused}; {str(too).removeprefix(f'{path}: ')}") from None
    if reader is read_text and found.heights.ndim == 2 and found.steps is None:
        raise refused
    return found


def _profile_at(places: Array, heights: Array, assumed_unit: str = "") -> Profile:
    """Return a profile of heights at places along a line, on an even grid of as many points.

    Places a tenth of a step beside an even grid are taken as rounded. Otherwise, and where heights are
    missing (nan), those on the grid are interpolated along straight lines.
    """
    known = np.isfinite(heights)
    if not known.any():
        raise ValueError("the profile has no heights")
    first, last = int(np.argmax(known)), int(known.size - np.argmax(known[::-1]))
    places, heights, known = places[first:last], heights[first:last], known[first:last]
    missing = int(np.count_nonzero(~known))
    if missing > 0.1 * known.size:  # share of all points
        raise ValueError(f"{missing} of the {known.size} heights are missing; measure the profile again")
    if places.size > 1 and places[-1] < places[0]:
        places, heights, known = places[::-1], heights[::-1], known[::-1]
    steps = np.diff(places)
    if not np.all(steps > 0):
        k = int(np.argmin(steps))
        raise ValueError(
            f"x = {places[k]:g} m is followed by {places[k + 1]:g} m; give x in increasing or decreasing "
            f"order"
        )
    even, spacing = np.linspace(places[0], places[-1], places.size, retstep=True)
    resampled = bool(np.abs(places - even).max() > _EVEN * spacing)
    if resampled or missing:
        heights = np.interp(even if resampled else places, places[known], heights[known])
    return Profile(np.array(heights, dtype=np.float64), float(spacing), assumed_unit, missing, resampled)


def _in_metres(path: Path, raw: NDArray[Any], metre: float, missing: float | None) -> Array:
    """Heights of a file in m, of a unit of so many metres; nan where the number of a missing point stands."""
    if raw.dtype.kind not in "fiu":
        raise ValueError(f"{path}: heights are {raw.dtype.name}, not real numbers; give their real part")
    z = raw.astype(np.float64)
    if missing is not None:
        marked = _equal(z, missing)
        if not marked.any():
            raise ValueError(f"{path}: no height is {missing:g}; leave --missing-value out")
        z[marked] = np.nan
    else:
        _refuse_sentinels(path, z)
    z *= metre
    return z


def _equal(z: Array, value: float) -> NDArray[np.bool_]:
    return np.abs(z - value) <= (0.01 if abs(value) > 1e30 else _EQUAL) * abs(value)


def _refuse_sentinels(path: Path, z: Array) -> None:
    """Refuse an extreme height that programs write for missing points, if it is far from all others."""
    with np.errstate(invalid="ignore"):
        for value in (float(extreme.reduce(z, axis=None)) for extreme in (np.fmin, np.fmax)):
            if not any(_equal(np.array(value), mark) for mark in _SENTINELS):
                continue
            marked = _equal(z, value)
            others = z[~marked & np.isfinite(z)]
            if not others.size:
                continue
            low, high = float(others.min()), float(others.max())
            if max(low - value, value - high) > 3.0 * (high - low):  # ranges of all other heights
                raise ValueError(
                    f"{path}: {np.count_nonzero(marked)} of {z.size} heights are {value:.8g}, far from all "
                    f"others; if they stand for missing points, give --missing-value={value:.8g}"
                )
