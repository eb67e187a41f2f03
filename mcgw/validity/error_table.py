"""Errors of the model against boundary elements: the packaged table and its interpolation."""

from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np
from scipy.special import digamma

from analytic.arrays import Array

COLUMNS = ("area", "stiffness", "separation", "load")  # quantities with an error
_MODEL = ("map", "model", "interaction")  # columns of words
_SURE = 2.1  # standard deviations that hold 95 % of maps left out: light loads have long tails
_DIGITS, _ROUNDING = 12, 1e-9  # of places in the table, which are its points if they are as close
# Standard deviation of the gap over sqrt(m0) between spectra of H = 0.5 to 1 and one alpha, a unit of
# ln(alpha/2): 0.01 to 0.02 at alpha = 3 and 7, 0.04 to 0.06 at 15, whatever the load (fresh maps, README).
_SPECTRA = {"separation": 0.02, "load": 0.02}


@cache
def packaged() -> Any:
    """Rows of the packaged table; the head of the file describes them."""
    return read((files("mcgw.validity") / "table.csv").read_text(encoding="utf-8").splitlines())


def read(lines: Iterable[str]) -> Any:
    """Return the rows of a table, an array with named columns; # begins a comment."""
    head, *rows = (line for line in lines if not line.startswith("#"))
    kinds = [(name, "U16" if name in _MODEL else "f8") for name in head.split(",")]
    return np.loadtxt(rows, kinds, delimiter=",", ndmin=1)


@cache
def grid_of(kind: str, model: str, interaction: str) -> "Grid":
    """Table of a model on one kind of maps, "gaussian" or "caps"."""
    rows = packaged()
    here = (rows["map"] == kind) & (rows["model"] == model) & (rows["interaction"] == interaction)
    return Grid(rows[here], along_separation=kind == "caps")


class Expected(NamedTuple):
    """Errors at some loads; nan outside the measured range."""

    bias: dict[str, Array]  # mean over maps
    off: dict[str, Array]  # how far 95 % of surfaces are from it
    maps: int  # the fewest behind a number
    loads: tuple[float, float]  # between which the area was measured here; nan if nowhere
    lightest: float  # from which on there is a number of it, by theory below those


class Grid:
    """Errors of one model on one kind of maps; x of its rows is alpha, or eta R sigma of caps.

    Between rows everything is linear in the logarithms of x and p; of caps `along_separation`, in those of x
    and p/x, which goes with the separation alone. Outside nothing is said. Rows without a map are of lighter
    loads than were measured, where theory tells what contact tends to (`runs/validation/limits.py`).
    """

    def __init__(self, table: Any, *, along_separation: bool) -> None:
        table = table[np.argsort(table["p"], kind="stable")]
        self.x, self.along_separation = np.unique(table["x"]), along_separation
        self.rows = [table[table["x"] == x] for x in self.x]
        # Loads at a gap scatter as gaps do, times their steepness.
        self.scatter = {name: _scatter_law(table, name) for name in COLUMNS if name != "load"}

    def holds(self, x: float) -> bool:
        """Whether surfaces on both sides of this x were measured."""
        return bool(self.x[0] * (1 - _ROUNDING) <= x <= self.x[-1] * (1 + _ROUNDING))

    def expected(self, x: float, p: Array, contacts: Array | None = None, waves: float = np.nan) -> Expected:
        """Errors of surfaces of one x within the grid at loads p > 0 of the model, shape (loads,).

        A surface has so many contacts at each load, and so many independent heights: by default as many as
        the maps. A gap, and what follows from it, is as sure as the long waves are many, however many
        contacts lie on them.
        """
        place = round(float(np.interp(np.log(x), np.log(self.x), np.arange(len(self.x)))), _DIGITS)
        near = {k: 1 - abs(k - place) for k in range(len(self.x)) if abs(k - place) < 1}
        rows = [self.rows[k].copy() for k in near]
        for each, k in zip(rows, near, strict=True):
            each["p"] *= x / self.x[k] if self.along_separation else 1.0
        found = {
            name: np.tensordot([*near.values()], [_between(each, name, p) for each in rows], 1)
            for name in COLUMNS
        }
        solved = [each[each["maps"] > 0] for each in rows]
        low, high = max(each["p"][0] for each in solved), min(each["p"][-1] for each in solved)
        lightest = max(each["p"][np.isfinite(each["area"])][0] for each in rows)
        with np.errstate(divide="ignore", invalid="ignore"):
            spots = np.ones_like(p) if contacts is None else np.sqrt(np.exp(found["area"][1]) / contacts)
        maps, longest = np.concatenate(solved)["maps"].min(), np.sqrt(np.exp(found["area"][2]) / waves)
        off = {}
        for name, (bias, of_spots, _, steep, theory) in found.items():
            start, of_x, of_contacts = self.scatter["separation" if name == "load" else name]
            scatter = np.exp(start + of_x * np.log(x) + of_contacts * of_spots + steep)
            # Few maps determine a mean, and alpha does not determine a spectrum.
            other = 0.0 if self.along_separation else _SPECTRA.get(name, 0.0) * np.log(x / self.x[0])
            unsure = np.hypot(np.hypot(scatter / np.sqrt(maps), other * np.exp(steep)), theory)
            far = _SURE * np.hypot(scatter * (spots if name == "area" else np.fmax(spots, longest)), unsure)
            # ratios differ by factors
            off[name] = far if name == "separation" else (1 + bias) * np.expm1(far)
        loads = (low, high) if low <= high else (np.nan, np.nan)
        return Expected({name: values[0] for name, values in found.items()}, off, int(maps), loads, lightest)


