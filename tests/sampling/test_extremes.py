"""Numerical stability at the extremes: each test is a row of runs/EXTREMES.md.

Every case works to the accuracy stated, without a warning (pytest turns them into errors), or gets one
clear error.
"""

import math

import numpy as np
import pytest
from oracles.inside import sampler_of
from oracles.literal import sums_of_heights
from scipy.special import log_ndtr

import analytic
import mcgw
from mcgw.sampling.counted import counts_of

GAMMA_STAR = math.exp(0.5) / (math.exp(0.5) - 1)


def agree(ensemble):
    """Means within 5 exact standard errors of theory, wherever anything fluctuates."""
    scene = ensemble.scene
    for name in scene.quantities:
        exact = scene.theory.cumulants(name, scene.separations)
        difference = np.abs(ensemble.mean(name) - exact.mean)
        assert (difference <= 5 * np.sqrt(exact.variance / ensemble.n_surfaces) + 1e-12 * exact.mean).all()


@pytest.mark.parametrize(("n", "sampler"), [(1, "cells"), (1, "tail"), (2, "direct"), (2, "cells")])
def test_one_or_two_asperities(make_scene, n, sampler):
    ensemble = mcgw.simulate(make_scene(n_asperities=n, sampler=sampler, n_surfaces=2000))
    agree(ensemble)
    assert ensemble.contacts.max() <= n


def test_1e15_asperities(make_scene):
    agree(mcgw.simulate(make_scene(n_asperities=10**15, sampler="aggregate", n_surfaces=64)))


def test_one_surface(make_scene):
    ensemble = mcgw.simulate(make_scene(n_surfaces=1))
    assert np.isnan(ensemble.std("load")).all()
    low, high = (end[:3] for end in ensemble.interval("load"))
    assert ((low < ensemble.mean("load")[:3]) & (ensemble.mean("load")[:3] < high)).all()
    assert (ensemble.mean("load") == ensemble.load[0]).all()


@pytest.mark.slow
def test_10_000_separations(make_scene):
    h = tuple(np.linspace(0, 4, 10_000))
    scene = make_scene(separations=h, quantities=("load", "contacts"), sampler="cells")
    sums = sampler_of(scene).block(0, 2)
    heights = mcgw.heights(scene, 0)
    some = make_scene(separations=h[::500], quantities=("load", "contacts"), sampler="cells")
    for name in some.quantities:
        np.testing.assert_allclose(sums[name][0][::500], sums_of_heights(some, heights, name), rtol=1e-12)


@pytest.mark.parametrize("quantity", list(analytic.QUANTITIES))
def test_quantities_alone(make_scene, quantity):
    alone = sampler_of(make_scene(quantities=(quantity,))).block(0, 3)
    together = sampler_of(make_scene(quantities=tuple(analytic.QUANTITIES))).block(0, 3)
    assert set(alone) == {quantity}
    np.testing.assert_allclose(alone[quantity], together[quantity], rtol=1e-12)


def test_count_law_far_in_the_tail(make_scene):
    """p = 1e-300: the probability is right to 1e-12, the count is 0, for N up to 2^53."""
    h = 37.0
    scene = make_scene(separations=(h,), n_asperities=2**53)
    sampler = sampler_of(scene)
    assert abs(sampler.mesh.high_extras / math.exp(log_ndtr(-h)) - 1) < 1e-12
    assert counts_of(scene, sampler.mesh, 0, 64).high_extras.sum() == 0


def test_rare_contacts_among_2_to_the_53(make_scene):
    """h = 8: 5.6 contacts expected of 9e15 asperities, where 1 - p rounds to 1."""
    scene = make_scene(separations=(8.0,), n_asperities=2**53, quantities=("contacts",), n_surfaces=2000)
    expected = 2**53 * float(analytic.fn(0, 8.0))
    contacts = mcgw.simulate(scene).contacts[:, 0]
    assert abs(contacts.mean() - expected) < 5 * np.sqrt(expected / 2000)
    assert abs(contacts.var() / expected - 1) < 5 * np.sqrt(2 / 2000 + 1 / expected / 2000)
