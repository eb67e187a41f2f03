"""What a map's estimates are made of, on small maps whose sums are known in closed form."""

import math

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from numpy.polynomial.polynomial import polyder, polyval2d
from oracles.inside import (
    SUMS,
    Summits,
    _unhidden,
    by_caps,
    by_summits,
    coarse_sums_of,
    summit_sums_of,
    variation,
    visible,
)
from oracles.rough import fit_map
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.stats import norm

import analytic
import mcgw
from mcgw.maps import Topography

UM = 1e-6


@pytest.mark.parametrize(("count", "across", "step"), [
    (summit_sums_of, 1, 1), (summit_sums_of, 2, 1), (coarse_sums_of, 1, 2),
])  # fmt: skip
def test_differences_of_a_polynomial_are_its_derivatives(count, across, step):
    """Of fifth order: curvatures are exact; slopes lose h^4/30 of f^(5), plain ones h^2/12 of f^(4).

    On every point, and on the four maps of every second one.
    """
    (rows, columns), pixel, edge = (26, 24), (0.25, 0.4), 4 * step  # points at each edge are left out
    c = np.random.default_rng(1).normal(size=(6, 6))  # c[a, b] of x^a y^b
    c[np.add.outer(np.arange(6), np.arange(6)) > 5] = 0
    x, y = (np.arange(columns) - 8) * pixel[0], (np.arange(rows) - 10) * pixel[1]
    z = polyval2d(*np.meshgrid(x, y), c)
    found = count(Topography(z, pixel), across=across)
    u, v = np.meshgrid(x[edge:-edge], y[edge:-edge])

    def derivative(order, axis):
        return polyval2d(u, v, polyder(c, order, axis=axis))

    means = np.empty_like(z)
    for j, i in np.ndindex(step, step):
        means[j::step, i::step] = z[j::step, i::step].mean()
    f, both = (z - means)[edge:-edge, edge:-edge], ((0, step * pixel[0]), (1, step * pixel[1]))
    slopes = [derivative(1, k) - h**4 / 30 * derivative(5, k) for k, h in both]
    bends = [[derivative(2, k) + share * h**2 * derivative(4, k) for k, h in both] for share in (0, 1 / 12)]
    squares = [np.ones_like(f), f, f**2, f**3, *(s**2 for s in slopes)]
    squares += [*((xx**2 + yy**2) / 2 for xx, yy in bends), slopes[0] * slopes[1]]
    row, column = np.indices(f.shape)
    part = row * across // f.shape[0] * across + column * across // f.shape[1]
    for name, sums, square in zip(SUMS, found.sums, squares, strict=True):
        expected = np.bincount(part.ravel(), square.ravel())
        np.testing.assert_allclose(sums, expected, rtol=1e-10, atol=1e-9, err_msg=name)
    assert found.area == pytest.approx(step**2 * f.size * pixel[0] * pixel[1], rel=1e-14)


