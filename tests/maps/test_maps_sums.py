"""What a map's estimates are made of, on small maps whose sums are known in closed form."""

import math

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from numpy.polynomial.polynomial import polyder, polyval2d
from oracles.inside import (
    SUMS,
    SummitSums,
    _apex,
    by_caps,
    by_moments,
    by_summits,
    coarse_sums_of,
    jackknife,
    mean_squares,
    moments_of,
    skewness_of,
    summit_sums_of,
    unhidden,
    visible,
)
from scipy.integrate import quad
from scipy.stats import norm, t as t_law

import analytic
from mcgw.maps import Topography


@pytest.mark.parametrize("across", [1, 2])
def test_differences_of_a_polynomial_are_its_derivatives(across):
    """Of fifth order: curvatures are exact; slopes lose h^4/30 of f^(5), plain ones h^2/12 of f^(4)."""
    (rows, columns), (dx, dy) = (21, 18), (0.25, 0.4)
    c = np.random.default_rng(1).normal(size=(6, 6))  # c[a, b] of x^a y^b
    c[np.add.outer(np.arange(6), np.arange(6)) > 5] = 0
    x, y = (np.arange(columns) - 8) * dx, (np.arange(rows) - 10) * dy
    z = polyval2d(*np.meshgrid(x, y), c)
    found = summit_sums_of(Topography(z, (dx, dy)), across=across)
    u, v = np.meshgrid(x[4:-4], y[4:-4])  # four points at each edge are left out

    def derivative(order, axis):
        return polyval2d(u, v, polyder(c, order, axis=axis))

    f = z[4:-4, 4:-4] - z.mean()
    slopes = [derivative(1, k) - h**4 / 30 * derivative(5, k) for k, h in ((0, dx), (1, dy))]
    bends = [
        [derivative(2, k) + share * h**2 * derivative(4, k) for k, h in ((0, dx), (1, dy))]
        for share in (0, 1 / 12, 1 / 3)
    ]
    squares = [np.ones_like(f), f, f**2, f**3, *(s**2 for s in slopes)]
    squares += [*((xx**2 + yy**2) / 2 for xx, yy in bends), slopes[0] * slopes[1]]
    row, column = np.indices(f.shape)
    part = row * across // f.shape[0] * across + column * across // f.shape[1]
    for name, sums, square in zip(SUMS, found.sums, squares, strict=True):
        expected = np.bincount(part.ravel(), square.ravel())
        np.testing.assert_allclose(sums, expected, rtol=1e-10, atol=1e-9, err_msg=name)
    assert found.area == pytest.approx(f.size * dx * dy, rel=1e-14)
    assert found.pixel_area == pytest.approx(dx * dy, rel=1e-14)


A, B, PIXEL = 3e-7, 2e-7, (0.5e-6, 0.8e-6)
PHASES = 2 * math.pi / 10, 2 * math.pi / 8  # ten pixels to a wave along x, eight along y


def two_waves(turned):
    """Cosines along x and y with their tops on pixels; or the same with x and y changed about."""
    i, j = np.arange(40), np.arange(32)
    z = A * np.cos(PHASES[0] * i) + B * np.cos(PHASES[1] * j)[:, None]
    return Topography(z.T.copy() if turned else z, PIXEL[::-1] if turned else PIXEL, periodic=True)


