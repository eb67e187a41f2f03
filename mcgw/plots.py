"""Figures: Monte-Carlo means on the curves of the theory. Matplotlib is imported here and nowhere else."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.figure import Figure

from analytic import Exponential, Grading, Homogeneous
from mcgw.compare import Comparison, Curve
from mcgw.formats.pictures import save_figure
from mcgw.intervals import TOO_FEW
from mcgw.scene import Scene
from mcgw.terminal import one_line

__all__ = ["STYLE", "grading_label", "quantity_figure", "save_comparison", "shown_title"]

# One style for all figures: colours of Okabe and Ito, told apart by colour-blind readers and in grey.
STYLE: Any = {
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": cycler(color=["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"]),
    "axes.grid": True,
    "grid.color": "0.9",
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "savefig.dpi": 160,
    "svg.fonttype": "none",
}
_TITLES = {
    "load": "Load $P$ (N)",
    "area": "Real area $A$ (m²)",
    "stiffness": "Stiffness $-dP/dd$ (N/m)",
    "contacts": "Contacts",
    "conductance": r"Conductance $C\rho$ (m)",
}


def shown_title(scene: Scene, otherwise: str) -> str:
    """Title of a scene as one line of plain text: no escape sequences, no mathematics between dollars."""
    return one_line(scene.title).replace("$", r"\$") or otherwise


def grading_label(grading: Grading) -> str:
    """A few words for a caption."""
    match grading:
        case Homogeneous():
            return "homogeneous"
        case Exponential():
            return f"exponential grading, γ = {grading.gamma:g}"
    return f"{type(grading).__name__.lower()} grading"


def save_comparison(comparison: Comparison, path: str | Path) -> None:
    """Draw each quantity with its theory, and below it the residual in standard errors.

    Parameters
    ----------
    comparison : Comparison
        From `mcgw.compare.compare`.
    path : str or Path
        The ending chooses the format: .png, .pdf, .svg.
    """
    ensemble, scene = comparison.ensemble, comparison.ensemble.scene
    columns = len(comparison.curves)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(max(3.1 * columns, 6.2), 5.2), layout="constrained")
        axes = figure.subplots(2, columns, sharex=True, squeeze=False, height_ratios=[3, 1])
        for (name, curve), (above, below) in zip(comparison.curves.items(), axes.T, strict=True):
            _draw_curve(above, ensemble.separations, curve)
            above.set_title(_TITLES[name])
            _draw_residual(below, ensemble.separations, curve)
        axes[1, 0].set_ylabel("residual\n(standard errors)")
        axes[0, 0].legend(loc="lower left")
        verdict = comparison.verdict
        word = "agree" if verdict.agrees else "DISAGREE"
        figure.suptitle(
            f"{shown_title(scene, 'Ensemble')}\nMonte Carlo and theory {word}: "
            f"χ² = {verdict.chi_square:.1f} for {verdict.degrees} degrees of freedom, p = {verdict.p:.3g}",
            fontsize=10,
        )
        caption = (
            f"{ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, "
            f"{grading_label(scene.grading)}; sampler {ensemble.sampler}, seed {scene.seed}"
        )
        figure.supxlabel(f"separation $d/\\sigma$\n{caption}", fontsize=9)
        save_figure(figure, path)


def quantity_figure(comparison: Comparison, name: str) -> Figure:
    """One quantity with its theory and residual, as wide as a phone.

    Parameters
    ----------
    comparison : Comparison
        From `mcgw.compare.compare`.
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
        _draw_curve(above, h, curve)
        _draw_residual(below, h, curve)
        above.set_title(_TITLES[name], loc="left")
        above.legend(loc="lower left")
        below.set(xlabel="separation d/σ", ylabel="residual\n(std. errors)")
    return figure


def _draw_curve(axis: Any, h: np.ndarray, curve: Curve) -> None:
    order = np.argsort(h, kind="stable")
    axis.plot(h[order], curve.theory[order], label="theory", zorder=2)
    seen, known = curve.mean > 0, np.isfinite(curve.low)
    for shown, marker, label in ((seen & known, "o", "Monte Carlo, 95 %"), (seen & ~known, "x", TOO_FEW)):
        mean, low, high = (x[shown] for x in (curve.mean, curve.low, curve.high))
        bars = np.nan_to_num([np.minimum(mean - low, 0.999 * mean), high - mean])
        if shown.any() or marker == "o":
            axis.errorbar(
                h[shown], mean, bars, fmt=marker, ms=3, mfc="none", color="C1", lw=1, label=label, zorder=3
            )
    if np.any(seen) or np.any(curve.theory > 0):
        axis.set_yscale("log")


def _draw_residual(axis: Any, h: np.ndarray, curve: Curve) -> None:
    axis.axhspan(-2, 2, color="0.93", zorder=0)
    axis.axhline(0, color="C0", lw=1)
    axis.plot(h, curve.residual, "o", ms=3, mfc="none", color="C1")
    axis.set_ylim(-max(4, 1.1 * np.abs(curve.residual).max()), max(4, 1.1 * np.abs(curve.residual).max()))
