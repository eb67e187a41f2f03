"""Summits at their places, and means by levels: against lattice sums, plain loops and exact limits."""

import json
import math
import re
import sys
from dataclasses import replace
from itertools import pairwise
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.located_by_hand import residual
from scipy.ndimage import map_coordinates
from scipy.optimize import brentq
from scipy.signal import get_window
from scipy.stats import t as student

import mcgw
from mcgw.elasticity import elastic as public, newton
from mcgw.elasticity.equilibrium import BalanceError, Located
from mcgw.elasticity.levels import LEVELS, Level, Pressed, alone, located, rimless
from mcgw.elasticity.multilevel import design, differences, mean_of, terms_of
from mcgw.elasticity.newton import Equations, State
from mcgw.elasticity.profiles import ProfileSpots, _sneddon
from mcgw.elasticity.sources import maps_of
from mcgw.elasticity.spots import Grid, HertzSpots, field_beyond_point
from mcgw.maps.map_files import write_map
from mcgw.maps.synthetic import Spectrum, gaussian_map
from mcgw.maps.topography import Topography

SPECTRUM = Spectrum(rms=1e-6, long=40e-6, short=5e-6)
LATTICE = -3.900264920001956  # 4 zeta(1/2) beta(1/2), physics of a square lattice


@pytest.fixture
def rng():
    return np.random.default_rng(20261124)


def some(n, size, rng, periodic=True, shape=(64, 64)):
    """Summits of different heights and radii at places of their own."""
    cells = rng.choice(shape[0] * shape[1], n, replace=False)
    places = np.array(np.divmod(cells, shape[1]))
    spots = HertzSpots(1e-6 * rng.standard_normal(n), 1e-5 * rng.uniform(0.5, 2, n), 1e9)
    return Located(spots, places, Grid(shape, size, periodic))


class TestPotential:
    def test_of_images_is_the_lattice_constant(self):
        for n in (48, 64, 100):
            assert_allclose(Grid((n, n), (2.0, 2.0), True).potential[0, 0], LATTICE / 2, rtol=1e-14)

    def test_is_the_sum_over_images(self):
        """Between two points, by plain summation over 29 000 images; what is left out is 1e-5."""
        grid, far = Grid((48, 96), (2.0, 1.0), True), 60
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

    @pytest.mark.parametrize("periodic", [True, False])
    def test_series_sum_as_the_matrix(self, periodic, rng):
        one = some(40, (2e-4, 1e-4), rng, periodic, (48, 96))
        loads = rng.random(40)
        series = one.grid.pressed(one.places, loads, one.places)
        assert_allclose(series, one.grid.between(one.places) @ loads, rtol=1e-11)

    def test_needs_points(self):
        with pytest.raises(ValueError, match="46 or more"):
            Grid((45, 45), (1.0, 1.0), True)
        wide = Grid((46, 184), (3.0, 1.0), True)
        assert (wide.pixel, wide.area) == (pytest.approx((3 / 184, 1 / 46)), 3.0)


class TestField:
    def test_is_that_of_hertz(self):
        """Integral of Hertz's pressure over 1/r, and far away the point load's."""
        from scipy.integrate import dblquad

        a, r = 1.0, 1.7
        integral, _ = dblquad(
            lambda phi, q: q * math.sqrt(1 - q * q) / math.sqrt(r * r + q * q - 2 * r * q * math.cos(phi)),
            0, a, 0, 2 * math.pi, epsabs=1e-11,
        )  # fmt: skip
        more, _ = field_beyond_point(np.array([r * r]), np.array([a * a / 1.125]))
        assert_allclose(more + 1 / r, 1.5 / math.pi * integral, rtol=1e-9)
        far, _ = field_beyond_point(np.array([1e4]), np.array([a * a / 1.125]))
        assert_allclose(far, 1e-6 / 10, rtol=1e-4)  # a^2/(10 r^3)

    def test_has_its_derivative(self, rng):
        r2, a2, step = rng.uniform(0.01, 4, 30), rng.uniform(0.1, 2, 30), 1e-6
        up, down = (field_beyond_point(r2, a2 + s)[0] for s in (step, -step))
        assert_allclose(field_beyond_point(r2, a2)[1], (up - down) / (2 * step), rtol=1e-6)

    def test_two_summits_at_one_place_are_neutral(self):
        """0.5/(E* a), by which each of two equal spots pushes the other, as much as it sinks by itself."""
        more, _ = field_beyond_point(np.array([1e-14]), np.array([2.0]))
        assert_allclose((more + 1e7) / math.pi, 0.5, rtol=1e-6)


