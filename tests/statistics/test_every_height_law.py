"""Thirteen height laws through everything that judges and shows, below, at and above their support.

What is printed of N, contacts and means is held to an independent integral over the density (or a plain
sum over measured heights); a separation that nothing reaches has mean and variance 0, and no warning.
"""

import re
from dataclasses import replace

import numpy as np
import pytest
from conftest import SURFACE
from oracles import exact
from oracles.inside import (
    cautions,
    comparison_text,
    forecast,
    report_html,
    spread_of,
    summary,
)
from oracles.thirteen_height_laws import LAWS, SAMPLE

import analytic
import mcgw
from analytic import QUANTITIES, Exponential, Gaussian, MeasuredHeights
from mcgw import compare, converge

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
    terms = 2 * v ** (2 * q.exponent + 1) * scene.grading(s) ** q.modulus * law.pdf(s)
    return unit * float(np.sum(half * w * terms))


def around(law):
    """Separations below, at and above the support, where it has an end; else far out."""
    low, high = (end if np.isfinite(end) else far for end, far in zip(law.support, (-9.0, 40.0), strict=True))
    return low - 1, low, 0.5, high, high + 1


@every_law
def test_what_is_printed_is_the_theory_of_that_law(name, ensemble_of):
    e = ensemble_of(name, (-0.3, 0.4, 1.1), "tail")
    scene, comparison = e.scene, compare(e)
    exact = {q: [literal(scene, q, h) for h in scene.separations] for q in scene.quantities}
    for q, curve in comparison.curves.items():
        np.testing.assert_allclose(curve.theory, exact[q], rtol=1e-8)
    rows = [line.split() for line in comparison_text(comparison).splitlines() if "..." in line]
    printed = [float(row[6]) for row in rows]
    error = np.concatenate([comparison.curves[q].stderr for q in scene.quantities])
    expected = np.concatenate([exact[q] for q in scene.quantities])
    assert np.all(np.abs(printed - expected) <= 0.06 * error)  # its second digit
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
    np.testing.assert_allclose(model.mean("contacts", h), model.number * law.sf(np.array(h)), rtol=1e-9)


AROUND = [  # laws with one end, with two and with none in each of the three samplers
    ("gaussian", "direct"), ("exponential", "cells"), ("exponential", "tail"), ("exponential", "direct"),
    ("weibull 1.5", "tail"), ("weibull 3.6", "tail"), ("nayak", "cells"), ("table", "cells"),
    ("measured", "direct"), ("uniform", "cells"), ("uniform", "tail"), ("uniform", "direct"),
    ("beta", "tail"), ("lognormal", "cells"), ("gamma", "tail"), ("t", "cells"), ("triangle", "direct"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "sampler"), AROUND)
def test_everything_takes_separations_around_the_support(name, sampler, ensemble_of):
    """All separations together, and the highest by itself."""
    h = around(LAWS[name])
    for separations in (h, h[-1:]):
        e = ensemble_of(name, separations, sampler)
        comparison = compare(e)
        assert comparison.verdict.agrees
        assert summary(e, ATTRIBUTES)
        cautions(e.scene)
        assert comparison.verdict.line
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
        heights=LAWS[name], separations=h, n_asperities=300, n_surfaces=300, rel_err=0.1,
        grading=Exponential(0.5),
    )  # fmt: skip
    expected = forecast(scene)
    assert {x for _, x in expected.out_of_reach} == set(h[3:])
    with pytest.warns(UserWarning, match="more surfaces than n_surfaces allows"):
        ensemble = mcgw.simulate(scene)
    assert np.all(ensemble.load[:, 3:] == 0)
    with pytest.raises(ValueError, match=r"no height reaches d/sigma = .*, so there is nothing to test"):
        converge(scene.replace(separations=h[3:], rel_err=None), seeds=2)


def test_a_figure_of_nothing_is_drawn(ensemble_of):
    """A report with its figures, where nothing at all touches: axes without a logarithm of 0."""
    page = report_html(ensemble_of("uniform", (3.0, 4.0), quantities=("load",)), ATTRIBUTES)
    assert page.count("<svg") == 2


NAMES = tuple(analytic.QUANTITIES)


@pytest.fixture(scope="module")
def scene():
    return mcgw.Scene(
        surface=SURFACE,
        separations=(1.5, 0.0, 0.5),
        grading=analytic.Exponential(2.0),
        heights=analytic.ExponentialHeights(),
        contact=mcgw.Contact(quantities=NAMES),
        ensemble=mcgw.Sampling(n_asperities=3000),
        n_surfaces=300,
        seed=6,
    )


def test_forecast(scene):
    for name in NAMES:
        spread = exact.std(scene, name) / exact.mean(scene, name)
        np.testing.assert_allclose(spread_of(scene, name).relative, spread, rtol=1e-7)
    found = forecast(scene.replace(rel_err=0.01, n_surfaces=10**6))
    plain = (1.959963984540054 / 0.01 * exact.std(scene, "load") / exact.mean(scene, "load")) ** 2
    needed = found.needed["load"]
    assert np.all((plain < needed) & (needed < 1.01**2 * plain))  # an end 1 % away, of either of the two
    most = max(float(n.max()) for n in found.needed.values())
    assert most <= found.surfaces <= 1.07 * most + 64
