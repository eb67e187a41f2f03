"""Levels of a pressed map: summits alone and located, in any unit and either way around."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.inside import Pressed, alone, balanced, located, rimless
from oracles.located_by_hand import residual
from oracles.rough import rough

import mcgw


def test_the_rim_of_what_touches_is_counted_step_by_step(rng):
    """On a torus, literally: of each pair of neighbours one of which touches."""
    touching = rng.random((5, 7)) < 0.4
    pairs = [((j, i), (j, (i + 1) % 7)) for j in range(5) for i in range(7)]
    pairs += [((j, i), ((j + 1) % 5, i)) for j in range(5) for i in range(7)]
    steps = sum(touching[a] != touching[b] for a, b in pairs)
    assert rimless(touching) == pytest.approx((touching.sum() - 0.1181141597562 * steps) / 35, rel=1e-9)


def test_a_map_without_a_summit_is_told():
    bowl = np.zeros((64, 64))
    bowl[8, 8] = -1e-6
    with pytest.raises(mcgw.RunError, match="has no summit"):
        located(Pressed(bowl, (6.4e-5, 6.4e-5), 1e11, 1e6))


def test_alone_is_hertz_over_the_summits(rng):
    one = Pressed(rough(rng).heights, (6.4e-5, 6.4e-5), 1e11, 5e7)
    values, spots = alone(one), one.spots
    depth = np.maximum(spots.heights - values["mean_gap"], 0)
    assert_allclose((4 / 3 * 1e11 * np.sqrt(spots.radii) * depth**1.5).sum(), 5e7 * 6.4e-5**2, rtol=1e-9)
    assert_allclose(values["area"], math.pi * (spots.radii * depth).sum(), rtol=1e-12)


def test_at_the_gap_of_a_pressure_holds_what_holds_under_it(rng):
    """Of located summits nearly: they are as wide to their neighbours as alone at what is given."""
    heights = rough(rng).heights
    size, p = (6.4e-5, 6.4e-5), 2e6
    for level, off in ((alone, 1e-9), (located, 0.02)):
        under = level(Pressed(heights, size, 1e11, p))
        at = level(Pressed(heights, size, 1e11, separation=under["mean_gap"]))
        assert at.pop("pressure") == pytest.approx(p, rel=off)
        for name, value in at.items():
            assert value == pytest.approx(under[name], rel=off)
        clear = level(Pressed(heights, size, 1e11, separation=2 * float(np.ptp(heights))))
        assert clear == dict.fromkeys(("area", "stiffness", "conductance", "pressure"), 0)


def test_located_summits_are_in_balance():
    """Those that touch are among those that are looked at, and the surface around them makes them larger."""
    heights = rough(np.random.default_rng(1)).heights
    one = Pressed(heights, (6.4e-5, 6.4e-5), 1e11, 2e9)
    spots, places = one.touching()
    once, _ = one.touching(fits=1)
    assert spots.radii.tolist() == once.least_radii(one.plane(once)).tolist()
    found = balanced(spots, places, one.grid, one.plane(spots), one.load)
    assert residual(spots, places, one.grid, one.plane(spots), found) < 1e-10
    values, load = located(one), spots.loads(found.penetrations).sum()
    assert values["area"] == pytest.approx(spots.areas(found.penetrations).sum(), rel=1e-12)
    assert (values["stiffness"], values["mean_gap"]) == (found.stiffness, found.separation)
    assert load == pytest.approx(2e9 * 6.4e-5**2, rel=1e-10)
    assert np.any((found.penetrations > 0) & (spots.heights < one.plane(one.spots)))
    paraboloids, at = one.touching(fits=0)
    sharp = balanced(paraboloids, at, one.grid, one.plane(paraboloids), one.load)
    assert values["area"] > 1.02 * paraboloids.areas(sharp.penetrations).sum()
