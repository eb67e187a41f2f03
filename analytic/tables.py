"""A measured grading: points of E*(s)/E* against height, from a CSV file or a nanoindenter."""

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

__all__ = ["Table"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Table:
    """A measured grading: monotone interpolation (PCHIP), clamped outside the data.

    Parameters
    ----------
    s : sequence of float
        Reduced heights z/sigma, increasing.
    ratio : sequence of float
        E*(s)/E* at these heights.

    Raises
    ------
    ValueError
        If there are fewer than two points, if they are not finite, or not increasing in `s`.
    """

    s: tuple[float, ...]
    ratio: tuple[float, ...]
    smooth: bool = True

    def __init__(self, s: Sequence[float], ratio: Sequence[float]) -> None:
        object.__setattr__(self, "s", tuple(map(float, s)))
        object.__setattr__(self, "ratio", tuple(map(float, ratio)))
        if len(self.s) != len(self.ratio) or len(self.s) < 2:
            raise ValueError(
                f"table: give two or more points, as many s as ratio, not {len(self.s)} and {len(self.ratio)}"
            )
        if not np.all(np.isfinite([self.s, self.ratio])):
            raise ValueError("table: every height and modulus must be finite")
        if not np.all(np.diff(self.s) > 0):
            raise ValueError("table: the heights must increase from row to row")

    @property
    def breaks(self) -> tuple[float, ...]:
        """The knots: the interpolant has one continuous derivative there."""
        return self.s

    @cached_property
    def _interpolant(self) -> PchipInterpolator:
        return PchipInterpolator(self.s, self.ratio)

    def __call__(self, s: Array) -> Array:
        """The interpolant; outside the data the nearest value."""
        return np.asarray(self._interpolant(np.clip(s, self.s[0], self.s[-1])), dtype=np.float64)

    @classmethod
    def from_csv(cls, path: str | Path, *, sigma: float, E_star: float) -> "Table":
        """Read a two-column CSV file with a header.

        Parameters
        ----------
        path : str or Path
            Header ``s`` or ``z`` (height, in sigma or in m), then ``ratio`` or ``E_star``
            (E*(s)/E*, or E*(s) in Pa).
        sigma : float
            Makes z reduced, m.
        E_star : float
            Makes E_star relative, Pa.

        Returns
        -------
        Table
            Its points in the order of height.

        Raises
        ------
        ValueError
            If the header is another one or a row is not two numbers.
        """
        with open(path, newline="", encoding="utf-8-sig") as file:
            header, *rows = [row for row in csv.reader(file) if row] or [[]]
        units = {"s": 1.0, "z": sigma, "ratio": 1.0, "E_star": E_star}
        names = [name.strip() for name in header]
        if len(names) != 2 or names[0] not in ("s", "z") or names[1] not in ("ratio", "E_star"):
            raise ValueError(
                f"{path}: the header must be s or z, then ratio or E_star, not {','.join(names)!r}"
            )
        try:
            data = np.array([[float(a), float(b)] for a, b in rows]).reshape(-1, 2)
        except ValueError:
            raise ValueError(f"{path}: every row below the header must be two numbers") from None
        data = data[np.argsort(data[:, 0], kind="stable")] / [units[names[0]], units[names[1]]]
        return cls(data[:, 0].tolist(), data[:, 1].tolist())
