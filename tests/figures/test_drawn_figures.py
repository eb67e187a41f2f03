"""What is drawn is what was computed: lines, error bars, labels, legends and verdicts, read from the axes."""

import dataclasses
import math

import numpy as np
import pytest
from conftest import SURFACE
from matplotlib.collections import LineCollection
from oracles import inside, told
from oracles.crowding import crowded
from oracles.inside import Comparison, FigureData, Panel, Points, Series, draw
from oracles.study_by_hand import made_up

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


def named_in(figure):
    """What the one legend says."""
    (legend,) = figure.subfigs[0].legends
    return [text.get_text() for text in legend.get_texts()]


X = np.array([1.0, 2.0, 4.0])
SERIES = (
    Series("line alone", X, X**2),
    Series("with points", X, 3 * X, Points(X + 0.5, 3 * X + 1, X / 10, 3 * X + 2)),
    Series("γ = 1", X, 5 * X, Points(X, 5 * X, X / 3, 5 * X)),
)


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_panels_are_drawn_as_they_are(scale, recorded):
    """Two alike under one legend, which names lines as they are drawn; on decades bars end above zero."""
    panel = Panel("the panel", "x (m)", "y (N)", SERIES, ("linear", scale), level=2.5)
    figure = draw(FigureData("The title", "The caption.", (panel, panel)))
    if scale == "log":
        recorded("drawn.log", told.drawn(figure))
    used = [axis for axis in figure.axes if axis.get_title(loc="left")]
    assert len(used) == 2
    assert named_in(figure) == [*(s.label for s in SERIES), "Monte Carlo, 95 %"]
    entries = figure.subfigs[0].legends[0].legend_handles
    points = [s.points for s in SERIES if s.points]
    for axis in used:
        assert axis.get_yscale() == scale
        lines = [x for x in axis.get_lines() if len(x.get_xdata()) == 3 and x.get_linestyle() != "None"]
        for line, series, entry in zip(lines, SERIES, entries[:-1], strict=True):
            np.testing.assert_array_equal(line.get_xydata(), np.stack([series.x, series.theory], axis=1))
            assert (entry.get_color(), entry.get_linestyle()) == (line.get_color(), line.get_linestyle())
        for line, p in zip(markers_of(axis), points, strict=True):
            np.testing.assert_array_equal(line.get_xydata(), np.stack([p.x, p.mean], axis=1))
        most = 0.95 if scale == "log" else np.inf
        low = np.concatenate([p.mean - np.minimum(1.96 * p.stderr, most * p.mean) for p in points])
        high = np.concatenate([p.mean + 1.96 * p.stderr for p in points])
        ends = np.stack([np.concatenate([p.x for p in points]), low, high], axis=1)
        np.testing.assert_allclose(bars_of(axis), ends, rtol=1e-12)


@pytest.mark.parametrize(("residuals", "shown"), [([0.7, 0.8, 0.75], 1), ([0.7, -0.8, 0.0], 3)])
def test_residuals_of_one_draw_over_gamma_are_one_point(residuals, shown):
    """Beside a series without any error, which has none at all."""
    points = Points(X, X + np.array(residuals), np.ones(3), X)
    series = Series("a", X, X, points), Series("b", X, X, Points(X, X, 0 * X, X))
    panel = Panel("p", inside.GAMMA, "y", series, ("log", "linear"))
    above, below = draw(FigureData("", "", (panel,))).axes
    assert (above.get_xscale(), below.get_xscale()) == ("log", "log")
    assert [len(line.get_xdata()) for line in markers_of(below)] == [shown]


def test_a_wide_panel_follows_a_row_that_is_not_full():
    narrow, wide = Panel("", "x", "y"), Panel("", "x", "y", wide=True)
    assert len(draw(FigureData("", "", (*[narrow] * 5, wide))).axes) == 6


