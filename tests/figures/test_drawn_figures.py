"""What is drawn is what was computed: lines, error bars, labels, legends and verdicts, read from the axes."""

import dataclasses
import math

import numpy as np
import pytest
from conftest import SURFACE
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.lines import Line2D
from oracles import told
from oracles.crowding import crowded
from oracles.inside import (
    FAMILIES,
    GAMMA,
    PAIRS,
    THEORY,
    Check,
    Comparison,
    Convergence,
    Curve,
    FigureData,
    Panel,
    Points,
    Series,
    Slope,
    compare,
    comparison_figure,
    convergence_figure,
    draw,
    look,
    power_of_ten,
    quantity_panel,
    save,
    tradeoff_figure,
)

import analytic
import mcgw
from mcgw.figures import style


def bars_of(axis):
    """x, low and high ends of vertical error bars."""
    found = []
    for lines in (c for c in axis.collections if isinstance(c, LineCollection)):
        for (x0, y0), (x1, y1) in lines.get_segments():
            if x0 == x1:
                found.append((x0, min(y0, y1), max(y0, y1)))
    return np.array(found)


def markers_of(axis):
    """Lines of markers alone."""
    lines = (line for line in axis.get_lines() if line.get_linestyle() == "None" and len(line.get_xdata()))
    return [line for line in lines if line.get_marker() in list("os^Dv")]


X = np.array([1.0, 2.0, 4.0])
SERIES = (
    Series("line alone", X, X**2),
    Series("with points", X, 3 * X, Points(X + 0.5, 3 * X + 1, X / 10, 3 * X + 2)),
    Series("γ = 1", X, 5 * X, Points(X, 5 * X, X / 3, 5 * X)),
)


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_panels_are_drawn_as_they_are(scale, recorded):
    panel = Panel("the panel", "x (m)", "y (N)", SERIES, ("linear", scale), level=2.5)
    figure = draw(FigureData("The title", "The caption.", (panel, panel)))
    if scale == "log":
        recorded("drawn.log", told.drawn(figure))
    used = [axis for axis in figure.axes if axis.get_title(loc="left")]
    assert len(used) == 2
    (legend,) = figure.subfigs[0].legends  # one for both, above them
    assert [axis.get_legend() for axis in figure.axes] == [None] * 4
    assert [t.get_text() for t in legend.get_texts()] == [*(s.label for s in SERIES), "Monte Carlo, 95 %"]
    for axis in used:
        assert (axis.get_xlabel(), axis.get_ylabel()) == ("", "y (N)")  # the residuals below say what x is
        assert axis.get_title(loc="left") == "the panel"
        assert (axis.get_xscale(), axis.get_yscale()) == ("linear", scale)
        lines = [x for x in axis.get_lines() if len(x.get_xdata()) == 3 and x.get_linestyle() != "None"]
        for line, series in zip(lines, SERIES, strict=True):
            np.testing.assert_array_equal(line.get_xydata(), np.stack([series.x, series.theory], axis=1))
        assert any(np.all(np.asarray(x.get_ydata()) == 2.5) for x in axis.get_lines())
        shown = [s.points for s in SERIES if s.points]
        for line, points in zip(markers_of(axis), shown, strict=True):
            np.testing.assert_array_equal(line.get_xydata(), np.stack([points.x, points.mean], axis=1))
        bars = bars_of(axis)
        low = np.concatenate([p.mean - np.minimum(1.96 * p.stderr, reach(p, scale)) for p in shown])
        high = np.concatenate([p.mean + 1.96 * p.stderr for p in shown])
        np.testing.assert_allclose(bars[:, 0], np.concatenate([p.x for p in shown]))
        np.testing.assert_allclose(bars[:, 1], low, rtol=1e-12)
        np.testing.assert_allclose(bars[:, 2], high, rtol=1e-12)


