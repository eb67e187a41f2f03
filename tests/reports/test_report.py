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
        patch.setattr("mcgw.reports.report_figures.svg_of", lambda panel, label: "<svg></svg>")
        patch.setattr("mcgw.reports.report_figures._PRESSURES", 1)
        yield


@pytest.fixture(scope="module")
def scene():
    """Heights that are not Gaussian, separations in no order, quantities in an order of their own."""
    return mcgw.Scene(
        surface=SURFACE,
        title="The title",
        separations=H,
        grading=analytic.Exponential(2.0),
        heights=analytic.ExponentialHeights(),
        contact=mcgw.Contact(quantities=QUANTITIES),
        ensemble=mcgw.Sampling(n_asperities=3000),
        n_surfaces=150,
        seed=2,
    )


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


def page_of(scene, **changes):
    return report_html(mcgw.simulate(scene, **changes), ATTRIBUTES)


def facts(page):
    return dict(re.findall(r"<tr><td>(.*?)</td><td>(.*?)</td></tr>", page))


# --- numbers ------------------------------------------------------------------------------------------


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


# --- words that depend on the ensemble ------------------------------------------------------------------


def test_disagreement_is_shown_and_names_are_no_markup(small):
    stiffer = replace(SURFACE, E_star=1.1 * SURFACE.E_star)
    wrong = replace(mcgw.simulate(small), scene=small.replace(surface=stiffer, title="<b>&1"))
    page = report_html(wrong, ATTRIBUTES)
    assert '<p class="verdict bad">Monte Carlo and theory DISAGREE' in page
    assert "<h1>&lt;b&gt;&amp;1</h1>" in page


def test_cautions_are_those_of_the_scene(small):
    """Two that a hand can tell: exp(-h - 1) of the heights lie above h; moduli 1 - 0.3 s fall below 0."""

    deep = small.replace(grading=lambda s: 1 - 0.3 * s, negative="clip", separations=(-0.5, 1.0))
    plain, told = (
        [html.unescape(x) for x in re.findall(r"<li>(.*?)</li>", page_of(scene), re.DOTALL)]
        for scene in (small, deep)
    )
    for caution in (
        "up to d/sigma = -0.5 more than half of all asperities touch",
        "the modulus is negative at heights that touch (set to zero)",
    ):
        assert sum(line.startswith(caution) for line in told) == 1
        assert not [line for line in plain if line.startswith(caution[:20])]
    assert plain[-1].startswith("every contact is elastic")


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
    page = page_of(small, n_surfaces=1, separations=(1.0,))
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


# --- contact laws ---------------------------------------------------------------------------------------


METAL = {
    "law": mcgw.KogutEtsion(critical=0.05),
    "unload_from": "loop",
    "joint": mcgw.Joint(resistivity=1e-7, film_resistance=1e-14),
}


def test_the_contact_law_and_its_rivals_are_in_the_report(make_scene, page):
    """Ratios of the means at h = 1 from physics.md: Chang .0532829, Kogut .0534662, Zhao .0487678."""
    scene = make_scene(
        n_surfaces=5,
        separations=(0.5, 1.0, 2.0),
        grading=analytic.Homogeneous(),
        quantities=("load",),
        **METAL,
    )
    ensemble = mcgw.simulate(scene)
    told = report_html(ensemble, ATTRIBUTES)
    assert "KogutEtsion(critical=0.05, poisson=0.3)" in told
    assert "film 1×10⁻¹⁴ ohm m²" in told
    rows = dict(re.findall(r"<tr><td>(chang-etsion-bogy|zhao-maietta-chang)</td><td>([^<]+)</td>", told))
    for name, mean in (
        ("chang-etsion-bogy", 0.05328285176044976),
        ("zhao-maietta-chang", 0.04876778006841703),
    ):
        assert float(rows[name]) == pytest.approx(mean / 0.05346624148043353, rel=1e-4)
    share = re.search(r"([\d.]+) % of the contacts have yielded at", told)[1]
    gone = analytic.contacts(SURFACE, 0.55) / analytic.contacts(SURFACE, 0.5)
    assert float(share) / 100 == pytest.approx(float(gone), abs=1e-3)
    assert "every contact is elastic" not in told
    assert "Other contact laws" not in page  # Hertz has no rivals
    for shown in (ensemble, scene):
        assert "contact law  KogutEtsion(critical=0.05, poisson=0.3)" in repr(shown)
        assert "resistivity 1e-07 ohm m, film 1e-14 ohm m^2" in repr(shown)


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
    assert "Sources of error at this load" not in page_of(scene, n_surfaces=1)
