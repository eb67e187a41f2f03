"""Figures of a report by their numbers: the spread over surfaces, and curves at equal pressure."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from oracles import exact
from oracles.inside import pressure_panels, round_pressures, solved_pressures, spread, spread_panel

import analytic
import mcgw

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "10 mm^2", "78.6 GPa")


@pytest.fixture(scope="module")
def scene():
    h = [0.0, 0.5, 1.0, 1.5, 2.0]
    return mcgw.Scene(SURFACE, separations=h, n_surfaces=12, seed=1, joint=mcgw.Joint(resistivity=0.07))


def test_spread_is_std_over_mean(make_scene):
    """Of the surfaces, and exact by quadrature over the heights."""
    h, names = (1.0, 0.0, 2.0), ("load", "contacts")
    heights = analytic.ExponentialHeights()
    ensemble = mcgw.simulate(
        make_scene(separations=h, heights=heights, quantities=names, n_surfaces=60, seed=4)
    )
    for series, name in zip(spread_panel("", ensemble, np.sort(h)).series, names, strict=True):
        values = ensemble.values(name).astype(float)
        assert series.label == name
        np.testing.assert_array_equal(series.points.x, h)
        np.testing.assert_allclose(
            series.points.mean, values.std(axis=0, ddof=1) / values.mean(axis=0), rtol=1e-10
        )
        ratio = exact.std(ensemble.scene, name) / exact.mean(ensemble.scene, name)
        np.testing.assert_allclose(series.points.theory, ratio, rtol=1e-7)
        np.testing.assert_array_equal(series.x, np.sort(h))
        np.testing.assert_allclose(series.theory, ratio[np.argsort(h)], rtol=1e-7)


def test_error_of_std_over_mean_is_that_of_repetitions(make_scene):
    """400 ensembles of 100 surfaces: their deviation is known to 3.5 %, so 15 % is four of that."""
    scene = make_scene(separations=[0.0, 2.0], n_surfaces=40_000, seed=9, quantities=("load",))
    drawn = mcgw.simulate(scene)
    values = drawn.load.reshape(400, 100, 2)
    ratio = values.std(axis=1, ddof=1) / values.mean(axis=1)
    told = spread("a", scene, "load", np.array([0.0, 2.0]), drawn).points.stderr
    np.testing.assert_allclose(20 * told, ratio.std(axis=0), rtol=0.15)


@pytest.fixture(autouse=True)
def _few_pressures(pressures):
    pressures(2)


def test_curves_are_values_and_scatter_of_solve_on_theory(scene):
    """The line is that of an infinite surface: of the means of theory at its own separation."""
    solved, area = solved_pressures(scene), SURFACE.nominal_area
    expected = [
        ("Load: pressure at a separation", "separation d/σ", "separation", 1.0),
        ("Real contact area", "A/Aₙ (%)", "area", 100 / area),
        ("Normal stiffness", "K/Aₙ (MPa/µm)", "stiffness", 1e-12 / area),
        ("Contact conductance", "C/Aₙ (S/m²)", "conductance_si", 1 / area),
    ]
    for (about, panel), (title, label, name, factor) in zip(pressure_panels(solved), expected, strict=True):
        assert about.startswith(f"{title} against nominal pressure from ")
        (series,) = panel.series
        assert (panel.title, panel.ylabel) == (title, label)
        pressure = [1e-6 * x.amount / area for x in solved]
        told = pressure, [factor * x.value[name] for x in solved], [factor * x.std[name] for x in solved]
        for given, wanted in zip(panel.paint.args, told, strict=True):
            np.testing.assert_allclose(given, wanted, rtol=1e-12)
        panel.paint(axis := Figure().subplots())
        assert axis.get_legend_handles_labels()[1] == ["specimens: mean, std"]
        ends = [factor * x.theory[name] for x in (solved[0], solved[-1])]
        np.testing.assert_allclose(series.theory[[0, -1]], ends, rtol=1e-9)
        np.testing.assert_allclose(series.x[[0, -1]], [pressure[0], pressure[-1]], rtol=1e-9)


def test_pressures_of_a_page_are_round():
    for *ends, found in (
        (1.1e6, 1.9e6, [1.1e6, 1.9e6]), (3e-2, 0.2, [0.05, 0.1, 0.2]), (1e3, 1e7, [1e3, 1e4, 1e5, 1e6, 1e7]),
    ):  # fmt: skip
        assert round_pressures(*ends, 5) == pytest.approx(found)


FLAT = ({"separations": 1.0}, {"separations": [8.0, 9.0]}, {"quantities": ["contacts"], "joint": None})


@pytest.mark.parametrize("changes", [*FLAT, {"n_surfaces": 1}])
def test_there_are_no_curves_where_no_pressures_are_spanned(scene, changes):
    assert solved_pressures(scene.replace(**changes)) == []
    assert list(pressure_panels([])) == []


@pytest.mark.slow
def test_curves_rise_with_the_pressure_where_adhesion_lets_a_load_fall_below_0(scene):
    attracting = scene.replace(law=mcgw.DerjaguinMullerToporov(pull_off=0.3))
    curves = [panel for _, panel in pressure_panels(solved_pressures(attracting))]
    assert len(curves) >= 4
    for panel in curves:
        _, mean, std = panel.paint.args
        for values in (mean, panel.series[0].theory):
            rising = -1 if "separation" in panel.ylabel else 1
            assert np.all(rising * np.diff(values) > 0), panel.title
        assert np.all(std > 0)
