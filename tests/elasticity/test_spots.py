"""Contacts on single summits: against Hertz, closed forms of powers, and plain loops over rays."""

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.inside import Pressed, Spots, fallen
from oracles.rough import rough
from scipy.integrate import quad
from scipy.ndimage import map_coordinates


@pytest.mark.parametrize("n", [1.0, 1.6, 4.0])
def test_of_a_power_are_integrals_of_sneddon(n):
    """f = c r^n, by quadrature with r = a sin t; the stiffness is the slope of the load."""
    c, E_star, a = 0.3, 3.0, 1.5

    def integral(k):
        return quad(lambda t: (a * math.sin(t)) ** k * c * n * (a * math.sin(t)) ** (n - 1), 0, math.pi / 2)[
            0
        ]

    depth = c * math.sqrt(math.pi) * math.gamma(n / 2 + 1) / math.gamma((n + 1) / 2)  # at a = 1
    spots, delta = Spots(np.zeros(1), np.ones(1), np.array([depth]), np.array([n]), E_star), a * integral(0)
    assert spots.contact_radii(np.array([delta])) == pytest.approx(a, rel=1e-9)
    assert spots.loads(np.array([delta])) == pytest.approx(2 * E_star * integral(2), rel=1e-9)
    up, down = (spots.loads(np.array([delta * (1 + s)])) for s in (1e-5, -1e-5))
    assert spots.slopes(np.array([delta])) == pytest.approx((up - down) / (2e-5 * delta), rel=1e-8)


def test_carry_a_load_at_one_separation():
    rng = np.random.default_rng(3)
    spots = Spots.hertz(1e-6 * rng.standard_normal(50), 1e-5 * rng.uniform(0.5, 2, 50), 1e9)
    for load in (1e-9, 1e-3, 10.0):
        assert spots.loads(spots.heights - spots.separation_at(load)).sum() == pytest.approx(load, rel=1e-10)
    flat = Spots.hertz(np.zeros(2), np.full(2, 1e-5), 1e9)
    assert flat.loads(np.full(2, -flat.separation_at(1e-3))).sum() == pytest.approx(1e-3, rel=1e-10)


def test_contacts_are_at_least_as_wide_as_their_mean_square():
    spots = Spots.hertz(np.array([0.0, -1e-7, -9e-7]), np.full(3, 1e-5), 1e9)
    squared = np.array([5e-12, 4e-12])
    assert_allclose(spots.least_radii(-5e-7) ** 2, [5e-12, 4.5e-12, squared.mean()], rtol=1e-12)


def test_of_a_map_are_means_over_eight_rays():
    """Literal: six steps to the rim, each ray down to its first valley."""
    rng = np.random.default_rng(20261124)
    heights = rough(rng, 96, 64, (1e-6, 1.5e-6)).heights
    one = Pressed(heights, (9.6e-5, 9.6e-5), 1e11, 5e7)
    summits, which = one._counted, np.arange(3, one.spots.heights.size, 7)
    radii = rng.uniform(1e-6, 9e-6, which.size)
    found = fallen(
        one._map, summits, which, Spots.hertz(one.spots.heights[which], summits.radii[which], 1e11), radii
    )
    assert found.heights.tolist() == one.spots.heights[which].tolist()
    for k, a, depth, power in zip(which, radii, found.depths, found.powers, strict=True):
        r = a * np.arange(7) / 6
        bend = summits.curvatures[:, k].mean() / 2 * np.diff(r**2)
        rays = []
        for m in range(8):
            x = summits.x[k] + r * math.cos(m * math.pi / 4)
            y = summits.y[k] + r * math.sin(m * math.pi / 4)
            at = [y / 1.5e-6 - 0.5, x / 1e-6 - 0.5]
            falls = -np.diff(map_coordinates(heights, at, order=3, mode="grid-wrap"))
            ups = np.flatnonzero(falls <= 0)
            if ups.size:
                falls[ups[0] :] = bend[ups[0] :]
            rays.append(falls)
        bends = np.mean(rays, axis=0) / np.diff(r**2)  # f' = 2 bend r
        deep = load = 0.0
        for ends, c in zip(pairwise(r / a), bends, strict=True):
            low, high = (math.asin(min(x, 1)) for x in ends)
            deep += 2 * c * a**2 * quad(math.sin, low, high)[0]
            load += 4e11 * c * a**3 * quad(lambda t: math.sin(t) ** 3, low, high)[0]
        assert depth == pytest.approx(deep, rel=1e-9)
        assert 2e11 * power / (power + 1) * a * depth == pytest.approx(load, rel=1e-9)
