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
from mcgw.figures.map_fit import heights_panel
from mcgw.figures.panels import SEPARATION, Panel, Series, draw_panel, keys
from mcgw.figures.studies import checks_panel, errors_panel, quantity_panel, residuals_panel
from mcgw.figures.style import MONTE_CARLO, SAMPLE, SEEN, STYLE, THEORY, shown_title, step
from mcgw.formats.table import evenly
from mcgw.maps.fit import Fit
from mcgw.maps.profile_fit import ProfileFit
from mcgw.statistics.comparison import Comparison, Points, SweepComparison
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
def _(result: Ensemble, *, quantity: str | None = None) -> Panel:
    """Mean and interval; the band holds 90 % of all surfaces; two thirds where no law is known."""
    result, quantity = shown(result), quantity or result.quantities[0]
    q, order = result.scene.quantity(quantity), np.argsort(result.separations, kind="stable")
    h, mean, std = (x[order] for x in (result.separations, result.mean(quantity), result.std(quantity)))
    low, high = (x[order] for x in result.interval(quantity))
    arms = np.nan_to_num([np.minimum(mean - low, 0.999 * mean), high - mean])
    ends = exact_ends(result.scene, quantity, 0.9) if result.n_surfaces > 1 else None

    def paint(axis: Any) -> None:
        if result.n_surfaces > 1:
            least, most = (mean - std, mean + std) if ends is None else (x[order] for x in ends)
            least = np.maximum(least, mean / 20)  # an axis of logarithms has no place for 0
            words = "std over surfaces (no quick law)" if ends is None else "90 % of the surfaces"
            axis.fill_between(h, least, most, color=MONTE_CARLO, alpha=0.18, lw=0, label=words)
        axis.errorbar(h, mean, arms, **SEEN, fmt="o-", label="mean, 95 %")

    scales = ("linear", "log" if np.any(mean > 0) else "linear")
    label, title = f"{quantity.replace('_', ' ')} ({q.unit})", f"{result.n_surfaces} surfaces"
    return Panel(shown_title(result.scene, title), SEPARATION, label, scales=scales, paint=paint)


@panel_of.register
def _(result: Comparison, *, quantity: str | None = None) -> Panel:
    quantity = quantity or next(iter(result.curves))
    title = f"Monte Carlo and theory {result.verdict.word}: p = {result.verdict.p:.3g} over all means"
    panel = quantity_panel(result, quantity)
    return replace(panel, title=title, ylabel=result.ensemble.scene.quantity(quantity).title)


panel_of.register(SweepComparison, lambda result: residuals_panel("all points", result.residuals))
panel_of.register(Tradeoff, errors_panel)
panel_of.register(Convergence, lambda result: replace(
    checks_panel(result), title=f"Statistical convergence {result.word}: p = {result.p:.3g}",
    xlabel="probability by chance; grey: fails",
))  # fmt: skip
panel_of.register(Fit, lambda result: replace(
    heights_panel(result), title=f"{result.summits.size} summits, sigma = {result.summits.std():.4g} m",
))  # fmt: skip


@panel_of.register
def _(result: Paired) -> Panel:
    order = np.argsort(result.separations, kind="stable")
    columns = [x[order] for x in (result.separations, result.ratio, 1.96 * result.stderr)]
    label = f"ratio of the mean {result.quantity}"
    return Panel("", SEPARATION, label, paint=lambda axis: axis.errorbar(*columns, **_SAME, fmt="o-"))


@panel_of.register
def _(result: Sweep, *, quantity: str | None = None) -> Panel:
    """Return a line a point, from the first to the last along all axes."""
    order, size = np.argsort(result.separations, kind="stable"), result.axes.size
    quantity = quantity or result.quantities[0]
    means, errors = (get(quantity).reshape(size, -1) for get in (result.mean, result.stderr))
    h, some = result.separations[order], evenly(size, _MOST_LINES)

    def paint(axis: Any) -> None:
        for k, at in enumerate(some):
            own = step(result.axes.values_text(at), k, len(some))
            axis.errorbar(h, means[at][order], 1.96 * errors[at][order], marker="o", ms=3, **own)

    among = f"{len(some)} of {size} points" if len(some) < size else f"{size} points"
    label = f"mean {quantity.replace('_', ' ')} ({result.scenes[0].quantity(quantity).unit})"
    scales = ("linear", "log" if np.any(means > 0) else "linear")
    return Panel(
        f"{', '.join(result.axes.keys)}: {among}, 95 %", SEPARATION, label, scales=scales, paint=paint
    )


@panel_of.register
def _(result: Slopes, *, k: int = 0) -> Panel:
    """At one separation, and at the first values of all other keys."""
    value, error, theory = (
        np.moveaxis(x, result.axis, 0)[..., k].reshape(len(result.at), -1)[:, 0]
        for x in (result.value, result.stderr, result.theory)
    )

    series = Series("theory", result.at, theory, Points(result.at, value, error, theory))
    return Panel("", result.key, f"change of the mean {result.quantity.replace('_', ' ')}", (series,))


@panel_of.register
def _(result: Solution) -> Panel:
    x = result.surfaces["separation"]

    def paint(axis: Any) -> None:
        axis.hist(x, bins="auto", color=SAMPLE, label=f"{x.size} surfaces")
        axis.axvline(result.theory["separation"], color=THEORY, label="theory, infinite surface")
        axis.axvline(x.mean(), color=MONTE_CARLO, ls="--", label="mean of the surfaces")
        axis.margins(y=0.3)  # room for the legend

    title = f"at {result.given} = {result.amount:.6g} {quantity_of(result.given).unit}"
    return Panel(title, SEPARATION, "surfaces", paint=paint)


@panel_of.register
def _(result: ProfileFit) -> Panel:
    m = result.moments
    rms = float(np.sqrt(m.m0))
    z = np.linspace(-4 * rms, m.mean_height + 4 * m.sigma, 401)

    def paint(axis: Any) -> None:
        axis.plot(z, norm.pdf(z, scale=rms), color=SAMPLE, label=f"all heights, Sq = {rms:.4g} m")
        summits = norm.pdf(z, m.mean_height, m.sigma)
        axis.plot(z, summits, color=THEORY, label=f"summits, sigma = {m.sigma:.4g} m")
        axis.margins(y=0.3)

    title = f"from {len(result.lengths)} profile(s), alpha = {m.alpha:.3g}"
    return Panel(title, "height above the mean plane (m)", "density (1/m)", paint=paint)