def test_residuals_are_below_their_panel():
    """In standard errors, with the marker and the colour of their series; none where there are no points."""
    panels = Panel("with", "x (m)", "y (N)", SERIES), Panel("without", "x (m)", "y (N)", SERIES[:1])
    above, below, alone = draw(FigureData("", "", panels)).axes
    assert (below.get_xlabel(), alone.get_xlabel()) == ("x (m)", "x (m)")
    assert below.get_xlim() == above.get_xlim()
    labelled = [
        [axis.xaxis.get_tick_params()["labelbottom"], axis.yaxis.get_tick_params()["labelleft"]]
        for axis in (above, below, alone)
    ]
    assert labelled == [[False, True], [True, True], [True, True]]  # the axis of both stands below
    shown = [line for line in markers_of(below) if line.get_linestyle() == "None"]
    looks = [(line.get_marker(), line.get_color()) for line in markers_of(above)]
    for line, series, drawn in zip(shown, SERIES[1:], looks, strict=False):
        z = (series.points.mean - series.points.exact) / series.points.stderr
        np.testing.assert_allclose(line.get_xydata(), np.stack([series.points.x, z], axis=1))
        assert (line.get_marker(), line.get_color()) == drawn
    low, high = below.get_ylim()
    assert low == -high < -np.abs(SERIES[1].points.residual).max()
    (band,) = below.patches
    assert (band.get_y(), band.get_height()) == (-2, 4)


@pytest.mark.parametrize(("residuals", "shown"), [([0.7, 0.8, 0.75], 1), ([0.7, -0.8, 0.0], 3)])
def test_residuals_of_one_draw_over_gamma_are_one_point(residuals, shown):
    """Beside a series without any error, which has none at all."""
    points = Points(X, X + np.array(residuals), np.ones(3), X)
    series = Series("a", X, X, points), Series("b", X, X, Points(X, X, 0 * X, X))
    _, below = draw(FigureData("", "", (Panel("p", GAMMA, "y", series),))).axes
    assert [len(line.get_xdata()) for line in markers_of(below)] == [shown]


def test_there_are_no_residuals_of_points_whose_errors_are_not_known():
    series = Series("a", X, X, Points(X, X, 0 * X, X)), Series("b", X, X)
    axes = draw(FigureData("", "", (Panel("p", "x", "y", series),))).axes
    assert [axis.get_xlabel() for axis in axes] == ["x"]
    assert style.line("γ = 1", 3) == {"label": "γ = 1", "color": "#000000", "linestyle": "-"}
    assert {look(names[0])["linestyle"] for names in (*FAMILIES, *PAIRS)} == {"-"}
    assert {look(names[0])["marker"] for names in (*FAMILIES, *PAIRS)} == {"o"}


def reach(points, scale):
    """On a logarithmic axis a bar ends above zero."""
    return 0.95 * points.mean if scale == "log" else np.inf


def test_three_panels_are_one_row_under_a_legend_of_all_outside_them():
    """Lines of any panel are in the one legend, which covers no panel and no title."""
    series = [Series(name, X, k * X) for k, name in enumerate(("first", "second", "third"), 1)]
    panels = tuple(Panel(one.label, "x", "y", (one,)) for one in series)
    figure = draw(FigureData("The title", "", panels))
    figure.draw_without_rendering()
    (legend,) = figure.subfigs[0].legends
    assert [text.get_text() for text in legend.get_texts()] == ["first", "second", "third"]
    places = [axis.get_position() for axis in figure.axes]
    assert len({round(place.y0, 3) for place in places}) == 1
    assert [place.x0 for place in places] == sorted({place.x0 for place in places})
    box = legend.get_window_extent()
    assert not any(box.overlaps(axis.get_tightbbox()) for axis in figure.axes)
    assert not box.overlaps(figure._suptitle.get_window_extent())


