"""Means by levels: chains and numbers of maps by hand, coverage by repetition."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.inside import design, difference, mean_of, terms_of
from scipy.stats import t as student


def made_up(rng, maps):
    """Three levels of two quantities: 0.9 of the variance is known to the second one."""
    common, own = rng.standard_normal((maps, 2)), rng.standard_normal((2, maps, 2))
    dear = 10 + common + 0.3 * own[0]
    return np.stack([7 + 0.8 * common + own[1], 9 + common, dear], axis=1)


@pytest.mark.parametrize("tried", [2, 5])
def test_of_one_level_takes_the_maps_that_the_error_asks_for(tried, rng):
    pilot = rng.normal([3.0, 10.0], [0.6, 1.0], (tried, 2))
    asked = (student.ppf(0.975, 20) * pilot.std(axis=0, ddof=1) / pilot.mean(axis=0) / 0.02) ** 2
    found = design(pilot[:, None], [2.0], 0.02)
    assert (found.chain, found.maps) == ((0,), (math.ceil(asked.max()),))
    assert (found.cost, found.plain) == pytest.approx((2 * found.maps[0], 2 * asked.max()))
    assert design(pilot[:, None], [2.0], 0.02, solves=7).maps == (7,)
    assert design(pilot[:, None], [2.0], 0.9).maps == (4,)


def test_takes_the_chain_that_costs_least(rng):
    pilot = made_up(rng, 2000)
    assert design(pilot, (0.01, 0.1, 10.0), 0.01).chain == (1, 2)
    assert design(pilot, (0.01, 9.0, 10.0), 0.01).chain != (1, 2)
    useless = np.stack([rng.standard_normal((500, 2)), pilot[:500, 2]], axis=1)
    alone = design(useless, (1.0, 1.5), 0.01)
    assert alone.chain == (1,)
    assert_allclose(alone.plain / alone.cost, 1, rtol=0.05)


@pytest.mark.parametrize("solves", [20, 49])
def test_of_some_solves_takes_what_gains_most(solves, rng):
    """By hand, of variances 1 + 0.09, 1 and 0.09 (Giles): the dearest level alone would be less work."""
    found = design(made_up(rng, 2000), (0.01, 0.1, 10.0), 0.01, solves)
    assert (found.chain, found.maps[-1]) == ((1, 2), solves)
    assert found.maps[0] == pytest.approx(solves * math.sqrt(10.1 / 0.1 / 0.09), rel=0.1)
    gain = 1.09 * 10 / (math.sqrt(0.1) + math.sqrt(0.09 * 10.1)) ** 2
    assert found.plain / found.cost == pytest.approx(gain, rel=0.1)


def test_covers_and_has_no_bias(rng):
    """2000 repetitions: 95 % intervals cover within 4.5 standard errors; the mean of the means, too."""
    true, covered, means, many = 10.0, 0, [], 2000
    for _ in range(many):
        samples = [
            difference(made_up(rng, n)[:, term]) for n, term in zip((60, 12), terms_of((1, 2)), strict=True)
        ]
        found = mean_of(samples)
        low, high = found.interval()
        covered += int(low[0] <= true <= high[0])
        means.append(found.mean[0])
    assert abs(covered / many - 0.95) < 4.5 * math.sqrt(0.95 * 0.05 / many)
    error = np.std(means) / math.sqrt(many)
    assert abs(np.mean(means) - true) < 4.5 * error
    assert abs(np.mean(means) - 9.0) > 50 * error  # the cheap level's mean alone is seen
