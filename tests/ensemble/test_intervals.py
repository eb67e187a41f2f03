"""Intervals: they cover as often as they say, with one contact or millions, or are not given.

Gate of coverage: of 4000 intervals that cover with probability 0.95, fewer than 0.93 do once in 6e7.
"""

import numpy as np
import pytest
from conftest import SURFACE
from oracles.inside import (
    FEWEST,
    TOO_FEW,
    Results,
    Spread,
    comparison_text,
    count_interval,
    exact_ends,
    forecast,
    pearson3_quantile,
    spread_of,
    stacked,
)
from scipy.special import gammaincinv
from scipy.stats import binom, norm, pearson3, poisson, t as student

import analytic
import mcgw

SEEDS = 4000
LAWS = {
    "gaussian": analytic.Gaussian(),
    "exponential": analytic.ExponentialHeights(),
    "weibull": analytic.Weibull(3.6),
}


def cut(expected, surfaces, law, count, gamma):
    """One ensemble, long enough to be cut into 4000 of so many contacts each."""
    n = 2000
    h = float(law.isf(np.array(expected / (surfaces * n))))
    drawn = mcgw.Sampling(n_asperities=n, count=count, sampler="cells", n_surfaces=SEEDS * surfaces, seed=7)
    scene = mcgw.Scene(
        SURFACE, separations=(h,), grading=analytic.Exponential(gamma), heights=law, ensemble=drawn
    )
    return mcgw.simulate(scene)


def intervals(ensemble, surfaces):
    """Intervals of the parts, by quantity: each part as a separation of its own, so in one go."""
    scene = ensemble.scene
    found = {}
    for name in scene.quantities:
        parts = ensemble.values(name).reshape(SEEDS, surfaces).T
        wide = scene.replace(n_surfaces=surfaces, separations=scene.separations * SEEDS)
        found[name] = mcgw.Ensemble(wide, "cells", Results({name: parts})).interval(name)
    return found


def coverage(ensemble, surfaces):
    """Share of the intervals given that cover, by quantity; 1 where none is given."""
    theory, h = ensemble.scene.theory, ensemble.scene.separations
    shares = {}
    for name, (low, high) in intervals(ensemble, surfaces).items():
        exact, given = float(theory.mean(name, h)[0]), ~np.isnan(low)
        assert given.all() or not given.any()
        assert name != "contacts" or given.all()
        assert not (low < 0).any()
        shares[name] = np.mean(((low <= exact) & (exact <= high))[given]) if given.any() else 1.0
    return shares


@pytest.mark.parametrize(
    ("expected", "surfaces", "law", "gamma", "count"),
    [
        (0.03, 10, "gaussian", 1.0, "fixed"), (3.8, 2, "exponential", 2.0, "poisson"),
        pytest.param(30.0, 10, "weibull", 0.2, "fixed", marks=pytest.mark.slow),
    ],
)  # fmt: skip
def test_intervals_cover(expected, surfaces, law, gamma, count):
    assert min(coverage(cut(expected, surfaces, LAWS[law], count, gamma), surfaces).values()) >= 0.93


@pytest.mark.parametrize(
    ("count", "contacts"), [("poisson", 4.5), pytest.param("fixed", 12.0, marks=pytest.mark.slow)]
)
def test_few_contacts_have_the_interval_of_their_exact_law(count, contacts):
    """It covers 95 of 100, no more; a false alarm in 1e5. Too few are those of which 2.5 % have none."""
    found = coverage(cut(contacts, 2, LAWS["gaussian"], count, 2.0), 2)
    for name in ("load", "area", "stiffness"):
        assert abs(found[name] - 0.95) < 4.6 * np.sqrt(0.95 * 0.05 / SEEDS)
    low, high = intervals(cut(3.0, 2, LAWS["gaussian"], count, 2.0), 2)["load"]
    assert np.isnan([low, high]).all()


