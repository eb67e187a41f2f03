"""Errors of the model against boundary elements: the packaged table and its interpolation."""

import csv
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import numpy as np
from scipy.special import digamma

from analytic.arrays import Array

COLUMNS = ("area", "stiffness", "separation", "load")  # quantities with an error
_OF_GAP = ("separation", "load")
_SURE = 2.1  # standard deviations that hold 95 % of maps left out: light loads have long tails
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

    def farthest(self, name: str, share: Array) -> Array:
        """How far 95 % of surfaces are from the bias, at most, if they scatter by a share of what maps do."""
        off = _SURE * np.hypot(self.scatter[name] * share, self.unsure[name])
        return (
            off if name == "separation" else (1 + self.bias[name]) * np.expm1(off)
        )  # ratios differ by factors


def scatter_law(rows: Mapping[str, Array], name: str) -> Array:
    """Fit the standard deviation between maps as a power of x times one of the loaded spots.

    Eight maps tell a deviation to a quarter; all those of a model tell such a law to a few per cent, and over
    the table it is theirs (`runs/validation/README.md`). Weighted least squares of the logarithms.

    Returns
    -------
    ndarray
        Logarithm of the deviation where x and spots are 1, and both powers.
    """
    std = rows[f"{name}_std"]
    share = std if name == "separation" else std / (1 + rows[name])
    known = np.isfinite(share) & (share > 0) & (rows["maps"] > 0)
    nu = rows["maps"][known] - 1
    # The mean logarithm of a variance of nu degrees of freedom lies below that of its mean.
    told = np.log(share[known]) + (np.log(nu / 2) - digamma(nu / 2)) / 2
    columns = np.column_stack([np.ones_like(nu), *(np.log(rows[key][known]) for key in ("x", "contacts"))])
    weight = np.sqrt(nu)
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
    rows : list of dict of str to ndarray
        Columns of the rows of each, by rising load.
    scatter : dict of str to ndarray
        Laws of that between maps, by column, of separations over their unit, else as of a logarithm; loads
        at a gap scatter as gaps do, times their steepness.
    along_separation : bool
        Whether loads are taken over x.
    """

    x: Array
    rows: list[dict[str, Array]]
    scatter: dict[str, Array]
    along_separation: bool

    @classmethod
    def of(cls, found: Iterable[Mapping[str, str]], *, along_separation: bool) -> "Grid":
        """Make a grid from rows of the table."""
        ordered = sorted(found, key=lambda row: float(row["p"]))
        words = ("map", "model", "interaction")
        table = {
            key: np.array([float(row[key]) for row in ordered]) for key in ordered[0] if key not in words
        }
        x = np.unique(table["x"])
        rows = [{key: column[table["x"] == value] for key, column in table.items()} for value in x]
        scatter = {name: scatter_law(table, name) for name in COLUMNS if name != "load"}
        return cls(x, rows, scatter, along_separation)

    def holds(self, x: float) -> bool:
        """Whether surfaces on both sides of this x were measured."""
        return bool(self.x[0] * (1 - _ROUNDING) <= x <= self.x[-1] * (1 + _ROUNDING))

    def expected(self, x: float, p: Array) -> Expected:
        """Errors of surfaces of one x within the grid at loads p > 0 of the model, shape (loads,)."""
        place = float(np.interp(np.log(x), np.log(self.x), np.arange(len(self.x))))
        k, nearest = int(place), round(place)
        near = {k: k + 1 - place, k + 1: place - k} if abs(place - nearest) > _ROUNDING else {nearest: 1.0}
        units = self.x if self.along_separation else np.ones_like(self.x)
        unit = x if self.along_separation else 1.0
        with np.errstate(divide="ignore"):
            at = np.log(p / unit)
        found = {
            name: np.sum(
                [share * _between(self.rows[k], name, units[k], at) for k, share in near.items()], axis=0
            )
            for name in COLUMNS
        }
        solved = [self.rows[k]["p"][self.rows[k]["maps"] > 0] / units[k] for k in near]
        low, high = max(loads[0] for loads in solved), min(loads[-1] for loads in solved)
        lightest = max(self.rows[k]["p"][np.isfinite(self.rows[k]["area"])][0] / units[k] for k in near)
        maps = min(int(m[m > 0].min()) for m in (self.rows[k]["maps"] for k in near))
        scatter, unsure = {}, {}
        for name, (_, contacts, _, steep, theory) in found.items():
            start, of_x, of_contacts = self.scatter["separation" if name == "load" else name]
            scatter[name] = np.exp(start + of_x * np.log(x) + of_contacts * contacts + steep)
            # Few maps determine a mean, and alpha does not determine a spectrum.
            other = _SPECTRA * np.log(x / self.x[0]) if name in _OF_GAP and not self.along_separation else 0.0
            of_maps = np.hypot(scatter[name] / np.sqrt(maps), other * np.exp(steep))
            unsure[name] = np.hypot(of_maps, theory)
        return Expected(
            {name: values[0] for name, values in found.items()},
            scatter,
            unsure,
            np.exp(found["area"][1]),
            np.exp(found["area"][2]),
            maps,
            (float(unit * low), float(unit * high)) if low <= high else (np.nan, np.nan),
            float(unit * lightest),
        )


def _between(rows: Mapping[str, Array], name: str, unit: float, at: Array) -> Array:
    """Bias, logarithms of contacts, waves and steepness, and what is unsure, shape (5, loads)."""
    bias, off = rows[name], rows[f"{name}_std"]
    # The table's load is the right one; at a given gap the model is known by its own.
    own = rows["p"] * (1 + bias) if name == "load" else rows["p"]
    known = np.isfinite(own)
    if not known.any():
        return np.full((5, *at.shape), np.nan)
    # Change of the logarithm of the load per unit of gap, between maps.
    steep = np.log(off / (1 + bias) / rows["separation_std"]) if name == "load" else np.zeros_like(own)
    unsure = np.where(rows["maps"] > 0, 0.0, off if name == "separation" else off / (1 + bias))
    points = np.log(own[known] / unit)
    nearest = points[np.argmin(np.abs(points - at[:, None]), axis=1)]
    at = np.where(np.abs(nearest - at) <= _ROUNDING, nearest, at)
    numbers = bias, np.log(rows["contacts"]), np.log(rows["waves"]), steep, unsure
    return np.array([np.interp(at, points, y[known], np.nan, np.nan) for y in numbers])
