"""Monte-Carlo means on the curves of the theory; of a sweep all residuals, and the point farthest off."""

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from analytic import quantity_of
from mcgw.ensemble.intervals import TOO_FEW
from mcgw.figures.panels import draw_residual
from mcgw.figures.style import (
    LEVEL,
    PAPER,
    SAMPLE,
    SEEN,
    STYLE,
    THEORY,
    contact_label,
    look,
    power_of_ten,
    shown_title,
)
from mcgw.formats.pictures import save_figure
from mcgw.machine.terminal import one_line
from mcgw.statistics.comparison import Comparison, Curve

if TYPE_CHECKING:
    from mcgw.statistics.comparison import SweepComparison

__all__ = ["draw_curve", "draw_residuals", "quantity_figure", "save_comparison", "sweep_figure"]

_MOST_COLUMNS = 3  # more are too small to read on a page
# Inches: from column to column, the least width, the label at the left, ticks with labels; a band of panels.
_PITCH, _NARROWEST, _LABEL, _TICKS, _EDGE = 3.1, 7.0, 0.3, 0.6, 0.08
_TITLE, _CURVE, _BETWEEN, _RESIDUAL, _UNDER = 0.3, 2.83, 0.21, 0.93, 0.3
_BAND = _TITLE + _CURVE + _BETWEEN + _RESIDUAL + _UNDER
_HEAD, _FOOT = 0.36, 0.36  # two lines each
_BELOW = 0.01  # of the smallest mean that is drawn: how far down its axis goes
_BIN = 0.5  # standard errors
_CAPTION = (
    "Residuals of points that share their surfaces move together, as those of neighbouring separations do; "
    "the verdict allows for both."
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
    if not isinstance(comparison, Comparison):
        figure = sweep_figure(comparison)
        with mpl.rc_context(STYLE):
            save_figure(figure, path)
        return
    ensemble, scene = comparison.ensemble, comparison.ensemble.scene
    with mpl.rc_context(STYLE):
        figure = _with_panels(comparison)
        verdict = comparison.verdict
        word = "agree" if verdict.agrees else "DISAGREE"
        figure.suptitle(
            f"{shown_title(scene, 'Ensemble')}\nMonte Carlo and theory of this model {word}: "
            f"{verdict.seen.replace('chi-square', 'χ² =')}, p = {verdict.p:.3g}",
            fontsize=10,
            y=1 - _EDGE / figure.get_figheight(),
        )
        caption = (
            f"{ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, "
            f"{contact_label(scene)}; sampler {ensemble.sampler}, seed {scene.seed}"
        )
        figure.supxlabel(f"separation d/σ\n{caption}", fontsize=9, y=_EDGE / figure.get_figheight())
        save_figure(figure, path)


def _with_panels(comparison: Comparison) -> Figure:
    """A pair of panels for each quantity, at given places: to look for them takes as long as to draw."""
    h = comparison.ensemble.separations
    columns = 2 if len(comparison.curves) == 4 else min(len(comparison.curves), _MOST_COLUMNS)
    bands = -(-len(comparison.curves) // columns)
    width, height = max(_PITCH * columns, _NARROWEST), _BAND * bands + _HEAD + _FOOT
    pitch = (width - _LABEL) / columns
    figure = Figure(figsize=(width, height))

    def panel(left: float, bottom: float, tall: float, beside: Any = None) -> Any:
        inches = left / width, bottom / height, (pitch - _TICKS - _EDGE) / width, tall / height
        axis = figure.add_axes(inches, sharex=beside)
        axis.ticklabel_format(axis="y", scilimits=(-3, 4))  # for which there is room
        return axis

    first = None
    for k, (name, curve) in enumerate(comparison.curves.items()):
        left = _LABEL + _TICKS + pitch * (k % columns)
        bottom = _FOOT + _BAND * (bands - 1 - k // columns) + _UNDER
        below = panel(left, bottom, _RESIDUAL, first)
        above = panel(left, bottom + _RESIDUAL + _BETWEEN, _CURVE, below)
        first = first or below
        draw_curve(above, h, curve)
        above.set_title(quantity_of(name).title)
        above.tick_params(labelbottom=False)
        _draw_residual(below, h, curve)
        if k % columns == 0:
            below.set_ylabel("residual\n(standard errors)")
        if k == 0:
            above.legend(loc="lower left")
    return figure


def quantity_figure(comparison: Comparison, name: str) -> Figure:
    """One quantity with its theory and residual, as wide as a phone.

    Parameters
    ----------
    comparison : Comparison
        From `mcgw.statistics.comparison.compare`.
    name : str
        One of its curves.

    Returns
    -------
    matplotlib.figure.Figure
        Two panels, one below the other.
    """
    h, curve = comparison.ensemble.separations, comparison.curves[name]
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(4.0, 3.9), layout="constrained")
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=[3, 1])
        draw_curve(above, h, curve)
        _draw_residual(below, h, curve)
        above.set_title(quantity_of(name).title, loc="left")
        above.legend(loc="lower left")
        below.set(xlabel="separation d/σ", ylabel="residual\n(std. errors)")
    return figure


def draw_curve(axis: Any, h: np.ndarray, curve: Curve) -> None:
    """One quantity: its theory as a line, means with intervals on it."""
    order = np.argsort(h, kind="stable")
    axis.plot(h[order], curve.theory[order], color=THEORY, label="theory", zorder=2)
    pulls = bool(np.any(curve.theory < 0) or np.any(curve.mean < 0))  # no place for it on a log axis
    seen, known = (curve.mean != 0) if pulls else (curve.mean > 0), np.isfinite(curve.low)
    for shown, marker, label in ((seen & known, "o", "Monte Carlo, 95 %"), (seen & ~known, "x", TOO_FEW)):
        mean, low, high = (x[shown] for x in (curve.mean, curve.low, curve.high))
        bars = np.nan_to_num([mean - low if pulls else np.minimum(mean - low, 0.999 * mean), high - mean])
        if shown.any() or marker == "o":
            axis.errorbar(h[shown], mean, bars, fmt=marker, **SEEN, lw=1, label=label, zorder=3)
    if pulls:
        axis.axhline(0, color=LEVEL, lw=0.8, zorder=1)
    elif np.any(seen) or np.any(curve.theory > 0):
        axis.set_yscale("log")
        axis.yaxis.set_major_formatter(power_of_ten)
        if np.any(seen) and np.any(~seen):  # theory goes on falling where nothing touches any more
            axis.set_ylim(bottom=_BELOW * curve.mean[seen].min())


def _draw_residual(axis: Any, h: np.ndarray, curve: Curve) -> None:
    axis.plot(h, curve.residual, "o", **SEEN)
    draw_residual(axis, max(4, 1.1 * float(np.abs(curve.residual).max())))


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
    word = "agree" if verdict.agrees else "DISAGREE"
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(8.4, 3.9), layout="constrained")
        left, right = figure.subplots(1, 2)
        draw_residuals(comparison, left)
        _draw_worst(comparison, right)
        figure.suptitle(
            f"{shown_title(sweep.scenes[0], 'Sweep')}: {verdict.points} scenes\n"
            f"Monte Carlo and theory of this model {word}: p = {verdict.p:.3g} for all points together",
            fontsize=10,
        )
        figure.supxlabel(_CAPTION, fontsize=8, color=PAPER)
    return figure


def draw_residuals(comparison: "SweepComparison", axis: Any) -> None:
    """A histogram of all residuals on what it is in the mean, where theory holds."""
    z = comparison.residuals
    most = max(4.0, _BIN * np.ceil(np.abs(z).max(initial=0.0) / _BIN))
    edges = np.arange(-most, most + _BIN / 2, _BIN)
    axis.hist(z, bins=edges, color=SAMPLE, label=f"{len(z)} means")
    x = np.linspace(-most, most, 201)
    expected = len(z) * _BIN * np.exp(-(x**2) / 2) / np.sqrt(2 * np.pi)
    axis.plot(x, expected, color=THEORY, label="normal: expected if theory holds")
    axis.set_yscale("log")  # a single one far off is seen beside thousands
    axis.yaxis.set_major_formatter(power_of_ten)
    axis.set_ylim(0.4, 60 * max(expected.max(), 1.0))
    axis.set(xlabel="residual (standard errors)", ylabel="means of all points")
    axis.set_title("all points")
    axis.legend(loc="upper left")


def _draw_worst(comparison: "SweepComparison", axis: Any) -> None:
    """Residuals of the point that is the least likely by chance; those that count have a marker."""
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
