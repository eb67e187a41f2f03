"""Every number of the report's page, read as a reader would, against numbers made here."""

import dataclasses
import html
import re

import exact
import numpy as np
import pytest

import analytic
import mcgw
from mcgw.reports.html import report_html
from mcgw.scene.cautions import cautions
from mcgw.statistics.comparison import compare

LOWERED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
QUANTITIES = ("area", "contacts", "load", "conductance", "stiffness")
H = (0.5, 0.0, 2.0, 1.0)
HEADINGS = {
    "load": "Load (N)",
    "area": "Area (m²)",
    "stiffness": "Stiffness (N/m)",
    "contacts": "Contacts",
    "conductance": "Conductance (m)",
}
ATTRIBUTES = {
    "digest": "a1b2", "seed": 77, "sampler": "cells", "date": "2026-01-02", "versions": "mcgw 9 <x>",
    "commit": "c0ffee", "cpu": "A & B",
    "scene": 'title = "T"\n[contact]\nseparations = [\n    0.5,\n    0.0,\n]\n',
}  # fmt: skip


@pytest.fixture(scope="module")
def ensemble():
    from conftest import SURFACE

    scene = mcgw.Scene(
        surface=SURFACE,
        title="The title",
        separations=H,
        grading=analytic.Exponential(2.0),
        quantities=QUANTITIES,
        n_asperities=3000,
        n_surfaces=150,
        seed=2,
    )
    return mcgw.simulate(scene)


@pytest.fixture(scope="module")
def page(ensemble):
    return report_html(ensemble, ATTRIBUTES)


def value(text):
    """A number as the page writes it, 1.234×10⁻⁵, and what it was read from."""
    found = re.match(r"([-+−]?[\d.]+)(?:×10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?", text)
    assert found, text
    power = 10.0 ** int((found[2] or "⁰").translate(LOWERED))
    return float(found[1].replace("−", "-")) * power, found


def test_numbers_are_read_as_they_are_written():
    assert value("6.6982×10⁻¹⁷")[0] == pytest.approx(6.6982e-17)
    assert value("−6361.2")[0] == -6361.2


def test_tables(ensemble, page):
    sections = re.findall(r"<section><h3>(.*?)</h3>(.*?)</section>", page, flags=re.DOTALL)
    assert [heading for heading, _ in sections] == [HEADINGS[name] for name in QUANTITIES]
    curves = compare(ensemble).curves
    for (_, table), name in zip(sections, QUANTITIES, strict=True):
        assert re.findall(r"<th>(.*?)</th>", table) == ["d/σ", "mean", "± 95 %", "theory", "residual"]
        rows = [re.findall(r"<td>(.*?)</td>", row) for row in re.findall(r"<tr>(<td>.*?)</tr>", table)]
        assert [float(row[0]) for row in rows] == list(H)
        x = ensemble.values(name).astype(float)
        theory, stderr = exact.mean(ensemble.scene, name), exact.std(ensemble.scene, name) / np.sqrt(150)
        for k, (_, mean, error, shown, residual) in enumerate(rows):
            assert value(mean)[0] == pytest.approx(x[:, k].mean(), rel=1e-3)
            half = (curves[name].high[k] - curves[name].low[k]) / 2
            assert value(error)[0] == pytest.approx(half, rel=0.06)
            assert value(error)[0] == pytest.approx(1.976 * x[:, k].std(ddof=1) / np.sqrt(150), rel=0.2)
            assert value(shown)[0] == pytest.approx(theory[k], rel=6e-5)
            assert value(residual)[0] == pytest.approx((x[:, k].mean() - theory[k]) / stderr[k], abs=0.06)


def facts(page):
    return dict(re.findall(r"<tr><td>(.*?)</td><td>(.*?)</td></tr>", page))


def test_the_surface(ensemble, page):
    """Each fact with its unit, and the same in units of sigma."""
    s, found = ensemble.scene.surface, facts(page)
    expected = {
        "standard deviation σ of the summit heights": [(s.sigma, " m")],
        "summit radius R": [(s.radius, " m = "), (s.radius / s.sigma, " σ")],
        "summits per area η": [(s.eta, " m⁻²; ηRσ = "), (s.eta * s.radius * s.sigma, "")],
        "nominal area Aₙ": [(s.nominal_area, " m² = "), (s.nominal_area / s.sigma**2, " σ²")],
        "composite modulus E*": [(s.E_star, " Pa")],
        "contacts expected at the lowest separation": [(1500.0, "")],
    }
    for key, parts in expected.items():
        left = found[key]
        for number, after in parts:
            shown, match = value(left)
            assert shown == pytest.approx(number, rel=6e-4), key
            left = left[match.end() :]
            assert left.startswith(after), (key, left)
            left = left[len(after) :]
        assert left == ""
    assert found["grading E*(s)/E*"] == "exponential grading, γ = 2"


def test_words_and_verdict(ensemble, page):
    assert (
        "150 rough surfaces of 3000 asperities, exponential grading, γ = 2, each pressed on a plane at "
        "4 separations from d/σ = 0 to 2. Every asperity is a Hertz contact."
    ) in page
    verdict = compare(ensemble).verdict
    seen = f"chi-square {verdict.chi_square:.1f} for {verdict.degrees} degrees of freedom"
    assert f"theory of this model agree: {seen}" in page
    assert f"p = {verdict.p:.3g} (false alarms: 1 in 1000)" in page
    assert '<p class="verdict">' in page
    poisson = dataclasses.replace(ensemble.scene, count="poisson", separations=(1.0,), quantities=("load",))
    other = report_html(mcgw.simulate(poisson), ATTRIBUTES)
    assert "3000 asperities on average (a Poisson number)" in other
    assert "at 1 separation from" in other


def test_every_caution_is_there(ensemble, page):
    listed = [html.unescape(x) for x in re.findall(r"<li>(.*?)</li>", page, re.S)]
    assert listed[:-1] == cautions(ensemble.scene)
    assert listed[-1].startswith("every contact is elastic")


def test_provenance(page):
    found = facts(page[page.index("<h2>Provenance") :])
    shown = {key: str(ATTRIBUTES[key]) for key in ATTRIBUTES if key != "scene"}
    assert {key: html.unescape(text) for key, text in found.items()} == shown
    assert "separations = [0.5, 0.0]" in page


def test_figures_are_named_and_in_order(page):
    labels = re.findall(r'aria-label="([^"]*)"', page)
    long = [analytic.QUANTITIES[name].long_name for name in QUANTITIES]
    assert [html.unescape(x) for x in labels[-6:]] == [*long, "std over mean against separation"]
    assert [x.partition(" against")[0] for x in labels[:-6]] == [
        "Load: pressure at a separation",
        "Real contact area",
        "Normal stiffness",
        "Contact conductance times ρ",
    ]
    assert page.count("Monte Carlo, 95 %") >= len(QUANTITIES)


def test_many_separations_are_shown_from_the_first_to_the_last(ensemble):
    scene = dataclasses.replace(
        ensemble.scene, separations=tuple(np.linspace(0, 2, 33)), quantities=("load",)
    )
    page = report_html(mcgw.simulate(scene), ATTRIBUTES)
    (table,) = re.findall(r"<section>(.*?)</section>", page, flags=re.DOTALL)
    rows = re.findall(r"<tr><td>([^<]*)</td>", table)
    assert [float(h) for h in rows] == pytest.approx([0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2])
