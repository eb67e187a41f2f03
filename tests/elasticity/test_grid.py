"""The potential of a periodic half-space: against lattice sums."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.inside import Grid

LATTICE = -3.900264920001956  # 4 zeta(1/2) beta(1/2), physics of a square lattice


def test_potential_of_own_images_is_the_lattice_constant():
    for n in (48, 64, 100):
        assert_allclose(Grid((n, n), (2.0, 2.0)).potential[0, 0], LATTICE / 2, rtol=1e-14)


def test_potential_is_the_sum_over_images():
    """Between two points, by plain summation over 29 000 images; what is left out is 1e-5."""
    grid, far = Grid((48, 96), (2.0, 1.0)), 60
    i, j = np.meshgrid(np.arange(-far, far + 1), np.arange(-2 * far, 2 * far + 1))

    def plain(x, y):
        """Less the background of all those cells, in closed form."""
        a, b = 2 * far + 1, 2 * far + 0.5
        sides = [(a + p * x, b + q * y) for p in (-1, 1) for q in (-1, 1)]
        background = sum(u * math.asinh(v / u) + v * math.asinh(u / v) for u, v in sides) / 2
        return float((1 / np.hypot(x + 2 * i, y + j)).sum()) - background

    apart = grid.potential[12, 24] - grid.potential[6, 3]
    assert_allclose(apart, plain(0.5, 0.25) - plain(0.0625, 0.125), atol=2e-5)
    assert abs(apart) > 1


def test_series_sum_as_the_matrix():
    rng, grid = np.random.default_rng(20261124), Grid((48, 96), (2e-4, 1e-4))
    places, loads = np.array(np.divmod(rng.choice(48 * 96, 40, replace=False), 96)), rng.random(40)
    assert_allclose(grid.summed(places, loads), grid.between(places) @ loads, rtol=1e-11)


def test_a_grid_needs_points():
    with pytest.raises(ValueError, match="46 or more"):
        Grid((45, 45), (1.0, 1.0))
    wide = Grid((46, 184), (3.0, 1.0))
    assert wide.pixel == pytest.approx((3 / 184, 1 / 46))