def test_there_are_no_residuals_of_points_whose_errors_are_not_known():
    series = Series("a", X, X, Points(X, X, 0 * X, X)), Series("b", X, X)
    axes = draw(FigureData("", "", (Panel("p", "x", "y", series),))).axes
    assert [axis.get_xlabel() for axis in axes] == ["x"]
    assert style.line("γ = 1", 3) == {"label": "γ = 1", "color": "#000000", "linestyle": "-"}


@pytest.fixture
def converged(make_scene):
    checks = (("first", "seen so", 0.5), ("second", "seen else", 1e-5), ("third", "x", 0.0))
    slopes = []
    for against, least, value in (("M", 1.0, -0.49), ("N", 1875.0, -0.55)):
        sizes = least * np.array([1.0, 4.0, 16.0])
        errors = 0.3 / np.sqrt(sizes) * [1, 1.1, 0.9]
        slopes.append(inside.Slope(against, sizes, errors, np.array([0.1, 0.2, 0.05]), value, 0.02))
    scores = np.random.default_rng(1).normal(size=400)
    found = tuple(inside.Check(*check) for check in checks)
    return inside.Convergence(make_scene(title="T"), found, tuple(slopes), scores)


def test_convergence(converged, recorded):
    assert repr(converged).startswith("Statistical convergence FAILED")
    passed = dataclasses.replace(converged, checks=converged.checks[:1])
    assert repr(passed).startswith("Statistical convergence passed")
    figure = draw(inside.convergence_figure(converged))
    recorded("drawn.converge", told.drawn(figure))
    for axis, curve in zip(figure.axes[:2], converged.slopes, strict=True):
        fit = axis.get_lines()[0].get_ydata()
        np.testing.assert_allclose(fit, fit[0] * np.sqrt(curve.sizes[0] / curve.sizes), rtol=1e-12)
        assert np.mean(np.log(curve.errors) - np.log(fit)) == pytest.approx(0, abs=1e-12)
    few = dataclasses.replace(passed, slopes=(), scores=np.empty(0))
    said = [text.get_text() for axis in draw(inside.convergence_figure(few)).axes for text in axis.texts]
    assert sorted(said) == [f"{what}: too few contacts" for what in ("slope in M", "slope in N", "z-scores")]


@pytest.mark.site
def test_a_study_has_room(converged):
    assert not crowded(draw(inside.convergence_figure(converged)))


def test_tradeoff(make_scene, recorded):
    scene = make_scene(title="T", separations=(2.0,), quantities=("area",), n_surfaces=75)
    study = made_up(scene)
    figure = draw(inside.tradeoff_figure(study))
    recorded("drawn.tradeoff", [*told.drawn(figure), *str(study.sheet((0.1, 1e-4, 1e-7))).splitlines()])
    curve = next(line for line in figure.axes[-1].get_lines() if line.get_label() == "surfaces")
    np.testing.assert_allclose(curve.get_xydata(), [(0.1, 0.05), (9.0, math.hypot(0.004, 0.03))])


@pytest.mark.parametrize(("x", "label"), [(1e-12, "10⁻¹²"), (1.0, "10⁰"), (1e308, "10³⁰⁸"), (30.0, "30")])
def test_labels_of_decades_are_plain_text(x, label):
    assert inside.power_of_ten(x) == label


# --- comparisons ----------------------------------------------------------------------------------------

QUANTITIES = ("load", "area", "stiffness", "contacts", "conductance")
H = (1.0, 0.0, 2.0)


@pytest.fixture(scope="module")
def comparison(make_scene):
    scene = make_scene(
        surface=SURFACE,
        separations=H,
        grading=analytic.Exponential(2.0),
        quantities=QUANTITIES,
        n_surfaces=60,
        seed=4,
    )
    return mcgw.compare(mcgw.simulate(scene))


def drawn(comparison, curve):
    """Axes of the load alone, as in a report, with another curve."""
    changed = Comparison(comparison.ensemble, {"load": curve}, comparison.verdict)
    return draw(FigureData("", "", (inside.quantity_panel(changed, "load"),))).axes


