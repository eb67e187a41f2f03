"""What a figure shows, as numbers: lines of theory and Monte-Carlo points, ready to draw, test or export."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mcgw.formats.table import Column, Table

__all__ = [
    "GAMMA",
    "SEPARATION",
    "FigureData",
    "Panel",
    "Points",
    "Series",
    "figure_table",
    "ratio_of_sums",
]

Array = NDArray[np.float64]

GAMMA, SEPARATION = "grading factor γ", "separation d/σ"
_COLUMNS = ("panel", "series", "kind", "x", "theory", "mean", "stderr")


@dataclass(frozen=True)
class Points:
    """Monte-Carlo means, arrays of one shape.

    Parameters
    ----------
    x, mean, stderr : ndarray
        Where, what, and its standard error, from the surfaces alone.
    exact : ndarray
        What theory says there.
    """

    x: Array
    mean: Array
    stderr: Array
    exact: Array

    @property
    def residual(self) -> Array:
        """(mean - exact)/stderr."""
        return (self.mean - self.exact) / self.stderr


@dataclass(frozen=True)
class Series:
    """A line of theory, points on it if it has a counterpart by Monte Carlo, and the side shaded."""

    label: str
    x: Array
    theory: Array
    points: Points | None = None
    shaded: Literal["", "below", "above"] = ""


@dataclass(frozen=True)
class Panel:
    """One pair of axes; `scales` are those of x and y, `level` a value worth a line of its own."""

    title: str
    xlabel: str
    ylabel: str
    series: tuple[Series, ...]
    scales: tuple[str, str] = ("linear", "linear")
    level: float | None = None
    ylim: tuple[float, float] | None = None


@dataclass(frozen=True)
class FigureData:
    """A figure: its file's name, what it says, and its panels."""

    name: str
    title: str
    caption: str
    panels: tuple[Panel, ...]
    columns: int = 2


def ratio_of_sums(b: Array, a: Array) -> tuple[Array, Array]:
    """Ratio of two means over the same surfaces and its standard error, by the delta method.

    Parameters
    ----------
    b, a : ndarray
        Sums of each surface, shape (surfaces, ...).

    Returns
    -------
    (ndarray, ndarray)
        Of shape (...).
    """
    mean = a.mean(axis=0)
    ratio = b.mean(axis=0) / mean
    return ratio, (b - ratio * a).std(axis=0, ddof=1) / np.sqrt(len(a)) / mean


def figure_table(figure: FigureData) -> Table:
    """Every number of a figure."""
    rows: list[tuple[float | str, ...]] = []
    for panel in figure.panels:
        for series in panel.series:
            rows += [
                (panel.title, series.label, "line", x, y, "", "")
                for x, y in zip(series.x, series.theory, strict=True)
            ]
            p = series.points
            if p:
                points = zip(p.x, p.exact, p.mean, p.stderr, strict=True)
                rows += [(panel.title, series.label, "point", *point) for point in points]
    columns = zip(_COLUMNS, zip(*rows, strict=True), strict=True)
    return Table(tuple(Column(name, values) for name, values in columns))
