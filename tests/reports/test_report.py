"""The report: every number of the page, read as a reader would, against numbers made here."""

import html
import re
from dataclasses import replace

import numpy as np
import pytest
from conftest import SURFACE
from oracles.inside import report_html, solved_pressures, typeset

import analytic
import mcgw
from mcgw.cli import main

H = (0.5, 0.0, 2.0, 1.0)
QUANTITIES = ("area", "contacts", "load", "conductance", "stiffness")
HEADINGS = (
    "real contact area (m²)", "number of contacts", "normal load (N)",
    "contact conductance, times the resistivity rho (m)", "normal stiffness (N/m)",
)  # fmt: skip
ATTRIBUTES = {
    "digest": "a1b2", "seed": 77, "sampler": "cells", "date": "2026-01-02", "versions": "mcgw 9 <x>",
    "commit": "c0ffee", "cpu": "A & B",
    "scene": 'title = "T"\n[contact]\nseparations = [\n    0.5,\n    0.0,\n]\n',
}  # fmt: skip


@pytest.fixture(scope="module", autouse=True)
def _not_drawn():
    """Figures are made, and neither laid out nor drawn; drawn pages are in the tier `site`."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mcgw.reports.html.svg_of", lambda panel, label: "<svg></svg>")
        patch.setattr("mcgw.reports.html._PRESSURES", 1)
        yield


@pytest.fixture(scope="module")
def scene(make_scene):
    """Heights that are not Gaussian, separations in no order, quantities in an order of their own."""
    law = analytic.ExponentialHeights()
    return make_scene(title="T", separations=H, heights=law, quantities=QUANTITIES, n_surfaces=50, seed=2)


@pytest.fixture(scope="module")
def small(scene):
    """A scene whose report costs little."""
    return scene.replace(quantities=("load",), separations=(0.5, 1.0), n_surfaces=12)


@pytest.fixture(scope="module")
def ensemble(scene):
    return mcgw.simulate(scene)


@pytest.fixture(scope="module")
def page(ensemble):
    return report_html(ensemble, ATTRIBUTES)


def facts(page):
    return dict(re.findall(r"<tr><td>(.*?)</td><td>(.*?)</td></tr>", page))


def test_the_surface(ensemble, page):
    """What its scene shows, the same in units of sigma, and contacts: heights s > 0."""
    s, found = ensemble.scene.surface, facts(page)
    area, radius, overlap = s.nominal_area / s.sigma**2, s.radius / s.sigma, s.eta * s.radius * s.sigma
    assert found["reduced"] == typeset(f"R/σ = {radius:.4g}, ηRσ = {overlap:.4g}, Aₙ/σ² = {area:.4g}")
    assert found["contacts"] == f"{3000 * np.exp(-1):.4g} expected at the smallest separation"
    for name, text in ensemble.scene.sheet().facts:
        assert not name or html.unescape(found[name]) == typeset(text)


def test_its_tables_are_those_of_the_comparison(ensemble, page):
    """Whose cells are read on a terminal: see `test_shown_numbers`; typeset here, under their headings."""
    tables = mcgw.compare(ensemble).tables()
    for heading, table in zip(HEADINGS, tables.values(), strict=True):
        assert re.search(rf"<h3>{re.escape(heading)}</h3><div[^>]*>{re.escape(table.rows().html())}", page)
    assert re.findall(r"<th>(.*?)</th>", table.html()) == [
        "d/σ", "mean", "95 % interval", "std", "theory", "residual"
    ]  # fmt: skip


def test_disagreement_is_shown_and_names_are_no_markup(small):
    stiffer = replace(SURFACE, E_star=1.1 * SURFACE.E_star)
    wrong = replace(mcgw.simulate(small), scene=small.replace(surface=stiffer, title="<b>&1"))
    page = report_html(wrong, ATTRIBUTES)
    assert '<p class="verdict bad">Monte Carlo and theory DISAGREE' in page
    assert "<h1>&lt;b&gt;&amp;1</h1>" in page


def test_provenance_and_the_scene_to_run_again(page, small, tmp_path):
    found = facts(page[page.index("<h2>Provenance") :])
    shown = {key: str(ATTRIBUTES[key]) for key in ATTRIBUTES if key != "scene"}
    assert {key: html.unescape(text) for key, text in found.items()} == shown
    assert "separations = [0.5, 0.0]" in page
    mcgw.run(small, tmp_path / "e.h5")
    assert main(["report", str(tmp_path / "e.h5")]) == 0
    again = (tmp_path / "e.html").read_text(encoding="utf-8")
    text = html.unescape(re.findall(r"<pre>(.*?)</pre>", again, flags=re.DOTALL)[-1])
    assert mcgw.scene_from(text) == small


def test_one_surface_where_no_pressure_is_common(small):
    page = report_html(mcgw.simulate(small, n_surfaces=1, separations=(1.0,)), ATTRIBUTES)
    assert "1 separation from" in page
    assert "At a given pressure" not in page
    assert "std over mean" not in page


def test_a_run_that_goes_on_has_a_report(small, tmp_path):
    path = tmp_path / "e.h5"
    mcgw.run(small.replace(n_surfaces=40), path, shard="1/2")
    assert main(["report", str(path), "-o", str(tmp_path / "e.html")]) == 0
    page = (tmp_path / "e.html").read_text(encoding="utf-8")
    assert f"{mcgw.open_ensemble(path).n_surfaces} rough surfaces" in page
    assert "none until it is complete" in page


def test_the_budget_at_a_pressure_and_the_corrected_answer(small):
    """Of Gaussian summits whose parameters are known to so much; the numbers are those of a search."""
    scene = small.replace(
        heights=analytic.Gaussian(), grading=analytic.Homogeneous(), n_surfaces=40,
        quantities=("load", "area", "stiffness"), uncertainty={"sigma": "20 %"}, separations=(0.8, 1.0, 1.2),
    )  # fmt: skip
    (found,) = solved_pressures(scene)
    searched = mcgw.solve(scene, load=found.amount)
    assert (found.theory, found.value) == (searched.theory, searched.value)
    budget = searched.budget()
    page = report_html(mcgw.simulate(scene), ATTRIBUTES)
    text = " ".join(html.unescape(re.sub("<[^>]+>", " ", page)).split())
    assert f"{budget.advice}." in text
    assert "best (95 %)" in text
    assert "Sources of error at this load" in text
    for line, share in budget.shares.items():
        assert f"{line} {share[0]:.2%}" in text
    assert typeset(f"{found.value['area']:.4g} ± {budget.all[0]:.1%}") in text
    assert solved_pressures(scene.replace(n_surfaces=1)) == []
