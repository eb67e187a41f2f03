"""Heights that are not Gaussian: everything that judges, forecasts or shows takes the scene's own law."""

import dataclasses
import re

import exact
import numpy as np
import pytest
from oracles import POWERS, factor

import analytic
import mcgw
from mcgw.ensemble.forecast import forecast, relative_spread
from mcgw.ensemble.solution import solutions
from mcgw.reports.html import report_html
from mcgw.reports.plan import plan_of
from mcgw.scene.cautions import cautions
from mcgw.statistics.comparison import compare
from mcgw.statistics.convergence import converge

QUANTITIES = tuple(analytic.QUANTITIES)
LAWS = {"exponential": analytic.ExponentialHeights(), "weibull": analytic.Weibull(1.564)}


def scene_of(law):
    from conftest import SURFACE

    return mcgw.Scene(
        surface=SURFACE,
        separations=(1.5, 0.0, 0.5),
        grading=analytic.Exponential(2.0),
        heights=LAWS[law],
        quantities=QUANTITIES,
        n_asperities=3000,
        n_surfaces=300,
        seed=6,
    )


@pytest.fixture(scope="module", params=LAWS)
def scene(request):
    return scene_of(request.param)


@pytest.fixture(scope="module")
def ensemble(scene):
    return mcgw.simulate(scene)


def test_the_oracle_knows_the_law(scene):
    """Means of the law itself, and that it is far from Gaussian: the companion of all that follows."""
    assert exact.heights_of(scene).stats() == (pytest.approx(0, abs=1e-12), pytest.approx(1))
    gaussian = dataclasses.replace(scene, heights=analytic.Gaussian())
    apart = exact.mean(scene, "load") / exact.mean(gaussian, "load") - 1
    assert np.abs(apart).max() > 0.2


def test_compare(scene, ensemble):
    found = compare(ensemble)
    assert found.verdict.agrees
    assert found.verdict.degrees == 15
    for name, curve in found.curves.items():
        mean, stderr = exact.mean(scene, name), exact.std(scene, name) / np.sqrt(scene.n_surfaces)
        np.testing.assert_allclose(curve.theory, mean, rtol=1e-9)
        np.testing.assert_allclose(curve.stderr, stderr, rtol=1e-7)
        expected = (ensemble.values(name).mean(axis=0) - mean) / stderr
        np.testing.assert_allclose(curve.residual, expected, atol=1e-5)
        assert np.abs(curve.residual).max() < 5


def test_compare_with_another_law_disagrees(scene, ensemble):
    gaussian = dataclasses.replace(scene, heights=analytic.Gaussian())
    assert not compare(dataclasses.replace(ensemble, scene=gaussian)).verdict.agrees


def test_forecast(scene):
    for name in QUANTITIES:
        spread = exact.std(scene, name) / exact.mean(scene, name)
        np.testing.assert_allclose(relative_spread(scene, name), spread, rtol=1e-7)
    found = forecast(dataclasses.replace(scene, rel_err=0.01, n_surfaces=10**6))
    plain = (1.959963984540054 / 0.01 * exact.std(scene, "load") / exact.mean(scene, "load")) ** 2
    needed = found.needed["load"]
    assert np.all((plain < needed) & (needed < 1.01**2 * plain))  # an end 1 % away, of either of the two
    most = max(float(n.max()) for n in found.needed.values())
    assert most <= found.surfaces <= 1.07 * most + 64


def test_plan(scene):
    assert plan_of(scene).touching == pytest.approx(3000 * exact.share_above(scene, 0.0), rel=1e-12)


@pytest.mark.parametrize("law", ["exponential", pytest.param("weibull", marks=pytest.mark.slow)])
def test_solve(law):
    """Theory by the oracle; the mean over 300 surfaces within 5 standard errors and the 1/N of 3000."""
    scene, given = scene_of(law), "load"
    value = exact.mean(scene, given, [0.7])[0]
    (found,) = solutions(scene, given, [value])
    assert found.theory["separation"] == pytest.approx(0.7, rel=1e-9)
    for name in QUANTITIES:
        assert found.theory[name] == pytest.approx(exact.mean(scene, name, [0.7])[0], rel=1e-9)
        x = found.surfaces[name]
        assert x.mean() == pytest.approx(
            found.theory[name], abs=5 * x.std() / np.sqrt(x.size) + 1e-3 * found.theory[name]
        )
    np.testing.assert_allclose(found.surfaces[given], value, rtol=1e-10)


def test_heights_of_a_surface_give_its_row(scene, ensemble):
    s = mcgw.heights(scene, 7)
    for name in QUANTITIES:
        power, modulus = POWERS[name]
        d = np.maximum(s - 0.5, 0)
        row = ((d > 0) * d**power * scene.grading(s) ** modulus).sum() * factor(scene.surface, name)
        assert ensemble.values(name)[7, 2] == pytest.approx(row, rel=1e-11)


ATTRIBUTES = dict.fromkeys(("digest", "seed", "sampler", "date", "versions", "commit", "cpu", "scene"), "-")


def test_report(scene, ensemble):
    """The contacts that it expects, and theory in every table."""
    page = report_html(ensemble, ATTRIBUTES)
    assert "Monte Carlo and theory of this model agree" in page
    (said,) = re.findall(r"contacts expected at the lowest separation</td><td>([^<]*)<", page)
    assert float(said) == pytest.approx(3000 * exact.share_above(scene, 0.0), rel=5e-4)
    tables = page[page.index("<h2>Tables") : page.index("<h2>The surface")]
    theory = re.findall(r"<td>([\d.]+)(?:×10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?\s*</td><td>[−+][\d.]+</td></tr>", tables)
    lowered = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
    shown = [float(x) * 10.0 ** int((power or "⁰").translate(lowered)) for x, power in theory]
    expected = np.concatenate([exact.mean(scene, name) for name in QUANTITIES])
    np.testing.assert_allclose(shown, expected, rtol=6e-5)


def test_converge(scene):
    small = dataclasses.replace(scene, n_surfaces=100)
    found = converge(small)
    assert found.passed, found.checks
    assert len(found.checks) == 11

    def gaussian(asked):
        drawn = mcgw.simulate(dataclasses.replace(asked, heights=analytic.Gaussian()))
        return {name: drawn.values(name) for name in asked.quantities}

    assert not converge(small, gaussian).passed


def test_notes_of_deep_contacts(scene):
    """Compressed by more than the radius: the share of the law's own tail decides."""
    depth = 5.0
    surface = dataclasses.replace(scene.surface, radius=depth * scene.surface.sigma)
    asked = dataclasses.replace(scene, surface=surface)
    share = exact.share_above(scene, depth) / exact.share_above(scene, 0.0)
    told = [line for line in cautions(asked) if "compressed by more" in line]
    assert bool(told) == (share > 1e-3)
    if told:
        assert f"a share of {share:.2g} " in told[0]