def test_legends_name_the_line_that_is_drawn_so():
    figure = draw(FigureData("", "", (Panel("p", "x", "y", SERIES),)))
    axis, _ = figure.axes
    drawn = [x for x in axis.get_lines() if len(x.get_xdata()) == 3 and x.get_linestyle() != "None"]
    (legend,) = figure.subfigs[0].legends
    *named, _ = legend.legend_handles
    marks = [x for x in legend.findobj(Line2D) if x.get_linestyle() == "None"]
    assert [x.get_marker() for x in marks] == [x.get_marker() for x in markers_of(axis)]  # those of the data
    for entry, line in zip(named, drawn, strict=True):
        assert entry.get_color() == line.get_color()
        assert entry.get_linestyle() == line.get_linestyle()
    assert drawn[2].get_color() == "#000000"  # homogeneous, in every figure alike


def slope(against, value):
    sizes = np.array([1.0, 4.0, 16.0]) if against == "M" else np.array([1875.0, 7500.0, 30000.0])
    return Slope(
        against, sizes, 0.3 / np.sqrt(sizes) * [1, 1.1, 0.9], np.array([0.1, 0.2, 0.05]), value, 0.02
    )


def test_convergence(make_scene, kept, tmp_path, recorded):
    checks = (Check("first", "seen so", 0.5), Check("second", "seen else", 1e-5), Check("third", "x", 0.0))
    scores = np.random.default_rng(1).normal(size=400)
    found = Convergence(make_scene(title="T"), checks, (slope("M", -0.49), slope("N", -0.55)), scores)
    assert repr(found).startswith("Statistical convergence FAILED")
    assert repr(dataclasses.replace(found, checks=checks[:1])).startswith("Statistical convergence passed")
    save(convergence_figure(found), tmp_path / "x.png")
    (figure,) = kept
    recorded("drawn.converge", told.drawn(figure))
    assert not crowded(figure)
    for axis, curve in zip(figure.axes[:2], found.slopes, strict=True):
        fit = axis.get_lines()[0].get_ydata()
        np.testing.assert_allclose(fit, fit[0] * np.sqrt(curve.sizes[0] / curve.sizes), rtol=1e-12)
        assert np.mean(np.log(curve.errors) - np.log(fit)) == pytest.approx(0, abs=1e-12)
    good, bad = (c for c in figure.axes[3].collections if isinstance(c, PathCollection))
    np.testing.assert_allclose(bad.get_offsets()[:, 0], [1e-5, 1e-12])  # the second and third fail
    assert len(good.get_paths()[0].vertices) != len(bad.get_paths()[0].vertices)  # nor by colour alone


def test_convergence_without_slopes(make_scene, kept, tmp_path):
    found = Convergence(make_scene(), (Check("means", "x", 0.3),), (), np.empty(0))
    save(convergence_figure(found), tmp_path / "x.png")
    said = [text.get_text() for axis in kept[0].axes for text in axis.texts]
    assert sorted(said) == [
        "slope in M: too few contacts", "slope in N: too few contacts", "z-scores: too few contacts"
    ]  # fmt: skip
    assert "passed: p = 0.3 over 1 checks" in kept[0].get_suptitle()


def test_tradeoff(make_scene, kept, tmp_path, recorded):
    from oracles.inside import Ladder, Point, Rung, Tradeoff, Way

    points = (
        Point("tail", "mean", 10, 0.2, 0.02, 0.0, 1e-3, 16),
        Point("tail", "mean", 1000, 0.02, 0.002, 0.0, 4e-3, 16),
        Point("theory", "mean", 0, 0.0, 0.0, 0.0, 5e-4, 16),
    )
    ways = (Way("theory", "mean", 1e-13, 5e-4, 0.0), Way("tail", "mean", 0.0, 1e-3, 3e-6))
    ways += (Way("cells", "values", 1e-3, 0.25, 0.01), Way("exact law", "quantile", 1e-6, 0.01, 0.0))
    rungs = (Rung("formula", 0, 1e-3, 0.0, 0.03), Rung("surfaces", 10, 0.1, 0.04, 0.03))
    rungs += (Rung("surfaces", 1000, 9.0, 0.004, 0.03),)
    scene = make_scene(title="T", separations=(2.0,), quantities=("area",), n_surfaces=75)
    found = Tradeoff(scene, 2.0, points, ways, Ladder(rungs, ""), 1.0)
    save(tradeoff_figure(found), tmp_path / "x.png")
    (figure,) = kept
    recorded("drawn.tradeoff", told.drawn(figure))
    curve = next(line for line in figure.axes[-1].get_lines() if line.get_label() == "surfaces")
    np.testing.assert_allclose(curve.get_xydata(), [(0.1, 0.05), (9.0, math.hypot(0.004, 0.03))])