def seen(step=1):
    """What differences over so many pixels see of both waves, by their transfer functions."""
    phases, pixels = (step * t for t in PHASES), (step * p for p in PIXEL)
    both = [
        ((8 * math.sin(t) - math.sin(2 * t)) / 6 / p, (15 - 16 * math.cos(t) + math.cos(2 * t)) / 6 / p**2)
        for t, p in zip(phases, pixels, strict=True)
    ]
    return [s for s, _ in both], [b for _, b in both]


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(("count", "step"), [(summit_sums_of, 1), (coarse_sums_of, 2)])
def test_sums_over_two_waves(count, step, turned):
    """Mean squares are halves of squared amplitudes, on every point and on every second one."""
    found = count(two_waves(turned), across=2)
    (sx, sy), (bx, by) = seen(step)
    squares = mean_squares(found)
    slopes = ("slope_y", "slope_x") if turned else ("slope_x", "slope_y")
    assert squares[slopes[0]] == pytest.approx((A * sx) ** 2 / 2, rel=1e-12)
    assert squares[slopes[1]] == pytest.approx((B * sy) ** 2 / 2, rel=1e-12)
    assert squares["bend"] == pytest.approx(((A * bx) ** 2 + (B * by) ** 2) / 4, rel=1e-12)
    for name, width in (("bend_1", step), ("bend_2", 2 * step)):
        plain = [(2 - 2 * math.cos(width * t)) / (width * p) ** 2 for t, p in zip(PHASES, PIXEL, strict=True)]
        assert squares[name] == pytest.approx(((A * plain[0]) ** 2 + (B * plain[1]) ** 2) / 4, rel=1e-12)
    m = moments_of(found)
    assert m.m0 == pytest.approx((A**2 + B**2) / 2, rel=1e-12)
    assert m.m2 == pytest.approx(((A * sx) ** 2 + (B * sy) ** 2) / 4, rel=1e-12)
    assert skewness_of(found) == pytest.approx(0, abs=1e-9)
    assert found.area == pytest.approx(step**2 * 40 * 32 * PIXEL[0] * PIXEL[1], rel=1e-12)
    if step == 1:  # a summit where both are highest
        assert found.heights == pytest.approx(np.full(16, A + B), rel=1e-12)
        assert found.curvatures == pytest.approx(np.full(16, (A * bx + B * by) / 2), rel=1e-10)
        along_x = (np.arange(4) * (8 if turned else 10) + 0.5) / (32 if turned else 40)
        assert np.unique(found.places[0]) == pytest.approx(along_x)
        assert np.bincount(found.part).tolist() == [4, 4, 4, 4]


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
    assert found.places == pytest.approx(np.array([(column + 0.5) / columns, (row + 0.5) / rows]))
    np.testing.assert_array_equal(found.part, row * 3 // rows * 3 + column * 3 // columns)


def on_the_pixel(z, points=101):
    """The paraboloid of differences on a fine grid over the middle pixel: a literal maximum."""
    v, u = np.meshgrid(*2 * [np.linspace(-0.5, 0.5, points)], indexing="ij")
    gx, gy = (z[1, 2] - z[1, 0]) / 2, (z[2, 1] - z[0, 1]) / 2
    xx, yy = z[1, 2] - 2 * z[1, 1] + z[1, 0], z[2, 1] - 2 * z[1, 1] + z[0, 1]
    xy = (z[2, 2] - z[2, 0] - z[0, 2] + z[0, 0]) / 4
    return (z[1, 1] + gx * u + gy * v + xx * u * u / 2 + yy * v * v / 2 + xy * u * v).max()


def test_the_apex_is_the_highest_point_of_the_paraboloid_on_its_pixel():
    """Summits at random, and ridges whose determinant is next to nothing."""
    generator = np.random.default_rng(1)
    cases = [generator.random((3, 3)) ** power for power in (1, 4) for _ in range(60)]
    y, x = np.mgrid[-1:2, -1:2]
    for slope in (0.0, 0.5, 1.0, -1.0):
        cases += [-((x + slope * y - 0.1) ** 2) + 1e-9 * generator.random((3, 3)) for _ in range(15)]
    for z in cases:
        z[1, 1] = z.max()
        found, dense = _apex(z, 1, 1), on_the_pixel(z)
        # 101 points: the maximum lies 1/200 pixel away at most, where curvatures are below 8 ranges; the
        # vertex of a ridge whose determinant is 1e-10 is rounded to 1e-6 pixels, its height to 1e-12
        assert dense - 1e-11 <= found <= dense + 8 * np.ptp(z) / 200**2 + 1e-12
        assert z[1, 1] <= found <= z[1, 1] + np.ptp(z)


def counted(heights, curvatures, *, area=1.0, parts=4):
    """Summits of a map of four parts that are all alike."""
    sums = np.zeros((len(SUMS), parts))
    sums[0] = 100
    return SummitSums(
        sums, np.tile(heights, parts), np.tile(curvatures, parts), np.full((2, parts * len(heights)), 0.5),
        np.repeat(np.arange(parts), len(heights)), area / 100 / parts,
    )  # fmt: skip


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


def test_errors_are_a_jackknifes_widened_by_students_t():
    """Literal: the spread of what is left without each sub-area; two of them hold 95.45 % of a t law."""
    generator = np.random.default_rng(8)
    sums = generator.random((len(SUMS), 9)) + np.eye(len(SUMS), 9) * 5
    part = np.repeat(np.arange(9), 5)
    whole = SummitSums(sums, generator.normal(size=45), generator.random(45), np.zeros((2, 45)), part, 0.1)

    def statistic(t):
        return np.array([t.heights.mean(), t.heights.size / t.area])

    values = [whole.heights.mean(), 45 / (0.1 * sums[0].sum())]
    kept = [part != k for k in range(9)]
    without = [
        [whole.heights[k].mean() for k in kept],
        [40 / (0.1 * (sums[0].sum() - sums[0, k])) for k in range(9)],
    ]
    student = t_law(8).ppf(0.5 + math.erf(math.sqrt(2)) / 2)
    for (value, error), expected, left in zip(jackknife(statistic, whole), values, without, strict=True):
        spread = math.sqrt(8 / 9 * sum((x - sum(left) / 9) ** 2 for x in left))
        assert value == pytest.approx(expected, rel=1e-14)
        assert error == pytest.approx(spread * student / 2, rel=1e-10)


def test_moments_and_skewness_are_those_of_the_sums():
    sums = np.zeros((len(SUMS), 2))
    sums[:, 0] = [3, 6, 20, 90, 12, 30, 9, 8, 7, 1]
    sums[:, 1] = [2, -2, 4, -8, 4, 2, 15, 5, 5, 2]
    t = SummitSums(sums, np.zeros(0), np.zeros(0), np.zeros((2, 0)), np.zeros(0, dtype=int), 1.0)
    mean, square, cube = 4 / 5, 24 / 5, 82 / 5
    moments = moments_of(t)
    assert (moments.m0, moments.m2, moments.m4) == pytest.approx(
        (square - mean**2, 24 / 5, 24 / 5), rel=1e-14
    )
    assert skewness_of(t) == pytest.approx(
        (cube - 3 * mean * square + 2 * mean**3) / (square - mean**2) ** 1.5, rel=1e-14
    )
    told = by_moments(t)
    assert all(value == getattr(moments, x) for x, (value, _) in told.items() if x != "skewness")


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


@pytest.mark.parametrize(("overlap", "blur"), [(0.002, 0.0), (0.05, 0.0), (0.3, 0.0), (0.05, 0.3)])
def test_hidden_caps_by_quadrature(overlap, blur):
    """Of a Poisson field; and so many and so high seen, the field itself is found again."""
    share, mean, std = by_quadrature(overlap, blur)
    found = visible(overlap, blur)
    assert (found.share, found.mean, found.std) == pytest.approx((share, mean, std), rel=1e-7)
    radius, sigma = 1e-5, 1e-6
    eta = overlap / radius / sigma
    back = unhidden(eta * share, radius, sigma * std, blur * math.sqrt(2 * radius * sigma * std))
    if blur == 0:
        assert back == pytest.approx((eta, sigma), rel=1e-7)
        # Ripples in valleys, much flatter than the median, are no caps.
        z = np.linspace(-1, 1, 50)
        z *= sigma * std / np.tile(z, 4).std(ddof=1)
        heights, bends = np.append(z, [-9e-6, 9e-6]), np.append(np.full(50, 1 / radius), [2e4, 1e4])
        pairs = by_caps(counted(heights, bends, area=200 / eta / share), 0.0)
        assert [x for x, _ in pairs] == pytest.approx([eta, radius, sigma], rel=1e-7)
    else:
        assert back[0] > unhidden(eta * share, radius, sigma * std)[0]


def test_errors_of_caps_hold_a_quarter_of_what_blur_hides():
    """And how far the radius of the median is from that of the mean curvature."""
    generator = np.random.default_rng(3)
    sums = np.zeros((len(SUMS), 4))
    sums[0] = 100
    bends = 1e5 * (1 + 0.1 * generator.random(240) ** 2)
    whole = SummitSums(
        sums,
        1e-6 * generator.normal(size=240),
        bends,
        np.full((2, 240), 0.5),
        np.repeat(np.arange(4), 60),
        1e-9,
    )

    def found(t, blur):
        bend = np.median(t.curvatures)
        eta, sigma = unhidden(t.heights.size / t.area, 1 / bend, t.heights.std(ddof=1), blur)
        return np.array([eta, 1 / bend, sigma])

    pairs, sharp = jackknife(lambda t: found(t, 1e-6), whole), found(whole, 0.0)
    expected = [
        (pairs[0][0], math.hypot(pairs[0][1], 0.25 * (pairs[0][0] - sharp[0]))),
        (pairs[1][0], math.hypot(pairs[1][1], 1 / bends.mean() - pairs[1][0])),
        (pairs[2][0], math.hypot(pairs[2][1], 0.25 * (pairs[2][0] - sharp[2]))),
    ]
    np.testing.assert_allclose(by_caps(whole, 1e-6), expected, rtol=1e-9)
    assert pairs[0][0] > 1.01 * sharp[0]


@pytest.mark.parametrize(("share", "counted_too"), [(0.497, False), (0.503, True)])
def test_caps_are_as_sharp_as_half_of_the_median(share, counted_too):
    z = 1e-6 * np.linspace(-1, 1, 50)
    bends = np.full(50, 1e5)
    plain = by_caps(counted(z, bends, area=1e-6), 0.0)
    more = by_caps(counted(np.append(z, 3e-7), np.append(bends, share * 1e5), area=1e-6), 0.0)
    assert (more[0][0] > 1.01 * plain[0][0]) == counted_too
    assert (more[2][0] == plain[2][0]) == (not counted_too)


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
    assert unhidden(1e9, 1e-5, 0.0) is None
    assert unhidden(1e9, 1e-5, 1e-3) is None  # no field shows so many
    assert unhidden(1e3, 1e-5, 1e-6) == pytest.approx((1e3, 1e-6), rel=1e-5)
