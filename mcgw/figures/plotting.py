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
from mcgw.ensemble.paired import Paired
from mcgw.ensemble.solved import Solution
from mcgw.figures.against_theory import draw_residuals, quantity_panel
from mcgw.figures.panels import draw_panel, keys
from mcgw.figures.studies import draw_checks, draw_errors
from mcgw.figures.style import MONTE_CARLO, SAMPLE, SEEN, STYLE, THEORY, shown_title, step
from mcgw.formats.table import evenly
from mcgw.maps.fit import Fit
from mcgw.maps.profile_fit import ProfileFit
from mcgw.statistics.comparison import Comparison, SweepComparison
from mcgw.statistics.convergence import Convergence
from mcgw.statistics.tradeoff import Tradeoff
from mcgw.sweeps.between import Slopes
from mcgw.sweeps.sweep import Sweep

_SEPARATION = "separation $d/\\sigma$"
_MOST_LINES = 7


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
        With title and labels.
    """
    with mpl.rc_context(STYLE):
        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.subplots(layout="constrained")[1]
        _draw(result, ax, **options)
    return ax


@singledispatch
def _draw(result: Any, _: Any) -> None:
    raise TypeError(f"{type(result).__name__}: there is no figure of it")


@_draw.register
def _(result: Ensemble, ax: Any, *, quantity: str) -> None:
    """Mean and interval; the band holds 90 % of all surfaces; two thirds where no law is known."""
    result = shown(result)
    h, q = result.separations, result.scene.quantity(quantity)
    order = np.argsort(h, kind="stable")
    mean, std = result.mean(quantity), result.std(quantity)
    if result.n_surfaces > 1:
        exact = exact_ends(result.scene, quantity, 0.9)
        low, high = (mean - std, mean + std) if exact is None else exact
        low = np.maximum(low, mean / 20)  # an axis of logarithms has no place for 0
        words = "std over surfaces (no quick law)" if exact is None else "90 % of the surfaces"
        ax.fill_between(h[order], low[order], high[order], color=MONTE_CARLO, alpha=0.18, lw=0, label=words)
    low, high = result.interval(quantity)
    bars = np.nan_to_num([np.minimum(mean - low, 0.999 * mean), high - mean])[:, order]
    ax.errorbar(h[order], mean[order], bars, fmt="o-", **SEEN, label="mean, 95 %")
    if np.any(mean > 0):
        ax.set_yscale("log")
    ax.set(xlabel=_SEPARATION, ylabel=f"{quantity.replace('_', ' ')} ({q.unit})")
    ax.set_title(shown_title(result.scene, f"{result.n_surfaces} surfaces"))
    ax.legend()


@_draw.register
def _(result: Comparison, ax: Any, *, quantity: str) -> None:
    title = f"Monte Carlo and theory {result.verdict.word}: p = {result.verdict.p:.3g} over all means"
    panel = replace(quantity_panel(result, quantity), title=title)
    draw_panel(ax, panel)
    named = keys([ax], [panel])
    ax.legend(named.values(), named.keys())
    ax.set(ylabel=result.ensemble.scene.quantity(quantity).title)


@_draw.register
def _(result: Paired, ax: Any) -> None:
    order = np.argsort(result.separations, kind="stable")
    columns = (x[order] for x in (result.separations, result.ratio, 1.96 * result.stderr))
    ax.errorbar(*columns, fmt="o-", **SEEN, label="same surfaces, 95 %")
    ax.set(xlabel=_SEPARATION, ylabel=f"ratio of the mean {result.quantity}")
    ax.legend()


@_draw.register
def _(result: Sweep, ax: Any, *, quantity: str) -> None:
    """A line a point, from the first to the last along all axes."""
    order, points = np.argsort(result.separations, kind="stable"), list(result.axes.points())
    means, errors = result.mean(quantity), result.stderr(quantity)
    shown = evenly(len(points), _MOST_LINES)
    for place, i in enumerate(shown):
        columns = result.separations[order], means[points[i]][order], 1.96 * errors[points[i]][order]
        ax.errorbar(*columns, marker="o", ms=3, **step(result.axes.values_text(points[i]), place, len(shown)))
    if np.any(means > 0):
        ax.set_yscale("log")
    unit = result.scenes[0].quantity(quantity).unit
    ax.set(xlabel=_SEPARATION, ylabel=f"mean {quantity.replace('_', ' ')} ({unit})")
    among = f"{len(shown)} of {len(points)} points" if len(shown) < len(points) else f"{len(points)} points"
    ax.set_title(f"{', '.join(result.axes.keys)}: {among}, 95 %")
    ax.legend(fontsize=7)


@_draw.register
def _(result: Slopes, ax: Any, *, k: int) -> None:
    """At one separation, and at the first values of all other keys."""
    value, error, theory = (
        np.moveaxis(x, result.axis, 0)[..., k].reshape(len(result.at), -1)[:, 0]
        for x in (result.value, result.stderr, result.theory)
    )
    ax.errorbar(result.at, value, 1.96 * error, fmt="o", **SEEN, label="same surfaces, 95 %")
    ax.plot(result.at, theory, color=THEORY, label="theory")
    ax.set(xlabel=result.key, ylabel=f"change of the mean {result.quantity.replace('_', ' ')}")
    ax.legend()


@_draw.register
def _(result: Solution, ax: Any) -> None:
    x = result.surfaces["separation"]
    ax.hist(x, bins="auto", color=SAMPLE, label=f"{x.size} surfaces")
    ax.margins(y=0.3)  # room for the legend
    ax.axvline(result.theory["separation"], color=THEORY, label="theory, infinite surface")
    ax.axvline(x.mean(), color=MONTE_CARLO, ls="--", label="mean of the surfaces")
    unit = quantity_of(result.given).unit
    ax.set(xlabel=_SEPARATION, ylabel="surfaces", title=f"at {result.given} = {result.amount:.6g} {unit}")
    ax.legend()


@_draw.register
def _(result: Convergence, ax: Any) -> None:
    draw_checks(ax, result)
    ax.set_xlabel("probability by chance; grey: fails")
    ax.set_title(f"Statistical convergence {result.word}: p = {result.p:.3g}")


@_draw.register
def _(result: Tradeoff, ax: Any, *, want: str) -> None:
    draw_errors(ax, result, want)
    ax.legend(fontsize=7)


@_draw.register
def _(result: Fit, ax: Any) -> None:
    sigma = float(result.summits.std())
    ax.hist(result.summits, bins="auto", density=True, color=SAMPLE, label=f"{result.summits.size} summits")
    ax.margins(y=0.3)  # room for the legend
    z = np.linspace(-4 * sigma, 4 * sigma, 201)
    ax.plot(z, norm.pdf(z, scale=sigma), color=THEORY, label="Gaussian")
    ax.set(xlabel="summit height (m)", ylabel="density (1/m)", title=f"sigma = {sigma:.4g} m")
    ax.legend()


@_draw.register
def _(result: ProfileFit, ax: Any) -> None:
    m = result.moments
    rms = float(np.sqrt(m.m0))
    z = np.linspace(-4 * rms, m.mean_height + 4 * m.sigma, 401)
    ax.plot(z, norm.pdf(z, scale=rms), color=SAMPLE, label=f"all heights, Sq = {rms:.4g} m")
    summits = norm.pdf(z, m.mean_height, m.sigma)
    ax.plot(z, summits, color=THEORY, label=f"summits, sigma = {m.sigma:.4g} m")
    ax.set(xlabel="height above the mean plane (m)", ylabel="density (1/m)")
    ax.set_title(f"from {len(result.lengths)} profile(s), alpha = {m.alpha:.3g}")
    ax.margins(y=0.3)  # room for the legend
    ax.legend()


@_draw.register
def _(result: SweepComparison, ax: Any) -> None:
    draw_residuals(result, ax)
