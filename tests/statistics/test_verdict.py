"""What the verdict rests on: every quantity at every separation, and as many degrees as there are."""

import dataclasses

import numpy as np
import pytest
from oracles import exact
from oracles.inside import Check, Results, verdict
from scipy.stats import chi2

import analytic
import mcgw
from analytic.curvature import MEAN_CURVATURE
from mcgw import compare
from mcgw.statistics import verdict as parts

QUANTITIES = tuple(analytic.QUANTITIES)
H = (2.0, 0.0, 1.0)  # in no order: a verdict that sorts one of two lists would show


@pytest.fixture(scope="module")
def ensemble(make_scene):
    """Means of 750 surfaces known to 0.1 to 0.4 %: what is 2 % off is off by 5 to 20 standard errors.

    A number of asperities that is not eta A_n, which is 30 000 here.
    """
    scene = make_scene(separations=H, quantities=QUANTITIES, n_asperities=20_000, n_surfaces=750, seed=3)
    return mcgw.simulate(scene)


def scaled(ensemble, factors):
    """The same ensemble in memory, some columns multiplied: {(quantity, separation's number): factor}."""
    arrays = {name: ensemble.values(name).astype(float) for name in ensemble.scene.quantities}
    for (name, k), factor in factors.items():
        arrays[name][:, k] *= factor
    return dataclasses.replace(ensemble, sums=Results(arrays))


def test_the_ensemble_agrees_as_it_is(ensemble):
    assert verdict(scaled(ensemble, {})).agrees
    assert verdict(scaled(ensemble, {})) == verdict(ensemble)


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_each_quantity_alone_2_percent_off_breaks_it(ensemble, quantity):
    """All its means, too large or too small, and each of them alone."""
    for factor in (0.98, 1.02):
        wrong = scaled(ensemble, dict.fromkeys([(quantity, k) for k in range(len(H))], factor))
        assert not verdict(wrong).agrees
        assert compare(wrong).verdict == verdict(wrong)
    for k in range(len(H)):
        assert not verdict(scaled(ensemble, {(quantity, k): 1.02})).agrees


def test_the_last_of_many_separations_counts(make_scene):
    """More separations than a verdict looks at: the first and the last are among those it takes."""
    scene = make_scene(separations=tuple(np.linspace(0, 2, 60)), quantities=("load",), n_asperities=30_000)
    found = mcgw.simulate(scene)
    assert verdict(found).agrees
    for k in (0, 59):
        assert not verdict(scaled(found, {("load", k): 1.02})).agrees


def independent(ensemble):
    """Chi-square and degrees by a quadrature of its own, for an ensemble in which every mean counts."""
    scene = ensemble.scene
    columns = [(name, h) for name in scene.quantities for h in scene.separations]
    matrix = exact.covariance(scene, columns) / ensemble.n_surfaces
    unit = np.sqrt(np.diag(matrix))
    difference = np.concatenate(
        [ensemble.values(name).mean(axis=0) - exact.mean(scene, name) for name in scene.quantities]
    )
    size, axes = np.linalg.eigh(matrix / np.outer(unit, unit))
    keep = size > 1e-9  # below, a combination is a difference of equal columns
    z = (difference / unit) @ axes[:, keep] / np.sqrt(size[keep])
    return float(z @ z), int(keep.sum()), size


def test_chi_square_and_p_are_those_of_the_exact_covariance(ensemble):
    found = mcgw.simulate(ensemble.scene.replace(count="poisson"))
    chi_square, degrees, size = independent(found)
    assert size.min() > 1e-8  # far enough from where one would be thrown out
    said = verdict(found)
    assert said.degrees == degrees == len(QUANTITIES) * len(H)
    assert said.chi_square == pytest.approx(chi_square, rel=1e-6)
    assert said.p == pytest.approx(chi2.sf(chi_square, degrees), rel=1e-5)


def test_a_quantity_that_is_a_multiple_of_another_adds_no_degree(ensemble):
    """Without a grading the stiffness is the conductance times E*/2."""
    plain = ensemble.scene.replace(grading=analytic.Homogeneous())
    assert verdict(mcgw.simulate(plain)).degrees == (len(QUANTITIES) - 1) * len(H)


