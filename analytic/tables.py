"""A measured grading: points of E*(s)/E* against height, from a CSV file or a nanoindenter."""

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from analytic.arrays import Array, hold

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator


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

    Examples
    --------
    >>> import numpy as np
    >>> Table([0.0, 1.0, 2.0], [1.0, 1.5, 3.0])(np.array([-1.0, 1.0, 9.0]))
    array([1. , 1.5, 3. ])
    """

    s: tuple[float, ...]
    ratio: tuple[float, ...]
    smooth: bool = True

    def __init__(self, s: Sequence[float], ratio: Sequence[float]) -> None:
        hold(self, s=tuple(map(float, s)), ratio=tuple(map(float, ratio)))
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
    def _interpolant(self) -> "PchipInterpolator":
        from scipy.interpolate import PchipInterpolator  # a third of what the import of all else here takes

        return PchipInterpolator(self.s, self.ratio)

    def __call__(self, s: Array) -> Array:
        """Return the interpolant; outside the data the nearest value."""
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
            If the header is another one, a row is not two numbers, or there is no such regular file.
        """
        if not Path(path).is_file():
            raise ValueError(f"{path}: {'is not a regular' if Path(path).exists() else 'no such'} file")
        try:
            with open(path, newline="", encoding="utf-8-sig") as file:
                return cls.from_lines(file, sigma=sigma, E_star=E_star)
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from None

    @classmethod
    def from_lines(cls, lines: Iterable[str], *, sigma: float, E_star: float) -> "Table":
        """Read the lines of such a file, as `from_csv`.

        Raises
        ------
        ValueError
            Which says what is wrong, and quotes nothing of what stands there.
        """
        try:
            header, *rows = [row for row in csv.reader(lines) if row] or [[]]
        except csv.Error as error:
            raise ValueError(f"is not a table: {error}") from None
        units = {"s": 1.0, "z": sigma, "ratio": 1.0, "E_star": E_star}
        names = [name.strip() for name in header]
        if len(names) != 2 or names[0] not in ("s", "z") or names[1] not in ("ratio", "E_star"):
            raise ValueError("the first line must be s or z, a comma, and ratio or E_star (in m and Pa)")
        try:
            data = np.array([[float(a), float(b)] for a, b in rows]).reshape(-1, 2)
        except ValueError:
            raise ValueError(
                "every line below the header must be two numbers, separated by a comma"
            ) from None
        data = data[np.argsort(data[:, 0], kind="stable")] / [units[names[0]], units[names[1]]]
        return cls(data[:, 0].tolist(), data[:, 1].tolist())