class TestLocated:
    @pytest.mark.parametrize("periodic", [True, False])
    @pytest.mark.parametrize("load", [1e-4, 3e-3, 3e-2])
    def test_is_a_balance(self, periodic, load, rng):
        one = some(150, (3e-4, 3e-4), rng, periodic)
        balance = one.at_load(load)
        assert balance.merged == 0
        assert_allclose(balance.load, load, rtol=1e-10)
        assert residual(one, balance) < 1e-10

    @pytest.mark.parametrize("periodic", [True, False])
    def test_by_series_where_there_are_too_many_for_a_matrix(self, periodic, rng, monkeypatch):
        one = some(60, (3e-4, 3e-4), rng, periodic)
        by_matrix = one.at_load(3e-3)
        monkeypatch.setattr(newton, "_DENSE", 0)
        by_series = one.at_load(3e-3)
        assert residual(one, by_series) < 1e-10
        assert_allclose(by_series.stiffness, by_matrix.stiffness, rtol=1e-8)
        assert_allclose(by_series.separation, by_matrix.separation, rtol=1e-9)

    def test_far_spots_do_not_feel_each_other(self):
        spots = HertzSpots(np.zeros(2), np.array([1e-5, 2e-5]), 1e9)
        pair = Located(spots, np.array([[0, 0], [0, 99]]), Grid((100, 100), (1e3, 1e3), False))
        assert_allclose(pair.at_separation(-1e-8).load, spots.load(np.full(2, 1e-8)).sum(), rtol=1e-9)

    def test_pair_is_found_by_hand(self):
        """Two equal spots: one unknown."""
        spots = HertzSpots(np.zeros(2), np.full(2, 1e-5), 1e9)
        pair = Located(spots, np.array([[0, 0], [0, 50]]), Grid((100, 100), (2e-4, 2e-4), False))
        r = 1e-4  # far beyond the reach of point loads' correction

        def left(delta):
            return delta + 4 / 3 * math.sqrt(1e-5) * delta**1.5 / (math.pi * r) - 1e-7

        delta = brentq(left, 0, 1e-7, xtol=1e-22)
        assert_allclose(pair.at_separation(-1e-7).penetrations, delta, rtol=1e-9)

    def test_lattice_rises_by_its_constant(self):
        """Equal spots on a square lattice: the mean plane's correction, -3.9 P/(pi E* sqrt(n A))."""
        n = 6
        at = np.arange(n) * 16 + 8
        places = np.array([np.repeat(at, n), np.tile(at, n)])
        spots = HertzSpots(np.zeros(n * n), np.full(n * n, 1e-5), 1e9)
        lattice = Located(spots, places, Grid((96, 96), (1e-2, 1e-2), True))
        balance = lattice.at_load(1e-3)
        rise = -LATTICE * 1e-3 / (math.pi * 1e9 * n * 1e-2)
        assert_allclose(balance.penetrations + balance.separation, rise, rtol=1e-9)

    def test_stiffness_is_the_derivative(self, rng):
        one = some(100, (3e-4, 3e-4), rng)
        balance, step = one.at_load(3e-3), 1e-5
        up, down = (one.at_load(3e-3 * (1 + s)).separation for s in (step, -step))
        assert_allclose(balance.stiffness, 2 * step * 3e-3 / (down - up), rtol=1e-6)
        at = one.at_separation(balance.separation)
        assert_allclose([at.load, at.area], [balance.load, balance.area], rtol=1e-9)

    def test_spots_within_each_other_are_one(self):
        """Two summits two points apart under a load that makes one contact of them."""
        spots = HertzSpots(np.array([0.0, -1e-9]), np.array([1e-4, 2e-4]), 1e9)
        pair = Located(spots, np.array([[50, 50], [50, 52]]), Grid((100, 100), (1e-4, 1e-4), True))
        balance = pair.at_load(1e-3)
        assert balance.residual < 1e-10
        assert balance.contacts + balance.merged <= 2

    def test_a_summit_inside_a_higher_contact_is_left_out(self):
        """The others are in balance by plain loops; a load that merges many has no balance."""
        rng = np.random.default_rng(4)
        cells = rng.choice(24 * 24, 40, replace=False)
        spots = HertzSpots(1e-6 * rng.standard_normal(40), 1e-5 * rng.uniform(0.5, 20, 40), 1e9)
        places = np.array(np.divmod(cells, 24)) + 20
        one = Located(spots, places, Grid((64, 64), (1e-4, 1e-4), True))
        balance = one.at_load(0.1)
        kept = np.isfinite(balance.penetrations)
        lost = int(np.argmax(np.where(kept, -np.inf, spots.heights)))
        assert balance.merged == 1
        apart = np.hypot(*(places - places[:, [lost]])) * one.grid.pixel[0]
        over = np.sqrt(spots.squared_radius(balance.penetrations)) > apart
        assert np.any(over & (spots.heights > spots.heights[lost]))
        rest = Located(spots.only(kept), places[:, kept], one.grid)
        assert residual(rest, replace(balance, penetrations=balance.penetrations[kept])) < 1e-10
        assert_allclose(balance.load, 0.1, rtol=1e-10)
        with pytest.raises(BalanceError, match=r"no equilibrium of 38 summits .*; give a lower load"):
            one.at_load(1.0)

    @pytest.mark.parametrize("apart", [37, 36])
    def test_a_twentieth_of_what_touches_may_be_left_out(self, apart):
        """Two summits beside higher ones, where these, the second of them and 37 more touch: of 40."""
        at = [(20 + 40 * i, 20 + 40 * j) for i in range(10) for j in range(10)]
        (y, x), (v, u), *rest = at[0], at[99], *at[10 : 10 + apart]
        places = np.array([(y, x), (y, x + 1), (v, u), (v, u + 1), *rest]).T
        heights, radii = np.zeros(4 + apart), np.full(4 + apart, 1e-9)
        heights[[1, 3]], radii[:4] = -2e-7, [1e-5, 3e-5, 1e-5, 3e-5]
        one = Located(HertzSpots(heights, radii, 1e9), places, Grid((400, 400), (4e-4, 4e-4), False))
        if apart < 37:
            with pytest.raises(BalanceError, match="no equilibrium of 38 summits"):
                one.at_separation(-2.5e-7)
            return
        balance = one.at_separation(-2.5e-7)
        kept = np.isfinite(balance.penetrations)
        assert (np.flatnonzero(~kept).tolist(), balance.merged, balance.contacts) == ([1, 3], 2, 39)
        others = Located(one.spots.only(kept), places[:, kept], one.grid)
        assert residual(others, replace(balance, penetrations=balance.penetrations[kept])) < 1e-10

    @pytest.mark.parametrize(
        ("misfit", "reach", "doubtful"),
        [
            ((0, 0, 0, 3, 0, 0, 0), 20, 4),  # of its own pair, though another one lies deeper
            ((0, 0, 0, 0, -3, 0, 1), 20, 4),  # whatever its sign
            ((5, 0, 0, 0, 0, 0, 0), 20, 0),
            ((0, 5, 0, 0, 0, 0, 0), 20, 2),  # of two pairs, where the narrower one reaches farther
            ((0, 0, 0, 0, 0, 0, 2), 20, 2),  # without a neighbour: of the deepest pair
            ((0, 1, 0, -2, 0, 0, 0), 0, 3),  # without any pair: itself
        ],
    )
    def test_the_lower_of_the_deepest_pair_around_the_largest_misfit_is_doubtful(
        self, misfit, reach, doubtful
    ):
        """Pairs 0-1, 1-2, 3-4: the smaller squared radii over squared distances are 9/25, 9/16, 6/36."""
        spots = HertzSpots(np.array([2.0, 3.0, 1.0, 5.0, 4.0, 0.0, 0.0]), np.ones(7), 1.0)
        squared = np.array([100.0, 9.0, 9.0, 6.0, 7.0, 0.0, 9.0])  # of the radii 1, the penetrations, too
        places = np.array([[0] * 7, [0, 5, 9, 30, 36, 60, 90]])
        one = Equations(spots, places, Grid((100, 100), (100.0, 100.0), False), np.full(7, float(reach)))
        state = State(0.0, squared, np.array(misfit, dtype=float), 0.0, np.empty(0), np.empty(0))
        assert one.doubtful(state) == doubtful


