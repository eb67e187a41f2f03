"""Monte-Carlo means on the curves of the theory."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from analytic import quantity_of
from mcgw.ensemble.intervals import TOO_FEW
from mcgw.figures.style import STYLE, contact_label, shown_title
from mcgw.formats.pictures import save_figure
from mcgw.statistics.comparison import Comparison, Curve

__all__ = ["draw_curve", "quantity_figure", "save_comparison", "title_of"]

_MOST_COLUMNS = 6
_BELOW = 0.01  # of the smallest mean that is drawn: how far down its axis goes
_TITLES = {
    "load": "Load $P$ (N)",
    "area": "Real area $A$ (m²)",
    "stiffness": "Stiffness $K$ (N/m)",
    "contacts": "Contacts",
    "conductance": r"Conductance $C\rho$ (m)",
    "load_slope": "Slope of the loads (N/m)",
    "conductance_si": "Conductance (S or W/K)",
    "yielded": "Yielded contacts",
}


def title_of(quantity: str) -> str:
    """A quantity as the title of a panel."""
    q = quantity_of(quantity)
    return f"{_TITLES[q.base]}, unloading" if q.unloading else _TITLES[quantity]


def save_comparison(comparison: Comparison, path: str | Path) -> None:
    """Draw each quantity with its theory, and below it the residual in standard errors.

    Parameters
    ----------
    comparison : Comparison
        From `mcgw.statistics.comparison.compare`.
    path : str or Path
        The ending chooses the format: .png, .pdf, .svg.
    """
    ensemble, scene = comparison.ensemble, comparison.ensemble.scene
    columns = min(len(comparison.curves), _MOST_COLUMNS)
    bands = -(-len(comparison.curves) // columns)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(max(3.1 * columns, 6.2), 4.6 * bands + 0.6), layout="constrained")
        axes = figure.subplots(2 * bands, columns, sharex=True, squeeze=False, height_ratios=[3, 1] * bands)
        for k, (name, curve) in enumerate(comparison.curves.items()):
            above, below = axes[2 * (k // columns) :, k % columns][:2]
            draw_curve(above, ensemble.separations, curve)
            above.set_title(title_of(name))
            _draw_residual(below, ensemble.separations, curve)
        for k in range(len(comparison.curves), bands * columns):
            for axis in axes[2 * (k // columns) :, k % columns][:2]:
                axis.remove()
        for below in axes[1::2, 0]:
            below.set_ylabel("residual\n(standard errors)")
        axes[0, 0].legend(loc="lower left")
        verdict = comparison.verdict
        word = "agree" if verdict.agrees else "DISAGREE"
        figure.suptitle(
            f"{shown_title(scene, 'Ensemble')}\nMonte Carlo and theory of this model {word}: "
            f"χ² = {verdict.chi_square:.1f} for {verdict.degrees} degrees of freedom, p = {verdict.p:.3g}",
            fontsize=10,
        )
        caption = (
            f"{ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, "
            f"{contact_label(scene)}; sampler {ensemble.sampler}, seed {scene.seed}"
        )
        figure.supxlabel(f"separation $d/\\sigma$\n{caption}", fontsize=9)
        save_figure(figure, path)


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
        above.set_title(title_of(name), loc="left")
        above.legend(loc="lower left")
        below.set(xlabel="separation d/σ", ylabel="residual\n(std. errors)")
    return figure


def draw_curve(axis: Any, h: np.ndarray, curve: Curve) -> None:
    """One quantity: its theory as a line, means with intervals on it."""
    order = np.argsort(h, kind="stable")
    axis.plot(h[order], curve.theory[order], label="theory", zorder=2)
    pulls = bool(np.any(curve.theory < 0) or np.any(curve.mean < 0))  # no place for it on a log axis
    seen, known = (curve.mean != 0) if pulls else (curve.mean > 0), np.isfinite(curve.low)
    for shown, marker, label in ((seen & known, "o", "Monte Carlo, 95 %"), (seen & ~known, "x", TOO_FEW)):
        mean, low, high = (x[shown] for x in (curve.mean, curve.low, curve.high))
        bars = np.nan_to_num([mean - low if pulls else np.minimum(mean - low, 0.999 * mean), high - mean])
        if shown.any() or marker == "o":
            axis.errorbar(
                h[shown], mean, bars, fmt=marker, ms=3, mfc="none", color="C1", lw=1, label=label, zorder=3
            )
    if pulls:
        axis.axhline(0, color="0.55", lw=0.8, zorder=1)
    elif np.any(seen) or np.any(curve.theory > 0):
        axis.set_yscale("log")
        if np.any(seen) and np.any(~seen):  # theory goes on falling where nothing touches any more
            axis.set_ylim(bottom=_BELOW * curve.mean[seen].min())


def _draw_residual(axis: Any, h: np.ndarray, curve: Curve) -> None:
    axis.axhspan(-2, 2, color="0.93", zorder=0)
    axis.axhline(0, color="C0", lw=1)
    axis.plot(h, curve.residual, "o", ms=3, mfc="none", color="C1")
    axis.set_ylim(-max(4, 1.1 * np.abs(curve.residual).max()), max(4, 1.1 * np.abs(curve.residual).max()))
