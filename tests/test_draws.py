"""The pieces that draws are made of: laws of rare counts, surfaces far apart, sums that lose no digit."""

import math
from itertools import combinations

import numpy as np
import pytest
from scipy.stats import binom, chi2
from test_binomial import draw

from mcgw.sampling import counts
from mcgw.sampling.layout import Layout
from mcgw.sampling.moments import _PIECE, add_compensated, cell_moments
from mcgw.sampling.philox import CELLS, uniforms
from mcgw.sampling.samplers import sampler_of
from mcgw.sampling.uniform_sums import PLAIN, ROOTED, WORDS, sum_uniforms
from mcgw.scene.samplers import SAMPLERS

FALSE_ALARM = 1e-6  # of each chi-square test; the seeds are fixed
MANY = 2**20


def p_value(numbers, n, p):
    """Exact classes 0 ... n: of two asperities, both touch p^2 of the time, twice as often under Poisson."""
    expected = len(numbers) * binom.pmf(np.arange(n + 1), n, p)
    found = np.bincount(np.asarray(numbers, dtype=np.int64), minlength=n + 1)
    assert len(found) == n + 1
    return chi2.sf(((found - expected) ** 2 / expected).sum(), n)


@pytest.mark.parametrize(("n", "p"), [(2, 9e-3), (3, 9e-3)])
def test_rare_contacts_are_binomial_and_not_poisson(make_scene, n, p):
    """The number that touches, and the numbers that are shared out, where p is below 1 %."""
    touching = counts._touching(make_scene(n_asperities=n), p, 0, MANY)
    assert p_value(touching, n, p) > FALSE_ALARM
    assert p_value(draw(n, p, MANY), n, p) > FALSE_ALARM
    poisson = np.minimum(np.random.default_rng(1).poisson(n * p, MANY), n)
    assert p_value(poisson, n, p) < FALSE_ALARM  # the test can fail


def far_apart():
    """First surfaces of blocks: the very first, and each power of two from a group of surfaces on."""
    return [0, *(2**k for k in range(6, 48))]


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_numbers_of_contacts_do_not_repeat(make_scene, count):
    """Of 64 surfaces each, 2^6 ... 2^47 apart; equal by chance less than once in 10^60."""
    scene = make_scene(count=count, n_asperities=10**6)
    numbers = [counts._touching(scene, 0.3, first, 64) for first in far_apart()]
    for a, b in combinations(numbers, 2):
        assert np.mean(a == b) < 0.2


@pytest.mark.parametrize("sampler", SAMPLERS[1:])
def test_surfaces_do_not_repeat(make_scene, sampler):
    drawn = sampler_of(make_scene(sampler=sampler, n_asperities=200, separations=(0.0, 1.0)))
    loads = [drawn.block(first, 1).sums["load"][0, 0] for first in far_apart()]
    assert len(set(loads)) == len(loads)


def test_uniforms_do_not_repeat():
    """Whatever bit of the surface, the cell or the seed is another."""
    streams = [uniforms(0, CELLS, surface, 0, 64) for surface in far_apart()]
    streams += [uniforms(0, CELLS, 0, 2**k, 64) for k in range(20)]
    streams += [uniforms(2**k, CELLS, 0, 0, 64) for k in range(64)]
    streams += [uniforms(0, purpose, 0, 0, 64) for purpose in range(1, 7)]
    assert len(np.unique(np.concatenate(streams))) > 64 * len(streams) - 10  # of 32 bits, few are alike


def test_a_compensated_sum_is_the_exact_one():
    """Terms of all sizes, the larger first and last; a plain sum is wrong in the first digit."""
    terms = np.array([[1.0, 1e16], [1e16, 1.0], [1.0, -1e16], [-1e16, 3.0], [2.0**-40, 2.0**-40]])
    total, carry = np.zeros(2), np.zeros(2)
    for row in terms:
        add_compensated(total, carry, row)
    exact = [math.fsum(column) for column in terms.T]
    np.testing.assert_array_equal(total + carry, exact)
    assert (total != exact).all()
    assert (carry != 0).all()


def test_pieces_of_a_huge_cell_lose_no_digit():
    """Each moment is the exact sum of its pieces, rounded once; without what the carry holds it is not."""
    n, orders = 6 * _PIECE + 77, (11, 6)
    parts = []
    for start in range(0, n, _PIECE):
        w = np.ones(WORDS)
        sum_uniforms(w, np.uint64(5), 0, 0, start, min(start + _PIECE, n), 0, orders)
        parts.append(np.concatenate([w[PLAIN : PLAIN + 6], w[ROOTED : ROOTED + 6]]))  # what is not unfolded
    moments = cell_moments(5, 0, np.array([[n]]), Layout(*(np.array([order]) for order in orders)))[:, 0]
    found = np.concatenate([moments[:6], moments[11:17]])
    np.testing.assert_array_equal(found, [math.fsum(column) for column in zip(*parts, strict=True)])
    plain = np.zeros(found.size)
    for part in parts:
        plain += part
    assert (plain != found).any()


def test_a_poisson_number_does_not_undo_stratification(make_scene):
    """Strata are there for means: the number of asperities does not vary from surface to surface."""
    scenes = [
        make_scene(sampler="stratified", count=count, n_asperities=10**5) for count in ("fixed", "poisson")
    ]
    fixed, poisson = (sampler_of(scene).block(0, 5) for scene in scenes)
    np.testing.assert_array_equal(fixed.counts, poisson.counts)
    for name, values in poisson.sums.items():
        np.testing.assert_array_equal(values, fixed.sums[name])
    load = poisson.sums["load"][:, 0]
    assert load.std() / load.mean() < 1e-5  # of surfaces that are drawn: 5e-3
