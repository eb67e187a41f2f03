"""Errors of the model against boundary elements: the packaged table and its interpolation."""

import csv
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import numpy as np
from scipy.special import digamma

from analytic.arrays import Array

COLUMNS = ("area", "stiffness", "separation", "load")  # quantities with an error
_OF_GAP = ("separation", "load")
_ROUNDING = 1e-9  # tolerance at the points of the table
# Standard deviation of the gap over sqrt(m0) between spectra of H = 0.5 to 1 and one alpha, a unit of
# ln(alpha/2): 0.01 to 0.02 at alpha = 3 and 7, 0.04 to 0.06 at 15, whatever the load (fresh maps, README).
_SPECTRA = 0.02


@cache
def rows() -> tuple[dict[str, str], ...]:
    """Columns of the table by name; the head of the file describes them."""
    text = (files("mcgw.validity") / "table.csv").read_text(encoding="utf-8")
    return tuple(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))


@cache
def grid_of(kind: str, model: str, interaction: str) -> "Grid":
    """Table of a model on one kind of maps, "gaussian" or "caps"."""
    named = {"map": kind, "model": model, "interaction": interaction}
    found = [row for row in rows() if all(row[key] == word for key, word in named.items())]
    return Grid.of(found, along_separation=kind == "caps")


@dataclass(frozen=True)
class Expected:
    """Errors at some loads, each array in their shape; nan outside the measured range.

    Parameters
    ----------
    bias, scatter, unsure : dict of str to ndarray
        Mean over maps, standard deviation over them, and standard error of the mean for a surface of another
        spectrum, by column.
    contacts, waves : ndarray
        Loaded spots of a map, and independent heights.
    maps : int
        Fewest maps behind a number.
    loads : (float, float)
        Between which the area was measured here; nan if nowhere.
    lightest : float
        From which load on there is a number of the area, by theory below the first of `loads`.
    """

    bias: dict[str, Array]
    scatter: dict[str, Array]
    unsure: dict[str, Array]
    contacts: Array
    waves: Array
    maps: int
    loads: tuple[float, float]
    lightest: float


@dataclass(frozen=True)
class _Surface:
    """Rows of surfaces of one x: logarithms of loads, and the numbers there, by column."""

    at: dict[str, Array]
    numbers: dict[str, Array]  # bias, logarithms of contacts, waves and steepness, unsure: shape (5, rows)
    maps: int
    solved: tuple[float, float]  # logarithms of loads between which the area was measured

    @classmethod
    def of(cls, found: Iterable[Mapping[str, str]], unit: float) -> "_Surface":
        ordered = sorted(found, key=lambda row: float(row["p"]))
        p, contacts, waves = (_numbers(ordered, key) for key in ("p", "contacts", "waves"))
        maps, at, numbers = _numbers(ordered, "maps"), {}, {}
        for name in COLUMNS:
            bias, off = _numbers(ordered, name), _numbers(ordered, f"{name}_std")
            # The table's load is the right one; at a given gap the model is known by its own.
            own = p * (1 + bias) if name == "load" else p
            known = np.isfinite(own)
            at[name] = np.log(own[known] / unit)
            steep = np.log(_steepness(ordered)) if name == "load" else np.zeros_like(p)
            unsure = np.where(maps > 0, 0.0, off if name == "separation" else off / (1 + bias))
            numbers[name] = np.array([bias, np.log(contacts), np.log(waves), steep, unsure])[:, known]
        solved = np.log(p[maps > 0][[0, -1]] / unit)
        return cls(at, numbers, int(maps[maps > 0].min()), (float(solved[0]), float(solved[1])))

    def __call__(self, name: str, at: Array) -> Array:
        """Bias, logarithms of contacts, waves and steepness, and what is unsure, shape (5, loads)."""
        points = self.at[name]
        if not points.size:
            return np.full((5, *at.shape), np.nan)
        nearest = points[np.argmin(np.abs(points - at[:, None]), axis=1)]
        at = np.where(np.abs(nearest - at) <= _ROUNDING, nearest, at)
        return np.array([np.interp(at, points, y, np.nan, np.nan) for y in self.numbers[name]])


def _numbers(found: Iterable[Mapping[str, str]], key: str) -> Array:
    return np.array([float(row[key]) for row in found])


def _steepness(found: Sequence[Mapping[str, str]]) -> Array:
    """Change of the logarithm of the load per unit of gap, between maps."""
    load, off, gap = (_numbers(found, key) for key in ("load", "load_std", "separation_std"))
    return off / (1 + load) / gap