class TestLevels:
    def test_heights_in_any_unit_give_the_same(self, rng):
        heights = mcgw.maps.synthetic.gaussian_map(SPECTRUM, (64, 64), (1e-6, 1e-6), rng).heights
        one = Pressed(heights, (6.4e-5, 6.4e-5), 1e11, 5e7)
        other = Pressed(1e3 * heights, (6.4e-2, 6.4e-2), 1e11, 5e7)
        for level in (alone, located):
            a, b = level(one), level(other)
            powers = {"area": 2, "stiffness": 1, "conductance": 1, "mean_gap": 1}
            for name, power in powers.items():
                assert_allclose(b[name], a[name] * 1e3**power, rtol=1e-7)

    def test_the_rim_of_what_touches_is_counted_step_by_step(self, rng):
        """On a torus, literally: of each pair of neighbours one of which touches."""
        touching = rng.random((5, 7)) < 0.4
        pairs = [((j, i), (j, (i + 1) % 7)) for j in range(5) for i in range(7)]
        pairs += [((j, i), ((j + 1) % 5, i)) for j in range(5) for i in range(7)]
        steps = sum(touching[a] != touching[b] for a, b in pairs)
        assert rimless(touching) == pytest.approx((touching.sum() - 0.1181141597562 * steps) / 35, rel=1e-9)

    def test_a_map_without_a_summit_is_told(self):
        bowl = np.zeros((64, 64))
        bowl[8, 8] = -1e-6
        with pytest.raises(mcgw.RunError, match="has no summit"):
            located(Pressed(bowl, (6.4e-5, 6.4e-5), 1e11, 1e6))

    def test_alone_is_hertz_over_the_summits(self, rng):
        heights = mcgw.maps.synthetic.gaussian_map(SPECTRUM, (64, 64), (1e-6, 1e-6), rng).heights
        one = Pressed(heights, (6.4e-5, 6.4e-5), 1e11, 5e7)
        values, spots = alone(one), one.summits.spots
        depth = np.maximum(spots.heights - values["mean_gap"], 0)
        assert_allclose((4 / 3 * 1e11 * np.sqrt(spots.radii) * depth**1.5).sum(), 5e7 * 6.4e-5**2, rtol=1e-9)
        assert_allclose(values["area"], math.pi * (spots.radii * depth).sum(), rtol=1e-12)

    def test_at_the_gap_of_a_pressure_holds_what_holds_under_it(self, rng):
        heights = mcgw.maps.synthetic.gaussian_map(SPECTRUM, (64, 64), (1e-6, 1e-6), rng).heights
        size, p = (6.4e-5, 6.4e-5), 2e6  # so light that near pairs are told alike both ways
        for level in (alone, located):
            under = level(Pressed(heights, size, 1e11, p))
            at = level(Pressed(heights, size, 1e11, separation=under["mean_gap"]))
            assert_allclose(at.pop("pressure"), p, rtol=1e-9)
            for name, value in at.items():
                assert_allclose(value, under[name], rtol=1e-9)
            clear = level(Pressed(heights, size, 1e11, separation=2 * float(np.ptp(heights))))
            assert clear == dict.fromkeys(("area", "stiffness", "conductance", "pressure"), 0)


class TestProfiles:
    def test_of_fourth_power_is_in_closed_form(self):
        """f = c r^4: 8/3 c a^4 deep under 64/15 c E* a^5; a paraboloid's is Hertz's to rounding (Sneddon)."""
        a, E_star = np.linspace(0, 2.0, 201), 3.0
        for power, deep, heavy, off in ((4, 8 / 3, 64 / 15, 1e-3), (2, 2, 8 / 3, 1e-13)):
            depths = np.insert(_sneddon(a) @ np.diff(a**power), 0, 0.0)[None]
            spot, wide = ProfileSpots(np.zeros(1), a, depths, E_star), 1.503
            depth = np.array([deep * wide**power])
            assert_allclose(spot.squared_radius(depth), wide**2, rtol=off)
            assert_allclose(spot.load(depth), heavy * E_star * wide ** (power + 1), rtol=off)
            assert not spot.load(-depth).any()
            step = 1e-6 * depth
            slope = (spot.load(depth + step) - spot.load(depth - step)) / (2 * step)
            assert_allclose(spot.slope(depth), slope, rtol=1e-6)
            two = ProfileSpots(np.array([0.0, 1.0]), a, np.vstack([depths / 2, depths]), E_star)
            one = two.only(np.array([False, True]))
            assert one.heights.tolist() == [1.0]
            assert_allclose(one.load(depth), spot.load(depth), rtol=1e-12)
            assert_allclose(two.load(np.repeat(depth, 2))[1:], spot.load(depth), rtol=1e-12)

    def test_of_waves_fall_as_their_mean_around_a_top(self):
        """cos kx + cos ky is 2 J0(kr) around it: 2 - 2 cos ka deep, a paraboloid (ka)^2."""
        n, waves = 96, 4
        phase = 2 * math.pi * waves * np.arange(n) / n
        one = Pressed(np.cos(phase)[:, None] + np.cos(phase), (1.0, 1.0), 1.0, 1e-3)
        spots = one.profiles.spots
        assert spots.heights.size == waves**2
        k = 2 * math.pi * waves
        shallow = k * spots.radii < 1.6
        assert shallow.sum() == 3
        assert_allclose(spots.depths[:, shallow], [2 - 2 * np.cos(k * spots.radii[shallow])] * 16, rtol=0.04)
        beyond = np.diff(spots.depths[0, 5:]) / np.diff(spots.radii[5:] ** 2)
        assert (beyond > 0).all()

    def test_of_a_map_are_means_over_eight_rays(self, rng):
        """Literal: twelve steps of an eighth of the mean distance, each ray down to its first valley."""
        heights = gaussian_map(SPECTRUM, (64, 96), (1e-6, 1.5e-6), rng).heights
        one = Pressed(heights, (9.6e-5, 9.6e-5), 1e11, 5e7)
        spots, summits = one.profiles.spots, one._counted[1]
        n = spots.heights.size
        r = np.arange(13) / 8 * math.sqrt(9.6e-5**2 / n)
        assert_allclose(spots.radii, r, rtol=1e-12)
        for k in range(0, n, 7):
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
            falls, deep = np.mean(rays, axis=0), [0.0]
            for a in r[1:]:
                roots = [math.sqrt(max(a * a - x * x, 0)) for x in r]
                weights = -2 * a * np.diff(roots) / np.diff(r**2)
                deep.append(float(falls @ weights))
            steps = np.maximum(np.diff(deep), 0.04 * bend)
            assert_allclose(spots.depths[k, 1:], np.cumsum(steps), rtol=1e-9)

    def test_of_a_map_are_in_balance(self, rng):
        heights = mcgw.maps.synthetic.gaussian_map(SPECTRUM, (64, 64), (1e-6, 1e-6), rng).heights
        one = Pressed(heights, (6.4e-5, 6.4e-5), 1e11, 5e7)
        balance = one.profiles.at_load(one.load)
        assert residual(one.profiles, balance) < 1e-10
        assert balance.area > 1.02 * one.summits.at_load(one.load).area