@pytest.mark.parametrize(("x", "label"), [(1e-12, "10⁻¹²"), (1.0, "10⁰"), (1e308, "10³⁰⁸"), (30.0, "30")])
def test_labels_of_decades_are_plain_text(x, label):
    assert power_of_ten(x) == label


# --- comparisons ----------------------------------------------------------------------------------------

TITLES = {
    "load": "Load P (N)",
    "area": "Real area A (m²)",
    "stiffness": "Stiffness K (N/m)",
    "contacts": "Contacts",
    "conductance": "Conductance Cρ (m)",
}
QUANTITIES = tuple(TITLES)
H = (1.0, 0.0, 2.0)


@pytest.fixture(scope="module")
def comparison():
    scene = mcgw.Scene(
        surface=SURFACE,
        title="A title",
        separations=H,
        grading=analytic.Exponential(2.0),
        contact=mcgw.Contact(quantities=QUANTITIES),
        ensemble=mcgw.Sampling(n_asperities=3000),
        n_surfaces=60,
        seed=4,
    )
    return compare(mcgw.simulate(scene))


def test_comparison(comparison):
    """Theory in the order of the separations, means and their intervals where they are."""
    data = comparison_figure(comparison)
    h, order = np.array(H), np.argsort(H)
    assert [panel.title for panel in data.panels] == list(TITLES.values())
    for panel, curve in zip(data.panels, comparison.curves.values(), strict=True):
        ((series,), points) = panel.series, panel.series[0].points
        assert (series.label, panel.xlabel, panel.scales) == ("theory", "separation d/σ", ("linear", "log"))
        for found, expected in (
            ((series.x, series.theory), (h[order], curve.theory[order])),
            ((points.x, points.mean, points.exact), (h, curve.mean, curve.theory)),
            ((points.stderr, *points.interval), (curve.stderr, curve.low, curve.high)),
        ):
            np.testing.assert_array_equal(found, expected)
        np.testing.assert_array_equal(points.residual, curve.residual)
    verdict = comparison.verdict
    assert data.title == (
        f"A title\nMonte Carlo and theory agree: χ² = {verdict.chi_square:.1f} for "
        f"{verdict.degrees} degrees, p = {verdict.p:.3g}"
    )
    assert data.caption == (
        "60 surfaces of 3000 asperities, exponential grading, γ = 2; "
        f"sampler {comparison.ensemble.sampler}, seed 4"
    )


def test_lopsided_intervals_and_large_residuals_are_drawn_as_they_are(comparison):
    """Longer upwards than downwards, and the other way round; 20 standard errors stay in sight."""
    curve = comparison.curves["load"]
    mean = curve.theory + 20 * curve.stderr
    lopsided = Curve(mean, mean * [0.9, 0.7, 0.99], mean * [1.3, 1.1, 1.5], curve.theory, curve.stderr)
    above, below = drawn(one_of(comparison, lopsided))
    (line,) = (x for x in above.get_lines() if x.get_label() == "theory")
    assert line.get_color() == THEORY
    (points,) = markers_of(above)
    np.testing.assert_array_equal(points.get_xydata(), np.column_stack([H, mean]))
    bars = np.column_stack([H, lopsided.low, lopsided.high])
    np.testing.assert_allclose(bars_of(above), bars, rtol=1e-12)
    low, high = below.get_ylim()
    assert low < lopsided.residual.min() < lopsided.residual.max() < high


