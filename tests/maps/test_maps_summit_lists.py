"""Summits one by one: those of a few cosines, known on paper; their table; what each tile of a map tells."""

import csv
import math

import numpy as np
import pytest
from oracles.fit_of_maps import fit_map
from oracles.inside import SUMS, SummitSums, summit_sums_of
from scipy.optimize import brentq

import mcgw
from mcgw.cli import main
from mcgw.maps import Topography, write_map
from mcgw.maps.summits import summits_of, tiles_of, variation

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


def test_waves_along_the_diagonals():
    """Principal directions between the axes: the mixed derivative tells the two curvatures apart."""
    n, q = 200, 2 * math.pi / (20 * UM)
    x, y = np.meshgrid(np.arange(n) * UM, np.arange(n) * UM)
    z = 1e-7 * (3 * np.cos(q * (x + y)) + np.cos(q * (x - y)))
    topography = Topography(z, (UM, UM), periodic=True)
    found = summits_of(topography, summit_sums_of(topography), (0.0, 0.0))
    assert found.heights.size == 200  # two in each cell of 20 um
    a = 2 * q * q * 1e-7
    # Stencils of the fourth order at 20 pixels a wave: (2 pi/20)^4/30 of a first derivative, twice.
    np.testing.assert_allclose(found.curvatures[0], 3 * a, rtol=1e-3)
    np.testing.assert_allclose(found.curvatures[1], a, rtol=2e-3)
    np.testing.assert_allclose(found.x / (10 * UM) % 1, np.full(200, 0.05), atol=1e-6)  # half a pixel


def test_places_are_those_on_the_map_as_it_was_read(without_caps):
    """A cutoff takes a margin off; the bumps, one a field of a chess board, stay where they were."""
    rng = np.random.default_rng(4)
    column, row = (a.ravel() for a in np.meshgrid(np.arange(8), np.arange(6)))
    bumps = np.array([30 + 20 * column, 30 + 20 * row]) + rng.uniform(-1, 1, (2, column.size))
    y, x = np.mgrid[0:160, 0:200] + 0.5
    z = sum(np.exp(-((x - a) ** 2 + (y - b) ** 2) / 20) for a, b in bumps.T)
    found = fit_map(Topography(z * UM, (UM, UM)), cutoff=8 * UM, form="none").listed
    distance = np.hypot(found.x / UM - bumps[0][:, None], found.y / UM - bumps[1][:, None]).min(axis=1)
    assert np.all(distance < 0.05)


def test_ridges_between_pixels_are_counted_and_have_a_radius(without_caps):
    """White noise: some have a saddle by stencils of the fourth order. None is without a curvature."""
    noise = Topography(np.random.default_rng(5).normal(size=(150, 150)) * UM, (UM, 2 * UM))
    found = fit_map(noise, cutoff=None, form="none").listed
    assert 0 < found.unresolved < 0.03 * found.heights.size
    assert np.all(found.curvatures > 0)
    assert np.all(np.isfinite(found.radii))
    ridges = found.curvatures[0] == found.curvatures[1]  # plain differences, of the pixel below each
    i, j = 4 + np.rint(summit_sums_of(noise).places[:, ridges] * 142 - 0.5).astype(int)
    z = noise.heights
    x, y = z[j, i + 1] + z[j, i - 1] - 2 * z[j, i], z[j + 1, i] + z[j - 1, i] - 2 * z[j, i]
    np.testing.assert_allclose(found.curvatures[0][ridges], -(x + y / 4) / 2 / UM**2, rtol=1e-9)


@pytest.fixture(scope="module")
def tables(waves, tmp_path_factory):
    folder = tmp_path_factory.mktemp("tables")
    write_map(waves, folder / "map.npy")
    words = ["fit", str(folder / "map.npy"), "--cutoff", "none", "--form", "none", "--parts", "3"]
    words += ["--summits", str(folder / "s.csv"), "--tiles", str(folder / "t.csv")]
    assert main([*words, "-o", str(folder / "f.toml")]) == 0
    return folder


def rows(path):
    comment, *lines = path.read_text().splitlines()
    assert comment.startswith("# ")
    names = [name.partition(" (")[0] for name in lines[0].split(",")]
    return list(csv.DictReader(lines[1:], names))


def test_the_table_reads_back_to_the_last_bit(tables, waves):
    fit = mcgw.fit(waves, cutoff=None, form="none", parts=3)
    found = rows(tables / "s.csv")
    listed = fit.listed
    columns = (listed.x, listed.y, fit.summits, fit.radii, *listed.curvatures)
    for name, values in zip(
        ("x", "y", "height", "radius", "curvature_1", "curvature_2"), columns, strict=True
    ):
        np.testing.assert_array_equal([float(row[name]) for row in found], values)
    assert [int(row["tile"]) for row in found] == listed.tile.tolist()


def test_each_tile_by_itself(tables, waves):
    """Literal: the mean squares of numbers on each ninth of the map, and the summits that stand there."""
    found = rows(tables / "t.csv")
    listed = mcgw.fit(waves, cutoff=None, form="none", parts=3).listed
    assert [row["column"] + row["row"] for row in found[:4]] == ["00", "10", "20", "01"]
    x, y = X(0.5 * UM * (np.arange(800) + 0.5)), Y(0.6 * UM * (np.arange(500) + 0.5))
    column, line = np.arange(800) * 3 // 800, np.arange(500) * 3 // 500
    for k, row in enumerate(found):
        z = x[column == k % 3] + y[line == k // 3][:, None]
        assert float(row["m0"]) == pytest.approx(z.var(), rel=1e-9)
        here = listed.tile == k
        assert int(row["summits"]) == here.sum()
        assert float(row["eta"]) == pytest.approx(here.sum() / (z.size * 0.3e-12), rel=1e-12)
        assert float(row["sigma"]) == pytest.approx(listed.heights[here].std(ddof=1), rel=1e-9)
        assert float(row["radius"]) == pytest.approx(1 / listed.curvatures[:, here].mean(), rel=1e-9)
    for name, order in (("m2", 1), ("m4", 2)):
        x, y = X(0.5 * UM * (np.arange(800) + 0.5), order), Y(0.6 * UM * (np.arange(500) + 0.5), order)
        mean = np.mean([float(row[name]) for row in found])
        assert mean == pytest.approx(((x**2).mean() + (y**2).mean()) / 2, rel=5e-3)


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
    assert math.isnan(variation(np.array([np.nan])))
