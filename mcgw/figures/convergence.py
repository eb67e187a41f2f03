"""Figure of a convergence test: slopes of the error, z-scores, and the probability of every check."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from mcgw.figures.style import BAND, MONTE_CARLO, SAMPLE, STYLE, THEORY, shown_title
from mcgw.formats.pictures import save_figure
from mcgw.statistics.checks import Slope
from mcgw.statistics.comparison import FALSE_ALARM
from mcgw.statistics.convergence import Convergence

__all__ = ["draw_checks", "save_convergence"]

_TITLES = {"M": "surfaces $M$", "N": "asperities $N$"}


def save_convergence(found: Convergence, path: str | Path) -> None:
    """Draw a convergence test.

    Parameters
    ----------
    found : Convergence
        From `mcgw.statistics.convergence.converge`.
    path : str or Path
        The ending chooses the format: .png, .pdf, .svg.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10, 7), layout="constrained")
        parts: Any = figure.subfigures(2, 1, height_ratios=[1.1, 1])
        top, bottom = parts
        axes = dict(zip("MNz", top.subplots(1, 3), strict=True))
        drawn = {curve.against for curve in found.slopes}
        for curve in found.slopes:
            _draw_slope(axes[curve.against], curve)
        for name in {"M", "N"} - drawn:
            _say(axes[name], f"slope in {name}: too few contacts")
        _draw_scores(axes["z"], found.scores)
        draw_checks(bottom.subplots(), found)
        word = "passed" if found.passed else "FAILED"
        figure.suptitle(
            f"{shown_title(found.scene, 'Scene')}\nStatistical convergence {word}: p = {found.p:.3g} over "
            f"{len(found.checks)} checks (false alarms: 1 in {1 / FALSE_ALARM:.0f})",
            fontsize=10,
        )
        save_figure(figure, path)


def _say(axis: Any, text: str) -> None:
    axis.text(0.5, 0.5, text, ha="center", va="center", transform=axis.transAxes)
    axis.set_axis_off()


def _draw_slope(axis: Any, curve: Slope) -> None:
    fit = np.exp(np.mean(np.log(curve.errors) + np.log(curve.sizes) / 2)) / np.sqrt(curve.sizes)
    axis.loglog(curve.sizes, fit, color=THEORY, label="slope $-1/2$")
    axis.errorbar(
        curve.sizes, curve.errors, 1.96 * curve.stderr * curve.errors, fmt="o", ms=4, mfc="none",
        color=MONTE_CARLO, label="measured, 95 %",
    )  # fmt: skip
    axis.set_xlabel(_TITLES[curve.against])
    axis.set_ylabel("rms error (standard deviations)" if curve.against == "M" else "rms relative error")
    axis.set_title(f"slope {curve.value:.4f} ± {1.96 * curve.uncertainty:.4f}")
    axis.legend(loc="lower left")


def _draw_scores(axis: Any, z: np.ndarray) -> None:
    if not z.size:
        _say(axis, "z-scores: too few contacts")
        return
    edges = np.linspace(-4, 4, 25)
    axis.hist(np.clip(z, -4, 4), edges, density=True, color=SAMPLE, label=f"{z.size} means")
    x = np.linspace(-4, 4, 201)
    axis.plot(x, np.exp(-(x**2) / 2) / np.sqrt(2 * np.pi), color=THEORY, label="standard normal")
    axis.set_ylim(0, 0.58)
    axis.set_xlabel("error of a mean (exact standard errors)")
    axis.set_title("z-scores")
    axis.legend(loc="upper center", ncols=2, handlelength=1.2, columnspacing=1)


def draw_checks(axis: Any, found: Convergence) -> None:
    """The probability of every check."""
    floor = 1e-12
    names = [check.name for check in found.checks]
    p = np.array([max(check.p, floor) for check in found.checks])
    limit = FALSE_ALARM / len(p)
    rows = np.arange(len(p))[::-1]
    axis.axvspan(floor / 10, limit, color=BAND, zorder=0)
    axis.hlines(rows, p, 1, color="0.7", lw=1)
    failed = p <= limit
    for some, color, marker in ((~failed, THEORY, "o"), (failed, MONTE_CARLO, "X")):
        axis.scatter(p[some], rows[some], color=color, marker=marker, s=28, zorder=3)
    axis.set_xscale("log")
    axis.set_xlim(floor / 3, 2.5)
    axis.set_yticks(rows, [f"{c.name}: {c.seen}" for c in found.checks], fontsize=8)
    axis.set_ylim(-0.7, len(names) - 0.3)
    axis.grid(visible=False, axis="y")
    axis.set_xlabel("probability by chance; grey: fails (the far left stands for all below $10^{-12}$)")
