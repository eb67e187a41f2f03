"""Monte-Carlo means on curves of theory; for a sweep all residuals and the worst point."""

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from mcgw.figures.data import SEPARATION, FigureData, Panel, Points, Series
from mcgw.figures.panels import draw, draw_residual
from mcgw.figures.style import (
    PAPER,
    SAMPLE,
    STYLE,
    THEORY,
    contact_label,
    look,
    power_of_ten,
    save_figure,
    shown_title,
)
from mcgw.machine.terminal import one_line
from mcgw.statistics.comparison import Comparison

if TYPE_CHECKING:
    from mcgw.statistics.comparison import SweepComparison

_MOST_COLUMNS = 3  # more are too small to read on a page
_BIN = 0.5  # standard errors
_CAPTION = (
    "Residuals of points with the same surfaces, and of neighbouring separations, are correlated; the "
    "verdict allows for this."
)


def save_comparison(comparison: "Comparison | SweepComparison", path: str | Path) -> None:
    """Draw each quantity with its theory, and below it the residual in standard errors; or those of a sweep.

    Parameters
    ----------
    comparison : Comparison or SweepComparison
        From `mcgw.statistics.comparison.compare`.
    path : str or Path
        The ending chooses the format: .png, .pdf, .svg.
    """
    if isinstance(comparison, Comparison):
        figure = draw(_data(comparison))
    else:
        figure = sweep_figure(comparison)
    with mpl.rc_context(STYLE):
        save_figure(figure, path)


def _data(comparison: Comparison) -> FigureData:
    ensemble, scene, verdict = comparison.ensemble, comparison.ensemble.scene, comparison.verdict
    panels = tuple(quantity_panel(comparison, name) for name in comparison.curves)
    seen = verdict.seen.replace("chi-square", "χ² =").replace(" degrees of freedom", " degrees")  # one line
    return FigureData(
        f"{shown_title(scene, 'Ensemble')}\n"
        f"Monte Carlo and theory {verdict.word}: {seen}, p = {verdict.p:.3g}",
        f"{ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, "
        f"{contact_label(scene)}; sampler {ensemble.sampler}, seed {scene.seed}"
        + (f"; {comparison.of_many}" if comparison.of_many else ""),
        panels,
        columns=2 if len(panels) == 4 else _MOST_COLUMNS,
    )


def quantity_panel(comparison: Comparison, name: str) -> Panel:
    """One quantity with its theory and residuals.

    Parameters
    ----------
    comparison : Comparison
        From `mcgw.statistics.comparison.compare`.
    name : str
        One of its curves.

    Returns
    -------
    Panel
        Over the separations.
    """
    h, curve = comparison.ensemble.separations, comparison.curves[name]
    order = np.argsort(h, kind="stable")
    points = Points(h, curve.mean, curve.stderr, curve.theory, (curve.low, curve.high))
    series = Series("theory", h[order], curve.theory[order], points)
    pulls = bool(np.any(curve.theory < 0) or np.any(curve.mean < 0))  # it does not fit a log axis
    scales, level = (("linear", "linear"), 0.0) if pulls else (("linear", "log"), None)
    return Panel(comparison.ensemble.scene.quantity(name).title, SEPARATION, "", (series,), scales, level)


def sweep_figure(comparison: "SweepComparison") -> Figure:
    """The distribution of all residuals, and those of the worst point along the separations.

    Parameters
    ----------
    comparison : SweepComparison
        From `mcgw.statistics.comparison.compare`.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels beside each other.
    """
    verdict, sweep = comparison.verdict, comparison.sweep
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(8.4, 3.9), layout="constrained")
        left, right = figure.subplots(1, 2)
        draw_residuals(comparison, left)
        _draw_worst(comparison, right)
        figure.suptitle(
            f"{shown_title(sweep.scenes[0], 'Sweep')}: {verdict.points} scenes\n"
            f"Monte Carlo and theory {verdict.word}: p = {verdict.p:.3g} for all points together",
            fontsize=10,
        )
        figure.supxlabel(_CAPTION, fontsize=8, color=PAPER)
    return figure


def draw_residuals(comparison: "SweepComparison", axis: Any) -> None:
    """Draw a histogram of all residuals on its expectation if theory holds."""
    z = comparison.residuals
    most = max(4.0, _BIN * np.ceil(np.abs(z).max(initial=0.0) / _BIN))
    edges = np.arange(-most, most + _BIN / 2, _BIN)
    axis.hist(z, bins=edges, color=SAMPLE, label=f"{len(z)} means")
    x = np.linspace(-most, most, 201)
    expected = len(z) * _BIN * np.exp(-(x**2) / 2) / np.sqrt(2 * np.pi)
    axis.plot(x, expected, color=THEORY, label="normal: expected if theory holds")
    axis.set_yscale("log")  # a single outlier shows beside thousands
    axis.yaxis.set_major_formatter(power_of_ten)
    axis.set_ylim(0.4, 60 * max(expected.max(), 1.0))
    axis.set(xlabel="residual (standard errors)", ylabel="means of all points")
    axis.set_title("all points")
    axis.legend(loc="upper left")


def _draw_worst(comparison: "SweepComparison", axis: Any) -> None:
    """Draw residuals of the least likely point; those that count have a marker."""
    t = comparison.worst[0]
    for name, residual, counts in zip(t.quantities, t.residual, t.counts, strict=True):
        shown = np.where(counts, residual, np.nan)
        axis.plot(t.separations, shown, ms=3, mfc="none", lw=1, label=name, **look(name))
    largest = np.abs(t.residual[t.counts]).max(initial=0.0)
    draw_residual(axis, max(4, 1.5 * largest))
    point = list(comparison.sweep.axes.points())[t.number]
    at = one_line(comparison.sweep.axes.text(point)).replace("$", r"\$")
    axis.set_title(textwrap.fill(f"worst: {at}; p = {t.verdict.p:.2g} of this point alone", 48), fontsize=9)
    axis.set(xlabel="separation d/σ", ylabel="residual (standard errors)")
    axis.legend(loc="upper left", ncols=2, fontsize=8)
