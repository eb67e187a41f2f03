"""Monte-Carlo means on curves of theory; for a sweep all residuals and the worst point."""

import textwrap
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.figures.data import SEPARATION, FigureData, Panel, Points, Series
from mcgw.figures.style import BAND, LEVEL, SAMPLE, THEORY, contact_label, look, shown_title
from mcgw.machine.terminal import one_line
from mcgw.scene.scene import Scene
from mcgw.statistics.comparison import Comparison, SweepComparison

ENOUGH = 20  # contacts in the ensemble; with fewer a mean is far from Gaussian
_BIN = 0.5  # standard errors
_RESIDUAL = "residual (standard errors)"
_CAPTION = (
    "Residuals of points with the same surfaces, and of neighbouring separations, are correlated; the "
    "verdict allows for this."
)


def comparison_figure(comparison: Comparison | SweepComparison) -> FigureData:
    """Each quantity with its theory and residuals; of a sweep all residuals and those of the worst point."""
    verdict = comparison.verdict
    if not isinstance(comparison, Comparison):
        title = f"{shown_title(comparison.sweep.scenes[0], 'Sweep')}: {len(comparison.points)} scenes"
        said = f"Monte Carlo and theory {verdict.word}: p = {verdict.p:.3g} for all points together"
        panels = (residuals_panel("all points", comparison.residuals), _worst_panel(comparison))
        return FigureData(f"{title}\n{said}", _CAPTION, panels)
    ensemble, scene = comparison.ensemble, comparison.ensemble.scene
    curves = tuple(quantity_panel(comparison, name) for name in comparison.curves)
    seen = verdict.seen.replace("chi-square", "χ² =").replace(" degrees of freedom", " degrees")  # one line
    return FigureData(
        f"{shown_title(scene, 'Ensemble')}\n"
        f"Monte Carlo and theory {verdict.word}: {seen}, p = {verdict.p:.3g}",
        f"{ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, "
        f"{contact_label(scene)}; sampler {ensemble.sampler}, seed {scene.seed}"
        + (f"; {comparison.of_many}" if comparison.of_many else ""),
        curves,
    )


def quantity_panel(comparison: Comparison, name: str) -> Panel:
    """Return one of the curves over the separations, with its theory and residuals."""
    h, curve = comparison.ensemble.separations, comparison.curves[name]
    order = np.argsort(h, kind="stable")
    points = Points(h, curve.mean, curve.stderr, curve.theory, (curve.low, curve.high))
    series = Series("theory", h[order], curve.theory[order], points)
    pulls = bool(np.any(curve.theory < 0) or np.any(curve.mean < 0))  # it does not fit a log axis
    scales, level = (("linear", "linear"), 0.0) if pulls else (("linear", "log"), None)
    return Panel(comparison.ensemble.scene.quantity(name).title, SEPARATION, "", (series,), scales, level)


def spread(
    label: str, scene: Scene, name: str, line: Array, drawn: Ensemble | None, fewest: float = ENOUGH
) -> Series:
    """Return the exact standard deviation over the mean of a quantity, and that of what was drawn.

    Points have standard errors by the exact law of one surface, to first order: half of std's, that of the
    mean, and both together. There are none at separations with fewer contacts in the ensemble.
    """
    exact = _std_over_mean(scene.theory.cumulants(name, line))
    if drawn is None:
        return Series(label, line, exact)
    h = drawn.separations
    known = (scene.theory.mean("contacts", h) * drawn.n_surfaces >= fewest) & (drawn.std(name) > 0)
    if not known.any():
        return Series(label, line, exact)
    law = scene.theory.cumulants(name, h[known])
    there = _std_over_mean(law)
    relative = np.sqrt((law.excess_kurtosis + 2) / 4 + there**2 - law.skewness * there)
    seen = drawn.std(name)[known] / np.abs(drawn.mean(name)[known])
    return Series(label, line, exact, Points(h[known], seen, there * relative / drawn.n_surfaces**0.5, there))


def _std_over_mean(law: Any) -> Array:
    with np.errstate(divide="ignore", invalid="ignore"):  # nan where nothing touches
        return np.asarray(np.sqrt(law.variance) / np.abs(law.mean))


def residuals_panel(title: str, z: Array) -> Panel:
    """Draw a histogram of residuals on its expectation if theory holds; one outlier shows."""
    most = max(4.0, _BIN * np.ceil(np.abs(z).max(initial=0.0) / _BIN))
    x = np.linspace(-most, most, 201)
    expected = len(z) * _BIN * np.exp(-(x**2) / 2) / np.sqrt(2 * np.pi)

    def paint(axis: Any) -> None:
        bins = np.arange(-most, most + _BIN / 2, _BIN)
        axis.hist(z, bins, color=SAMPLE, label=f"{len(z)} means")
        axis.plot(x, expected, color=THEORY, label="normal: expected if theory holds")
        axis.set_ylim(0.4, 3 * max(expected.max(), 1.0))

    return Panel(title, _RESIDUAL, "means", scales=("linear", "log"), paint=paint)


def _worst_panel(comparison: SweepComparison) -> Panel:
    """Residuals of the least likely point; those that count have a marker."""
    t = comparison.worst[0]

    def paint(axis: Any) -> None:
        axis.axhspan(-2, 2, color=BAND, zorder=0)
        axis.axhline(0, color=LEVEL, lw=0.8, zorder=1)
        for name, residual, counts in zip(t.quantities, t.residual, t.counts, strict=True):
            z, label = np.where(counts, residual, np.nan), name.replace("_", " ")
            axis.plot(t.separations, z, ms=3, mfc="none", lw=1, label=label, **look(name))
        reach = max(4, 1.5 * np.abs(t.residual[t.counts]).max(initial=0.0))
        axis.set_ylim(-reach, reach)

    point = list(comparison.sweep.axes.points())[t.number]
    at = one_line(comparison.sweep.axes.text(point)).replace("$", r"\$")
    title = textwrap.fill(f"worst: {at}; p = {t.verdict.p:.2g} of this point alone", 36)
    return Panel(title, SEPARATION, _RESIDUAL, paint=paint)
