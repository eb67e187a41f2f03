"""Figures of a report by their numbers: the spread over surfaces, curves at equal pressure, and a patch."""

import re

import exact
import numpy as np
import pytest
from conftest import SURFACE as COARSE

import analytic
import mcgw
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import MemoryResults
from mcgw.figures.panels import draw
from mcgw.reports.html import solution_of
from mcgw.reports.report_figures import _relative_error, _spread, line_figure, pressure_curves
from mcgw.statistics.comparison import compare

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "10 mm^2", "78.6 GPa")


@pytest.fixture(scope="module")
def scene():
    return mcgw.Scene(
        SURFACE,
        separations=[0.0, 0.5, 1.0, 1.5, 2.0],
        n_surfaces=12,
        seed=1,
        film=mcgw.Film(resistivity=0.07),
    )


def test_spread_is_std_over_mean():
    """Of the surfaces, and exact by quadrature over the heights."""
    h, names = (1.0, 0.0, 2.0), ("load", "area", "stiffness", "contacts", "conductance")
    ensemble = mcgw.simulate(
        mcgw.Scene(
            COARSE, separations=h, grading=analytic.Exponential(2.0), heights=analytic.ExponentialHeights(),
            quantities=names, n_asperities=3000, n_surfaces=60, seed=4,
        )
    )  # fmt: skip
    data = _spread(compare(ensemble))
    (panel,) = data.panels
    assert (panel.xlabel, panel.ylabel, panel.scales) == (
        "separation d/σ", "std / mean", ("linear", "log")
    )  # fmt: skip
    assert [series.label for series in panel.series] == list(names)
    for series, name in zip(panel.series, names, strict=True):
        values = ensemble.values(name).astype(float)
        ratio = values.std(axis=0, ddof=1) / values.mean(axis=0)
        np.testing.assert_array_equal(series.points.x, h)
        np.testing.assert_allclose(series.points.mean, ratio, rtol=1e-10)
        spread = exact.std(ensemble.scene, name) / exact.mean(ensemble.scene, name)
        np.testing.assert_allclose(series.points.exact, spread, rtol=1e-7)
        np.testing.assert_array_equal(series.x, np.sort(h))
        np.testing.assert_allclose(series.theory, spread[np.argsort(h)], rtol=1e-7)
    # One drawn of many: each id of a page is there once, and an SVG takes the width it is given.
    one, two = (line_figure(draw(data), label).svg for label in ("one name", "two"))
    ids = [set(re.findall(r'\bid="([^"]+)"', svg)) for svg in (one, two)]
    assert ids[0]
    assert not ids[0] & ids[1]
    assert set(re.findall(r'(?:href="|url\()#([^")]+)', one)) <= ids[0]
    assert not re.search(r' (width|height)="', one.partition(">")[0])
    assert "separation d/σ" in one


def test_error_of_std_over_mean_is_that_of_repetitions(make_scene):
    """400 ensembles of 100 surfaces: their deviation is known to 3.5 %, so 15 % is four of that."""
    scene = make_scene(separations=[0.0, 2.0], n_surfaces=40_000, seed=9, quantities=("load",))
    values = mcgw.simulate(scene).load.reshape(400, 100, 2)
    ratio = values.std(axis=1, ddof=1) / values.mean(axis=1)
    told = _relative_error(scene, "load") * exact.std(scene, "load") / exact.mean(scene, "load")
    np.testing.assert_allclose(told / np.sqrt(100), ratio.std(axis=0), rtol=0.15)


