"""What ``.plot()`` of each result draws: one pair of axes."""

from dataclasses import replace
from functools import singledispatch
from typing import Any

import matplotlib as mpl
import numpy as np
from scipy.stats import norm

from analytic import quantity_of
from mcgw.ensemble.ensemble import Ensemble, shown
from mcgw.ensemble.intervals import exact_ends
from mcgw.ensemble.paired import Paired, Slopes
from mcgw.ensemble.solved import Solution
from mcgw.figures.against_theory import quantity_panel, residuals_panel
from mcgw.figures.data import SEPARATION, Mark, Panel
from mcgw.figures.map_fit import heights_panel
from mcgw.figures.panels import draw_panel, keys
from mcgw.figures.studies import checks_panel, errors_panel
from mcgw.figures.style import MONTE_CARLO, SAMPLE, SEEN, STYLE, THEORY, shown_title, step
from mcgw.formats.table import evenly
from mcgw.maps.fit import Fit
from mcgw.maps.profile_fit import ProfileFit
from mcgw.statistics.comparison import Comparison, SweepComparison
from mcgw.statistics.convergence import Convergence
from mcgw.statistics.tradeoff import Tradeoff
from mcgw.sweeps.sweep import Sweep

_MOST_LINES = 7
_SAME = {**SEEN, "label": "same surfaces, 95 %"}


def draw(result: Any, ax: Any = None, **options: Any) -> Any:
    """Draw a result.

    Parameters
    ----------
    result : object
        Of a class that has a function below.
    ax : matplotlib Axes, optional
        Where; default: new axes of pyplot, so that a notebook shows them.
    **options
        Of that function.

    Returns
    -------
    matplotlib.axes.Axes
        With title, labels and a legend.
    """
    panel = panel_of(result, **options)
    with mpl.rc_context(STYLE):
        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.subplots(layout="constrained")[1]
        draw_panel(ax, panel)
        if named := keys([ax], [panel]):
            ax.legend(named.values(), named.keys(), fontsize=8)
    return ax


@singledispatch
def panel_of(result: Any) -> Panel:
    """Return the panel of a result."""
    raise TypeError(f"{type(result).__name__}: there is no figure of it")


@panel_of.register
def _(result: Ensemble, *, quantity: str) -> Panel:
    """Mean and interval; the band holds 90 % of all surfaces; two thirds where no law is known."""
    result = shown(result)
    h, q = result.separations, result.scene.quantity(quantity)
    order, marks = np.argsort(h, kind="stable"), []
    mean, std = result.mean(quantity), result.std(quantity)
    if result.n_surfaces > 1:
        exact = exact_ends(result.scene, quantity, 0.9)
        low, high = (mean - std, mean + std) if exact is None else exact
        low = np.maximum(low, mean / 20)  # an axis of logarithms has no place for 0
        words = "std over surfaces (no quick law)" if exact is None else "90 % of the surfaces"
        ends = h[order], low[order], high[order]
        marks.append(Mark("fill_between", *ends, color=MONTE_CARLO, alpha=0.18, lw=0, label=words))
    low, high = result.interval(quantity)
    arms = np.nan_to_num([np.minimum(mean - low, 0.999 * mean), high - mean])[:, order]
    marks.append(Mark("errorbar", h[order], mean[order], arms, **SEEN, fmt="o-", label="mean, 95 %"))
    scales = ("linear", "log" if np.any(mean > 0) else "linear")
    label, title = f"{quantity.replace('_', ' ')} ({q.unit})", f"{result.n_surfaces} surfaces"
    return Panel(shown_title(result.scene, title), SEPARATION, label, scales=scales, marks=tuple(marks))


@panel_of.register
def _(result: Comparison, *, quantity: str) -> Panel:
    title = f"Monte Carlo and theory {result.verdict.word}: p = {result.verdict.p:.3g} over all means"
    panel = quantity_panel(result, quantity)
    return replace(panel, title=title, ylabel=result.ensemble.scene.quantity(quantity).title)