def test_lopsided_intervals_and_large_residuals_are_drawn_as_they_are(comparison):
    """Longer upwards than downwards, and the other way round; 20 standard errors stay in sight.

    Theory is a line in the order of the separations.
    """
    curve = comparison.curves["load"]
    mean = curve.theory + 20 * curve.stderr
    ends = mean * [0.9, 0.7, 0.99], mean * [1.3, 1.1, 1.5]
    lopsided = Points(curve.x, mean, curve.stderr, curve.theory, *ends)
    above, below = drawn(comparison, lopsided)
    bars = np.column_stack([H, lopsided.low, lopsided.high])
    np.testing.assert_allclose(bars_of(above), bars, rtol=1e-12)
    (line,) = (x for x in above.get_lines() if x.get_label() == "theory")
    np.testing.assert_array_equal(line.get_xydata(), np.column_stack([H, curve.theory])[np.argsort(H)])
    low, high = below.get_ylim()
    assert low < lopsided.residual.min() < lopsided.residual.max() < high


def test_of_residuals_that_read_alike_the_first_is_shown(comparison):
    """Which of them has most rounding depends on the processor."""
    curve = comparison.curves["load"]
    for pull, shown in (([1e-9, -2e-9, 3e-9], 0), ([0.5, -2.001, 2.002], 1), ([-0.5, 0.4, 0.506], 2)):
        mean = curve.theory + np.array(pull) * curve.stderr
        changed = dataclasses.replace(comparison, curves={"load": dataclasses.replace(curve, mean=mean)})
        assert changed.sheet().only("separation").columns[0].values == [H[shown]]
        assert "-0.00" not in changed.table().text()


def test_too_few_contacts_have_a_marker_of_their_own_and_pulls_a_linear_axis(comparison):
    curve = comparison.curves["load"]
    few = dataclasses.replace(curve, low=curve.low * [1, 1, np.nan], high=curve.high * [1, 1, np.nan])
    axis = drawn(comparison, few)[0]
    (points,) = markers_of(axis)
    (cross,) = (x for x in axis.get_lines() if x.get_marker() == "x" and len(x.get_xdata()))
    np.testing.assert_array_equal(points.get_xdata(), H[:2])
    np.testing.assert_array_equal(cross.get_xydata(), [(H[2], curve.mean[2])])
    assert named_in(axis.get_figure(root=True))[-1] == "too few contacts"
    pull = Points(curve.x, -curve.mean, curve.stderr, -curve.theory, -curve.high, -curve.low)
    axis = drawn(comparison, pull)[0]
    assert axis.get_yscale() == "linear"
    np.testing.assert_allclose(bars_of(axis)[:, 1:], np.column_stack([pull.low, pull.high]), rtol=1e-12)
    touches_nowhere = dataclasses.replace(curve, mean=curve.mean * [1, 1, 0])
    axis = drawn(comparison, touches_nowhere)[0]
    assert axis.get_ylim()[0] == pytest.approx(0.01 * curve.mean[:2].min())


# Panels, sign of the mean, and how far theory is: linear axes of pulls, exponents at the side.
ROOM = [(1, 1, 1.0), (5, 1, 1e6), (6, -1, 1.0), (7, -1, 1e6)]


@pytest.mark.parametrize(
    ("panels", "sign", "size"), [pytest.param(*x, marks=() if x[0] == 1 else pytest.mark.site) for x in ROOM]
)
def test_panels_of_a_comparison_have_room(comparison, panels, sign, size):
    names = (*QUANTITIES, "yielded", "load_slope")[:panels]
    one = comparison.curves["load"]
    mean, error = sign * 1e-12 * one.mean, 1e-13 * one.mean
    theory = mean * (1 + 0.01 * size)
    curve = Points(one.x, mean, 1e-13 * one.stderr, theory, mean - error, mean + error)
    figure = draw(
        inside.comparison_figure(dataclasses.replace(comparison, curves=dict.fromkeys(names, curve)))
    )
    assert len(figure.axes) == 2 * panels
    assert not crowded(figure)
    figure.axes[0].set_title("A title for which there is no room " * 9)  # which would be seen
    assert crowded(figure)
