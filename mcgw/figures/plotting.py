"""What ``.plot()`` of each result draws: one pair of axes."""

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
from mcgw.figures.map_fit import draw_heights
from mcgw.figures.panels import PANELS, SEPARATION, Panel, Series, draw_panel, keys
from mcgw.figures.studies import draw_checks, draw_errors, draw_residuals, quantity_panel
from mcgw.figures.style import MONTE_CARLO, SAMPLE, SEEN, THEORY, shown_title, step
from mcgw.formats.table import evenly
from mcgw.maps.fit import Fit
from mcgw.maps.profile_fit import ProfileFit
from mcgw.statistics.comparison import Comparison, Points, SweepComparison
from mcgw.statistics.convergence import Convergence
from mcgw.statistics.tradeoff import Tradeoff
from mcgw.sweeps.sweep import Sweep

_MOST_LINES = 7


def draw(result: Any, ax: Any = None, **options: Any) -> Any:
    """Draw a result on axes, which are returned; by default new ones of pyplot, which a notebook shows."""
    with mpl.rc_context(PANELS):
        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.subplots(layout="constrained")[1]
        draw_on(result, ax, **options)
        if named := keys([ax]):
            ax.legend(named.values(), named.keys(), fontsize=8)
    return ax


@singledispatch
def draw_on(result: Any, _: Any) -> None:
    """Draw a result, with title and labels."""
    raise TypeError(f"{type(result).__name__}: there is no figure of it")


@draw_on.register
def _(result: Comparison, axis: Any, *, quantity: str | None = None) -> None:
    quantity = quantity or next(iter(result.curves))
    draw_panel(axis, quantity_panel(result, quantity))
    title = f"Monte Carlo and theory {result.verdict.word}: p = {result.verdict.p:.3g} over all means"
    axis.set(title=title, ylabel=result.ensemble.scene.quantity(quantity).title)


@draw_on.register
def _(result: Slopes, axis: Any, *, k: int = 0) -> None:
    """At one separation, and at the first values of all other keys."""
    every = (np.moveaxis(x, result.axis, 0)[..., k] for x in (result.value, result.stderr, result.theory))
    value, error, theory = (x.reshape(len(result.at), -1)[:, 0] for x in every)
    series = Series("theory", result.at, theory, Points(result.at, value, error, theory))
    label = f"change of the mean {result.quantity.replace('_', ' ')}"
    draw_panel(axis, Panel("", result.key, label, (series,)))


@draw_on.register
def _(result: Ensemble, axis: Any, *, quantity: str | None = None) -> None:
    """Mean and interval; the band holds 90 % of all surfaces; two thirds where no law is known."""
    result, quantity = shown(result), quantity or result.quantities[0]
    q, order = result.scene.quantity(quantity), np.argsort(result.separations, kind="stable")
    columns = result.separations, result.mean(quantity), result.std(quantity), *result.interval(quantity)
    h, mean, std, low, high = (x[order] for x in columns)
    logarithmic = bool(np.any(mean > 0) and np.all(mean >= 0))
    lowest = mean / 1000 if logarithmic else -np.inf  # an axis of logarithms has no place for 0
    title, label = f"{result.n_surfaces} surfaces", f"{quantity.replace('_', ' ')} ({q.unit})"
    axis.set(title=shown_title(result.scene, title), xlabel=SEPARATION, ylabel=label)
    axis.set_yscale("log" if logarithmic else "linear")
    if result.n_surfaces > 1:
        ends = exact_ends(result.scene, quantity, 0.9)
        least, most = (mean - std, mean + std) if ends is None else (x[order] for x in ends)
        words = "std over surfaces (no quick law)" if ends is None else "90 % of the surfaces"
        band: Any = {"color": MONTE_CARLO, "alpha": 0.18, "lw": 0, "label": words}
        axis.fill_between(h, np.maximum(least, 50 * lowest), most, **band)
    arms = np.nan_to_num([mean - np.maximum(low, lowest), high - mean])
    axis.errorbar(h, mean, arms, **SEEN, fmt="o-", label="mean, 95 %")


@draw_on.register
def _(result: SweepComparison, axis: Any) -> None:
    axis.set_title("all points")
    draw_residuals(result.residuals, axis)


draw_on.register(Convergence, draw_checks)
draw_on.register(Fit, draw_heights)
draw_on.register(Tradeoff, draw_errors)


@draw_on.register
def _(result: Paired, axis: Any) -> None:
    order = np.argsort(result.separations, kind="stable")
    columns = (x[order] for x in (result.separations, result.ratio, 1.96 * result.stderr))
    axis.errorbar(*columns, **SEEN, fmt="o-", label="same surfaces, 95 %")
    axis.set(xlabel=SEPARATION, ylabel=f"ratio of the mean {result.quantity}")


@draw_on.register
def _(result: Sweep, axis: Any, *, quantity: str | None = None) -> None:
    """Draw a line a point, from the first to the last along all axes."""
    order, size = np.argsort(result.separations, kind="stable"), result.axes.size
    quantity = quantity or result.quantities[0]
    means, errors = (get(quantity).reshape(size, -1)[:, order] for get in (result.mean, result.stderr))
    axis.set_yscale("log" if np.any(means > 0) else "linear")
    some = evenly(size, _MOST_LINES)
    for k, at in enumerate(some):
        own = step(result.axes.values_text(at), k, len(some))
        axis.errorbar(result.separations[order], means[at], 1.96 * errors[at], marker="o", ms=3, **own)
    among = f"{len(some)} of {size} points" if len(some) < size else f"{size} points"
    label = f"mean {quantity.replace('_', ' ')} ({result.scenes[0].quantity(quantity).unit})"
    axis.set(title=f"{', '.join(result.axes.keys)}: {among}, 95 %", xlabel=SEPARATION, ylabel=label)


@draw_on.register
def _(result: Solution, axis: Any) -> None:
    x = result.surfaces["separation"]
    axis.hist(x, bins="auto", color=SAMPLE, label=f"{x.size} surfaces")
    axis.axvline(result.theory["separation"], color=THEORY, label="theory, infinite surface")
    axis.axvline(x.mean(), color=MONTE_CARLO, ls="--", label="mean of the surfaces")
    axis.margins(y=0.3)  # room for the legend
    title = f"at {result.given} = {result.amount:.6g} {quantity_of(result.given).unit}"
    axis.set(title=title, xlabel=SEPARATION, ylabel="surfaces")


@draw_on.register
def _(result: ProfileFit, axis: Any) -> None:
    m, rms = result.moments, float(np.sqrt(result.moments.m0))
    z = np.linspace(-4 * rms, m.mean_height + 4 * m.sigma, 401)
    summits = norm.pdf(z, m.mean_height, m.sigma)
    axis.plot(z, norm.pdf(z, scale=rms), color=SAMPLE, label=f"all heights, Sq = {rms:.4g} m")
    axis.plot(z, summits, color=THEORY, label=f"summits, sigma = {m.sigma:.4g} m")
    axis.margins(y=0.3)
    title = f"from {len(result.lengths)} profile(s), alpha = {m.alpha:.3g}"
    axis.set(title=title, xlabel="height above the mean plane (m)", ylabel="density (1/m)")
