"""The pieces that draws are made of: laws of rare counts, surfaces far apart, sums that lose no digit."""

import math
from fractions import Fraction
from itertools import combinations, product

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebvander
from oracles.inside import SAMPLERS, sampler_of
from scipy.stats import binom, chi2, kstest, norm

from mcgw.sampling.cells import mesh_of
from mcgw.sampling.counted import counts_of, extra_heights
from mcgw.sampling.moments import Layout, OneByOne, add_compensated
from mcgw.sampling.philox import CELLS, centred, philox, uniforms

FALSE_ALARM = 1e-6  # of each chi-square test; the seeds are fixed
MANY = 2**18


def p_value(numbers, n, p, most):
    """Classes 0 ... most, the last with all above: of two asperities, both touch p^2 of the time.

    Under Poisson's law they would twice as often.
    """
    share = binom.pmf(np.arange(most + 1), n, p)
    share[-1] += binom.sf(most, n, p)
    expected, found = len(numbers) * share, np.bincount(np.minimum(numbers, most), minlength=most + 1)
    return chi2.sf(((found - expected) ** 2 / expected).sum(), most)


@pytest.mark.parametrize(("n", "h"), [(2, 2.4), (300, 4.0)])
def test_rare_contacts_are_binomial_and_not_poisson(make_scene, n, h):
    """The number that touches, and that in the highest cells, where few do."""
    scene = make_scene(n_asperities=n, separations=(h, h + 0.5))
    mesh = mesh_of(scene)
    found = counts_of(scene, mesh, 0, MANY)
    numbers = np.vstack([found.low_extras, found.cells, found.high_extras])
    shares = np.concatenate([[mesh.low_extras], mesh.probability, [mesh.high_extras]])
    above = np.searchsorted(mesh.edges, h + 0.5) + 1
    for first in (0, above):
        touching = numbers[first:].sum(axis=0)
        kept = min(n, 6)  # no more than so many touch
        p = shares[first:].sum()
        assert p_value(touching, n, p, kept) > FALSE_ALARM
    poisson = np.minimum(np.random.default_rng(1).poisson(n * shares.sum(), MANY), n)
    if n < 10:
        assert p_value(poisson, n, shares.sum(), n) < FALSE_ALARM  # the test can fail