def test_students_interval_does_not_cover_few_contacts():
    """The companion: the same gate throws out the interval of one variance from few surfaces."""
    ensemble = cut(3.8, 10, LAWS["gaussian"], "fixed", 1.0)
    x = ensemble.load.reshape(SEEDS, 10)
    half = student.ppf(0.975, 9) * x.std(axis=1, ddof=1) / np.sqrt(10)
    exact = float(ensemble.scene.theory.mean("load", ensemble.separations)[0])
    assert np.mean(np.abs(x.mean(axis=1) - exact) <= half) < 0.93


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_interval_is_a_shifted_gamma_law_turned_round(make_scene, count):
    """Word by word: quantiles of gamma of shape 4/skewness^2, of unit variance, about the exact mean."""
    scene = make_scene(count=count, n_asperities=200, n_surfaces=5, separations=(0.5, 1.0, 1.0, 0.0))
    ensemble = mcgw.simulate(scene)
    exact = scene.theory.cumulants("load", scene.separations)
    shape = 4 / (exact.skewness / np.sqrt(5)) ** 2
    low, high = (
        1 + (gammaincinv(shape, p) - shape) / np.sqrt(shape) * np.sqrt(exact.variance / 5) / exact.mean
        for p in (0.025, 0.975)
    )
    np.testing.assert_allclose(ensemble.interval("load"), ensemble.mean("load") / [high, low], rtol=1e-9)


@pytest.mark.parametrize(("k", "level"), [(0, 0.95), (7, 0.5), (7, 0.95), (1000, 0.95)])
def test_count_interval_by_definition(k, level):
    """Each end is where so few, or so many, contacts have half of what the level leaves."""
    tail = (1 - level) / 2
    low, high = count_interval(np.array([k]), 1000.0, poisson=False, level=level)
    assert binom.sf(k - 1, 1000, low[0] / 1000) == pytest.approx(tail if k else 1.0)
    assert binom.cdf(k, 1000, high[0] / 1000) == pytest.approx(tail if k < 1000 else 1.0)
    low, high = count_interval(np.array([k]), 1000.0, poisson=True, level=level)
    assert poisson.sf(k - 1, low[0]) == pytest.approx(tail if k else 1.0)
    assert poisson.cdf(k, high[0]) == pytest.approx(tail)


def test_count_interval_of_few_of_very_many_is_garwoods():
    """Of 1e18 asperities: SciPy's own inverse of the beta law fails there."""
    k = np.array([1.0, 1e3, 1e9, 1e12])
    few, of_all = (count_interval(k, 1e18, poisson=law) for law in (True, False))
    np.testing.assert_allclose(of_all, few, rtol=1e-9)


def test_spread_of_many_separations_is_that_of_each(make_scene):
    """Unsorted, repeated, more than share a rule; and where the density underflows there is nothing."""
    h = (*np.linspace(3, -2.5, 40), 2.0, 2.0, 38.0)
    scene = make_scene(separations=h, grading=analytic.Exponential(1.0))
    for name in ("load", "stiffness"):
        spread, exact = spread_of(scene, name), scene.theory.cumulants(name, h[:-1])
        np.testing.assert_allclose(spread.relative[:-1], np.sqrt(exact.variance) / exact.mean, rtol=1e-10)
        np.testing.assert_allclose(spread.skewness[:-1], exact.skewness, rtol=1e-9)
    assert exact.skewness.min() < 0  # where few of almost all do not touch
    assert spread.relative[-1] == np.inf
    assert np.isnan(spread.reach(10**6)[-1])


@pytest.mark.parametrize("share", [0.05, 1.0])
def test_a_few_equal_terms_are_covered(share):
    """A share of the mean from a Poisson number of equal terms, the rest steady: exact sums over that law."""
    number, given = np.arange(400), 0
    for expected in np.arange(0.2, 100.0, 0.2):
        one = np.array([1 / np.sqrt(expected)])
        low, high = Spread(share * one, one).ratio(1)
        if not np.isnan(low[0]):
            seen = 1 - share + share * number / expected
            inside = (low <= seen) & (seen <= high)
            assert poisson.pmf(number, expected)[inside].sum() >= 0.93, expected
            given += 1
    assert given > 375