def scatter_law(found: Iterable[Mapping[str, str]], name: str) -> Array:
    """Fit the standard deviation between maps as a power of x times one of the loaded spots.

    Eight maps tell a deviation to a quarter; all those of a model tell such a law to a few per cent, and over
    the table it is theirs (`runs/validation/README.md`). Weighted least squares of the logarithms.

    Returns
    -------
    ndarray
        Logarithm of the deviation where x and spots are 1, and both powers.
    """
    bias, std, maps = (_numbers(found, key) for key in (name, f"{name}_std", "maps"))
    share = std if name == "separation" else std / (1 + bias)
    known = np.isfinite(share) & (share > 0) & (maps > 0)
    nu = maps[known] - 1
    x, contacts = (np.log(_numbers(found, key)[known]) for key in ("x", "contacts"))
    # The mean logarithm of a variance of nu degrees of freedom lies below that of its mean.
    told = np.log(share[known]) + (np.log(nu / 2) - digamma(nu / 2)) / 2
    columns, weight = np.column_stack([np.ones_like(x), x, contacts]), np.sqrt(nu)
    return np.asarray(np.linalg.lstsq(columns * weight[:, None], told * weight, rcond=None)[0])


@dataclass(frozen=True)
class Grid:
    """Errors of one model on one kind of maps.

    Between rows everything is linear in the logarithms of x and p; of caps in those of x and p/x, which
    goes with the separation alone. Outside nothing is said. Rows without a map are of lighter loads than were
    measured, where theory tells what contact tends to (`runs/validation/limits.py`).

    Parameters
    ----------
    x : ndarray
        Rising: alpha, or eta R sigma of caps.
    surfaces : tuple
        The rows of each.
    scatter : dict of str to ndarray
        Laws of that between maps, by column, of separations over their unit, else as of a logarithm; loads
        at a gap scatter as gaps do, times their steepness.
    along_separation : bool
        Whether loads are taken over x.
    """

    x: Array
    surfaces: tuple[_Surface, ...]
    scatter: dict[str, Array]
    along_separation: bool

    @classmethod
    def of(cls, found: Iterable[Mapping[str, str]], *, along_separation: bool) -> "Grid":
        """Make a grid from rows of the table."""
        by_x, found = defaultdict(list), list(found)
        for row in found:
            by_x[float(row["x"])].append(row)
        x = sorted(by_x)
        surfaces = tuple(_Surface.of(by_x[value], value if along_separation else 1.0) for value in x)
        scatter = {name: scatter_law(found, name) for name in COLUMNS if name != "load"}
        return cls(np.array(x), surfaces, scatter, along_separation)

    def holds(self, x: float) -> bool:
        """Whether surfaces on both sides of this x were measured."""
        return bool(self.x[0] * (1 - _ROUNDING) <= x <= self.x[-1] * (1 + _ROUNDING))

    def expected(self, x: float, p: Array) -> Expected:
        """Errors of surfaces of one x within the grid at loads p > 0 of the model, shape (loads,)."""
        near = self._near(x)
        unit = x if self.along_separation else 1.0
        with np.errstate(divide="ignore"):
            at = np.log(p / unit)
        found = {name: np.sum([share * s(name, at) for share, s in near], axis=0) for name in COLUMNS}
        low, high = max(s.solved[0] for _, s in near), min(s.solved[1] for _, s in near)
        lightest = max(s.at["area"][0] for _, s in near)
        bias = {name: values[0] for name, values in found.items()}
        scatter, unsure = {}, {}
        maps = min(s.maps for _, s in near)
        for name, (_, contacts, _, steep, theory) in found.items():
            start, of_x, of_contacts = self.scatter["separation" if name == "load" else name]
            scatter[name] = np.exp(start + of_x * np.log(x) + of_contacts * contacts + steep)
            # Few maps determine a mean, and alpha does not determine a spectrum.
            other = _SPECTRA * np.log(x / self.x[0]) if name in _OF_GAP and not self.along_separation else 0.0
            of_maps = np.hypot(scatter[name] / np.sqrt(maps), other * np.exp(steep))
            unsure[name] = np.hypot(of_maps, theory)
        return Expected(
            bias,
            scatter,
            unsure,
            np.exp(found["area"][1]),
            np.exp(found["area"][2]),
            maps,
            (float(unit * np.exp(low)), float(unit * np.exp(high))) if low <= high else (np.nan, np.nan),
            float(unit * np.exp(lightest)),
        )

    def _near(self, x: float) -> list[tuple[float, _Surface]]:
        """Neighbouring surfaces and their weights."""
        place = float(np.interp(np.log(x), np.log(self.x), np.arange(len(self.x))))
        nearest = round(place)
        if abs(place - nearest) <= _ROUNDING:
            return [(1.0, self.surfaces[nearest])]
        k = int(place)
        return [(k + 1 - place, self.surfaces[k]), (place - k, self.surfaces[k + 1])]
