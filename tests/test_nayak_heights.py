"""Nayak's law of summit heights: published densities, mpmath in both tails, its limit, and its samples."""

import math

import mpmath as mp
import numpy as np
import pytest
import scipy.stats

import analytic
from analytic import Gaussian, HeightRule, Homogeneous, Nayak

DENSITIES = {  # p(0), p(2) of heights over sqrt(m0), above the mean plane of the surface
    1.6: (0.00366848561180587, 0.532312950790285),
    2.0: (0.0459483593407531, 0.441484818068322),
    5.0: (0.238734539355392, 0.239972906814589),
    10.0: (0.316873842161959, 0.168119159705182),
    100.0: (0.390587253425044, 0.0818569654881881),
}
ALPHAS = (1.501, 1.6, 2.0, 5.0, 100.0, 1e6)
FINE = (0, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1, 1.4, 2, 3, 4, 6, 9, 15, 30, 60)


def literal(alpha, x):
    """The closed density, whose terms cancel far down."""
    alpha, x = mp.mpf(alpha), mp.mpf(x)
    rho = mp.sqrt(3 / (2 * alpha))
    mu, v = mp.sqrt(2) * rho * x, 2 * (1 - rho**2)
    a = mu / mp.sqrt(v)
    rest = 2 / mp.sqrt(1 + v) * mp.exp(-(mu**2) / (2 * (1 + v))) * mp.ncdf(a / mp.sqrt(1 + v))
    return mp.sqrt(3) * mp.npdf(x) * ((mu**2 + v - 2) * mp.ncdf(a) + mu * mp.sqrt(v) * mp.npdf(a) + rest)


def shares(alpha, x):
    """Probabilities below and above, by quadrature on pieces that fit how they fall."""
    width = math.sqrt(1 - 1.5 / alpha)
    down = {x - step * width / max(1, -x / width) for step in FINE} | {x - k for k in range(5) if x > 0}
    up = {x + step / max(1, x) for step in FINE} | {
        k * width for k in (1, 2, 4, 6, 8, 10, 20) if k * width > x
    }
    return tuple(
        mp.quad(lambda t: literal(alpha, t), [mp.mpf(p) for p in sorted(part)]) for part in (down, up)
    )


@pytest.mark.parametrize("alpha", DENSITIES)
def test_published_densities(alpha):
    law = Nayak(alpha)
    found = law.density((np.array([0.0, 2.0]) - law.mean) / law.std) / law.std
    assert found == pytest.approx(DENSITIES[alpha], rel=2e-14)


@pytest.mark.parametrize("alpha", [1.501, 2.0, 100.0])
@pytest.mark.parametrize("y", [-20.0, -0.3, 1.7, 30.0])
def test_density_and_shares_in_both_tails(alpha, y):
    """At y deviations, below the mean those of summits of one curvature; to what a height's digits leave."""
    law, width = Nayak(alpha), math.sqrt(1 - 1.5 / alpha)
    s = np.array((y * (width if y < 0 else 1) - law.mean) / law.std)
    x = float(law.over_rms(s))
    known = 1e-14 * (1 + y * y / 10)
    with mp.workdps(40):
        assert float(law.density(s)) / law.std == pytest.approx(float(literal(alpha, x)), rel=known)
        below, above = shares(alpha, x)
        if y < 3:
            assert float(law.below(s)) == pytest.approx(float(below), rel=known)
        assert float(law.above(s)) == pytest.approx(float(above if y > -1 else 1 - below), rel=known)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_quantiles_give_their_shares_back(alpha):
    law = Nayak(alpha)
    p = np.concatenate([10.0 ** -np.arange(1.0, 290.0, 13.0), np.linspace(0.01, 0.5, 50)])
    for find, share, start in (
        (law.from_below, law.below, np.inf),
        (law.from_above, law.above, -np.inf),
        (law.from_above, law.above, 2.0),
    ):
        q = p if np.isinf(start) else p[p > 1e-270]
        s, wanted = find(q, start), q * share(np.array(start))
        # what the last digits of a height make of a share
        known = 1e-14 + 4e-16 * law.density(s) / wanted * (np.abs(s) + law.mean / law.std)
        assert np.all(np.abs(share(s) / wanted - 1) < known)
    assert law.from_below(np.array([0.0, 1.0]), 0.4) == pytest.approx([-np.inf, 0.4], rel=1e-14)
    assert np.all(law.from_above(np.array([0.5, 1.0]), 99.0) == 99.0)  # nothing is there


@pytest.mark.parametrize("alpha", ALPHAS)
def test_it_is_reduced(alpha):
    """Mean 0 and deviation 1 with the closed mean and variance; skewness as published."""
    rule = HeightRule.over([-60.0], Homogeneous(), Nayak(alpha))
    one, mean, square, cube = (float(rule.probabilities @ rule.heights**k) for k in range(4))
    assert (one, square) == (pytest.approx(1, rel=2e-14), pytest.approx(1, rel=2e-13))
    assert mean == pytest.approx(0, abs=1e-13)
    published = {1.6: 0.373, 2.0: 0.190}
    assert alpha not in published or cube == pytest.approx(published[alpha], abs=5e-4)


def test_the_variance_is_that_of_bush_gibson_and_thomas():
    assert Nayak(2.0).std ** 2 == pytest.approx(1 - 0.8968057562340189 / 2, rel=1e-15)


def test_the_limit_is_gaussian():
    s = np.linspace(-8, 12, 81)
    for alpha, off in ((1e6, 1e-3), (1e10, 1e-7)):  # as alpha^(-3/2), times a polynomial of the height
        law = Nayak(alpha)
        assert np.abs(law.density(s) / Gaussian().density(s) - 1).max() < off
        assert analytic.fn(1.5, 2.0, heights=law) == pytest.approx(analytic.fn(1.5, 2.0), rel=off)


@pytest.mark.parametrize("alpha", [1.51, 3.0, 100.0])
def test_samples_follow_the_law(alpha):
    """p > 1e-4: a false alarm in 3000 for three seeds; a mean or a deviation off by 4 % fails."""
    s = Nayak(alpha).sample(np.random.default_rng(5), 100_000)
    assert s.shape == (100_000,)
    assert scipy.stats.kstest(Nayak(alpha).below(s), "uniform").pvalue > 1e-4
    for wrong in (s + 0.04, 1.04 * s):
        assert scipy.stats.kstest(Nayak(alpha).below(wrong), "uniform").pvalue < 1e-4


@pytest.mark.parametrize("s", [-8.0, -2.6, -1.1, 0.3, 5.0])
def test_small_steps_keep_their_digits(s):
    law, t = Nayak(1.6), np.array([1e-9, 1e-4, 0.05])
    with mp.workdps(40):
        x, step = mp.mpf(float(law.over_rms(s))), [mp.mpf(law.std) * mp.mpf(v) for v in t.tolist()]
        exact = [float(mp.log(literal(1.6, x + d) / literal(1.6, x))) for d in step]
    assert law.log_ratio(np.array(s), t) == pytest.approx(exact, rel=1e-12, abs=1e-14)


@pytest.mark.parametrize("alpha", [1.5, 1.0, math.nan, math.inf, -3.0])
def test_there_is_no_such_surface(alpha):
    with pytest.raises(ValueError, match="give a number from 1"):
        Nayak(alpha)