def named_in(figure):
    """What the one legend says."""
    (legend,) = figure.subfigs[0].legends
    return [text.get_text() for text in legend.get_texts()]


def drawn(comparison, name="load"):
    """One quantity alone, as in a report."""
    return draw(FigureData("", "", (quantity_panel(comparison, name),))).axes


def one_of(comparison, curve):
    """The same with another curve of the load, and that alone."""
    return Comparison(comparison.ensemble, {"load": curve}, comparison.verdict)


def test_of_residuals_that_read_alike_the_first_is_shown(comparison):
    """Which of them has most rounding depends on the processor."""
    curve = comparison.curves["load"]
    for pull, shown in (([1e-9, -2e-9, 3e-9], 0), ([0.5, -2.001, 2.002], 1), ([-0.5, 0.4, 0.506], 2)):
        mean = curve.theory + np.array(pull) * curve.stderr
        compared = one_of(comparison, dataclasses.replace(curve, mean=mean))
        assert compared.worst(1).only("separation").columns[0].values == [H[shown]]
        assert f"{H[shown]:g}" in compared.sheet().text()
        assert compared.sheet().only("separation").columns[0].values == [H[shown]]
    still = dataclasses.replace(curve, mean=curve.theory - 1e-9 * curve.stderr)
    assert "-0.00" not in one_of(comparison, still).worst(3).text()


def test_too_few_contacts_have_a_marker_of_their_own_and_pulls_a_linear_axis(comparison):
    curve = comparison.curves["load"]
    few = dataclasses.replace(curve, low=curve.low * [1, 1, np.nan], high=curve.high * [1, 1, np.nan])
    axis = drawn(one_of(comparison, few))[0]
    (points,) = markers_of(axis)
    (cross,) = (x for x in axis.get_lines() if x.get_marker() == "x" and len(x.get_xdata()))
    np.testing.assert_array_equal(points.get_xdata(), H[:2])
    np.testing.assert_array_equal(cross.get_xydata(), [(H[2], curve.mean[2])])
    assert named_in(axis.get_figure(root=True))[-1] == "too few contacts"
    pull = Curve(-curve.mean, -curve.high, -curve.low, -curve.theory, curve.stderr)
    axis = drawn(one_of(comparison, pull))[0]
    assert axis.get_yscale() == "linear"
    np.testing.assert_allclose(bars_of(axis)[:, 1:], np.column_stack([pull.low, pull.high]), rtol=1e-12)
    touches_nowhere = dataclasses.replace(curve, mean=curve.mean * [1, 1, 0])
    axis = drawn(one_of(comparison, touches_nowhere))[0]
    assert axis.get_ylim()[0] == pytest.approx(0.01 * curve.mean[:2].min())


# --- drawn ------------------------------------------------------------------------------------------------


# Panels, sign of the mean, and how far theory is: linear axes of pulls, exponents at the side.
ROOM = [(1, 1, 1.0), (2, -1, 1e6), (5, 1, 1e6), (6, -1, 1.0), (7, 1, 1.0), (7, -1, 1e6)]


@pytest.mark.parametrize(
    ("panels", "sign", "size"), [pytest.param(*x, marks=() if x[0] == 1 else pytest.mark.site) for x in ROOM]
)
def test_panels_of_a_comparison_have_room(comparison, kept, tmp_path, panels, sign, size):
    names = (*QUANTITIES, "yielded", "load_slope")[:panels]
    one = comparison.curves["load"]
    mean, error = sign * 1e-12 * one.mean, 1e-13 * one.mean
    curve = Curve(mean, mean - error, mean + error, mean * (1 + 0.01 * size), 1e-13 * one.stderr)
    many = dataclasses.replace(comparison, curves=dict.fromkeys(names, curve))
    save(comparison_figure(many), tmp_path / "x.png")
    assert len(kept[0].axes) == 2 * panels
    assert not crowded(kept[0])
    kept[0].axes[0].set_title("A title for which there is no room " * 9)  # which would be seen
    assert crowded(kept[0])
