"""Binomial numbers, against mpmath and the exact distribution, and shared out among cells."""

import math

import mpmath as mp
import numpy as np
import pytest
from scipy import stats

from mcgw.sampling import binomial
from mcgw.sampling.binomial import SURFACES, TRIALS, WORDS, binomials
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.counts import counts_of, halvings_of

FALSE_ALARM = 1e-6  # of each chi-square test; the seeds are fixed

LARGE = 1e9  # variance from which betainc of SciPy 1.14.0 is off, by 0.01 in the middle of n = 1e15
CASES = [  # 55 is the largest mean that is inverted, 56 the smallest that is not
    (1, 0.5), (1, 0.005), (3, 0.3), (30, 0.01), (55, 0.5), (56, 0.5), (200, 0.1), (1000, 0.5), (10**6, 1e-6),
    (10**6, 0.37), (10**9, 3e-8), (10**12, 1e-11), (10**15, 2e-13), (10**15, 0.5), (2**53, 0.25),
    (20_000, 0.009),
]  # fmt: skip


def draw(n, p, m, *, seed=5, node=3, first=0):
    """`m` numbers, one a surface."""
    work, numbers = np.empty(WORDS), np.empty(m)
    for start in range(0, m, SURFACES):
        size = min(SURFACES, m - start)
        work[TRIALS : TRIALS + size] = n
        binomials(work, size, p, np.uint64(seed), np.uint64(first + start), np.uint64(node))
        numbers[start : start + size] = work[:size]
    return numbers


def of_many(k, n, p):
    """Share up to k where the variance is LARGE: Edgeworth's expansion is off by its inverse."""
    deviation = math.sqrt(n * p * (1 - p))
    z = (k + 0.5 - n * p) / deviation
    return stats.norm.cdf(z) + (1 - 2 * p) / (6 * deviation) * (1 - z * z) * stats.norm.pdf(z)


def test_shares_of_many_are_those_of_the_law():
    """Against sums in mpmath of a million and one probabilities, where skewness has a say."""
    n, p, k = 10**10, 1e-4, 1_000_500
    with mp.workdps(30):
        term = mp.binomial(n, k) * mp.mpf(p) ** k * (1 - mp.mpf(p)) ** (n - k)
        total, j = term, k
        while term > 1e-14:
            term *= mp.mpf(j) * (1 - mp.mpf(p)) / (mp.mpf(p) * (n - j + 1))
            total, j = total + term, j - 1
    assert of_many(k, n, p) == pytest.approx(float(total), abs=2e-6)
    alone = stats.norm.cdf((k + 0.5 - n * p) / math.sqrt(n * p * (1 - p)))
    assert abs(alone - float(total)) > 1e-5  # without skewness it would be off


def p_value(numbers, n, p):
    """Of a chi-square test in classes that are about equally probable."""
    law = stats.binom(n, p)
    edges = np.unique(law.ppf(np.arange(1, 40) / 40))
    below = law.cdf(edges) if law.var() < LARGE else of_many(edges, n, p)
    expected = len(numbers) * np.diff(np.concatenate([[0], below, [1]]))
    found = np.bincount(np.searchsorted(edges, numbers), minlength=len(expected))
    few = expected < 5
    expected, found = (np.append(x[~few], x[few].sum()) for x in (expected, found))
    return stats.chi2.sf(((found - expected) ** 2 / np.maximum(expected, 1e-300)).sum(), np.sum(~few) - 1)


@pytest.mark.parametrize(("n", "p"), CASES)
def test_numbers_have_the_binomial_law(n, p):
    numbers = draw(n, p, 200_000)
    assert (numbers == np.floor(numbers)).all()
    assert 0 <= numbers.min() <= numbers.max() <= n
    assert p_value(numbers, n, p) > FALSE_ALARM


@pytest.mark.parametrize(
    ("n", "p"), [(1.0, 0.5), (2.0, 0.009), (5.0, 0.3), (300.0, 0.009), (55.0, 0.5), (1e15, 1e-14)]
)
def test_small_numbers_are_those_of_their_uniforms(n, p):
    """The smallest number that at least a share u of all do not exceed, in exact sums of probabilities."""
    work, uniforms = np.zeros(WORDS), (np.arange(SURFACES) + 0.37) / SURFACES
    work[TRIALS : TRIALS + SURFACES], work[binomial._LEFT : binomial._LEFT + SURFACES] = n, uniforms
    binomial._invert(work, SURFACES, p)
    np.testing.assert_array_equal(work[:SURFACES], stats.binom(n, p).ppf(uniforms))


