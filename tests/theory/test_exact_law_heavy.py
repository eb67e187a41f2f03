"""Exact laws of heavy tails against drawn surfaces, and what is said of specimens by them."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.exact_law_drawn import scores, some
from oracles.exact_law_grid import faults, laws
from oracles.inside import Needs
from oracles.scenes import scene_by
from scipy import stats

import mcgw
from mcgw.statistics.laws_of_values import laws_of_values

HEAVY = [(stats.fisk(8.0), 58_000, 2.5), (stats.t(4), 3000, 1.5), (stats.lognorm(1.0), 20_000, 3.0)]


def scene_of(heights, n, h, **more):
    surface = mcgw.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e9)
    return scene_by(surface, separations=[h], heights=heights, n_asperities=n, seed=3, **more)


@pytest.mark.slow
@pytest.mark.parametrize("k", range(0, 630, 71))
def test_a_law_of_the_grid_has_no_fault(k):
    names, model, h = list(laws())[k]
    found, off, _, _ = faults(model, h)
    assert not found, names
    assert off < 1e-6, names


@pytest.mark.slow
@pytest.mark.parametrize("k", [0, 20])
def test_drawn_surfaces_are_beyond_quantiles_as_often_as_said(k):
    """Numbers beyond are binomial; a false alarm in 1e4 runs, by the rarest of the fewer surfaces."""
    names, model, h = some()[k]
    z = scores(model, h, 100_000 if model.number == 100 else 20_000, k)
    assert np.all(np.isnan(z) | (np.abs(z) < 5)), names
    assert np.isfinite(z).sum() >= 4


@pytest.mark.slow
def test_a_tenth_more_asperities_would_be_seen():
    _, model, h = some()[30]
    more = replace(model, n_asperities=1.1 * model.number)
    assert np.nanmax(np.abs(scores(model, h, 100_000, 1, of=more))) > 5


@pytest.mark.slow
@pytest.mark.parametrize(("heights", "n", "h"), HEAVY)
def test_specimens_of_heavy_tails_are_as_drawn(heights, n, h):
    """Ends of 90 % of separations at a load, of loads; `compare` of all values; a quantile of `tradeoff`."""
    scene = scene_of(heights, n, h, n_surfaces=4000)
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
    half = Needs(scene.replace(quantities=("load",), separations=(h,))).of_one("quantile")
    each = np.quantile(
        mcgw.simulate(scene.replace(n_surfaces=100_000)).load[:, 0].reshape(100, 1000), 0.99, axis=1
    )
    assert 1.96 * (each / each.mean()).std() * np.sqrt(1000) == pytest.approx(half, rel=0.4)
