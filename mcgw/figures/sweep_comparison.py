"""A sweep against theory, for a reader of a thousand points: all residuals, and the point farthest off."""

import textwrap
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from mcgw.figures.style import BAND, LEVEL, PAPER, SAMPLE, STYLE, THEORY, look, power_of_ten, shown_title
from mcgw.machine.terminal import one_line
from mcgw.statistics.sweep_comparison import SweepComparison

__all__ = ["draw_residuals", "sweep_figure"]

_BIN = 0.5  # standard errors
_CAPTION = (
    "Residuals of points that share their surfaces move together, as those of neighbouring separations do; "
    "the verdict allows for both."
)


def sweep_figure(comparison: SweepComparison) -> Figure:
    """The distribution of all residuals, and those of the worst point along the separations.

    Parameters
    ----------
    comparison : SweepComparison
        From `mcgw.statistics.sweep_comparison.compare_sweep`.

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


def draw_residuals(comparison: SweepComparison, axis: Any) -> None:
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


def _draw_worst(comparison: SweepComparison, axis: Any) -> None:
    """Residuals of the point that is the least likely by chance; those that count have a marker."""
    one = comparison.worst[0]
    t = one.tested
    axis.axhspan(-2, 2, color=BAND, zorder=0)
    axis.axhline(0, color=LEVEL, lw=0.8)
    for name, residual, counts in zip(t.quantities, t.residual, t.counts, strict=True):
        shown = np.where(counts, residual, np.nan)
        axis.plot(t.separations, shown, ms=3, mfc="none", lw=1, label=name, **look(name))
    largest = np.abs(t.residual[t.counts]).max(initial=0.0)
    axis.set_ylim(-max(4, 1.5 * largest), max(4, 1.5 * largest))
    point = list(comparison.sweep.axes.points())[one.number]
    at = one_line(comparison.sweep.axes.text(point)).replace("$", r"\$")
    axis.set_title(textwrap.fill(f"worst: {at}; p = {t.verdict.p:.2g} of this point alone", 48), fontsize=9)
    axis.set(xlabel="separation d/σ", ylabel="residual (standard errors)")
    axis.legend(loc="upper left", ncols=2, fontsize=8)