def made_up(rng, maps):
    """Three levels of two quantities: 0.9 of the variance is known to the second one."""
    common, own = rng.standard_normal((maps, 2)), rng.standard_normal((2, maps, 2))
    dear = 10 + common + 0.3 * own[0]
    return {0: 7 + 0.8 * common + own[1], 1: 9 + common, 2: dear}


class TestMultilevel:
    @pytest.mark.parametrize("tried", [2, 5])
    def test_of_one_level_takes_the_maps_that_the_error_asks_for(self, tried, rng):
        pilot = rng.normal([3.0, 10.0], [0.6, 1.0], (tried, 2))
        asked = (student.ppf(0.975, 20) * pilot.std(axis=0, ddof=1) / pilot.mean(axis=0) / 0.02) ** 2
        found = design({0: pilot}, [2.0], 0.02)
        assert (found.chain, found.maps) == ((0,), (math.ceil(asked.max()),))
        assert (found.cost, found.plain) == pytest.approx((2 * found.maps[0], 2 * asked.max()))
        assert design({0: pilot}, [2.0], 0.02, solves=7).maps == (7,)
        assert design({0: pilot}, [2.0], 0.9).maps == (4,)

    def test_takes_the_chain_that_costs_least(self, rng):
        pilot = made_up(rng, 2000)
        assert design(pilot, (0.01, 0.1, 10.0), 0.01).chain == (1, 2)
        assert design(pilot, (0.01, 9.0, 10.0), 0.01).chain != (1, 2)
        useless = {0: rng.standard_normal((500, 2)), 2: pilot[2][:500]}
        alone = design(useless, (1.0, 0.0, 1.5), 0.01)
        assert alone.chain == (2,)
        assert_allclose(alone.plain / alone.cost, 1, rtol=0.05)

    @pytest.mark.parametrize("solves", [20, 49])
    def test_of_some_solves_takes_what_gains_most(self, solves, rng):
        """By hand, of variances 1 + 0.09, 1 and 0.09 (Giles): the dearest level alone would be less work."""
        found = design(made_up(rng, 2000), (0.01, 0.1, 10.0), 0.01, solves)
        assert (found.chain, found.maps[-1]) == ((1, 2), solves)
        assert found.maps[0] == pytest.approx(solves * math.sqrt(10.1 / 0.1 / 0.09), rel=0.1)
        gain = 1.09 * 10 / (math.sqrt(0.1) + math.sqrt(0.09 * 10.1)) ** 2
        assert found.plain / found.cost == pytest.approx(gain, rel=0.1)

    def test_never_takes_more_solves_than_there_may_be(self, rng):
        """A product and its quotient differ by rounding."""
        pilot, every = made_up(rng, 50), range(4, 200)
        assert [design(pilot, (0.01, 0.1, 10.0), 0.01, n).maps[-1] for n in every] == list(every)

    def test_covers_and_has_no_bias(self, rng):
        """2000 repetitions: 95 % intervals cover within 4.5 standard errors; the mean of the means, too."""
        true, covered, means, many = 10.0, 0, [], 2000
        for _ in range(many):
            samples = [
                differences(made_up(rng, n), term) for n, term in zip((60, 12), terms_of((1, 2)), strict=True)
            ]
            found = mean_of(samples)
            low, high = found.interval()
            covered += int(low[0] <= true <= high[0])
            means.append(found.mean[0])
        assert abs(covered / many - 0.95) < 4.5 * math.sqrt(0.95 * 0.05 / many)
        error = np.std(means) / math.sqrt(many)
        assert abs(np.mean(means) - true) < 4.5 * error
        assert abs(np.mean(means) - 9.0) > 50 * error  # the cheap level's mean alone is seen

    def test_a_whole_list_has_no_error(self, rng):
        assert mean_of([rng.random((7, 2))], population=7).stderr.max() == 0


BED = 3.0  # pressure over modulus on a bed of springs, for a depth of one side of the map


class Springs:
    """Tamaas's interface over a bed of springs, each of which feels only what is above it."""

    pressure, gap = "pressure", "gap"
    answer = 1e-7  # the error that it stops at, or what it raises

    def __init__(self, model, heights, tolerance, primal, constraint):
        assert (model.E, model.nu) == (1.0, 0.0)
        assert model.shape == list(heights.shape)
        assert model.size == [1.0, pytest.approx(1.5)]
        assert heights.flags.c_contiguous
        assert (tolerance, primal) == (1e-6, constraint)
        self.model, self.heights, self.what, self.max_iter = model, heights, primal, 0

    def solve(self, target):
        assert self.max_iter == 20_000
        if isinstance(self.answer, Exception):
            raise self.answer
        h = self.heights

        def at(d):
            return BED * np.maximum(h - d, 0)

        def off(d):
            held = at(d).mean()
            return held - target if self.what == "pressure" else d + held / BED - target

        traction = at(brentq(off, h.min() - 2, h.max(), xtol=1e-16, rtol=1e-14))
        if self.what == "gap":
            traction[...] = traction.mean()  # of which the mean alone is right
        else:
            assert not np.any(self.model.traction[h == h.min()])  # where it begins is no problem of gaps
        self.model.traction[...] = traction
        self.model.displacement[...] = traction / BED
        return self.answer


def springs_model(kind, size, shape):
    assert kind == "2d"
    return SimpleNamespace(size=size, shape=shape, traction=np.ones(shape) * 0, displacement=np.zeros(shape))


@pytest.fixture
def springs(monkeypatch):
    said = []
    library = ModuleType("tamaas")
    library.Model, library.PolonskyKeerRey = springs_model, Springs
    library.model_type = SimpleNamespace(basic_2d="2d")
    library.LogLevel = SimpleNamespace(error="error")
    library.set_log_level = said.append
    monkeypatch.setitem(sys.modules, "tamaas", library)
    yield library
    assert set(said) <= {"error"}