@pytest.mark.parametrize("periodic", [True, False])
@pytest.mark.parametrize("holes", [False, True])
def test_summits_are_points_above_their_neighbours(periodic, holes):
    """Of whole numbers, so that many are equal: of these the last one counts. Points near holes do not."""
    generator = np.random.default_rng(2)
    z = generator.integers(0, 12, (30, 26)).astype(float)
    there = generator.random(z.shape) > 0.01 if holes else np.ones(z.shape, dtype=bool)
    there[0, 7] = there[12, -1] = not holes
    found = summit_sums_of(Topography(z, (1.0, 1.0), periodic), across=3, seen=there if holes else None)
    edge, places = 0 if periodic else 4, []
    rows, columns = z.shape[0] - 2 * edge, z.shape[1] - 2 * edge
    near = [(b, a) for b in range(-2, 3) for a in range(-2, 3)]
    points = 0
    for j in range(edge, z.shape[0] - edge):
        for i in range(edge, z.shape[1] - edge):
            if not all(there[(j + b) % z.shape[0], (i + a) % z.shape[1]] for b, a in near):
                continue
            points += 1
            around = {
                (b, a): z[(j + b) % z.shape[0], (i + a) % z.shape[1]] for b, a in near if abs(a) < 2 > abs(b)
            }
            if all(other < z[j, i] or (other == z[j, i] and at <= (0, 0)) for at, other in around.items()):
                places.append((j - edge, i - edge))
    row, column = np.array(places).T
    assert found.sums[0].sum() == points
    np.testing.assert_array_equal([found.y // 1, found.x // 1], [row + edge, column + edge])
    np.testing.assert_array_equal(found.tile, row * 3 // rows * 3 + column * 3 // columns)


def counted(heights, curvatures, *, area=1.0, parts=4):
    """Summits of a map of four parts that are all alike."""
    sums = np.zeros((len(SUMS), parts))
    sums[0] = 100
    heights, bends = np.tile([heights, curvatures], parts)
    tile = np.repeat(np.arange(parts), len(heights) // parts)
    return Summits(
        sums, bends, bends, heights, bends, np.array([bends, bends]), tile, (area / 100 / parts, 1.0)
    )


def test_what_a_grid_loses_goes_as_the_square_of_the_pixel():
    """Of a quarter as many points four times as much is lost: what is extrapolated is the truth."""
    eta, radius, sigma = 400.0, 2.0, 3.0
    loss = np.array([0.02, 0.03, 0.01])

    def seen_by(share):  # density, curvature and spread of heights with so much of a loss
        n = round(eta / 4 * (1 - share * loss[0]))
        z = np.linspace(-1, 1, n)
        z *= sigma * (1 - share * loss[2]) / np.tile(z, 4).std(ddof=1)
        return counted(z, np.full(n, (1 - share * loss[1]) / radius))

    found = by_summits(seen_by(1), seen_by(4))
    assert [value for value, _ in found] == pytest.approx([eta, radius, sigma], rel=1e-12)
    # The parts are alike: the error is a quarter of what was added, but for the n - 1 of the spread.
    added = [eta * 0.02, radius / 0.97 - radius, sigma * 0.01]
    assert [error for _, error in found[:2]] == pytest.approx([x / 4 for x in added[:2]], rel=1e-9)
    assert found[2][1] == pytest.approx(added[2] / 4, rel=0.03)


def by_quadrature(overlap, blur):
    """Share, mean and deviation of the summits without a taller neighbour beyond `blur` of their valley."""

    def hidden(s):  # mean number of neighbours that are as much taller at their distance
        if blur == 0:
            return analytic.fn(1, s) / 2
        return quad(lambda r: r * norm.sf(s + r * r - 2 * r * blur), 0, blur + 5, epsabs=1e-12)[0]

    x, w = leggauss(60)
    s, w = 7 * x, 7 * w
    p = w * norm.pdf(s) * np.exp([-4 * math.pi * overlap * hidden(float(t)) for t in s])
    mean = p @ s / p.sum()
    return p.sum(), mean, math.sqrt(p @ (s - mean) ** 2 / p.sum())


@pytest.mark.parametrize(("overlap", "blur"), [(0.002, 0.0), (0.3, 0.0), (0.05, 0.3)])
def test_hidden_caps_by_quadrature(overlap, blur):
    """Of a Poisson field; and so many and so high seen, the field itself is found again."""
    share, mean, std = by_quadrature(overlap, blur)
    found = visible(overlap, blur)
    assert (found.share, found.mean, found.std) == pytest.approx((share, mean, std), rel=1e-7)
    radius, sigma = 1e-5, 1e-6
    eta = overlap / radius / sigma
    back = _unhidden(eta * share, radius, sigma * std, blur * math.sqrt(2 * radius * sigma * std))
    if blur == 0:
        assert back == pytest.approx((eta, sigma), rel=1e-7)
        # Ripples in valleys, much flatter than the median, are no caps.
        z = np.linspace(-1, 1, 50)
        z *= sigma * std / np.tile(z, 4).std(ddof=1)
        heights, bends = np.append(z, [-9e-6, 9e-6]), np.append(np.full(50, 1 / radius), [2e4, 1e4])
        pairs = by_caps(counted(heights, bends, area=200 / eta / share), 0.0)
        assert [x for x, _ in pairs] == pytest.approx([eta, radius, sigma], rel=1e-7)
        assert pairs[1][1] == pytest.approx(1 / bends.mean() - radius, rel=1e-9)  # median and mean differ
    else:
        assert back[0] > _unhidden(eta * share, radius, sigma * std, 0.0)[0]


def test_caps_are_as_sharp_as_half_of_the_median():
    z, bends = 1e-6 * np.linspace(-1, 1, 50), np.full(50, 1e5)
    plain, flat, sharp = (
        by_caps(counted(np.append(z, height), np.append(bends, bend), area=1e-6), 0.0)
        for height, bend in (([], []), (3e-7, 0.497e5), (3e-7, 0.503e5))
    )
    assert flat[2][0] == plain[2][0] != sharp[2][0]
    assert sharp[0][0] > 1.01 * plain[0][0] > flat[0][0] / 1.01


def test_a_map_has_sixteen_points_for_four_sub_areas():
    """And four at each edge that do not count, unless it is periodic."""
    z = np.random.default_rng(1).normal(size=(24, 24))
    assert summit_sums_of(Topography(z, (1.0, 1.0))).sums[0].sum() == 256
    assert summit_sums_of(Topography(z[:16, :16], (1.0, 1.0), periodic=True)).sums[0].sum() == 256
    for few in (z[:23], z[:, :23]):
        with pytest.raises(ValueError, match="points are left: too few for 4 x 4 sub-areas"):
            summit_sums_of(Topography(few, (1.0, 1.0)))


def test_where_nothing_is_seen_nothing_is_found_again():
    nothing = visible(1e30)
    assert (nothing.share, nothing.mean, nothing.std) == (0, 0, 0)
    assert visible(0.0).share == pytest.approx(1, rel=1e-12)
    assert visible(0.0).std == pytest.approx(1, rel=1e-9)
    assert _unhidden(1e9, 1e-5, 0.0, 0.0) is None
    assert _unhidden(1e9, 1e-5, 1e-3, 0.0) is None  # no field shows so many
    assert _unhidden(1e3, 1e-5, 1e-6, 0.0) == pytest.approx((1e3, 1e-6), rel=1e-5)


# --- summits one by one: those of a few cosines, known on paper -------------------------------------------


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


def test_every_summit_of_four_cosines(without_caps):
    """A summit stands where both waves have a maximum: place, height and curvatures follow.

    On pixels of 0.5 x 0.6 um, 50 to a short wave.
    """
    x, y = (np.arange(800) + 0.5) * 0.5 * UM, (np.arange(500) + 0.5) * 0.6 * UM
    waves = Topography(X(x) + Y(y)[:, None], (0.5 * UM, 0.6 * UM), periodic=True)
    fit = fit_map(waves, cutoff=None, form="none")
    x, y = (a.ravel() for a in np.meshgrid(X.maxima(), Y.maxima()))
    assert fit.summits.size == x.size == 160
    found = fit.listed
    true = X(x) + Y(y)
    nearest = np.argmin(np.hypot(x - found.x[:, None], y - found.y[:, None]), axis=1)
    assert sorted(nearest) == list(range(x.size))
    bend_x, bend_y = -X(x, 2), -Y(y, 2)
    skew_x, skew_y = (abs(w(t, 3) / w(t, 2))[nearest] for w, t in ((X, x), (Y, y)))
    # The vertex through three points h apart lies h^2/6 times (third over second derivative) beside it.
    assert np.all(abs(found.x - x[nearest]) < 1.2 * (0.5 * UM) ** 2 / 6 * skew_x + 1e-3 * UM)
    assert np.all(abs(found.y - y[nearest]) < 1.2 * (0.6 * UM) ** 2 / 6 * skew_y + 1e-3 * UM)
    np.testing.assert_allclose(fit.summits, (true - true.mean())[nearest], atol=1e-4 * 0.1 * UM)
    # Curvatures are those at the pixel, up to half of it beside the summit.
    order = np.argsort([-bend_x[nearest], -bend_y[nearest]], axis=0)
    bends = np.take_along_axis(np.array([bend_x, bend_y])[:, nearest], order, axis=0)
    beside = np.take_along_axis(np.array([0.25 * UM * skew_x, 0.3 * UM * skew_y]), order, axis=0)
    assert np.all(abs(found.curvatures / bends - 1) < 1.1 * beside + 0.004)
    assert np.all(abs(fit.radii * np.sqrt(bends[0] * bends[1]) - 1) < beside.sum(axis=0) + 0.004)


def test_principal_curvatures_of_a_turned_paraboloid_are_exact():
    """Its axes lie aslant to the pixels, so that its mixed derivative counts."""
    y, x = np.indices((25, 25)) - 12.0
    z = 5.0 - x**2 - 0.75 * (0.5 * x * y + 3 * y**2)
    (found,) = summit_sums_of(Topography(z, (0.5, 0.5)), across=1).curvatures.T
    expected = np.linalg.eigvalsh(np.array([[2.0, 0.375], [0.375, 4.5]]) / 0.25)
    np.testing.assert_allclose(found, expected[::-1], rtol=1e-12)


def test_tiles_without_summits_or_points_are_nan():
    """One summit has no spread of heights."""
    sums = np.ones((len(SUMS), 4))
    sums[:, 3] = 0
    two = np.full((2, 3), 2.0)
    one = Summits(sums, *two, np.ones(3), two[0], two, np.array([0, 0, 1]), (0.5, 1.0))
    found = {c.name: np.asarray(c.values).tolist() for c in one.tiles().columns}
    assert found["summits"] == [2, 1, 0, 0]
    assert (found["column"], found["row"]) == ([0, 1, 0, 1], [0, 0, 1, 1])
    assert found["eta"][:3] == [4, 2, 0]
    assert found["radius"][:2] == [0.5, 0.5]
    assert found["sigma"][0] == 0
    nan = {"radius": [2, 3], "sigma": [1, 2, 3], "eta": [3], "m0": [3], "m2": [3], "m4": [3]}
    for name, places in nan.items():
        assert np.flatnonzero(np.isnan(found[name])).tolist() == places, name
    assert variation(np.array([1.0, 3.0, np.nan])) == pytest.approx(math.sqrt(2) / 2)
    assert math.isnan(variation(np.array([1.0, np.nan])))


# --- maps that no instrument gives ------------------------------------------------------------------------


def test_every_point_of_two_by_two_may_be_a_summit():
    """Of odd sides too: as many as there can be."""
    z = np.zeros((33, 33))
    z[::2, ::2] = 1.0
    assert summit_sums_of(Topography(z, (1e-6, 1e-6))).heights.size == 13 * 13


NO_SURFACE = r"m2 = .* no surface has these; give the right unit, or take bad points .* out by --spikes"
NO_NUMBERS = "squares of their derivatives overflow, or points are missing"


@pytest.mark.parametrize(("factor", "place", "height", "told"), [
    (1.0, (3, 30), -0.016, NO_SURFACE), (1e-90, (0, 0), 0.0, NO_SURFACE), (1.0, (30, 30), 1e80, NO_NUMBERS),
])  # fmt: skip
def test_moments_that_no_surface_has_are_refused_in_one_line(factor, place, height, told):
    """Slopes on the margin count and heights do not; squares of sums overflow or vanish, sums do not."""
    z = factor * 1e-6 * np.random.default_rng(1).normal(size=(64, 66))
    z[place] = height
    with pytest.raises(ValueError, match=told):
        mcgw.fit(Topography(z, (1e-6, 1e-6)), cutoff=None)


def test_sums_that_lack_a_point_are_refused():
    z = 1e-6 * np.random.default_rng(1).normal(size=(64, 66))
    z[16, 16] = np.nan
    with pytest.raises(ValueError, match=f"on pixels of 1e-06 m: {NO_NUMBERS}"):
        summit_sums_of(Topography(z, (1e-6, 2e-6)))