def test_heights_below_all_cells_follow_the_law_from_the_lowest_separation_on(make_scene):
    scene = make_scene(separations=(-5.3, 0.0), n_asperities=10**6, grading=None)
    mesh = mesh_of(scene)
    heights = extra_heights(scene, mesh, 0, counts_of(scene, mesh, 0, MANY // 32))[:, 1]
    low, ends = heights[heights < mesh.edges[0]], norm.cdf([-5.3, mesh.edges[0]])
    assert low.size > 100
    assert kstest((norm.cdf(low) - ends[0]) / np.ptp(ends), "uniform").pvalue > FALSE_ALARM


@pytest.mark.parametrize("n", [10**9, 10**12])
def test_cells_far_in_the_tail_are_as_probable_as_they_are(make_scene, n):
    """Of 20 contacts among so many: mean numbers of all cells, |z| < 5.5, false alarms 4e-8 each."""
    h = float(norm.isf(20 / n))
    scene = make_scene(n_asperities=n, separations=(h, h + 0.3, h + 0.9))
    mesh, m = mesh_of(scene), 2**17
    found, expected = counts_of(scene, mesh, 0, m).cells, n * mesh.probability
    z = (found.mean(axis=1) - expected) / np.sqrt(expected / m)
    assert np.abs(z).max() < 5.5
    assert (0.01 * np.sqrt(expected * m)).max() > 5.5  # one in a hundred too many would be seen


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_counts_are_multinomial_or_independent(make_scene, count):
    """Means, variances and covariances of all pairs of cells: |z| < 5.5, false alarms 4e-8 a number."""
    scene = make_scene(separations=(-0.5, 0.0, 1.0, 2.0), n_asperities=2000, count=count, seed=3)
    mesh, m = mesh_of(scene), 40_000
    counts = counts_of(scene, mesh, 0, m).cells.astype(float)
    n, p = scene.n_asperities, mesh.probability
    exact = n * (np.diag(p) - (np.outer(p, p) if count == "fixed" else 0))
    sd = np.sqrt(np.diag(exact))
    assert np.abs((counts.mean(axis=1) - n * p) / sd * np.sqrt(m)).max() < 5.5
    correlation = (np.cov(counts) - exact) / np.outer(sd, sd)
    spread = np.sqrt(1 + np.eye(len(p)) * (1 + 1 / (n * p)))  # of a pair, and of a variance with its kurtosis
    assert np.abs(correlation / spread * np.sqrt(m)).max() < 5.5
    wrong = exact + (n * np.outer(p, p) if count == "fixed" else -n * np.outer(p, p))  # the other law
    seen = (np.cov(counts) - wrong) / np.outer(sd, sd) / spread * np.sqrt(m)
    assert np.abs(seen).max() > 5.5


def far_apart():
    """First surfaces of blocks: the very first, and each power of two from a group of surfaces on."""
    return [0, *(2**k for k in range(6, 48))]


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_numbers_of_contacts_do_not_repeat(make_scene, count):
    """Of 64 surfaces each, 2^6 ... 2^47 apart; equal by chance less than once in 10^60."""
    scene = make_scene(count=count, n_asperities=10**6)
    mesh = mesh_of(scene)
    numbers = [counts_of(scene, mesh, first, 64).cells.sum(axis=0) for first in far_apart()]
    for a, b in combinations(numbers, 2):
        assert np.mean(a == b) < 0.2


@pytest.mark.parametrize("sampler", SAMPLERS[1:])
def test_surfaces_do_not_repeat(make_scene, sampler):
    drawn = sampler_of(make_scene(sampler=sampler, n_asperities=200, separations=(0.0, 1.0)))
    loads = [drawn.block(first, 1)["load"][0, 0] for first in far_apart()]
    assert len(set(loads)) == len(loads)


def test_uniforms_do_not_repeat():
    """Whatever bit of the surface, the cell or the seed is another."""
    streams = [uniforms(0, CELLS, surface, 0, 64) for surface in far_apart()]
    streams += [uniforms(0, CELLS, 0, 2**k, 64) for k in range(20)]
    streams += [uniforms(2**k, CELLS, 0, 0, 64) for k in range(64)]
    streams += [uniforms(0, purpose, 0, 0, 64) for purpose in range(1, 7)]
    for k in range(6, 35):  # far on in one stream
        streams.append(np.empty(64))
        centred(streams[-1], np.uint64(0), CELLS, 0, 0, 2**k, 64)
        streams[-1] = (1 + streams[-1]) / 2
    assert len(np.unique(np.concatenate(streams))) > 64 * len(streams) - 10  # of 32 bits, few are alike


def test_a_compensated_sum_is_the_exact_one():
    """Terms of all sizes, the larger first and last; a plain sum is wrong in the first digit."""
    terms = np.array([[1.0, 1e16], [1e16, 1.0], [1.0, -1e16], [-1e16, 3.0], [2.0**-40, 2.0**-40]])
    sums = np.zeros(4)
    for row in terms:
        add_compensated(sums, row.copy(), 0, 2)
    total, carry = sums.reshape(2, 2)
    exact = [math.fsum(column) for column in terms.T]
    np.testing.assert_array_equal(total + carry, exact)
    assert (total != exact).all()
    assert (carry != 0).all()


# Random123, kat_vectors: philox4x32 10, counter, key, output.
KNOWN = [
    ((0, 0, 0, 0), (0, 0), (0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8)),
    ((0xFFFFFFFF,) * 4, (0xFFFFFFFF,) * 2, (0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD)),
    (
        (0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344),
        (0xA4093822, 0x299F31D0),
        (0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1),
    ),
]


ORDERS = np.array(list(product(range(1, 22), range(22))))


@pytest.mark.parametrize("n", [0, 1, 61, 2500])
def test_moments_are_sums_of_chebyshev_polynomials(n):
    layout = Layout(ORDERS[:, 0], ORDERS[:, 1])
    moments = OneByOne().moments(7, 0, np.full((len(ORDERS), 1), n), layout)[:, 0]
    for cell, (start, (plain, rooted)) in enumerate(zip(layout.starts[:-1], ORDERS, strict=True)):
        u = uniforms(7, CELLS, 0, cell, n)
        terms = chebvander(2 * u - 1, 20)
        exact = np.concatenate([terms[:, :plain].sum(axis=0), (np.sqrt(u) @ terms)[:rooted]])
        found = moments[start : start + plain + rooted]
        np.testing.assert_allclose(found, exact, rtol=0, atol=1e-13 * n)


def test_moments_of_a_huge_cell_lose_no_digit():
    """Summed in pieces, each is the exact sum, rounded; one after another terms lose ten times as much."""
    n = 2 * 512 * 512 + 77
    found = OneByOne().moments(7, 0, np.array([[n]]), Layout(np.array([3]), np.array([2])))[:, 0]
    u = uniforms(7, CELLS, 0, 0, n)
    terms = chebvander(2 * u - 1, 2)
    columns = [*terms.T, np.sqrt(u), np.sqrt(u) * terms[:, 1]]
    np.testing.assert_allclose(found, [math.fsum(column) for column in columns], rtol=0, atol=5e-16 * n)


def philox_by_integers(counter, key):
    """Ten rounds of Philox4x32 in Python's integers, as Salmon and others print them (SC11)."""
    (c0, c1, c2, c3), (k0, k1) = counter, key
    for _ in range(10):
        p0, p1 = 0xD2511F53 * c0, 0xCD9E8D57 * c2
        c0, c1, c2, c3 = (p1 >> 32) ^ c1 ^ k0, p1 % 2**32, (p0 >> 32) ^ c3 ^ k1, p0 % 2**32
        k0, k1 = (k0 + 0x9E3779B9) % 2**32, (k1 + 0xBB67AE85) % 2**32
    return c0, c1, c2, c3


def uniforms_by_integers(seed, surface, cell, n):
    """Sixteen blocks of four words at a time: the first word of each block, then the second of each ..."""
    found = []
    for group in range(n // 64 + 1):
        blocks = [
            philox_by_integers(
                (16 * group + i, cell, surface % 2**32, surface >> 32), (seed % 2**32, seed >> 32)
            )
            for i in range(16)
        ]
        for w in range(4):
            found += [block[w] for block in blocks]
    return [Fraction(2 * k + 1, 2**33) for k in found[:n]]


@pytest.mark.parametrize(("counter", "key", "output"), KNOWN)
def test_published_vectors(counter, key, output):
    """Of the compiled generator, and of the one by integers."""
    words = [np.uint64(word) for word in (*counter, *key)]
    assert tuple(int(word) for word in philox.py_func(*words)) == output
    assert philox_by_integers(counter, key) == output


@pytest.mark.parametrize("where", [(0, 0, 0), (2**64 - 1, 2**40 + 5, 17), (7, 3, 2**20 - 1)])
def test_uniforms_are_the_centres_that_words_stand_for(where):
    """Exactly, for a length that ends inside a group."""
    seed, surface, cell = where
    assert uniforms(seed, CELLS, surface, cell, 999).tolist() == uniforms_by_integers(*where, 999)
