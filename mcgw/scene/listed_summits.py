"""Summits given one by one under [summits]: a file or lists of heights and radii."""

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import MeasuredHeights, MeasuredRadii, Surface
from mcgw.formats.named_files import read_text
from mcgw.scene.section import Section

__all__ = ["ListedSummits", "listed_table", "lists_summits", "read_listed"]

Array = NDArray[np.float64]

_COLUMNS = ("height", "radius")
_LISTS = ("file", "heights", "radii", "ratios", "resample")
_MOST_BYTES = 2**28


@dataclass(frozen=True, eq=False)
class ListedSummits:
    """Heights and radii of summits.

    Parameters
    ----------
    heights : ndarray
        m, above any plane, shape (summits,).
    radii : ndarray
        m, or over that of the surface, shape (summits,).
    resampled : bool
        Whether asperities are drawn from these, with replacement.
    over_surface : bool
        Whether `radii` are over that of the surface.
    """

    heights: Array
    radii: Array
    resampled: bool
    over_surface: bool

    def of_surface(self, nominal_area: float) -> dict[str, float]:
        """What they tell of a surface of this area (m^2): eta (1/m^2) and, if in m, sigma and radius (m)."""
        eta = self.heights.size / nominal_area
        if self.over_surface:
            return {"eta": eta}
        return {"sigma": float(self.heights.std()), "radius": float(1 / np.mean(1 / self.radii)), "eta": eta}

    def laws(self, surface: Surface) -> tuple[MeasuredHeights, MeasuredRadii]:
        """Laws of the heights and radii on this surface."""
        heights = MeasuredHeights(self.heights, resampled=self.resampled)
        return heights, MeasuredRadii(heights, self.radii / (1.0 if self.over_surface else surface.radius))


def lists_summits(section: Section) -> bool:
    """Whether [summits] gives them one by one."""
    return any(key in section for key in _LISTS)


def read_listed(section: Section, folder: Path) -> ListedSummits | None:
    """Read them; mistakes are noted, and give None."""
    file, heights, radii, ratios, resample = (section.take(key) for key in _LISTS)
    before = len(section.problems)
    for key in ("curvature", "largest_radius"):
        if key in section:
            section.fail(key, section.take(key), "summits that are listed have their own radii; leave it out")
    if resample not in (None, True, False):
        section.fail("resample", resample, "say true or false")
    key = "file" if file is not None else "heights"
    given = [heights, radii if radii is not None else ratios]
    try:
        if file is not None and (heights, radii, ratios) != (None, None, None):
            raise ValueError("and not both")
        if file is not None:
            given = list(_columns(folder / str(file)))
        if any(each is None for each in given) or (radii is not None and ratios is not None):
            raise ValueError("one list of each")
        found = _checked(*given)
    except (TypeError, ValueError) as error:
        advice = "give a CSV file with columns height and radius in m, or lists heights and radii"
        section.fail(key, {"file": file, "heights": heights}[key], f"{advice}; {error}")
        return None
    if len(section.problems) > before:
        return None
    return ListedSummits(*found, bool(resample), ratios is not None)


def _checked(heights: Any, radii: Any) -> tuple[Array, Array]:
    """Both as arrays.

    Raises
    ------
    ValueError
        If a law of them could not be made.
    """
    z, radius = (np.asarray(x, dtype=np.float64) for x in (heights, radii))
    if z.ndim != 1 or z.shape != radius.shape:
        raise ValueError(f"there are {z.size} heights and {radius.size} radii")
    for name, values, wrong in (
        ("height", z, ~np.isfinite(z)),
        ("radius", radius, ~(np.isfinite(radius) & (radius > 0))),
    ):
        if np.any(wrong):
            k = int(np.flatnonzero(wrong)[0])
            wanted = "a finite number" + (" > 0" if name == "radius" else "")
            raise ValueError(f"{name} of summit {k + 1} is {values[k]:g}, not {wanted}")
    MeasuredHeights(z)
    return z, radius


def _columns(path: Path) -> tuple[list[float], ...]:
    """Columns height and radius of a CSV file with a line of names; # begins a comment.

    Raises
    ------
    ValueError
        If the file cannot be read, or lacks a column or a number; nothing of what stands there is quoted.
    """
    lines = [line for line in read_text(path, _MOST_BYTES).splitlines() if line.strip()]
    rows = csv.reader(line for line in lines if not line.startswith("#"))
    names = [name.strip() for name in next(rows, [])]
    missing = [name for name in _COLUMNS if name not in names]
    if missing:
        raise ValueError(f"{path}: has no column {' and no column '.join(missing)}")
    where = [names.index(name) for name in _COLUMNS]
    table: list[tuple[float, ...]] = []
    for row in rows:
        try:
            table.append(tuple(float(row[k]) for k in where))
        except (ValueError, IndexError):
            raise ValueError(f"{path}: summit {len(table) + 1} has no number as height or radius") from None
    return tuple([row[k] for row in table] for k in range(len(_COLUMNS)))


def listed_table(radii: MeasuredRadii, file: str | None = None) -> dict[str, Any]:
    """The table [summits], read again the same; with a file by its name.

    Radii stand there over that of the surface, which has a last digit of its own.
    """
    lists = {"heights": list(radii.heights.heights), "ratios": list(radii.ratios)}
    return {**(lists if file is None else {"file": file}), "resample": radii.heights.resampled}
