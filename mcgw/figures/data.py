"""Numbers of a figure: lines of theory and Monte-Carlo points, to draw, test or export."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.formats.table import Column, Table

Estimate = tuple[Array, Array]  # means and their standard errors
Painter = Callable[[Any], None]

GAMMA, SEPARATION, PRESSURE = "grading factor γ", "separation d/σ", "pressure $P/A_n$ (MPa)"
_ROUNDING = 1e-14  # of a ratio of sums that are the same: no residual is given in units of it
_COLUMNS = ("panel", "series", "kind", "x", "theory", "mean", "stderr")


@dataclass(frozen=True)
class Points:
    """Monte-Carlo means, arrays of one shape.

    Parameters
    ----------
    x, mean, stderr : ndarray
        Place, mean and standard error.
    exact : ndarray
        Values of theory there.
    interval : (ndarray, ndarray), optional
        Ends of 95 % intervals, nan where there are too few contacts for one; default: those of a normal law.
    """

    x: Array
    mean: Array
    stderr: Array
    exact: Array
    interval: tuple[Array, Array] | None = None

    @property
    def residual(self) -> Array:
        """(mean - exact)/stderr."""
        return (self.mean - self.exact) / self.stderr

    @property
    def arms(self) -> tuple[Array, Array]:
        """How far the intervals reach below and above the means."""
        if self.interval is None:
            return 1.96 * self.stderr, 1.96 * self.stderr
        return self.mean - self.interval[0], self.interval[1] - self.mean


@dataclass(frozen=True)
class Series:
    """A line of theory, and points on it if it has a counterpart by Monte Carlo."""

    label: str
    x: Array
    theory: Array
    points: Points | None = None


def words(text: str, x: float = 0.5, y: float = 0.5, **look: Any) -> Painter:
    """Return what writes a text in place of axes."""

    def paint(axis: Any) -> None:
        axis.set_axis_off()
        axis.text(x, y, text, transform=axis.transAxes, **({"ha": "center", "va": "center"} | look))

    return paint


@dataclass(frozen=True)
class Panel:
    """One pair of axes.

    Parameters
    ----------
    title, xlabel, ylabel : str
        Its texts.
    series : tuple of Series, optional
        Lines of theory and points.
    scales : (str, str), optional
        Of x and y.
    level : float, optional
        A value of y worth a line of its own.
    paint : callable, optional
        Draws what else it shows, and sets other properties, on matplotlib's axes.
    wide : bool, optional
        Whether it takes all columns.
    """

    title: str
    xlabel: str
    ylabel: str
    series: tuple[Series, ...] = ()
    scales: tuple[str, str] = ("linear", "linear")
    level: float | None = None
    paint: Painter = lambda _: None
    wide: bool = False


@dataclass(frozen=True)
class FigureData:
    """A figure: its text and panels."""

    title: str
    caption: str
    panels: tuple[Panel, ...]


def ratio_of_sums(above: Sequence[Array], below: Sequence[Array]) -> Estimate:
    """Take a product of means over the same surfaces over another, with its error by the delta method.

    Parameters
    ----------
    above, below : sequence of ndarray
        Sums of each surface, shape (surfaces, ...), of the factors of numerator and denominator.

    Returns
    -------
    (ndarray, ndarray)
        Value and standard error, of shape (...); nan where there is nothing. An error of the last digits
        alone is 0.
    """
    signed = [*((1, x) for x in above), *((-1, x) for x in below)]
    with np.errstate(invalid="ignore", divide="ignore"):
        value = np.prod([x.mean(axis=0) ** float(sign) for sign, x in signed], axis=0)
        influence = np.sum([sign * x / x.mean(axis=0) for sign, x in signed], axis=0)
        relative = influence.std(axis=0, ddof=1) / np.sqrt(len(influence))
    return value, np.abs(value) * np.where(relative <= _ROUNDING, 0.0, relative)


def figure_table(figure: FigureData) -> Table:
    """Every number of a figure."""
    rows: list[tuple[float | str, ...]] = []
    for panel, series in ((one, series) for one in figure.panels for series in one.series):
        about, p = (panel.title, series.label), series.points
        rows += [(*about, "line", *at, "", "") for at in zip(series.x, series.theory, strict=True)]
        if p:
            rows += [(*about, "point", *at) for at in zip(p.x, p.exact, p.mean, p.stderr, strict=True)]
    return Table(tuple(map(Column, _COLUMNS, zip(*rows, strict=True))))