panel_of.register(SweepComparison, lambda result: residuals_panel("all points", result.residuals))
panel_of.register(Tradeoff, errors_panel)


@panel_of.register
def _(result: Paired) -> Panel:
    order = np.argsort(result.separations, kind="stable")
    columns = tuple(x[order] for x in (result.separations, result.ratio, 1.96 * result.stderr))
    marks = (Mark("errorbar", *columns, **_SAME, fmt="o-"),)
    return Panel("", SEPARATION, f"ratio of the mean {result.quantity}", marks=marks)


@panel_of.register
def _(result: Sweep, *, quantity: str) -> Panel:
    """Return a line a point, from the first to the last along all axes."""
    order, points = np.argsort(result.separations, kind="stable"), list(result.axes.points())
    means, errors = result.mean(quantity), result.stderr(quantity)
    some, marks = evenly(len(points), _MOST_LINES), []
    for place, i in enumerate(some):
        columns = result.separations[order], means[points[i]][order], 1.96 * errors[points[i]][order]
        own = step(result.axes.values_text(points[i]), place, len(some))
        marks.append(Mark("errorbar", *columns, marker="o", ms=3, **own))
    among = f"{len(some)} of {len(points)} points" if len(some) < len(points) else f"{len(points)} points"
    return Panel(
        f"{', '.join(result.axes.keys)}: {among}, 95 %",
        SEPARATION,
        f"mean {quantity.replace('_', ' ')} ({result.scenes[0].quantity(quantity).unit})",
        scales=("linear", "log" if np.any(means > 0) else "linear"),
        marks=tuple(marks),
    )


@panel_of.register
def _(result: Slopes, *, k: int) -> Panel:
    """At one separation, and at the first values of all other keys."""
    value, error, theory = (
        np.moveaxis(x, result.axis, 0)[..., k].reshape(len(result.at), -1)[:, 0]
        for x in (result.value, result.stderr, result.theory)
    )
    marks = (
        Mark("errorbar", result.at, value, 1.96 * error, **_SAME, fmt="o"),
        Mark("plot", result.at, theory, color=THEORY, label="theory"),
    )
    return Panel("", result.key, f"change of the mean {result.quantity.replace('_', ' ')}", marks=marks)


@panel_of.register
def _(result: Solution) -> Panel:
    x = result.surfaces["separation"]
    marks = (
        Mark("hist", x, bins="auto", color=SAMPLE, label=f"{x.size} surfaces"),
        Mark("axvline", result.theory["separation"], color=THEORY, label="theory, infinite surface"),
        Mark("axvline", x.mean(), color=MONTE_CARLO, ls="--", label="mean of the surfaces"),
        Mark("margins", y=0.3),  # room for the legend
    )
    title = f"at {result.given} = {result.amount:.6g} {quantity_of(result.given).unit}"
    return Panel(title, SEPARATION, "surfaces", marks=marks)


@panel_of.register
def _(result: Convergence) -> Panel:
    title = f"Statistical convergence {result.word}: p = {result.p:.3g}"
    return replace(checks_panel(result), title=title, xlabel="probability by chance; grey: fails")


@panel_of.register
def _(result: Fit) -> Panel:
    return replace(
        heights_panel(result), title=f"{result.summits.size} summits, sigma = {result.summits.std():.4g} m"
    )


@panel_of.register
def _(result: ProfileFit) -> Panel:
    m = result.moments
    rms = float(np.sqrt(m.m0))
    z = np.linspace(-4 * rms, m.mean_height + 4 * m.sigma, 401)
    heights, summits = norm.pdf(z, scale=rms), norm.pdf(z, m.mean_height, m.sigma)
    marks = (
        Mark("plot", z, heights, color=SAMPLE, label=f"all heights, Sq = {rms:.4g} m"),
        Mark("plot", z, summits, color=THEORY, label=f"summits, sigma = {m.sigma:.4g} m"),
        Mark("margins", y=0.3),
    )
    title = f"from {len(result.lengths)} profile(s), alpha = {m.alpha:.3g}"
    return Panel(title, "height above the mean plane (m)", "density (1/m)", marks=marks)