def test_curves_are_those_of_surfaces_whose_laws_are_known(scene):
    """Loads p_i exp(-2 h), areas k_i P^0.9: at equal pressure each area, and so mean and band, is known."""
    h = np.array(scene.separations)
    rng = np.random.default_rng(3)
    own, factor = rng.uniform(0.8, 1.2, size=(2, 12, 1))
    load = 50.0 * own * np.exp(-2 * h)
    rows = {
        "load": load, "area": 1e-9 * factor * load**0.9, "stiffness": 1e6 * factor * load**0.8,
        "contacts": load, "conductance_si": 0.3 * factor * load**0.95,
    }  # fmt: skip
    first, *others = pressure_curves(Ensemble(scene, "cells", MemoryResults(rows)))
    area = SURFACE.nominal_area
    expected = [
        ("Real contact area", "A/Aₙ (%)", 100 * 1e-9 / area, 0.9),
        ("Normal stiffness", "K/Aₙ (MPa/µm)", 1e-12 * 1e6 / area, 0.8),
        ("Contact conductance", "C/Aₙ (S/m²)", 0.3 / area, 0.95),
    ]
    for curve, (title, label, scale, power) in zip(others, expected, strict=True):
        (panel,) = curve.panels
        (series,) = panel.series
        assert (panel.title, panel.ylabel) == (title, label)
        exact_curves = scale * factor * (1e6 * series.x * area) ** power
        np.testing.assert_allclose(series.theory, exact_curves.mean(axis=0), rtol=1e-10)
        for side, q in zip(series.band, (0.05, 0.95), strict=True):
            np.testing.assert_allclose(side, np.quantile(exact_curves, q, axis=0), rtol=1e-10)
    ((panel,), (series,)) = first.panels, first.panels[0].series
    assert (panel.title, panel.ylabel) == ("Load: pressure at a separation", "separation d/σ")
    separations = np.log(50.0 * own / (1e6 * series.x * area)) / 2
    np.testing.assert_allclose(series.theory, separations.mean(axis=0), atol=1e-10)
    ends = 1e-6 / area * np.array([load[:, -1].max(), load[:, 0].min()])
    assert series.x[[0, -1]] == pytest.approx(ends, rel=1e-12)
    figure = draw(first)
    (axes,) = figure.axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("nominal pressure P/Aₙ (MPa)", "separation d/σ")
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "linear")
    assert figure.get_supxlabel() == "Line: mean. Band: 5 to 95 % of the surfaces."
    (axes,) = draw(others[0]).axes
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), others[0].panels[0].series[0].theory)


def test_there_is_no_band_where_there_are_not_several_surfaces(scene):
    curves = pressure_curves(mcgw.simulate(scene, n_surfaces=1))
    assert len(curves) == 4
    assert all(curve.panels[0].series[0].band is None for curve in curves)
    assert {curve.caption for curve in curves} == {"Line: mean."}


@pytest.mark.parametrize(
    "changes", [{"separations": 1.0}, {"separations": [8.0, 9.0]}, {"quantities": ["contacts"], "film": None}]
)
def test_there_are_no_curves_where_no_pressure_is_common(scene, changes):
    ensemble = mcgw.simulate(scene, **changes)
    assert pressure_curves(ensemble) == []
    assert solution_of(ensemble.scene, ensemble) is None


KINDS = [
    {"law": mcgw.KogutEtsion(critical=0.05), "unload_from": "loop"},
    {"law": mcgw.DerjaguinMullerToporov(pull_off=0.3)},
    {"interaction": {"reference": "mean-plane"}},
    {"count": "poisson", "grading": mcgw.Exponential(0.5)},
    {"film": mcgw.Film(conductivities=(200.0, 16.0)), "joint": mcgw.Joint("air", rms=2e-6)},
]


@pytest.mark.parametrize("changes", KINDS, ids=lambda x: next(iter(x)))
def test_every_kind_has_its_curves(scene, changes):
    """Positive and rising with the pressure, also where adhesion lets a load fall below 0."""
    curves = pressure_curves(mcgw.simulate(scene, **changes))
    assert len(curves) >= 4
    for curve in curves:
        (panel,) = curve.panels
        (series,) = panel.series
        rising = -1 if "separation" in panel.ylabel else 1
        assert np.all(rising * np.diff(series.theory) > 0), panel.title
        assert np.all(series.band[0] <= series.theory)
        assert np.all(series.theory <= series.band[1])


def test_the_band_of_separations_is_that_of_the_exact_law(scene):
    """A probability of 0.05 and 0.95 at its ends, to what a straight line between separations misses."""
    asked = scene.replace(separations=np.linspace(1.0, 2.5, 31), n_surfaces=200)
    (series,) = pressure_curves(mcgw.simulate(asked))[0].panels[0].series
    for k in (5, 30, 55):
        law = asked.theory.separation_law(1e6 * series.x[k] * asked.surface.nominal_area)
        ends = [float(side[k]) for side in series.band]
        np.testing.assert_allclose(law.cdf(ends), [0.05, 0.95], atol=3e-3)
