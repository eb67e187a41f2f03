"""Thirteen height laws through everything that judges and shows, below, at and above their support.

What is printed of N, contacts and means is held to an independent integral over the density (or a plain
sum over measured heights); a separation that nothing reaches has mean and variance 0, and no warning.
"""

import re
from dataclasses import replace

import numpy as np
import pytest
from thirteen_height_laws import LAWS, SAMPLE

import mcgw
import mcgw.reports.html
from analytic import QUANTITIES, Exponential, Gaussian, MeasuredHeights
from mcgw.ensemble.forecast import forecast
from mcgw.reports.html import report_html
from mcgw.reports.text import comparison_table, summary, verdict_line
from mcgw.scene.cautions import cautions
from mcgw.statistics.comparison import compare
from mcgw.statistics.convergence import converge

BOUNDED = {name: law for name, law in LAWS.items() if np.isfinite(law.support[1])}
ATTRIBUTES = {
    "digest": "0", "seed": 1, "sampler": "cells", "date": "", "versions": "", "commit": "", "cpu": "",
    "scene": "", "complete": True, "wall_seconds": 1.0,
}  # fmt: skip
every_law = pytest.mark.parametrize("name", LAWS)


@pytest.fixture
def ensemble_of(make_scene):
    def make(name, separations, sampler="cells", **changes):
        own = {"sampler": sampler, "n_surfaces": 64, "n_asperities": 300}
        if name == "measured":
            own = {"sampler": "direct", "n_surfaces": 1, "n_asperities": SAMPLE.size}
        scene = make_scene(
            heights=LAWS[name], separations=separations, grading=Exponential(0.5), **(own | changes)
        )
        return mcgw.simulate(scene)

    return make


@pytest.fixture
def no_figures(monkeypatch):
    """A report without its drawings, which take a second each."""
    for name in ("comparison_figures", "means_figures", "patch_pictures", "pressure_pictures"):
        monkeypatch.setattr(mcgw.reports.html, name, lambda _: [])


def literal(scene, quantity, h):
    """Mean of a quantity by a composite rule of its own over the law's density; or a plain sum."""
    q, law = QUANTITIES[quantity], scene.heights
    unit = scene.n_asperities * q.scale(scene.surface)
    if isinstance(law, MeasuredHeights):
        s = np.array([x for x in law.heights if x > h])
        return unit / SAMPLE.size * float(np.sum((s - h) ** q.exponent * scene.grading(s) ** q.modulus))
    high = min(law.support[1], 1e5 if law is LAWS["t"] else 60.0)
    marks = [h, high, *law.breaks, *np.arange(-1, 14, 0.25), *np.geomspace(14, 1e5, 60)]
    roots = np.sqrt(np.unique([b for b in marks if h <= b <= high]) - h)  # s = h + v^2
    x, w = np.polynomial.legendre.leggauss(20)
    half = np.diff(roots)[:, None] / 2
    v = roots[:-1, None] + half * (1 + x)
    s = np.minimum(h + v * v, np.nextafter(high, h))
    terms = 2 * v ** (2 * q.exponent + 1) * scene.grading(s) ** q.modulus * law.density(s)
    return unit * float(np.sum(half * w * terms))


def around(law):
    """Separations below, at and above the support, where it has an end; else far out."""
    low, high = (end if np.isfinite(end) else far for end, far in zip(law.support, (-9.0, 40.0), strict=True))
    return low - 1, low, 0.5, high, high + 1


@every_law
def test_what_is_printed_is_the_theory_of_that_law(name, ensemble_of, no_figures):
    e = ensemble_of(name, (-0.3, 0.4, 1.1), "tail")
    scene, comparison = e.scene, compare(e)
    exact = {q: [literal(scene, q, h) for h in scene.separations] for q in scene.quantities}
    for q, curve in comparison.curves.items():
        np.testing.assert_allclose(curve.theory, exact[q], rtol=1e-8)
    rows = [line.split() for line in comparison_table(comparison).splitlines() if "..." in line]
    printed = [float(row[5]) for row in rows]
    assert printed == pytest.approx([x for q in scene.quantities for x in exact[q]], rel=1e-5)
    page = report_html(e, ATTRIBUTES)
    contacts = re.search(r"contacts expected at the lowest separation</td><td>([\d.]+)<", page)
    assert float(contacts[1]) == pytest.approx(exact["contacts"][0], rel=2e-3)
    assert f"of {scene.n_asperities} asperities" in summary(e, ATTRIBUTES)
    assert comparison.verdict.agrees


