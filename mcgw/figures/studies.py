"""Figures of studies: Monte Carlo on theory, scatter, the convergence test, and error against time."""

import textwrap
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import EngFormatter, NullLocator

from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.figures import style
from mcgw.figures.panels import SEPARATION, FigureData, Panel, Series, words
from mcgw.figures.style import contact_label, look, shown_title
from mcgw.machine.terminal import one_line
from mcgw.scene.scene import Scene
from mcgw.statistics.comparison import Comparison, Points, SweepComparison
from mcgw.statistics.verdict import FALSE_ALARM

if TYPE_CHECKING:  # these import the samplers
    from mcgw.statistics.checks import Slope
    from mcgw.statistics.convergence import Convergence
    from mcgw.statistics.tradeoff import Tradeoff
    from mcgw.statistics.ways import Way

ENOUGH = 20  # contacts in the ensemble; with fewer a mean is far from Gaussian
_BIN = 0.5  # standard errors
_RESIDUAL = "residual (standard errors)"
_FLOOR, _LEAST = 1e-14, 1e-12  # errors and probabilities that are drawn
_TWO = 1.96  # standard errors that 95 of 100 keep
_TIME = "CPU time (s)"
_RULES: dict[str, dict[str, Any]] = {
    **{key: {"color": style.THEORY, "marker": "*"} for key in ("theory", "formula")},
    "exact law": {"color": style.HOMOGENEOUS, "marker": "P"},
    "solve": {"color": look("tail")["color"], "marker": "o"},
    "surfaces": {"color": look("tail")["color"], "marker": "s"},
    "boundary elements": {"color": style.HOMOGENEOUS, "marker": "D"},
}


def comparison_figure(comparison: Comparison | SweepComparison) -> FigureData:
    """Each quantity with its theory and residuals; of a sweep all residuals and those of the worst point."""
    verdict = comparison.verdict
    if not isinstance(comparison, Comparison):
        title = f"{shown_title(comparison.sweep.scenes[0], 'Sweep')}: {len(comparison.points)} scenes"
        said = f"Monte Carlo and theory {verdict.word}: p = {verdict.p:.3g} for all points together"
        every = Panel("all points", paint=partial(draw_residuals, comparison.residuals))
        panels = (every, Panel(paint=partial(_draw_worst, comparison)))
        shared = "Residuals of points with the same surfaces, and of neighbouring separations, are correlated"
        return FigureData(f"{title}\n{said}", f"{shared}; the verdict allows for this.", panels)
    ensemble, scene = comparison.ensemble, comparison.ensemble.scene
    curves = tuple(quantity_panel(comparison, name) for name in comparison.curves)
    seen = verdict.seen.replace("chi-square", "χ² =").replace(" degrees of freedom", " degrees")  # one line
    said = f"Monte Carlo and theory {verdict.word}: {seen}, p = {verdict.p:.3g}"
    drawn = f"{ensemble.n_surfaces} surfaces of {scene.n_asperities:g} asperities, {contact_label(scene)}"
    caption = [f"{drawn}; sampler {ensemble.sampler}, seed {scene.seed}", comparison.of_many]
    return FigureData(f"{shown_title(scene, 'Ensemble')}\n{said}", "; ".join(filter(None, caption)), curves)


def quantity_panel(comparison: Comparison, name: str) -> Panel:
    """Return one of the curves over the separations, with its theory and residuals."""
    points = comparison.curves[name]
    order = np.argsort(points.x, kind="stable")
    series = Series("theory", points.x[order], points.theory[order], points)
    title = comparison.ensemble.scene.quantity(name).title
    return Panel(title, SEPARATION, "", (series,), ("linear", "log"))


def spread_panel(title: str, ensemble: Ensemble, line: Array, names: Sequence[str] = ()) -> Panel:
    """Show how far surfaces spread, exactly and of those that were drawn, by quantity: all, or some."""
    scene = ensemble.scene
    series = tuple(spread(name, scene, name, line, ensemble) for name in names or scene.quantities)
    return Panel(title, SEPARATION, "std / mean", series, ("linear", "log"))