def _scatter_law(rows: Any, name: str) -> Array:
    """Fit the standard deviation between maps as a power of x times one of the loaded spots.

    Eight maps tell a deviation to a quarter; all those of a model tell such a law to a few per cent, and over
    the table it is theirs (`runs/validation/README.md`). Weighted least squares of the logarithms give that
    of the deviation where x and spots are 1, and both powers.
    """
    share = _share(rows, name)
    known = np.isfinite(share) & (share > 0) & (rows["maps"] > 0)
    nu = rows["maps"][known] - 1
    # The mean logarithm of a variance of nu degrees of freedom lies below that of its mean.
    told = np.log(share[known]) + (np.log(nu / 2) - digamma(nu / 2)) / 2
    columns = np.column_stack([np.ones_like(nu), *(np.log(rows[key][known]) for key in ("x", "contacts"))])
    weight = np.sqrt(nu)
    return np.asarray(np.linalg.lstsq(columns * weight[:, None], told * weight, rcond=None)[0])


def _share(rows: Any, name: str) -> Array:
    """Return the standard deviation between maps: of a separation over its unit, else relative."""
    std = rows[f"{name}_std"]
    return np.asarray(std if name == "separation" else std / (1 + rows[name]))


def _between(rows: Any, name: str, p: Array) -> Array:
    """Bias, logarithms of contacts, waves and steepness, and what is unsure, shape (5, loads)."""
    rows = rows[np.isfinite(rows[name])]
    if not rows.size:
        return np.full((5, *p.shape), np.nan)
    # The table's load is the right one; at a given gap the model is known by its own.
    points = np.log(rows["p"] * (1 + rows["load"] if name == "load" else 1))
    off = _share(rows, name)
    # Change of the logarithm of the load per unit of gap, between maps.
    steep = np.log(off / rows["separation_std"]) if name == "load" else np.zeros_like(off)
    unsure = np.where(rows["maps"] > 0, 0.0, off)
    numbers = rows[name], np.log(rows["contacts"]), np.log(rows["waves"]), steep, unsure
    with np.errstate(divide="ignore"):
        at = np.log(p)
    found = np.array([np.interp(at, points, y) for y in numbers])
    inside = (at >= points[0] - _ROUNDING) & (at <= points[-1] + _ROUNDING)
    return np.where(inside, found, np.nan)