@every_law
def test_cautions_know_the_law(name, make_scene):
    """Half of all summits, few contacts, and the highest summit: each by the law's own shares."""
    h = tuple(np.linspace(-0.6, 1.4, 21))
    own = {"n_surfaces": 1, "sampler": "direct"} if name == "measured" else {}
    scene = make_scene(
        heights=LAWS[name], separations=h, n_asperities=SAMPLE.size, grading=Exponential(0.5), **own
    )
    text = "\n".join(cautions(scene))
    contacts = np.array([literal(scene, "contacts", x) for x in h])
    said = scene.validity(h).measured  # by the size of the error, in its place
    half = [x for x, n, k in zip(h, contacts, said, strict=True) if n > scene.n_asperities / 2 and not k]
    told = re.search(r"up to d/sigma = (\S+) more than half", text)
    assert (told is not None) == bool(half)
    assert not half or float(told[1]) == pytest.approx(max(half), rel=1e-2)
    few = [x for x, n in zip(h, contacts, strict=True) if n < 30]
    told = re.search(r"from d/sigma = (\S+) fewer than 30 contacts", text)
    assert (told is not None) == bool(few)
    assert not few or float(told[1]) == pytest.approx(min(few), rel=1e-2)


def test_negative_moduli_are_looked_for_as_far_as_the_law_reaches(make_scene):
    """E* is negative from s = 12 on, which exponential heights reach and Gaussian ones do not."""
    falling = Exponential(-1e-5)  # negative above ln(1 + 1e5) = 11.5
    for name, expected in (("exponential", True), ("gaussian", False), ("uniform", False)):
        scene = make_scene(heights=LAWS[name], separations=(1.0,), grading=falling, negative="clip")
        text = "\n".join(cautions(scene))
        assert ("modulus is negative" in text) == expected, name


@every_law
def test_theory_is_zero_where_nothing_touches(name, make_scene):
    law = LAWS[name]
    h = around(law)
    scene = make_scene(
        heights=Gaussian() if name == "measured" else law, separations=h, grading=Exponential(0.5)
    )
    model = replace(scene.theory, heights=law)
    for quantity in QUANTITIES:
        exact = model.cumulants(quantity, h)
        if np.isfinite(law.support[1]):
            assert np.all(exact.mean[3:] == 0)
            assert np.all(exact.variance[3:] == 0)
        assert np.all(exact.mean[:3] > 0)
        np.testing.assert_allclose(model.mean(quantity, h), exact.mean, rtol=1e-9, atol=1e-300)
    np.testing.assert_allclose(model.mean("contacts", h), model.number * law.above(np.array(h)), rtol=1e-9)


@every_law
@pytest.mark.parametrize("sampler", ["cells", "tail", "direct"])
def test_everything_takes_separations_around_the_support(name, sampler, ensemble_of, no_figures):
    """All separations together, and the highest by itself, in the three samplers."""
    if name == "measured" and sampler != "direct":
        return
    h = around(LAWS[name])
    for separations in (h, h[-1:]):
        e = ensemble_of(name, separations, sampler)
        comparison = compare(e)
        assert comparison.verdict.agrees
        report_html(e, ATTRIBUTES)
        cautions(e.scene)
        summary(e, ATTRIBUTES)
        verdict_line(comparison.verdict)
        for quantity, curve in comparison.curves.items():
            nothing = curve.theory == 0
            assert np.all(e.values(quantity)[:, nothing] == 0)
            assert np.all(curve.residual[nothing] == 0)
    if np.isfinite(LAWS[name].support[1]):
        assert (comparison.verdict.degrees, comparison.verdict.p) == (0, 1.0)


@pytest.mark.parametrize("name", sorted(set(BOUNDED) - {"measured"}))
def test_a_stop_rule_does_not_wait_for_what_never_touches(name, make_scene):
    h = around(LAWS[name])
    scene = make_scene(
        heights=LAWS[name],
        separations=h,
        n_asperities=300,
        n_surfaces=300,
        rel_err=0.1,
        grading=Exponential(0.5),
    )
    expected = forecast(scene)
    assert {x for _, x in expected.out_of_reach} == set(h[3:])
    with pytest.warns(UserWarning, match="more surfaces than max_surfaces allows"):
        ensemble = mcgw.simulate(scene)
    assert np.all(ensemble.load[:, 3:] == 0)
    with pytest.raises(ValueError, match=r"no height reaches d/sigma = .*: nothing touches"):
        converge(replace(scene, separations=h[3:], rel_err=None), seeds=2)


def test_a_figure_of_nothing_is_drawn(ensemble_of):
    """A report with its figures, where nothing at all touches: axes without a logarithm of 0."""
    page = report_html(ensemble_of("uniform", (3.0, 4.0), quantities=("load",)), ATTRIBUTES)
    assert page.count("<svg") == 2
