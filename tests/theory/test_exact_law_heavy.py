"""Exact laws of many kinds against finer computations; what is said of specimens of heavy tails, as drawn."""

from unittest import mock

import numpy as np
import pytest
from oracles.accurately import term
from oracles.inside import of_one
from oracles.scenes import scene_by
from scipy import stats

import analytic
import mcgw
from analytic import exact_law
from mcgw.statistics.verdict import laws_of_values

SHARES = np.append(1 - np.geomspace(1e-6, 0.5, 60), np.geomspace(0.5, 1e-6, 60)[1:])
YIELDS = analytic.KogutEtsion(critical=0.05)
STICKS = analytic.JohnsonKendallRoberts(pull_off=0.01)
GRID = [  # heights, law, gamma, number of asperities and how it varies, and the share that touches
    (stats.t(4), None, 1, 100, "fixed", 0.01),
    (stats.pareto(5), YIELDS, 1, 30_000, "poisson", 0.01),
    (stats.lognorm(1.0), YIELDS, 2, 10**5, "fixed", 0.1),
    (stats.fisk(8.0), YIELDS, 0.5, 10**6, "poisson", 0.1),
    (stats.uniform(), STICKS, 1, 10**7, "fixed", 0.01),
]


@pytest.mark.parametrize(("heights", "law", "gamma", "n", "count", "share"), GRID)
def test_errors_are_at_most_the_stated_ones(heights, law, gamma, n, count, share):
    """Shares fall from 1 to 1e-6 in order; of more points and more cells they are as far as that."""
    surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=n, nominal_area=1.0, E_star=1e9)
    heights, grading = analytic.ScipyHeights(heights), analytic.Exponential(gamma)
    model = analytic.Model(surface, heights=heights, grading=grading, law=law, count=count)
    h = float(heights.isf(np.array(share)))
    found = model.distribution("load", h)
    most, least = found.sf(found.x[0]), found.sf(found.x[-1])
    assert 0 <= least <= 1e-6
    x = found.isf(SHARES[(least < SHARES) & (most > SHARES)])
    assert np.all(np.diff(x) >= 0)
    shares = found.sf(np.linspace(x[0], x[-1], 2000))
    assert np.all((shares >= 0) & (shares <= 1))
    assert np.all(np.diff(shares) <= 0)
    with mock.patch.multiple(exact_law, _POINTS=(3 * 2**15, 2**17), _CELLS=(30_000, 36_000)):
        off = np.abs(found.sf(x) - model.distribution("load", h).sf(x))
    assert off.max() < min(1e-6, found.error)


DRAWN = [(None, 100, "fixed"), (YIELDS, 1000, "poisson"), (STICKS, 1000, "fixed")]


def beyond(scene, h, shares, more=1.0):
    """Standard errors by which shares of 40 000 surfaces, summed asperity by asperity, lie beyond quantiles.

    With so many times the asperities of the scene.
    """
    law, rng, surfaces = scene.theory.distribution("load", h), np.random.default_rng(scene.seed), 40_000
    touching, n = stats.norm.sf(h), round(more * scene.n_asperities)
    by_count = {"poisson": rng.poisson(n * touching, surfaces), "fixed": rng.binomial(n, touching, surfaces)}
    counts = by_count[scene.count]
    s = stats.norm.isf(touching * rng.random(counts.sum()))
    one = analytic.quantity_of("load").scale(scene.surface) * term(scene, "load", h, s)
    loads = np.bincount(np.repeat(np.arange(surfaces), counts), one, surfaces)
    seen = np.array([np.mean(loads > x) for x in law.isf(shares)])
    return (seen - shares) / np.sqrt(shares * (1 - shares) / surfaces)


@pytest.mark.slow
@pytest.mark.parametrize(("law", "n", "count"), DRAWN)
def test_drawn_surfaces_are_beyond_quantiles_as_often_as_said(law, n, count):
    """Both tails down to 1e-3: |z| < 5, 18 numbers of 6e-7. The companion: a tenth more asperities."""
    surface, h = mcgw.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e9), 1.0
    given = {"law": law, "grading": mcgw.Exponential(2.0), "n_asperities": n, "count": count, "seed": 9}
    scene, shares = scene_by(surface, separations=[h], **given), np.array([1e-3, 1e-2, 0.1, 0.9, 0.99, 0.999])
    assert np.abs(beyond(scene, h, shares)).max() < 5
    assert np.abs(beyond(scene, h, shares, 1.1)).max() > 5


@pytest.mark.slow
def test_specimens_of_heavy_tails_are_as_drawn():
    """Ends of 90 % of separations at a load, of loads; `compare` of all values; a quantile of `tradeoff`."""
    surface, h = mcgw.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e9), 1.5
    some = {"heights": stats.t(4), "n_asperities": 3000, "n_surfaces": 4000}
    scene = scene_by(surface, separations=[h], seed=3, **some)
    found = mcgw.solve(scene, load=float(scene.theory.mean("load", h)))
    drawn, shares = found.surfaces["separation"], np.array([0.05, 0.95])
    allowed = 5 * np.sqrt(0.05 * 0.95 / 4000)
    ends = found.specimens("separation")
    np.testing.assert_allclose([np.mean(drawn <= end) for end in ends], shares, atol=allowed)
    values = mcgw.simulate(scene)
    loads = values.load[:, 0]
    between = scene.theory.distribution("load", h).interval(0.9)
    np.testing.assert_allclose([np.mean(loads <= end) for end in between], shares, atol=allowed)
    assert laws_of_values(values).p > 1e-5
    half = of_one(scene.replace(quantities=("load",), separations=(h,)), "quantile")
    each = np.quantile(
        mcgw.simulate(scene.replace(n_surfaces=100_000)).load[:, 0].reshape(100, 1000), 0.99, axis=1
    )
    assert 1.96 * (each / each.mean()).std() * np.sqrt(1000) == pytest.approx(half, rel=0.4)
