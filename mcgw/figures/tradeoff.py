"""Figure of a work-precision study: error against time, one panel a separation."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from mcgw.figures.style import STYLE, shown_title
from mcgw.formats.pictures import save_figure
from mcgw.statistics.tradeoff import Tradeoff

__all__ = ["draw_methods", "save_tradeoff"]

_FLOOR = 1e-16


def save_tradeoff(found: Tradeoff, path: str | Path) -> None:
    """Draw a work-precision study.

    Parameters
    ----------
    found : Tradeoff
        From `mcgw.statistics.tradeoff.tradeoff`.
    path : str or Path
        The ending chooses the format: .png, .pdf, .svg.
    """
    with mpl.rc_context(STYLE):
        columns = len(found.separations)
        figure = Figure(figsize=(3.6 * columns + 1, 5.6), layout="constrained")
        axes: Any = figure.subplots(1, columns, sharex=True, sharey=True, squeeze=False)[0]
        for k, (axis, h) in enumerate(zip(axes, found.separations, strict=True)):
            draw_methods(axis, found, k)
            axis.set_title(f"$d/\\sigma$ = {h:g}")
            axis.set_xlabel("CPU time (s)")
        axes[0].set_ylabel(f"rms relative error of the mean {found.scene.quantities[0]}")
        figure.suptitle(shown_title(found.scene, "Work and precision"), fontsize=10)
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=8)
        save_figure(figure, path)


def draw_methods(axis: Any, found: Tradeoff, k: int) -> None:
    """Error against time of every method at one of the separations."""
    for i, method in enumerate(found.methods):
        points = found.of(method.name)
        time = np.array([p.cpu for p in points])
        error = np.maximum([p.rms[k] for p in points], _FLOOR)
        law = {-0.5: ", size$^{-1/2}$", -1.5: ", size$^{-3/2}$"}.get(method.slope or 0.0, "")
        axis.errorbar(
            time, error, error * np.array([p.rms_stderr for p in points]), color=f"C{i % 6}",
            marker="os^"[i // 6 % 3], ms=4, mfc="none", lw=1, ls="-" if i < 6 else "--",
            label=f"{method.name}{law}",
        )  # fmt: skip
    low, high = 1e-2, 1e1
    for slope, start in ((-0.5, 3e-3), (-1.5, 1e-5)):
        axis.plot([low, high], [start, start * (high / low) ** slope], ":", color="0.5", lw=1)
        end = (high, start * (high / low) ** slope)
        axis.annotate(f"slope {slope:g}", end, fontsize=7, color="0.4", ha="right", va="bottom")
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_ylim(_FLOOR / 3, 10)