def test_the_ratio_of_probabilities_against_mpmath():
    """What decides on acceptance: to 2e-12, near the mode and far from it, for any number of trials.

    By the series, wherever these are said to serve, and without them.
    """
    rng, worst, served = np.random.default_rng(1), [], 0
    for _ in range(100):
        n = float(np.floor(10 ** rng.uniform(1.8, 15)))
        p = min(10 ** rng.uniform(math.log10(28.5 / n), math.log10(0.5)), 0.5)
        sd = math.sqrt(n * p * (1 - p))
        k = float(np.clip(np.floor(n * p + rng.uniform(-8, 8) * sd), 0, n))
        mode = float(math.floor((n + 1) * p))
        ends = (max(x, binomial._ZERO) * max(n - x, binomial._ZERO) for x in (mode, k))
        found = (
            binomial._shortfall_anywhere(n, p, mode)
            - binomial._shortfall_anywhere(n, p, k)
            + 0.5 * math.log(next(ends) / next(ends))
        )
        with mp.workdps(60):
            exact = float(log_probability(n, p, k) - log_probability(n, p, mode))
        rounded = 2.0**-53 * (k + mode) * (abs(k - n * p) + 1) / sd**2  # of n p: another p
        worst.append(abs(found - exact) - rounded)
        ratio, known = binomial.ratio_over_mode(n, p, k)
        if known:
            served += 1
            worst.append(abs(ratio / math.exp(exact) - 1) - rounded)
    assert max(worst) < 2e-12
    assert 75 < served < 100


def log_probability(n, p, k):
    """At 60 digits."""
    n, p, k = mp.mpf(n), mp.mpf(p), mp.mpf(k)
    return (
        mp.loggamma(n + 1)
        - mp.loggamma(k + 1)
        - mp.loggamma(n - k + 1)
        + k * mp.log(p)
        + (n - k) * mp.log1p(-p)
    )


@pytest.mark.parametrize(
    ("mean", "p"), [(28.0, 0.5), (28.0, 1e-3), (60.0, 0.3), (1e3, 0.5), (1e6, 1e-3), (1e11, 0.3)]
)
def test_the_hat_covers_the_law_and_the_squeeze_is_below_it(mean, p):
    """All that rejection rests on, at 20 000 uniforms, with no random number."""
    n = float(math.ceil(mean / p))
    for u in np.linspace(-0.4999, 0.4999, 20_001):
        k, _, w = binomial._proposal(n, p, u, 0.5)  # the largest v: the hat itself
        if 0 <= k <= n:
            assert not binomial.below_ratio(w * (1 + 1e-9), n, p, k)
        b = 1.15 + 2.53 * math.sqrt(n * p * (1 - p))
        k, sure, w = binomial._proposal(n, p, u, 0.42 - 4.2 / b)  # the largest v that is sure
        assert sure == (0.5 - abs(u) >= 0.07)
        assert not sure or binomial.below_ratio(w, n, p, k)


def test_a_number_is_a_function_of_seed_surface_and_node():
    whole = draw(1000, 0.3, 300)
    np.testing.assert_array_equal(draw(1000, 0.3, 100, first=150), whole[150:250])
    for other in ({"seed": 6}, {"node": 4}, {"first": 2**40}):
        assert abs(np.corrcoef(whole, draw(1000, 0.3, 300, **other))[0, 1]) < 5 / math.sqrt(300)


def test_the_ends_of_the_uniforms():
    """Rounding can leave a uniform of one: the number stays a number."""
    for n, p in ((1.0, 0.5), (55.0, 0.5), (1e15, 1e-15), (1e15, 2.7e-14), (5.0, 0.0)):
        ends = (0.0, 1e-20, 1.0 - 2**-53, 1.0)
        work = np.zeros(WORDS)
        work[TRIALS : TRIALS + 4], work[binomial._LEFT : binomial._LEFT + 4] = n, ends
        binomial._invert(work, 4, p)
        assert 0 == work[0] == work[1] <= work[2] <= work[3] <= min(n, 130)
    assert work[3] == 0


def test_a_number_does_not_hang_on_its_neighbours():
    """Some inverted, some not, in one block and one by one."""
    rng, p, work = np.random.default_rng(4), 0.3, np.empty(WORDS)
    trials = np.floor(10 ** rng.uniform(0, 5, SURFACES))
    assert 10 < np.sum(trials * p < binomial._SMALL) < 54
    work[TRIALS : TRIALS + SURFACES] = trials
    binomials(work, SURFACES, p, np.uint64(5), np.uint64(0), np.uint64(3))
    assert work[:SURFACES].tolist() == [draw(n, p, 1, first=i)[0] for i, n in enumerate(trials)]


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_cells_share_the_contacts_as_single_draws_would(make_scene, count):
    """The same halving as plain loops, one surface and one number at a time."""
    scene = make_scene(separations=tuple(np.linspace(0, 6, 13)), n_asperities=10**7, count=count, seed=9)
    mesh, surface = mesh_of(scene), 70
    halvings, found = halvings_of(mesh), counts_of(scene, mesh, surface, 3)
    leaves = [int(found.low_extras[0]), *found.cells[:, 0].tolist(), int(found.high_extras[0])]
    nodes, parent = [sum(leaves)], 0
    for size in halvings.sizes:
        children = []
        for node in nodes:
            rarer = int(draw(node, halvings.shares[parent], 1, seed=9, node=parent, first=surface)[0])
            children += [node - rarer, rarer] if halvings.turned[parent] else [rarer, node - rarer]
            parent += 1
        nodes = children[:size]
    assert nodes == leaves


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
