"""Summits that press each other down: against plain loops, single unknowns and lattice sums."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.inside import Grid, Spots, balanced, beyond_point
from oracles.located_by_hand import residual
from scipy.integrate import dblquad

from mcgw.elasticity import located

LATTICE = -3.900264920001956  # 4 zeta(1/2) beta(1/2), physics of a square lattice


def some(n, side=3e-4, seed=20261124, points=64):
    """Summits of different heights, radii and powers at places of their own."""
    rng = np.random.default_rng(seed)
    places = np.array(np.divmod(rng.choice(points**2, n, replace=False), points))
    radii, powers = 1e-5 * rng.uniform(0.5, 2, n), rng.uniform(1.4, 2.2, n)
    spots = Spots(1e-6 * rng.standard_normal(n), radii, radii, powers, 1e9)
    return spots, places, Grid((points, points), (side, side))


def test_field_is_that_of_hertz():
    """Integral of Hertz's pressure over 1/r, and far away the point load's."""
    r = 1.7
    integral, _ = dblquad(
        lambda phi, q: q * math.sqrt(1 - q * q) / math.sqrt(r * r + q * q - 2 * r * q * math.cos(phi)),
        0, 1, 0, 2 * math.pi, epsabs=1e-11,
    )  # fmt: skip
    assert beyond_point(r, 1.0) + 1 / r == pytest.approx(1.5 / math.pi * integral, rel=1e-9)
    assert beyond_point(1e-7, 1.0) + 1e7 == pytest.approx(0.75 * math.pi, rel=1e-6)
    inside = 0.75 * (1.75 * math.pi / 2)  # (2 - r^2) pi/2 at r = 1/2
    assert beyond_point(0.5, 1.0) + 2 == pytest.approx(inside, rel=1e-12)


@pytest.mark.parametrize("load", [1e-4, 3e-2])
def test_a_balance_is_one_by_plain_loops(load):
    spots, places, grid = some(80)
    start = spots.separation_at(load)
    found = balanced(spots, places, grid, start, load)
    assert found.share == 1
    assert spots.loads(found.penetrations).sum() == pytest.approx(load, rel=1e-10)
    assert residual(spots, places, grid, start, found) < 1e-10
    at = balanced(spots, places, grid, start)
    assert at.separation == start
    assert residual(spots, places, grid, start, at) < 1e-10


def test_series_where_there_are_too_many_for_a_matrix(monkeypatch):
    spots, places, grid = some(60)
    start = spots.separation_at(3e-3)
    by_matrix = balanced(spots, places, grid, start, 3e-3)
    monkeypatch.setattr(located, "_DENSE", 59)
    by_series = balanced(spots, places, grid, start, 3e-3)
    assert_allclose(by_series.penetrations, by_matrix.penetrations, rtol=1e-8, atol=1e-15)
    assert by_series.stiffness == pytest.approx(by_matrix.stiffness, rel=1e-8)


def test_a_lattice_rises_by_its_constant():
    """Equal spots on a square lattice: the mean plane's correction, -3.9 P/(pi E* sqrt(n A))."""
    n, at = 6, np.arange(6) * 16 + 8
    places = np.array([np.repeat(at, n), np.tile(at, n)])
    spots, grid = Spots.hertz(np.zeros(n * n), np.full(n * n, 1e-5), 1e9), Grid((96, 96), (1e-2, 1e-2))
    found = balanced(spots, places, grid, spots.separation_at(1e-3), 1e-3)
    rise = -LATTICE * 1e-3 / (math.pi * 1e9 * n * 1e-2)
    assert_allclose(found.penetrations + found.separation, rise, rtol=1e-9)


def test_stiffness_is_the_derivative():
    """Contacts stay as wide to their neighbours as they are alone at the separation given."""
    spots, places, grid = some(100)
    start, step = spots.separation_at(3e-3), 1e-5
    found = balanced(spots, places, grid, start, 3e-3)
    up, down = (balanced(spots, places, grid, start, 3e-3 * (1 + s)).separation for s in (step, -step))
    assert found.stiffness == pytest.approx(2 * step * 3e-3 / (down - up), rel=1e-6)


def test_without_a_balance_less_of_the_interaction_counts():
    """Wide spots side by side under a load that none of them can carry beside the others."""
    rng = np.random.default_rng(4)
    places = np.array(np.divmod(rng.choice(17 * 17, 100, replace=False), 17)) + 20
    spots = Spots.hertz(1e-6 * rng.standard_normal(100), 1e-5 * rng.uniform(0.5, 20, 100), 1e9)
    grid, shares = Grid((64, 64), (1e-4, 1e-4)), []
    for load in (0.01, 0.5, 10.0):
        start = spots.separation_at(load)
        found = balanced(spots, places, grid, start, load)
        shares.append(found.share)
        assert spots.loads(found.penetrations).sum() == pytest.approx(load, rel=1e-10)
        assert residual(spots, places, grid, start, found) < 1e-10
        assert found.stiffness > 0
    assert shares == [1.0, 0.5, 0.0]
