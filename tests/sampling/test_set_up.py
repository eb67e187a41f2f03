"""What is made before anything is drawn: by compiled steps, once, and never the result of another scene."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
import scipy.stats

import analytic
import mcgw
from mcgw.machine.memory import kept
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.rules import multiply, product
from mcgw.sampling.samplers import sampler_of
from mcgw.sampling.spacing import Gaps, cuts, price

LAW = analytic.Gaussian()


def cheapest_by_loops(n, low, high, before, root):
    """Every ladder of cells for one gap, priced cell by cell as `spacing` says it does."""
    fewest = 1 + math.ceil(max(math.log2(high - low) - math.log2(before), 0.0) - 1e-9)
    best, chosen = math.inf, None
    for growth in (2.0, 1.8, 1.6, 1.5, 1.45, 1.4, 1.3, 1.2):
        for parts in range(fewest, fewest + 9):
            rungs = [1.0]
            for _ in range(parts - 1):
                rungs.append(rungs[-1] * (1 / growth))
            upper = low + (high - low) * np.array(rungs[::-1])
            lower = np.concatenate([[low], upper[:-1]])
            total = 0.0
            for k, (a, b) in enumerate(zip(lower, upper, strict=True)):
                distance = before if k == 0 else a - low + (0.0 if root else before)
                if b - a > distance * (1 + 1e-9):
                    total = math.inf
                    break
                total += cell_price(n, a, b - a, distance, first=root and k == 0)
            if total < best * (1 - 1e-9):
                best, chosen = total, upper[:-1]
    return chosen


def cell_price(n, a, width, distance, *, first):
    """A cell takes time to begin, and so does each asperity, the more the more moments are needed."""
    above, beyond = (float(LAW.sf(np.array(x))) for x in (a, a + width))
    expected, digits = n * (above - beyond), 11.4
    if n * above > 400:
        reach = (distance if math.isfinite(distance) else 0.0) + width
        digits += math.log10(expected / (n * above) * math.sqrt(reach))
    bend = abs(float(LAW.log_ratio(np.array(a), np.array(width))))

    def rate(z):
        z = min(max(z, 1.05), 1e6)
        return math.log10(z + math.sqrt(z * z - 1))

    plain = digits / rate(min(1 + 2 * distance / width, 2 / bend))
    rooted = 1 + digits / rate(2 / bend) if first else 0.0
    return 250.0 + expected * float(price(np.array(plain), np.array(rooted)))


@pytest.mark.parametrize("n", [10**3, 10**6])
def test_gaps_are_cut_as_the_cheapest_of_all_ladders(n):
    """Together as one by one: with few asperities, where one cell is enough, and with crowds."""
    rng = np.random.default_rng(n % 97)
    low = np.sort(rng.uniform(-1, 4, 12))
    length = 10 ** rng.uniform(-4, -0.3, 12)
    before = length * 2 ** rng.uniform(-4, 3, 12)
    before[0] = np.inf
    root = rng.random(12) < 0.8
    root[0] = True
    gaps = Gaps(low, low + length, before, root)
    expected = [cheapest_by_loops(n, *gap) for gap in zip(gaps.low, gaps.high, before, root, strict=True)]
    np.testing.assert_allclose(np.sort(cuts(LAW, n, gaps)), np.sort(np.concatenate(expected)), rtol=1e-15)
    assert n < 10**6 or sum(map(len, expected)) > 12


SHAPES = [(1, 1, 1), (2, 0, 3), (20, 20, 3), (20, 20, 16), (7, 20, 37), (20, 5, 100)]


@pytest.mark.parametrize("shape", SHAPES)
def test_products_of_whole_numbers_are_exact(shape):
    """Whatever number of columns, and rows in any order in memory; compiled too."""
    rng = np.random.default_rng(sum(shape))
    a, b = rng.integers(-99, 99, shape[:2]).astype(float), rng.integers(-99, 99, shape[1:]).astype(float)
    np.testing.assert_array_equal(product(a, b), a @ b)
    np.testing.assert_array_equal(product(a, np.asfortranarray(b)), a @ b)
    compiled = np.empty((shape[0], shape[2]))
    multiply(a, b, compiled)
    np.testing.assert_array_equal(compiled, a @ b)


def test_each_sum_of_a_product_has_one_order():
    """A column has the same bits whichever columns stand beside it."""
    rng = np.random.default_rng(2)
    a, b = rng.normal(size=(20, 20)), rng.normal(size=(20, 45))
    whole = product(a, b)
    for columns in (slice(0, 1), slice(3, 24), slice(44, 45)):
        np.testing.assert_array_equal(product(a, np.ascontiguousarray(b[:, columns])), whole[:, columns])


def test_scenes_drawn_after_others_are_those_drawn_alone(make_scene):
    """Cells and trees are kept from scene to scene: in any order, each surface has the same bits."""
    changes = [
        {"grading": analytic.Exponential(2.0)},
        {"grading": analytic.Exponential(0.5)},
        {"grading": analytic.Table((0.0, 1.37, 3.0), (1.0, 2.0, 1.5))},
        {"separations": (0.0, 1.0, 2.5)},
        {"n_asperities": 5000},
        {"heights": analytic.Weibull(2.0)},
        {"law": mcgw.KogutEtsion(critical=0.1)},
        {"law": mcgw.KogutEtsion(critical=0.2)},
    ]
    scenes = [make_scene(n_surfaces=3, **change) for change in changes]
    first = [mcgw.simulate(scene).load for scene in scenes]
    for again in np.random.default_rng(4).integers(0, len(scenes), 30):
        np.testing.assert_array_equal(mcgw.simulate(scenes[again]).load, first[again])
    assert len({load.tobytes() for load in first}) == len(scenes)


def test_another_grading_takes_the_same_cells(make_scene):
    one, other = (mesh_of(make_scene(grading=analytic.Exponential(gamma))) for gamma in (2.0, 0.5))
    assert one is other
    assert mesh_of(make_scene(n_asperities=12345)) is not one


@dataclass(frozen=True)
class Frozen:
    x: float


@dataclass
class Loose:
    x: float


def test_only_what_cannot_change_is_remembered():
    calls = []

    @kept(4)
    def twice(argument):
        calls.append(argument)
        return argument

    class Own:
        pass

    for same in (2, 2.5, b"2", Frozen(2.0)):
        assert twice(same) is twice(same) or twice(same) == same
        assert len(calls) == 1
        calls.clear()
    for argument in (Loose(1.0), Own(), np.zeros(2), Frozen(np.zeros(2)), [1]):
        twice(argument)
        twice(argument)
        assert len(calls) == 2
        calls.clear()


def test_two_histograms_are_two_height_laws(make_scene):
    """Both are called rv_histogram: what is kept for one is not for the other."""
    rng = np.random.default_rng(1)
    laws = [
        analytic.ScipyHeights(scipy.stats.rv_histogram(np.histogram(x, bins=12), density=True))
        for x in (rng.normal(size=1000), rng.uniform(size=1000))
    ]
    assert laws[0] != laws[1]
    assert analytic.ScipyHeights(scipy.stats.gamma(3.0)) == analytic.ScipyHeights(scipy.stats.gamma(3.0))
    assert analytic.ScipyHeights(scipy.stats.gamma(3.0)) != analytic.ScipyHeights(scipy.stats.gamma(4.0))
    edges = [mesh_of(make_scene(heights=law, separations=(0.5,))).edges for law in laws]
    assert not np.array_equal(*edges)


def test_a_histogram_with_an_empty_bin_is_refused(make_scene):
    """It would be cut into ever smaller cells, without an end."""
    counts, edges = np.array([5.0, 9.0, 0.0, 2.0]), np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    law = analytic.ScipyHeights(scipy.stats.rv_histogram((counts, edges), density=False))
    with pytest.raises(ValueError, match=r"density is 0 at s = .*; fill the gap"):
        mcgw.simulate(make_scene(heights=law, grading=None, separations=(-1.0,)))


def test_a_surface_without_extras_is_one_of_many(make_scene):
    """Hardly any of them has an asperity beyond all cells; those that have one have it in a block too."""
    scene = make_scene(n_surfaces=200, n_asperities=1000, separations=(0.0, 2.0, 3.5))
    sampler = sampler_of(scene)
    block = sampler.block(0, 200)
    extras = sampler.drawn(0, 200, sampler.response.layout)[2]
    lonely = set(extras[:, 0].astype(int).tolist())
    assert 0 < len(lonely) < 100
    for surface in (*sorted(lonely)[:3], next(i for i in range(200) if i not in lonely)):
        np.testing.assert_array_equal(sampler.block(surface, 1).sums["load"][0], block.sums["load"][surface])
