"""In which unit the heights of a file are."""

from pathlib import Path

from mcgw.formats.units import METRES

__all__ = ["height_unit", "metres_in"]


def height_unit(path: Path, told: str | None, given: str | None) -> tuple[float, str]:
    """Size of the unit of heights, m, and the unit that was assumed ("m") if neither file nor user tells one.

    Raises
    ------
    ValueError
        If a unit is unknown, or the file and the user contradict each other.
    """
    if given is not None and told is not None and metres_in(path, given) != metres_in(path, told):
        raise ValueError(f"{path}: heights are in {told} as the file says, not in {given}; leave --unit out")
    unit = told or given
    return (1.0, "m") if unit is None else (metres_in(path, unit), "")


def metres_in(path: Path, unit: str) -> float:
    """Size of a unit of length, m.

    Raises
    ------
    ValueError
        If it is unknown.
    """
    if unit not in METRES:
        raise ValueError(f"{path}: {unit!r} is not a unit of length known here: {', '.join(METRES)}")
    return METRES[unit]