def spread(
    label: str, scene: Scene, name: str, line: Array, drawn: Ensemble | None, fewest: float = ENOUGH
) -> Series:
    """Return the exact standard deviation over the mean of a quantity, and that of what was drawn.

    Points have standard errors by the exact law of one surface, to first order: half of std's, that of the
    mean, and both together. There are none at separations with fewer contacts in the ensemble.
    """

    def over_mean(law: Any) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):  # nan where nothing touches
            return np.asarray(np.sqrt(law.variance) / np.abs(law.mean))

    whole = Series(label, line, over_mean(scene.theory.cumulants(name, line)))
    if drawn is None:
        return whole
    contacts = scene.theory.mean("contacts", drawn.separations) * drawn.n_surfaces
    known = (contacts >= fewest) & (drawn.std(name) > 0)
    if not known.any():
        return whole
    h, law = drawn.separations[known], scene.theory.cumulants(name, drawn.separations[known])
    exact, seen = over_mean(law), drawn.std(name)[known] / np.abs(drawn.mean(name)[known])
    relative = np.sqrt((law.excess_kurtosis + 2) / 4 + exact**2 - law.skewness * exact)
    return replace(whole, points=Points(h, seen, exact * relative / drawn.n_surfaces**0.5, exact))


def draw_residuals(z: Array, axis: Any) -> None:
    """Draw a histogram of residuals on its expectation if theory holds; one outlier shows."""
    most = max(4.0, _BIN * np.ceil(np.abs(z).max(initial=0.0) / _BIN))
    x = np.linspace(-most, most, 201)
    expected = len(z) * _BIN * np.exp(-(x**2) / 2) / np.sqrt(2 * np.pi)
    axis.set(xlabel=_RESIDUAL, ylabel="means", yscale="log")
    bins = np.arange(-most, most + _BIN / 2, _BIN)
    axis.hist(z, bins, color=style.SAMPLE, label=f"{len(z)} means")
    axis.plot(x, expected, color=style.THEORY, label="normal: expected if theory holds")
    axis.set_ylim(0.4, 3 * max(expected.max(), 1.0))


def _draw_worst(comparison: SweepComparison, axis: Any) -> None:
    """Residuals of the least likely point; those that count have a marker."""
    t = comparison.worst[0]
    axis.axhspan(-2, 2, color=style.BAND, zorder=0)
    axis.axhline(0, color=style.LEVEL, lw=0.8, zorder=1)
    for name, residual, counts in zip(t.quantities, t.residual, t.counts, strict=True):
        z, label = np.where(counts, residual, np.nan), name.replace("_", " ")
        axis.plot(t.separations, z, ms=3, mfc="none", lw=1, label=label, **look(name))
    reach = max(4, 1.5 * np.abs(t.residual[t.counts]).max(initial=0.0))
    at = one_line(comparison.sweep.axes.text(t.number)).replace("$", r"\$")
    title = textwrap.fill(f"worst: {at}; p = {t.verdict.p:.2g} of this point alone", 36)
    axis.set(title=title, xlabel=SEPARATION, ylabel=_RESIDUAL, ylim=(-reach, reach))


def convergence_figure(found: "Convergence") -> FigureData:
    """Slopes of the error, z-scores, and the probability of every check."""
    names = ("slope in M", "slope in N", "z-scores")
    parts = {name: Panel(paint=partial(words, f"{name}: too few contacts")) for name in names}
    parts |= {f"slope in {curve.against}": Panel(paint=partial(_draw_slope, curve)) for curve in found.slopes}
    if found.scores.size:
        parts["z-scores"] = Panel("z-scores", paint=partial(draw_residuals, found.scores))
    said = f"Statistical convergence {found.word}: p = {found.p:.3g} over {len(found.checks)} checks"
    title = f"{shown_title(found.scene, 'Scene')}\n{said} (false alarms: 1 in {1 / FALSE_ALARM:.0f})"
    checks = Panel("", paint=partial(draw_checks, found), wide=True)
    return FigureData(title, "", (*parts.values(), checks))


def _draw_slope(curve: "Slope", axis: Any) -> None:
    """Measured errors, and a line that falls with the root of the size."""
    fit = np.exp(np.mean(np.log(curve.errors) + np.log(curve.sizes) / 2)) / np.sqrt(curve.sizes)
    axis.set(xscale="log", yscale="log")
    axis.plot(curve.sizes, fit, color=style.THEORY, label="slope −1/2")
    own = style.SEEN | {"ms": 4, "fmt": "o", "label": "measured, 95 %"}
    axis.errorbar(curve.sizes, curve.errors, _TWO * curve.stderr * curve.errors, **own)
    axis.set_title(f"slope {curve.value:.4f} ± {_TWO * curve.uncertainty:.4f}".replace("-", "−"))
    if curve.against == "M":
        axis.set(xlabel="surfaces $M$", ylabel="rms error (standard deviations)")
    else:  # of less than a decade or two, with others named between
        axis.set(xlabel="asperities $N$", ylabel="rms relative error")
        axis.xaxis.set_minor_locator(NullLocator())
        axis.set_xticks(curve.sizes, [*map(EngFormatter(), curve.sizes)])