@pytest.mark.parametrize("contacts", [0.01, 3.0])
def test_where_hardly_any_asperity_does_not_touch(make_scene, contacts):
    """The number of contacts is N but for a rare one: too skew for a gamma law, within Chebyshev's bound."""
    h = -float(analytic.Gaussian().isf(np.array(contacts / 1000)))
    scene = make_scene(separations=(h,), grading=analytic.Exponential(1.0), n_asperities=1000, n_surfaces=1)
    spread = spread_of(scene, "contacts")
    low, high = spread.ratio(1)
    missing = np.random.default_rng(1).binomial(1000, contacts / 1000, SEEDS)
    share = (1000 - missing) / (1000 - contacts)
    assert np.mean((low <= share) & (share <= high)) >= 0.93
    assert forecast(scene.replace(rel_err=0.1, n_surfaces=10**6)).surfaces == 64


def test_nothing_drawn_leaves_nothing_open(make_scene):
    heights = analytic.MeasuredHeights(np.random.default_rng(1).standard_normal(3000))
    ensemble = mcgw.simulate(make_scene(n_surfaces=1, heights=heights, sampler="direct"))
    np.testing.assert_array_equal(ensemble.interval("load"), [ensemble.mean("load")] * 2)


def test_too_few_is_said_wherever_intervals_are(make_scene):
    """h = 4 and 8: one contact in 190 surfaces, and none."""
    h = (0.0, 4.0, 8.0)
    comparison = mcgw.compare(mcgw.simulate(make_scene(n_surfaces=20, separations=h, seed=3)))
    effective = spread_of(comparison.ensemble.scene, "load").effective(20)
    assert (effective < FEWEST).tolist() == [False, True, True]
    words = [
        TOO_FEW in x for x in comparison_text(comparison).splitlines() if x.split()[0] in ("0", "4", "8")
    ]
    assert words == 3 * [False, True, True] + 3 * [False]
    stored = stacked(comparison.tables(), "quantity").only("low_95").columns[0].values
    assert np.isnan(stored).tolist() == words


@pytest.mark.parametrize("share", [1e-4, 0.025, 0.5, 0.975])
def test_quantiles_are_those_of_scipy(share):
    skewness = np.array([-3.0, -0.5, -1e-3, -2e-5, 0.0, 2e-5, 1e-3, 0.5, 3.0])
    expected = pearson3.ppf(share, skewness)
    np.testing.assert_allclose(pearson3_quantile(share, skewness), expected, rtol=1e-9, atol=1e-9)
    assert pearson3_quantile(share, np.array([1e-6])) == pytest.approx(norm.ppf(share), abs=1e-5)


def test_ends_of_a_share_of_all_surfaces_are_those_of_the_exact_law(make_scene):
    """And none where no law is known, or where laws take a while."""
    scene = make_scene(separations=(0.0, 2.0))
    laws = [scene.theory.distribution("load", h) for h in (0.0, 2.0)]
    for share in (0.5, 0.9):
        ends = exact_ends(scene, "load", share)
        assert ends.shape == (2, 2)
        below = [[float(law.cdf(ends[i, k])) for k, law in enumerate(laws)] for i in (0, 1)]
        np.testing.assert_allclose(below, [[(1 - share) / 2] * 2, [(1 + share) / 2] * 2], atol=1e-9)
    many = scene.replace(separations=np.linspace(0, 3, 101))
    yielding = {"law": analytic.KogutEtsion(critical=0.1)}
    listed = {"heights": analytic.MeasuredHeights([0.0, 1.0, 2.0]), "sampler": "direct"}
    radii = {"heights": analytic.Nayak(5.0), "summits": analytic.RandomCurvature(5.0)}
    assert exact_ends(many, "contacts", 0.9).shape == (2, 101)
    for quick in (yielding, radii):
        assert exact_ends(scene.replace(**quick), "load", 0.9).shape == (2, 2)
        assert exact_ends(many.replace(**quick), "load", 0.9) is None
    for none in (radii | yielding, listed | {"n_asperities": 3, "n_surfaces": 1}):
        assert exact_ends(scene.replace(**none), "load", 0.9) is None
    assert exact_ends(scene, "depth", 0.9) is None
