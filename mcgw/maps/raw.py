"""What a reader of maps and profiles gets and gives: one for each format, in the units of the file."""

from pathlib import Path
from typing import Any, NamedTuple

from numpy.typing import NDArray

from analytic.arrays import Array
from mcgw.formats.units import METRES


class ForeignError(ValueError):
    """A file that is not in one of our formats, but may be in another."""


class Given(NamedTuple):
    """What a user says of a file.

    Parameters
    ----------
    pixel : (float, float) or None
        Size of a pixel, m; of a profile the first is the distance between points.
    unit : str or None
        Of the heights.
    missing : float or None
        Number that stands for a missing point, in the unit of the file.
    """

    pixel: tuple[float, float] | None
    unit: str | None
    missing: float | None


class Raw(NamedTuple):
    """What a file holds of a map or of a profile, before a user adds what it does not tell.

    Parameters
    ----------
    heights : ndarray
        In their unit, shape (rows, columns) or (points,).
    unit : str, optional
        Of the heights, where the file tells it.
    pixel : (float, float), optional
        Size of a pixel of a map, where the file tells it.
    periodic : bool, optional
        Whether opposite edges fit together.
    places : ndarray, optional
        Of the points of a profile along its line.
    lateral : str, optional
        Unit of the pixel or the places, where it is known.
    """

    heights: NDArray[Any]
    unit: str | None = None
    pixel: tuple[float, float] | None = None
    periodic: bool = False
    places: Array | None = None
    lateral: str | None = None


def metres_in(path: Path, unit: str | None) -> float:
    """Size of a unit of length, m; none is m.

    Raises
    ------
    ValueError
        If it is unknown.
    """
    if unit is not None and unit not in METRES:
        raise ValueError(f"{path}: {unit!r} is not a known unit of length: {', '.join(METRES)}")
    return METRES[unit or "m"]