def draw_checks(found: "Convergence", axis: Any) -> None:
    """Draw the probability of every check."""
    p = np.array([max(check.p, _LEAST) for check in found.checks])
    limit, rows = FALSE_ALARM / len(p), np.arange(len(p))[::-1]
    axis.set(xscale="log")
    axis.axvspan(_LEAST / 10, limit, color=style.BAND, zorder=0)
    axis.hlines(rows, p, 1, color="0.7", lw=1)
    for some, color, marker in ((p > limit, style.THEORY, "o"), (p <= limit, style.MONTE_CARLO, "X")):
        axis.scatter(p[some], rows[some], color=color, marker=marker, s=28, zorder=3)
    axis.set(xlim=(_LEAST / 3, 2.5), ylim=(-0.7, len(p) - 0.3))
    axis.set_xlabel("probability by chance; grey: fails (all below 10⁻¹² at the far left)")
    axis.set_title(f"Statistical convergence {found.word}: p = {found.p:.3g}")
    axis.set_yticks(rows, [check.name for check in found.checks])


def tradeoff_figure(found: "Tradeoff") -> FigureData:
    """Error against time, a panel for each answer, and the ladder of models below."""
    from mcgw.statistics.ways import WANTS

    title = f"{shown_title(found.scene, 'Speed and accuracy')}\n{found.sentence}"
    n, ways = found.scene.n_surfaces, found.ways
    times = [p.seconds for p in found.points]
    times += [way.seconds(n) for way in ways if way.want == "values" or not way.draws]
    within = min(times) / 2, 2 * max(times)
    wants = (Panel(paint=partial(draw_errors, found, want=want, xlim=within)) for want in WANTS)
    return FigureData(title, found.worth, (*wants, Panel(paint=partial(_draw_ladder, found), wide=True)))


def draw_errors(found: "Tradeoff", axis: Any, want: str = "mean", **limits: Any) -> None:
    """95 % bounds against time: measured points, lines of the expected slope, and ways without draws."""
    kept = [way for way in found.ways if way.want == want and way.measured]
    title = found.words(want) + f" ({found.scene.n_surfaces})" * (want == "values")
    axis.set(title=title, xlabel=_TIME, ylabel="error (95 % bound)")
    if not kept:
        some = any(way.want == want for way in found.ways)
        words("takes longer than the study" if some else "no way to it", axis)
        return
    axis.set(xscale="log", yscale="log")
    for way in kept:
        _draw_way(axis, way, found)
    axis.set(ylim=(_FLOOR / 3, 3), **limits)


def _draw_way(axis: Any, way: "Way", found: "Tradeoff") -> None:
    own = _RULES.get(way.name) or {key: look(way.name)[key] for key in ("color", "marker")}
    points = [p for p in found.points if (p.way, p.want) == (way.name, way.want) and p.n_surfaces]
    floor = max(way.floor, _FLOOR)
    if not way.draws or way.want == "values":
        axis.plot(way.seconds(found.scene.n_surfaces), floor, ls="", ms=6, label=way.name, **own)
    elif points:  # of growing numbers of surfaces, and the line that falls with the root of these
        columns = [(p.seconds, p.n_surfaces, p.rms, p.stderr) for p in points]
        time, size, error, stderr = np.array(columns).T
        of_one = np.exp(np.mean(np.log(_TWO * error) + np.log(size) / 2))
        axis.plot(time, of_one / np.sqrt(size), color=own["color"], lw=1)
        axis.errorbar(time, _TWO * error, _TWO**2 * stderr, ls="", ms=4, label=way.name, **own)
    if not way.draws:
        axis.axhline(floor, color=own["color"], lw=0.8, ls=":")


def _draw_ladder(found: "Tradeoff", axis: Any) -> None:
    """Whole errors of the conductance at a load against time, model by model; their parts as thin lines."""
    title = "conductance at its load, by numbers of surfaces or maps; dotted: without the model"
    axis.set(title=title, xlabel=_TIME, ylabel="whole error (95 % bound)", xscale="log", yscale="log")
    if known := not np.isnan(model := found.ladder[0].model):
        axis.axhline(model, color=style.LEVEL, lw=1, label="error of the model")
    for name, group in groupby(found.ladder, lambda rung: rung.name):
        rungs, own = [*group], _RULES[name]
        time, whole = [r.seconds for r in rungs], [r.whole if known else r.drawn for r in rungs]
        axis.plot(time, whole, **own, ms=5, ls="-" * (len(rungs) > 1), label=name)
        if len(rungs) == 1:
            continue
        if known:
            axis.plot(time, [r.drawn for r in rungs], color=own["color"], lw=0.8, ls=":")
        for r, *at in zip(rungs, time, whole, strict=True):
            text = f"{r.n_surfaces:g}"
            axis.annotate(text, at, (0, 5), textcoords="offset points", fontsize=7, ha="center")