class TestBoundaryElements:
    """What is asked of the solver and made of its answers, on a bed of springs that NumPy solves too."""

    size, E_star = (3e-4, 2e-4), 1e9

    def heights(self, rng):
        z = 1e-6 * rng.standard_normal((8, 12))
        return z - z.mean()

    def by_hand(self, z, p):
        """Separation of the plane from the deformed surface's mean plane, and what touches."""
        springs = BED * self.E_star / self.size[1]  # Pa/m
        d = brentq(
            lambda d: springs * np.maximum(z - d, 0).mean() - p, -1e-4, z.max(), xtol=1e-20, rtol=1e-14
        )
        return d + p / springs, z > d

    @pytest.mark.usefixtures("springs")
    @pytest.mark.parametrize("p", [2e6, 2e7])
    def test_make_si_values(self, p, rng):
        z, nominal = self.heights(rng), 6e-8
        found = LEVELS[-1].solve(Pressed(z, self.size, self.E_star, p))
        gap, touching = self.by_hand(z, p)
        nearer, _ = self.by_hand(z, 1.02 * p)
        stiffness = 0.02 * p * nominal / (gap - nearer)
        expected = {
            "area": rimless(touching) * nominal, "stiffness": stiffness,
            "conductance": 2 * stiffness / self.E_star, "mean_gap": gap,
        }  # fmt: skip
        assert found == pytest.approx(expected, rel=1e-9)
        at = LEVELS[-1].solve(Pressed(z, self.size, self.E_star, separation=gap))
        expected["pressure"] = p
        del expected["mean_gap"]
        assert at == pytest.approx(expected, rel=1e-8)

    @pytest.mark.usefixtures("springs")
    def test_of_a_plane_above_all_say_zero(self, rng):
        z = self.heights(rng)
        clear = LEVELS[-1].solve(Pressed(z, self.size, self.E_star, separation=float(z.max())))
        assert clear == dict.fromkeys(("area", "stiffness", "conductance", "pressure"), 0.0)
        near = LEVELS[-1].solve(Pressed(z, self.size, self.E_star, separation=0.99 * float(z.max())))
        assert min(near.values()) > 0

    @pytest.mark.usefixtures("springs")
    @pytest.mark.parametrize(
        ("answer", "held", "words"),
        [
            (FloatingPointError(), {"pressure": 1e6}, "a single point touches; give a higher pressure"),
            (FloatingPointError(), {"separation": 1e-7}, "a single point touches; give a smaller separation"),
            (1.1e-6, {"pressure": 1e6}, "stopped at an error of 1.1e-06; give a lower pressure"),
            (math.nan, {"separation": 1e-7}, "stopped at an error of nan; give a larger separation"),
        ],
    )
    def test_that_do_not_end_are_told(self, answer, held, words, rng, monkeypatch):
        monkeypatch.setattr(Springs, "answer", answer)
        with pytest.raises(mcgw.RunError, match=words):
            LEVELS[-1].solve(Pressed(self.heights(rng), self.size, self.E_star, **held))
        monkeypatch.setattr(Springs, "answer", 1e-6)
        assert LEVELS[-1].timed(Pressed(self.heights(rng), self.size, self.E_star, **held))[0]

    def test_that_are_not_there_are_told(self, rng, monkeypatch):
        monkeypatch.setitem(sys.modules, "tamaas", None)
        with pytest.raises(
            mcgw.RunError, match=r"need Tamaas: in a clone of mcgw, pip install -e '\.\[bem\]'"
        ):
            LEVELS[-1].solve(Pressed(self.heights(rng), self.size, self.E_star, 1e6))


@pytest.fixture
def cheap(monkeypatch):
    """Boundary elements that are a known multiple of what located summits say."""

    def solve(pressed):
        return {name: 1.25 * value for name, value in located(pressed).items()}

    levels = (*LEVELS[:2], Level("elastic", "stand-in", solve, 1.0))
    monkeypatch.setattr(public, "LEVELS", levels)


class TestSources:
    """What maps are taken of a source, and what is said of them."""

    @pytest.mark.parametrize("periodic", [True, False])
    def test_surrogates_have_the_spectrum_of_the_map(self, periodic, rng):
        """Each wave's mean square over 2000 of them, within five standard errors; one that is off is seen."""
        z = rng.standard_normal((8, 12)) + 3.0
        window = np.ones(z.shape)
        if not periodic:
            window = np.sqrt(np.outer(*(get_window("hann", n) for n in z.shape)))
            window /= np.sqrt((window**2).mean())
        power = np.abs(np.fft.rfft2((z - z.mean()) * window)) ** 2
        maps = maps_of(Topography(z, (1e-6, 2e-6), periodic))
        drawn = np.array([maps.heights(i, 5) for i in range(2000)])
        seen = np.abs(np.fft.rfft2(drawn)) ** 2
        error = seen.std(axis=0) / math.sqrt(len(seen))
        assert maps.number is None
        assert maps.size == pytest.approx((12e-6, 16e-6))
        assert_allclose(drawn.mean(axis=(1, 2)), 0, atol=1e-14)
        off = np.abs(seen - power).mean(axis=(1, 2))  # not the map itself
        assert off.min() > 0.1 * power.mean()
        z_scores = ((seen.mean(axis=0) - power) / np.where(error > 0, error, 1)).ravel()[1:]
        assert np.abs(z_scores).max() < 5
        assert np.abs((seen.mean(axis=0) - 1.2 * power) / np.where(error > 0, error, 1)).max() > 5

    def test_a_map_with_holes_is_refused(self, rng):
        whole = mcgw.maps.synthetic.gaussian_map(SPECTRUM, (64, 64), (1e-6, 1e-6), rng)
        holed = whole.heights.copy()
        holed[3, 4:6] = np.nan
        with pytest.raises(ValueError, match=r"^2 points are missing; fill them first"):
            maps_of(replace(whole, heights=holed))

    @pytest.mark.usefixtures("cheap")
    def test_an_answer_says_of_which_maps_it_is(self, rng):
        draw = mcgw.maps.synthetic.gaussian_map
        maps = [draw(SPECTRUM, (48, 48), (1e-6, 1e-6), rng) for _ in range(4)]
        asked = {"pressure": 5e7, "E_star": 1e11, "solves": 4, "pilot": 4}
        for source, said in (
            (SPECTRUM, "Gaussian maps of 64 x 64 points, 4e-05 m wide"),
            (maps[0], "Gaussian maps of the measured map's spectrum"),
            (maps, "the 4 given maps"),
        ):
            assert f"Elastic mean over {said}" in repr(mcgw.elastic(source, **asked))

    def test_maps_of_a_scene_have_its_moments_and_area(self, tmp_path):
        """Eight points to the shortest wave; the scene may have them from its surface, its law or a fit."""
        spectral = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "0.16 mm^2", "78.6 GPa")
        scene = mcgw.Scene(spectral, separations=0.0, n_surfaces=2, seed=1)
        spectrum = Spectrum.with_moments(mcgw.maps.synthetic.SpectralMoments(1e-12, 1e-3, 5e6))
        found = maps_of(scene)
        points = found.heights(3, 7).shape[0]
        assert 8 <= points * spectrum.short / 4e-4 < 8.8
        expected = gaussian_map(spectrum, (points,) * 2, (4e-4 / points,) * 2, np.random.default_rng([7, 3]))
        assert_allclose(found.heights(3, 7), expected.heights, rtol=1e-6, atol=1e-12)
        assert found.size == pytest.approx((4e-4, 4e-4))
        assert found.number is None
        drawn = gaussian_map(SPECTRUM, (96, 96), (1e-6, 1e-6), np.random.default_rng(1))
        fit = mcgw.fit(drawn, cutoff=None, form="none")
        fitted = maps_of(mcgw.fitted_scene(fit, nominal_area="0.04 mm^2"))
        assert fitted.heights(0, 1).std() == pytest.approx(math.sqrt(fit.moments.m0), rel=0.2)
        write_map(drawn, tmp_path / "map.npy")
        for source in (tmp_path / "map.npy", str(tmp_path / "map.npy")):
            assert np.array_equal(maps_of(source).heights(2, 1), maps_of(drawn).heights(2, 1))
            assert np.array_equal(maps_of([source]).heights(0, 1), drawn.heights - drawn.heights.mean())

    @pytest.mark.parametrize("over", [1, -1])
    def test_an_area_that_is_proposed_will_do(self, over):
        """As wide as the longest wave, or as 2048 points, eight of which are the shortest."""
        moments = mcgw.maps.synthetic.moments_on_grid(SPECTRUM, (512, 512), (1e-6, 1e-6))
        surface = mcgw.SpectralSurface(moments.m0, moments.m2, moments.m4, 1e-8, 1e11)
        scene = mcgw.Scene(surface, separations=0.0, n_surfaces=2, seed=1)
        spectrum = Spectrum.with_moments(moments)
        limit = spectrum.long if over > 0 else 256 * spectrum.short
        factor = (1 - over * 1e-3) * limit
        with pytest.raises(ValueError, match="give nominal_area = ") as told:
            maps_of(scene.replace(nominal_area=factor**2))
        proposed = float(re.search(r"nominal_area = (\S+) m\^2 or (?:more|less)", str(told.value))[1])
        assert maps_of(scene.replace(nominal_area=proposed)).number is None
        assert proposed == pytest.approx(limit**2, rel=0.015)
        maps_of(scene.replace(nominal_area=((1 + over * 1e-3) * limit) ** 2))

    @pytest.mark.parametrize(("size", "periodic"), [(1e-6, False), (2e-6, True), (None, True)])
    def test_maps_of_a_list_are_alike_and_periodic(self, size, periodic):
        flat = Topography(np.arange(12.0).reshape(3, 4), (1e-6, 1e-6), True)
        with pytest.raises(ValueError, match="maps: give one or more periodic maps, all of one"):
            maps_of([flat, Topography(flat.heights, (size, size), periodic)] if size else [])
        assert_allclose(maps_of([flat, flat]).heights(1, 0).ravel(), np.arange(12) - 5.5)


