"""Errors of the model against boundary elements: the packaged table, and what lies between its rows."""

import csv
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

__all__ = ["COLUMNS", "Expected", "Grid", "grid_of", "rows"]

Array = NDArray[np.float64]

COLUMNS = ("area", "stiffness", "separation", "load")  # what has an error
_ROUNDING = 1e-9  # by which a point of the table may be missed


@cache
def rows() -> tuple[dict[str, str], ...]:
    """Lines of the table, by the names of its columns; its head says what they are."""
    text = (files("mcgw.scene") / "validity.csv").read_text(encoding="utf-8")
    return tuple(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))


@cache
def grid_of(kind: str, model: str, interaction: str) -> "Grid | None":
    """What was measured of a model on one kind of maps, "gaussian" or "caps"; None if nothing was."""
    named = {"map": kind, "model": model, "interaction": interaction}
    found = [row for row in rows() if all(row[key] == word for key, word in named.items())]
    return Grid.of(found, along_separation=kind == "caps") if found else None


@dataclass(frozen=True)
class Expected:
    """Errors at some loads, each array in their shape; nan outside of what was measured.

    Parameters
    ----------
    bias, scatter : dict of str to ndarray
        Mean over maps and standard deviation over them, by column.
    contacts : ndarray
        Loaded spots of a map.
    maps : int
        Fewest maps behind a number.
    loads : (float, float)
        Between which the area was measured here; nan if nowhere.
    """

    bias: dict[str, Array]
    scatter: dict[str, Array]
    contacts: Array
    maps: int
    loads: tuple[float, float]


@dataclass(frozen=True)
class _Surface:
    """Rows of surfaces of one x: logarithms of loads, and the numbers there, by column."""

    at: dict[str, Array]
    numbers: dict[str, Array]  # bias, scatter, logarithm of contacts: shape (3, rows)
    maps: int

    @classmethod
    def of(cls, found: Iterable[Mapping[str, str]], unit: float) -> "_Surface":
        ordered = sorted(found, key=lambda row: float(row["p"]))
        p, contacts = (np.array([float(row[key]) for row in ordered]) for key in ("p", "contacts"))
        at, numbers = {}, {}
        for name in COLUMNS:
            bias, scatter = (np.array([float(row[key]) for row in ordered]) for key in (name, f"{name}_std"))
            # The table's load is the right one; at a given gap the model is known by its own.
            own = p * (1 + bias) if name == "load" else p
            known = np.isfinite(own)
            at[name] = np.log(own[known] / unit)
            numbers[name] = np.array([bias, scatter, np.log(contacts)])[:, known]
        return cls(at, numbers, min(int(row["maps"]) for row in ordered))

    def __call__(self, name: str, at: Array) -> Array:
        """Bias, scatter and log contacts, shape (3, loads)."""
        points = self.at[name]
        if not points.size:
            return np.full((3, *at.shape), np.nan)
        nearest = points[np.argmin(np.abs(points - at[:, None]), axis=1)]
        at = np.where(np.abs(nearest - at) <= _ROUNDING, nearest, at)
        return np.array([np.interp(at, points, y, np.nan, np.nan) for y in self.numbers[name]])


@dataclass(frozen=True)
class Grid:
    """What was measured of one model on one kind of maps.

    Between rows everything is linear in the logarithms of x and p; of caps in those of x and p/x, which
    goes with the separation alone. Outside nothing is said.

    Parameters
    ----------
    x : ndarray
        Rising: alpha, or eta R sigma of caps.
    surfaces : tuple
        The rows of each.
    along_separation : bool
        Whether loads are taken over x.
    """

    x: Array
    surfaces: tuple[_Surface, ...]
    along_separation: bool

    @classmethod
    def of(cls, found: Iterable[Mapping[str, str]], *, along_separation: bool) -> "Grid":
        """A grid of rows of the table."""
        by_x = defaultdict(list)
        for row in found:
            by_x[float(row["x"])].append(row)
        x = sorted(by_x)
        surfaces = tuple(_Surface.of(by_x[value], value if along_separation else 1.0) for value in x)
        return cls(np.array(x), surfaces, along_separation)

    def holds(self, x: float) -> bool:
        """Whether surfaces on both sides of it were measured."""
        return bool(self.x[0] * (1 - _ROUNDING) <= x <= self.x[-1] * (1 + _ROUNDING))

    def expected(self, x: float, p: Array) -> Expected:
        """Errors of surfaces of one x within the grid at loads p > 0 of the model, shape (loads,)."""
        near = self._near(x)
        unit = x if self.along_separation else 1.0
        with np.errstate(divide="ignore"):
            at = np.log(p / unit)
        found = {name: np.sum([share * s(name, at) for share, s in near], axis=0) for name in COLUMNS}
        ends = [s.at["area"][[0, -1]] for _, s in near if s.at["area"].size]
        low, high = (max(e[0] for e in ends), min(e[1] for e in ends)) if len(ends) == len(near) else (1, 0)
        return Expected(
            {name: values[0] for name, values in found.items()},
            {name: values[1] for name, values in found.items()},
            np.exp(found["area"][2]),
            min(s.maps for _, s in near),
            (float(unit * np.exp(low)), float(unit * np.exp(high))) if low <= high else (np.nan, np.nan),
        )

    def _near(self, x: float) -> list[tuple[float, _Surface]]:
        """The surfaces beside it, and how much each counts."""
        place = float(np.interp(np.log(x), np.log(self.x), np.arange(len(self.x))))
        nearest = round(place)
        if abs(place - nearest) <= _ROUNDING:
            return [(1.0, self.surfaces[nearest])]
        k = int(place)
        return [(k + 1 - place, self.surfaces[k]), (place - k, self.surfaces[k + 1])]
