"""Summits one by one: those of a few cosines, known on paper; their table; what each tile of a map tells."""

import math

import numpy as np
import pytest
from oracles.fit_of_maps import fit_map
from oracles.inside import SUMS, SummitSums
from scipy.optimize import brentq

from mcgw.maps import Topography
from mcgw.maps.summits import tiles_of, variation

UM = 1e-6


class Wave:
    """Two cosines along a line that repeats itself, and its maxima by bracketing."""

    def __init__(self, length, long, short):
        self.length = length
        self.parts = [(a, 2 * math.pi * n / length, phase) for a, n, phase in (long, short)]

    def __call__(self, t, order=0):
        return sum(a * q**order * np.cos(q * t + p + order * math.pi / 2) for a, q, p in self.parts)

    def maxima(self):
        grid = np.linspace(0, self.length, 20001)
        slope = self(grid, 1)
        at = np.nonzero((slope[:-1] > 0) & (slope[1:] <= 0))[0]
        return np.array([brentq(lambda t: self(t, 1), grid[k], grid[k + 1], xtol=1e-15) for k in at])


X = Wave(400 * UM, (0.3 * UM, 3, 0.4), (0.1 * UM, 16, 1.1))
Y = Wave(300 * UM, (0.2 * UM, 2, 2.0), (0.05 * UM, 10, 0.3))


@pytest.fixture(scope="module")
def waves():
    """Their sum on pixels of 0.5 x 0.6 um, 50 to a short wave."""
    x, y = (np.arange(800) + 0.5) * 0.5 * UM, (np.arange(500) + 0.5) * 0.6 * UM
    return Topography(X(x) + Y(y)[:, None], (0.5 * UM, 0.6 * UM), periodic=True)


def test_every_summit_of_four_cosines(waves, without_caps):
    """A summit stands where both waves have a maximum: place, height and curvatures follow."""
    fit = fit_map(waves, cutoff=None, form="none")
    x, y = (a.ravel() for a in np.meshgrid(X.maxima(), Y.maxima()))
    assert fit.summits.size == x.size == 160
    found = fit.listed
    assert found.unresolved == 0
    true = X(x) + Y(y)
    nearest = np.argmin(np.hypot(x - found.x[:, None], y - found.y[:, None]), axis=1)
    assert sorted(nearest) == list(range(x.size))
    bend_x, bend_y = -X(x, 2), -Y(y, 2)
    skew_x, skew_y = (abs(w(t, 3) / w(t, 2))[nearest] for w, t in ((X, x), (Y, y)))
    # The vertex through three points h apart lies h^2/6 times (third over second derivative) beside it.
    assert np.all(abs(found.x - x[nearest]) < 1.2 * (0.5 * UM) ** 2 / 6 * skew_x + 1e-3 * UM)
    assert np.all(abs(found.y - y[nearest]) < 1.2 * (0.6 * UM) ** 2 / 6 * skew_y + 1e-3 * UM)
    np.testing.assert_allclose(found.heights, (true - true.mean())[nearest], atol=1e-4 * 0.1 * UM)
    # Curvatures are those at the pixel, up to half of it beside the summit.
    order = np.argsort([-bend_x[nearest], -bend_y[nearest]], axis=0)
    bends = np.take_along_axis(np.array([bend_x, bend_y])[:, nearest], order, axis=0)
    beside = np.take_along_axis(np.array([0.25 * UM * skew_x, 0.3 * UM * skew_y]), order, axis=0)
    assert np.all(abs(found.curvatures / bends - 1) < 1.1 * beside + 0.004)
    assert np.all(abs(fit.radii * np.sqrt(bends[0] * bends[1]) - 1) < beside.sum(axis=0) + 0.004)


def test_tiles_without_summits_or_points_are_nan():
    """One summit has no spread of heights."""
    sums = np.ones((len(SUMS), 4))
    sums[:, 3] = 0
    one = SummitSums(sums, np.ones(3), np.full(3, 2.0), np.zeros((2, 3)), np.array([0, 0, 1]), 0.5)
    found = {c.name: np.asarray(c.values).tolist() for c in tiles_of(one).columns}
    assert found["summits"] == [2, 1, 0, 0]
    assert (found["column"], found["row"]) == ([0, 1, 0, 1], [0, 0, 1, 1])
    assert found["eta"][:3] == [4, 2, 0]
    assert found["radius"][:2] == [0.5, 0.5]
    assert found["sigma"][0] == 0
    nan = {"radius": [2, 3], "sigma": [1, 2, 3], "eta": [3], "m0": [3], "m2": [3], "m4": [3]}
    for name, places in nan.items():
        assert np.flatnonzero(np.isnan(found[name])).tolist() == places, name


def test_variation_is_that_of_tiles_that_tell_something():
    assert variation(np.array([1.0, 3.0, np.nan])) == pytest.approx(math.sqrt(2) / 2)
    assert math.isnan(variation(np.array([1.0, np.nan])))