@pytest.mark.usefixtures("cheap")
class TestElastic:
    def test_resumes(self, tmp_path):
        path = tmp_path / "solves.jsonl"
        asked = {"pressure": "50 MPa", "E_star": "100 GPa", "rel_err": 0.2, "path": path}
        first = mcgw.elastic(SPECTRUM, **asked)
        lines = path.read_text().splitlines()
        rows = [json.loads(line) for line in lines[1:26]]  # a pilot of eight maps, and the first of others
        assert [row["map"] for row in rows] == [k // 3 for k in range(24)] + [8]
        assert json.loads(lines[0])["seed"] == 1
        path.write_text("\n".join(lines[: len(lines) // 2]) + '\n{"level": "loc')
        with pytest.warns(UserWarning, match=f"solved again where needed: {len(lines) // 2 + 1}$"):
            again = mcgw.elastic(SPECTRUM, **asked)
        assert again.found.mean.tolist() == first.found.mean.tolist()
        assert again.found.stderr.tolist() == first.found.stderr.tolist()
        whole = path.read_bytes()
        assert whole.startswith("".join(f"{line}\n" for line in lines[: len(lines) // 2]).encode())
        seen = []
        once_more = mcgw.elastic(
            SPECTRUM, progress=lambda *told: seen.append(told), **asked
        )  # all lines can be read, and nothing is solved again
        assert (once_more.mean("area"), path.read_bytes()) == (again.mean("area"), whole)
        done, planned = np.array(seen).T
        assert done[0] > 0
        assert np.all(np.diff(done) >= 0)
        assert_allclose(planned, again.planned.cost)
        assert done[-1] == pytest.approx(planned[-1], rel=0.5)
        assert once_more.seconds == pytest.approx(
            sum(json.loads(x)["seconds"] for x in whole.splitlines()[1:])
        )
        assert set(json.loads(lines[0])) == {"maps", "pressure", "E_star", "seed", "plan", "check"}
        with pytest.raises(mcgw.StoreError, match="another path"):
            mcgw.elastic(SPECTRUM, **{**asked, "pressure": "60 MPa"})

    def test_is_what_its_solves_say(self, tmp_path):
        """Means, errors, table and cost from the lines of the file: a pilot, and fresh maps for each term."""
        path = tmp_path / "s.jsonl"
        asked = {"pressure": 5e7, "E_star": 1e11, "solves": 5, "pilot": 6, "path": path}
        found = mcgw.elastic(SPECTRUM, quantities=["mean_gap", "area"], **asked)
        _, *rows = map(json.loads, path.read_text().splitlines())
        names = [level.name for level in LEVELS]
        by = {(row["level"], row["map"]): row for row in rows}
        assert len(by) == len(rows)
        assert [(row["level"], row["map"]) for row in rows[:18]] == [(n, k) for k in range(6) for n in names]
        cost = {n: np.mean([by[n, k]["seconds"] for k in range(6)]) for n in names}
        used = [names[level] for level in found.planned.chain]
        assert used[-1] == "elastic"
        first, means, variances, parts = 6, [], [], []
        shown = zip(*(column.values for column in found.levels.columns), strict=True)
        for term, many in zip(
            [used[:1], *([b, a] for a, b in pairwise(used))],
            found.planned.maps,
            strict=True,
        ):
            maps = range(first, first + many)
            first += many
            x = np.array([[by[term[0], k]["values"][q] for q in found.quantities] for k in maps])
            for other in term[1:]:
                x -= [[by[other, k]["values"][q] for q in found.quantities] for k in maps]
            _, number, seconds, mean, std = next(shown)
            assert number == many
            assert seconds == pytest.approx(sum(cost[n] for n in term))
            assert (mean, std) == pytest.approx((x[:, 0].mean(), x[:, 0].std(ddof=1)), rel=1e-9)
            means.append(x.mean(axis=0))
            variances.append(x.var(axis=0, ddof=1) / many)
            parts.append(variances[-1] ** 2 / (many - 1))
        assert next(shown, None) is None
        assert max(k for _, k in by) == first - 1
        degrees = sum(variances) ** 2 / sum(parts)
        assert_allclose(found.found.mean, sum(means), rtol=1e-12)
        assert_allclose(found.found.degrees, degrees, rtol=1e-9)
        assert found.mean("area") == pytest.approx(sum(means)[1], rel=1e-12)
        half = student.ppf(0.95, degrees[1]) * math.sqrt(sum(variances)[1])
        assert_allclose(found.interval("area", 0.9), sum(means)[1] + np.array([-half, half]), rtol=1e-9)
        low, high = found.interval("mean_gap")
        assert high - low == pytest.approx(
            2 * student.ppf(0.975, degrees[0]) * math.sqrt(sum(variances)[0]), rel=1e-9
        )
        assert found.seconds == pytest.approx(sum(row["seconds"] for row in rows))
        told = [line.split() for line in str(found).splitlines()]
        assert [line[:2] for line in told[-2:]] == [["mean_gap", "m"], ["area", "m^2"]]
        assert told[-2][2:] == [f"{x:.5g}" for x in (sum(means)[0], low, high)]
        head, *lines = str(found.levels).splitlines()
        assert head.split() == ["term", "maps", "s", "a", "map", "mean", "mean_gap", "std"]
        for line, row in zip(lines, zip(*(c.values for c in found.levels.columns), strict=True), strict=True):
            form = [f"{x:{how}}" for x, how in zip(row[1:], ("d", ".2g", ".4g", ".2g"), strict=True)]
            assert line.split()[-4:] == form
            assert line.strip().startswith(row[0])
        words = ["summits, independent", "summits, located", "stand-in"]
        used = [words[level] for level in found.planned.chain]
        assert found.levels.columns[0].values == [used[0], *(f"{b} - {a}" for a, b in pairwise(used))]
        other = mcgw.elastic(SPECTRUM, quantities=["area"], seed=2, **{**asked, "path": None})
        assert other.mean("area") != found.mean("area")

    def test_says_what_levels_save(self):
        from mcgw.elasticity.multilevel import Design, Mean
        from mcgw.formats.table import Table

        nothing = Mean(np.ones(1), np.ones(1), np.ones(1))
        by_levels = public.Elastic(("area",), nothing, Table(()), Design((0, 2), (9, 4), 2.5, 31.0), 1.0, "w")
        assert by_levels.saved == pytest.approx(12.4)
        assert by_levels.verdict() == (
            "2.5 solves by levels, 12.4 times less than boundary elements alone: 31 for the same error"
        )
        alone = replace(by_levels, planned=Design((2,), (4,), 31.0, 31.0))
        assert alone.verdict() == "no cheaper level helps; boundary elements alone: 31 for the same error"

    def test_a_list_has_its_own_mean(self, rng):
        maps = [
            Topography(mcgw.maps.synthetic.gaussian_map(SPECTRUM, (64, 64), (1e-6, 1e-6), rng).heights,
                       (1e-6, 1e-6), periodic=True)
            for _ in range(5)
        ]  # fmt: skip
        found = mcgw.elastic(maps, pressure=5e7, E_star=1e11, solves=5, pilot=4)
        truth = np.mean([
            1.25 * located(Pressed(one.heights - one.heights.mean(), one.size, 1e11, 5e7))["area"]
            for one in maps
        ])  # fmt: skip
        assert_allclose(found.interval("area"), truth, rtol=1e-12)

    @pytest.mark.parametrize("solves", [None, 4])
    @pytest.mark.parametrize("maps", [1, 2, 5, 7])
    def test_equal_maps_leave_no_error(self, maps, solves, rng):
        """Variances are exactly zero, though the mean of some equal numbers is not one of them."""
        one = mcgw.maps.synthetic.gaussian_map(SPECTRUM, (64, 64), (1e-6, 1e-6), rng)
        found = mcgw.elastic([one] * maps, pressure=5e7, E_star=1e11, solves=solves)
        heights = one.heights - one.heights.mean()
        truth = located(Pressed(heights, one.size, 1e11, 5e7))["area"]
        assert_allclose(found.interval("area"), 1.25 * truth, rtol=1e-12)
        assert (found.planned.chain, found.planned.maps, found.saved) == ((2,), (4,), 1.0)

    def test_takes_a_separation(self, tmp_path, rng, monkeypatch):
        """The mean of a list, all of whose maps are solved, is theirs; one of five is clear of the plane."""
        draw, path = mcgw.maps.synthetic.gaussian_map, tmp_path / "s.jsonl"
        maps = [draw(SPECTRUM, (64, 64), (1e-6, 1e-6), rng) for _ in range(4)]
        maps.append(Topography(0.01 * maps[0].heights, (1e-6, 1e-6), periodic=True))
        asked = {"E_star": 1e11, "solves": 5, "pilot": 5, "path": path}
        found = mcgw.elastic(maps, separation="1 um", **asked)
        pressures = [
            1.25 * located(Pressed(x.heights - x.heights.mean(), x.size, 1e11, separation=1e-6))["pressure"]
            for x in maps
        ]
        assert pressures[-1] == 0
        assert found.quantities == ("area", "stiffness", "conductance", "pressure")
        assert found.mean("pressure") == pytest.approx(np.mean(pressures), rel=1e-12)
        assert "Pa" in str(found)
        for other in ({"separation": "2 um"}, {"pressure": 1e-6}):
            with pytest.raises(mcgw.StoreError, match="another path"):
                mcgw.elastic(maps, **other, **asked)
        with pytest.raises(mcgw.RunError, match="smaller separation"):
            mcgw.elastic(maps, separation="1 mm", E_star=1e11)
        apart = Level("elastic", "stand-in", lambda pressed: dict.fromkeys(located(pressed), 0.0), 1.0)
        monkeypatch.setattr(public, "LEVELS", (*LEVELS[:2], apart))  # the dearest level decides
        with pytest.raises(mcgw.RunError, match="none of 5 maps touches"):
            mcgw.elastic(maps, separation="1 um", E_star=1e11)

    @pytest.mark.parametrize("held", [b"", b"my notes", b"my notes\n", b"\x89HDF\r\n\x1a\n", b"[1]\n"])
    def test_a_file_in_the_way_stays(self, held, tmp_path):
        path = tmp_path / "solves.jsonl"
        path.write_bytes(held)
        with pytest.raises(mcgw.StoreError, match="another path"):
            mcgw.elastic(SPECTRUM, pressure=5e7, E_star=1e11, rel_err=0.2, path=path)
        assert path.read_bytes() == held

    def test_a_list_is_known_by_all_of_its_maps(self, tmp_path, rng):
        draw = mcgw.maps.synthetic.gaussian_map
        maps = [draw(SPECTRUM, (64, 64), (1e-6, 1e-6), rng) for _ in range(5)]
        asked = {"pressure": 5e7, "E_star": 1e11, "solves": 4, "pilot": 4, "path": tmp_path / "s.jsonl"}
        mcgw.elastic(maps[:4], **asked)
        with pytest.raises(mcgw.StoreError, match="another path"):
            mcgw.elastic([*maps[:3], maps[4]], **asked)

    def test_command(self, tmp_path, capsys):
        scene = tmp_path / "s.toml"
        scene.write_text(
            '[surface]\nm0 = 1e-12\nm2 = 0.3\nm4 = 3e11\nnominal_area = "1600 um^2"\nE_star = 1e11\n'
            "[contact]\nseparations = [1.0]\n[ensemble]\nn_surfaces = 2\n"
        )
        from mcgw.cli import main

        asked = {"pressure": 5e7, "solves": 4, "pilot": 4, "path": tmp_path / "own.jsonl", "E_star": "50 GPa"}
        mcgw.elastic(mcgw.load_scene(scene), **asked)  # what is given counts, not the scene's
        assert json.loads(asked["path"].read_text().splitlines()[0])["E_star"] == 5e10
        out = tmp_path / "solves.jsonl"
        code = main(["elastic", str(scene), "--pressure", "50MPa", "--rel-err", "0.3", "-o", str(out)])
        printed = capsys.readouterr().out
        assert code == 0
        assert "mean_gap" in printed
        assert str(out) in printed
        header = json.loads(out.read_text().splitlines()[0])
        assert (header["E_star"], header["pressure"]) == (1e11, 5e7)

    @pytest.mark.parametrize(
        ("changes", "words"),
        [
            ({"E_star": None}, "E_star: give"),
            ({"quantities": ["load"]}, "area, stiffness"),
            ({"quantities": []}, "area, stiffness"),
            ({"quantities": ["area", "load"]}, "area, stiffness"),
            ({"quantities": ["pressure"]}, "mean_gap"),
            ({"pressure": None, "separation": 1e-6, "quantities": ["mean_gap"]}, "pressure"),
            ({"pressure": None}, "one of the two"),
            ({"separation": 1e-6}, "one of the two"),
            ({"pressure": None, "separation": -1e-6}, "separation = -1e-06"),
            *(({"rel_err": x}, f"rel_err = {x},") for x in (2, 1, 0)),
            ({"solves": 3}, "solves = 3: .*4 or more"),
            ({"pilot": 1}, "4 or more"),
            ({"pilot": 3}, "pilot = 3, .*4 or more"),
            ({"seed": -1}, "seed = -1: give"),
        ],
    )
    def test_refuses(self, changes, words):
        with pytest.raises(ValueError, match=words):
            mcgw.elastic(SPECTRUM, **{"pressure": 5e7, "E_star": 1e11, **changes})

    def test_an_area_is_neither_too_small_nor_too_large_for_its_waves(self):
        surface = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "78.6 GPa")
        scene = mcgw.Scene(surface, separations=0.0, n_surfaces=2, seed=1)
        for area, words in (
            ("0.01 mm^2", "longer than the map.* or more"),
            ("10 cm^2", "more than 2048; .* or less"),
        ):
            with pytest.raises(ValueError, match=words):
                mcgw.elastic(scene.replace(nominal_area=area), pressure=1e6)

    def test_a_scene_without_a_spectrum_is_told(self):
        scene = mcgw.Scene(mcgw.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e9), separations=0.0, seed=1)
        with pytest.raises(ValueError, match="m0, m2, m4"):
            mcgw.elastic(scene, pressure=1e6)


@pytest.mark.site
def test_boundary_elements_find_hertz():
    """A paraboloid in the middle of a wide cell: area and stiffness to what a grid and images leave, 3 %."""
    pytest.importorskip("tamaas")
    n, radius, side = 512, 2.0, 1.0
    grid = (np.arange(n) + 0.5) / n - 0.5
    heights = -(grid[:, None] ** 2 + grid**2) / (2 * radius)
    a = 0.08  # sqrt(R delta), 41 points
    load = 4 / 3 * a**3 / radius
    found = LEVELS[-1].solve(Pressed(heights - heights.mean(), (side, side), 1.0, load))
    assert found["area"] == pytest.approx(math.pi * a**2, rel=0.03)
    # in series with the images: 1/K = 1/(2 a) + the lattice's constant/pi
    assert 1 / found["stiffness"] == pytest.approx(
        1 / (2 * 1.01 ** (1 / 3) * a) + LATTICE / math.pi, rel=0.03
    )
    assert found["conductance"] == pytest.approx(2 * found["stiffness"], rel=1e-12)
    wide = LEVELS[-1].solve(Pressed(3 * (heights - heights.mean()), (3.0, 3.0), 2.0, 2 * load))
    assert wide["area"] == pytest.approx(9 * found["area"], rel=1e-6)
    assert wide["stiffness"] == pytest.approx(6 * found["stiffness"], rel=1e-6)
    assert wide["mean_gap"] == pytest.approx(3 * found["mean_gap"], rel=1e-6)


@pytest.mark.site
def test_boundary_elements_hold_a_gap(rng):
    """The gap of a pressure, given, finds that pressure again: two of Tamaas's problems."""
    pytest.importorskip("tamaas")
    heights = mcgw.maps.synthetic.gaussian_map(SPECTRUM, (64, 64), (1e-6, 1e-6), rng).heights
    for p in (2e7, 1e9):
        under = LEVELS[-1].solve(Pressed(heights, (6.4e-5, 6.4e-5), 1e11, p))
        at = LEVELS[-1].solve(Pressed(heights, (6.4e-5, 6.4e-5), 1e11, separation=under["mean_gap"]))
        assert at["pressure"] == pytest.approx(p, rel=2e-5)
        assert at["area"] == pytest.approx(under["area"], rel=1e-3)
        assert at["stiffness"] == pytest.approx(under["stiffness"], rel=2e-4)
    clear = LEVELS[-1].solve(Pressed(heights, (6.4e-5, 6.4e-5), 1e11, separation=float(heights.max())))
    assert set(clear.values()) == {0.0}
    with pytest.raises(mcgw.RunError, match="higher pressure"):
        LEVELS[-1].solve(Pressed(heights, (6.4e-5, 6.4e-5), 1e11, 1e2))
