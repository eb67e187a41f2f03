"""What a report shows at equal pressure, of one surface, and of ensembles of every kind."""

import html
import re

import numpy as np
import pytest

import mcgw
from mcgw.cli import main
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import MemoryResults
from mcgw.figures.patch import patch_figures
from mcgw.figures.pressure_curves import pressure_curves, pressure_figure
from mcgw.reports.html import report_html

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "10 mm^2", "78.6 GPa")
ATTRIBUTES = dict.fromkeys(("digest", "sampler", "date", "versions", "commit", "cpu", "scene"), "-")


@pytest.fixture(scope="module")
def scene():
    return mcgw.Scene(
        SURFACE,
        separations=[0.0, 0.5, 1.0, 1.5, 2.0],
        n_surfaces=12,
        seed=1,
        film=mcgw.Film(resistivity=0.07),
    )


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
    found = {c.title: c for c in pressure_curves(Ensemble(scene, "cells", MemoryResults(rows)))}
    per_area = 1 / SURFACE.nominal_area
    for title, scale, power in (
        ("Real contact area", 100 * 1e-9 * per_area, 0.9),
        ("Normal stiffness", 1e-12 * 1e6 * per_area, 0.8),
        ("Contact conductance", 0.3 * per_area, 0.95),
    ):
        curve = found[title]
        exact = scale * factor * (1e6 * curve.pressure * SURFACE.nominal_area) ** power
        np.testing.assert_allclose(curve.mean, exact.mean(axis=0), rtol=1e-10)
        low, high = curve.band
        np.testing.assert_allclose(low, np.quantile(exact, 0.05, axis=0), rtol=1e-10)
        np.testing.assert_allclose(high, np.quantile(exact, 0.95, axis=0), rtol=1e-10)
    curve = found["Load: pressure at a separation"]
    exact = np.log(50.0 * own / (1e6 * curve.pressure * SURFACE.nominal_area)) / 2
    np.testing.assert_allclose(curve.mean, exact.mean(axis=0), atol=1e-10)
    pressures = 1e-6 * per_area * load
    assert curve.pressure[[0, -1]] == pytest.approx(
        [pressures[:, -1].max(), pressures[:, 0].min()], rel=1e-12
    )


def test_axes_are_of_mpa_and_of_powers_of_ten(scene):
    for curve in pressure_curves(mcgw.simulate(scene)):
        (axes,) = pressure_figure(curve).axes
        assert axes.get_xlabel() == "nominal pressure P/Aₙ (MPa)"
        assert axes.get_xscale() == "log"
        assert axes.get_yscale() == ("linear" if "separation" in curve.label else "log")
        texts = [text.get_text() for text in axes.get_legend().get_texts()]
        assert texts == ["5 to 95 % of the surfaces", "mean"]


@pytest.mark.parametrize("changes", [{"n_surfaces": 1}, {"sampler": "stratified"}])
def test_there_is_no_band_where_there_are_not_several_surfaces(scene, changes):
    curves = pressure_curves(mcgw.simulate(scene, **changes))
    assert len(curves) == 4
    assert all(curve.band is None for curve in curves)


@pytest.mark.parametrize(
    "changes", [{"separations": 1.0}, {"separations": [8.0, 9.0]}, {"quantities": ["contacts"], "film": None}]
)
def test_where_no_pressure_is_common_there_is_no_such_section(scene, changes):
    ensemble = mcgw.simulate(scene, **changes)
    assert pressure_curves(ensemble) == []
    assert "At a given pressure" not in report_html(ensemble, ATTRIBUTES)


def test_contacts_of_the_picture_are_those_of_the_file(scene):
    """Surface 0, at the separation of the scene where the share that touches is nearest to 0.3."""
    ensemble = mcgw.simulate(scene)
    found = patch_figures(scene)
    k = scene.separations.index(found.separation)
    assert found.contacts == ensemble.contacts[0, k]
    assert found.separation == 0.5  # 0.31 of a Gaussian's summits are above
    many = patch_figures(scene.replace(nominal_area="1 m^2"))
    assert not many.whole
    assert many.contacts == pytest.approx(0.31 * 20_000, rel=0.05)
    assert patch_figures(scene.replace(sampler="aggregate")) is None


def test_stratified_surfaces_have_a_report_of_means(scene):
    page = report_html(mcgw.simulate(scene, sampler="stratified"), ATTRIBUTES)
    assert "These are stratified surfaces: their means serve, nothing tests them against theory." in page
    assert "<th>d/σ</th><th>mean</th><th>theory</th></tr>" in page
    assert "residual" not in page
    assert "band" not in page


def test_a_scene_that_was_fitted_names_its_map(scene):
    fitted = scene.replace(title="Fitted to plate<1>.x3p: form taken off: plane; cutoff: none", n_surfaces=2)
    page = report_html(mcgw.simulate(fitted), ATTRIBUTES)
    assert "A synthetic twin of plate<1>.x3p." in html.unescape(page)
    assert "plate<1>" not in page
    assert "A synthetic twin" not in report_html(mcgw.simulate(scene, n_surfaces=2), ATTRIBUTES)


def test_the_verdict_is_two_sentences_at_the_top(scene):
    page = report_html(mcgw.simulate(scene), ATTRIBUTES)
    top = re.search(r'</h1>\s*<p class="verdict">(.*?)</p>', page, flags=re.DOTALL)[1]
    first, second = (html.unescape(line) for line in top.split("<br>\n"))
    assert first.startswith("Monte Carlo and theory of this model agree: ")
    assert first.endswith("(false alarms: 1 in 1000).")
    assert second == f"{scene.validity().verdict}."


def test_a_run_that_goes_on_has_a_report(scene, tmp_path):
    path = tmp_path / "e.h5"
    mcgw.run(scene.replace(n_surfaces=40), path, shard="1/2")
    assert not path.exists()
    assert main(["report", str(path), "-o", str(tmp_path / "e.html")]) == 0
    page = (tmp_path / "e.html").read_text(encoding="utf-8")
    assert f"{mcgw.open_ensemble(path).n_surfaces} rough surfaces" in page
    assert "none before it is complete" in page


def test_a_damaged_file_is_one_line(scene, tmp_path, capsys):
    path = tmp_path / "e.h5"
    mcgw.run(scene, path)
    path.write_bytes(path.read_bytes()[:-3000])
    capsys.readouterr()
    assert main(["report", str(path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not path.with_suffix(".html").exists()


KINDS = [
    {"law": mcgw.KogutEtsion(critical=0.05), "unload_from": "loop"},
    {"law": mcgw.DerjaguinMullerToporov(pull_off=0.3)},
    {"interaction": {"reference": "mean-plane", "at": "effective"}},
    {"count": "poisson", "grading": mcgw.Exponential(0.5)},
]


@pytest.mark.parametrize("changes", KINDS, ids=lambda x: next(iter(x)))
def test_every_kind_has_its_curves(scene, changes):
    """Positive and rising with the pressure, also where adhesion lets a load fall below 0."""
    curves = pressure_curves(mcgw.simulate(scene, **changes))
    assert len(curves) >= 4
    for curve in curves:
        rising = -1 if "separation" in curve.label else 1
        assert np.all(rising * np.diff(curve.mean) > 0), curve.title
        assert np.all(curve.band[0] <= curve.mean)
        assert np.all(curve.mean <= curve.band[1])