@pytest.mark.parametrize("n_surfaces", [20, 2000])
def test_what_is_thrown_out_where_few_touch(make_scene, n_surfaces):
    """One quantity at one separation: it counts where the exact law of its mean is within 0.1 of Gaussian."""
    taken = []
    for h in np.linspace(0, 4, 17):
        scene = make_scene(separations=(h,), quantities=("load",), n_surfaces=n_surfaces)
        s, p = exact.nodes(scene, h)
        x = exact.term(scene, "load", s, h)
        m1 = p @ x
        below = 1 - p.sum()
        k2, k3, k4 = (p @ (x - m1) ** k + below * (-m1) ** k for k in (2, 3, 4))
        asperities = scene.n_asperities * n_surfaces
        skewness, kurtosis = k3 / k2**1.5 / np.sqrt(asperities), (k4 / k2**2) / asperities
        counts = skewness < 0.1 and kurtosis < 0.1
        assert verdict(mcgw.simulate(scene)).degrees == counts, h
        taken.append(counts)
    assert taken[0]
    assert not taken[-1]


def test_the_rate_of_false_alarms_is_one_in_a_thousand():
    assert [Check("means", "", p).agrees for p in (1.001e-3, 0.999e-3)] == [True, False]


def test_curves_are_those_of_the_exact_law(ensemble):
    scene, curves = ensemble.scene, compare(ensemble).curves
    assert tuple(curves) == QUANTITIES
    for name, curve in curves.items():
        mean, theory = ensemble.values(name).mean(axis=0), exact.mean(scene, name)
        stderr = exact.std(scene, name) / np.sqrt(ensemble.n_surfaces)
        np.testing.assert_allclose(curve.mean, mean, rtol=1e-12)
        np.testing.assert_allclose(curve.theory, theory, rtol=1e-10)
        np.testing.assert_allclose(curve.stderr, stderr, rtol=1e-8)
        np.testing.assert_allclose(curve.residual, (mean - theory) / stderr, rtol=1e-5, atol=1e-6)


def test_no_contact_at_all_and_one_surface(make_scene):
    comparison = compare(mcgw.simulate(make_scene(separations=(9.0, 30.0))))
    assert comparison.verdict.agrees
    assert (comparison.verdict.degrees, comparison.verdict.p) == (0, 1.0)
    assert "agree: no mean is close enough to Gaussian for a test, p = 1" in comparison.verdict.line
    curve = compare(mcgw.simulate(make_scene(n_surfaces=1))).curves["load"]
    assert 0 < curve.low[0] < curve.mean[0] < curve.high[0]
    assert np.isnan(curve.low[-1])  # h = 4: too few contacts


# --- its parts, by hand ---


def test_radii_have_a_bound_that_one_in_ten_thousand_ensembles_passes(make_scene):
    """And none where there is one already, or where all radii are one."""
    scene = make_scene(
        heights=analytic.Nayak(5.0), summits=analytic.RandomCurvature(5.0), separations=(1.0,), grading=None
    )
    law = scene.summits
    for surfaces in (10**9, 10**12):
        largest = parts.bounded_theory(scene, surfaces).curvature.largest
        flatter = float(law.cdf(MEAN_CURVATURE / largest, 1.0)) * scene.touching * surfaces
        assert flatter == pytest.approx(1e-4, rel=0.02)
    few = parts.bounded_theory(scene, 1000).curvature  # of which fewer are flatter than a thousandth
    assert few.largest == pytest.approx(MEAN_CURVATURE / 1e-3, rel=1e-12)
    for known in (scene.replace(summits=analytic.RandomCurvature(5.0, 50.0)), make_scene()):
        assert parts.bounded_theory(known, 10**6) is known.theory


def test_a_sweep_is_judged_at_twelve_separations_and_never_more_than_surely(make_scene):
    scene = make_scene(separations=tuple(np.linspace(2, 0, 30)), n_surfaces=20, quantities=("load",))
    compared = compare(mcgw.sweep(scene, {"grading.gamma": [0.5, 1.0, 2.0]}))
    at = np.linspace(0, 29, 12).round().astype(int)
    for one in compared.points:
        np.testing.assert_array_equal(one.separations, np.linspace(2, 0, 30)[::-1][at])
    sure = tuple(dataclasses.replace(one, verdict=Check("means", "", 0.5)) for one in compared.points)
    assert dataclasses.replace(compared, points=sure).verdict.p == 1.0
    assert dataclasses.replace(compared, points=sure[:1]).verdict.p == 0.5
    told = []
    compare(mcgw.sweep(scene, {"grading.gamma": [0.5, 1.0]}), progress=lambda *pair: told.append(pair))
    assert told == [(0, 2), (1, 2), (2, 2)]
