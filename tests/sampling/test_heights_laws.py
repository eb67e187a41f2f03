"""Laws of heights beside the Gaussian: closed forms, literal quadrature, and every exact sampler.

Statistical gates are |z| < 5 for means and variances with fixed seeds: a false alarm in 2e6. The laws
differ from the Gaussian by tens of percent, thousands of standard errors.
"""

import math

import mpmath as mp
import numpy as np
import pytest
import scipy.stats
from hypothesis import example, given, settings, strategies as st
from oracles.literal import scores
from scipy.integrate import quad

import analytic
import mcgw
from analytic import (
    Exponential,
    ExponentialHeights,
    HeightRule,
    HeightTable,
    Homogeneous,
    Nayak,
    ScipyHeights,
    Weibull,
)

SAMPLE = np.random.default_rng(1).weibull(1.6, size=3000)
LAWS = {
    "exponential": ExponentialHeights(), "weibull +1": Weibull(1.56391), "weibull 0": Weibull(3.60235),
    "weibull -1": Weibull(40.743), "nayak": Nayak(1.8), "gamma": ScipyHeights(scipy.stats.gamma(2.5)),
    "beta": ScipyHeights(scipy.stats.beta(2.5, 3.5)), "laplace": ScipyHeights(scipy.stats.laplace()),
    "t": ScipyHeights(scipy.stats.t(8)), "uniform": ScipyHeights(scipy.stats.uniform()),
    "table": HeightTable.of(SAMPLE),
}  # fmt: skip
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())


def greenwood_williamson(n, h, gamma):
    """F*_n of exponential heights of mean 0, by hand, for h >= -1 (GW 1966 with the paper's grading)."""
    n, h, gamma = mp.mpf(n), mp.mpf(h), mp.mpf(gamma)
    return mp.gamma(n + 1) * mp.exp(-h - 1) * (gamma - (gamma - 1) * mp.mpf(2) ** (-n - 1) * mp.exp(-h))


@pytest.mark.parametrize("gamma", [0.2, 1.0, 2.0])
@pytest.mark.parametrize("n", [0, 0.25, 1.5, 3])
def test_exponential_heights_have_a_closed_form(n, gamma):
    h = np.array([-1.0, -0.5, 0.0, 1.0, 5.0, 20.0, 200.0])
    found = analytic.fn(n, h, Exponential(gamma), heights=ExponentialHeights())
    truth = [float(greenwood_williamson(n, x, gamma)) for x in h]
    # 64 nodes a piece, and exp(-201) known to 201 roundings of 1e-16; gamma = 2 loses a digit below 0.
    assert found == pytest.approx(truth, rel=1e-13 if n % 0.5 == 0 else 1e-12)


@every_law
def test_functions_of_a_law_fit_each_other(law):
    """It is reduced; shares are integrals of the density and have inverses; ratios are those of densities."""
    rule = analytic.HeightRule.over([-60.0], analytic.Homogeneous(), law)
    one, mean, square = (float(rule.probabilities @ rule.heights**k) for k in range(3))
    # Student's t lies below -60 with a probability of 1e-12; scipy's pdf is good to some 1e-13.
    assert (one, square) == (pytest.approx(1, abs=1e-9), pytest.approx(1, abs=1e-6))
    assert mean == pytest.approx(0, abs=1e-8)
    p = np.array([1e-6, 0.1, 0.5, 0.9])
    for s in (max(-1.1, law.support[0] + 0.1), 0.3, 1.1):
        low, high = law.ppf(p, s), law.isf(p, s)
        # scipy's ppf stops within 1e-9 of some shares
        assert law.cdf(low) == pytest.approx(p * law.cdf(np.array(s)), rel=1e-8, abs=1e-13)
        assert law.sf(high) == pytest.approx(p * law.sf(np.array(s)), rel=1e-8, abs=1e-13)
        assert np.all((low <= s) & (s <= high))
    a, b = 0.31, 0.62
    breaks = [x for x in law.breaks if a < x < b] or None
    area = quad(lambda s: float(law.pdf(np.array(s))), a, b, points=breaks, limit=300, epsrel=1e-11)[0]
    assert area == pytest.approx(float(law.cdf(np.array(b)) - law.cdf(np.array(a))), rel=1e-9)
    t = np.array([1e-9, 1e-3]) * min(law.span(a), 1e-3)
    expected = np.log(law.pdf(a + t) / law.pdf(np.array(a)))
    # absolute: the quotient of densities is known to a few last digits
    assert law.log_ratio(np.array(a), t) == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize(
    ("name", "sampler"),
    [*((name, "cells") for name in ("exponential", "nayak", "t", "uniform", "table")),
     *((name, "tail") for name in ("weibull -1", "t", "table")),
     *((name, "direct") for name in ("weibull +1", "laplace", "nayak", "table"))],
)  # fmt: skip
def test_samplers_have_the_exact_mean_and_variance(name, sampler, make_scene):
    law = LAWS[name]
    scene = make_scene(
        heights=law, sampler=sampler, n_surfaces=400, n_asperities=500, seed=7,
        separations=(-0.4, 0.0, 0.8), grading=Exponential(0.5),
    )  # fmt: skip
    assert max(scores(mcgw.simulate(scene))) < 5


@settings(deadline=None)
@given(st.lists(st.floats(-1e3, 1e3), min_size=2, max_size=60))
@example([1.0] * 100 + [2.0] * 50 + [5.0] * 50)
def test_a_table_of_any_heights_is_a_law(values):
    if np.std(values) < 1e-6:
        return
    law = HeightTable.of(values)
    assert np.all(np.diff(law.s) > 0)
    rule = analytic.HeightRule.over([law.s[0] - 1], analytic.Homogeneous(), law)
    # A gap between two heights is only known to their last digits.
    known = 1e-13 + 1e-15 * max(np.abs(law.s)) / min(np.diff(law.s))
    assert float(rule.probabilities.sum()) == pytest.approx(1, rel=known)
    assert float(rule.probabilities @ rule.heights**2) == pytest.approx(1, rel=100 * known)


@pytest.mark.parametrize(
    ("falls", "given", "refused"),
    [((20.0, 1), {}, {"heights": ExponentialHeights()}), ((-1.5, -1), {"heights": ExponentialHeights()}, {})],
)
def test_a_modulus_may_be_negative_where_no_height_is(falls, given, refused, make_scene):
    """Exponential heights begin at s = -1 and reach s = 36, where Gaussian ones never are."""
    place, side = falls
    falling = analytic.Custom(lambda s: np.where(side * (s - place) > 0, -1.0, 1.0), breaks=(place,))
    make_scene(grading=falling, separations=(-2.5,), **given)
    with pytest.raises(mcgw.SceneError, match="negative from s = "):
        make_scene(grading=falling, separations=(-2.5,), **refused)


DENSITIES = {  # p(0), p(2) of heights over sqrt(m0), above the mean plane of the surface
    1.6: (0.00366848561180587, 0.532312950790285),
    100.0: (0.390587253425044, 0.0818569654881881),
}
ALPHAS = (1.501, 2.0, 100.0, 1e6)
X, W = np.polynomial.legendre.leggauss(40)


def literal(alpha, x):
    """The closed density, whose terms cancel far down."""
    alpha, x = mp.mpf(alpha), mp.mpf(x)
    rho = mp.sqrt(3 / (2 * alpha))
    mu, v = mp.sqrt(2) * rho * x, 2 * (1 - rho**2)
    a = mu / mp.sqrt(v)
    rest = 2 / mp.sqrt(1 + v) * mp.exp(-(mu**2) / (2 * (1 + v))) * mp.ncdf(a / mp.sqrt(1 + v))
    return mp.sqrt(3) * mp.npdf(x) * ((mu**2 + v - 2) * mp.ncdf(a) + mu * mp.sqrt(v) * mp.npdf(a) + rest)


@pytest.mark.parametrize("alpha", DENSITIES)
def test_published_densities(alpha):
    law = Nayak(alpha)
    found = law.pdf((np.array([0.0, 2.0]) - law.mean) / law.std) / law.std
    assert found == pytest.approx(DENSITIES[alpha], rel=2e-14)


def height(alpha, y):
    """Reduced height at y deviations, below the mean plane those of summits of one curvature."""
    law = Nayak(alpha)
    return np.array((y * (math.sqrt(1 - 1.5 / alpha) if y < 0 else 1) - law.mean) / law.std)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_density_in_both_tails(alpha):
    """To what a height's digits leave."""
    law = Nayak(alpha)
    for y in (-20.0, -8.0, -3.0, -0.3, 0.1, 0.8, 1.7, 3.0, 6.0, 12.0, 30.0):
        s = height(alpha, y)
        with mp.workdps(40):
            exact = float(literal(alpha, float(law.over_rms(s))))
        assert float(law.pdf(s)) / law.std == pytest.approx(exact, rel=1e-14 * (1 + y * y / 10)), y


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("y", [-20.0, -0.3, 1.7, 30.0])
def test_shares_are_sums_over_the_density(alpha, y):
    """On pieces that widen from the height on, and are narrow where the density has its bend."""
    law, s, unit = Nayak(alpha), float(height(alpha, y)), math.sqrt(1 - 1.5 / alpha)
    known = 1e-14 * (1 + y * y / 10)
    marks = np.concatenate([np.arange(-8, 14, 0.25), (unit * np.arange(-14, 15) - law.mean) / law.std])

    def share(to):
        step = np.sign(to - s) * unit / max(1, abs(y)) / 4
        ends = np.concatenate(
            [[s, to], s + step * np.arange(1, 9), s + step * 8 * 1.25 ** np.arange(30), marks]
        )
        ends = np.unique(np.clip(ends, min(s, to), max(s, to)))
        a, b = ends[:-1, None], ends[1:, None]
        return float(np.sum((b - a) / 2 * W * law.pdf(a + (b - a) * (1 + X) / 2)))

    lowest = min(y, 0.0) - 14 / max(1, -y / 10)
    below, above = share((lowest * unit - law.mean) / law.std), share(max(s, 0.0) + 14)
    if y < 3:
        assert float(law.cdf(np.array(s))) == pytest.approx(below, rel=known)
    assert float(law.sf(np.array(s))) == pytest.approx(above if y > -1 else 1 - below, rel=known)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_quantiles_give_their_shares_back(alpha):
    law = Nayak(alpha)
    p = np.concatenate([10.0 ** -np.arange(1.0, 290.0, 13.0), np.linspace(0.01, 0.5, 50)])
    for find, share, start in (
        (law.ppf, law.cdf, np.inf),
        (law.isf, law.sf, -np.inf),
        (law.isf, law.sf, 2.0),
    ):
        q = p if np.isinf(start) else p[p > 1e-270]
        s, wanted = find(q, start), q * share(np.array(start))
        # what the last digits of a height make of a share
        known = 1e-13 + 4e-16 * law.pdf(s) / wanted * (np.abs(s) + law.mean / law.std)
        assert np.all(np.abs(share(s) / wanted - 1) < known)
    assert law.ppf(np.array([0.0, 1.0]), 0.4) == pytest.approx([-np.inf, 0.4], rel=1e-14)
    assert np.all(law.isf(np.array([0.5, 1.0]), 99.0) == 99.0)  # nothing is there


@pytest.mark.parametrize("alpha", ALPHAS)
def test_it_is_reduced(alpha):
    """Mean 0 and deviation 1 with the closed mean and variance; skewness as published."""
    rule = HeightRule.over([-60.0], Homogeneous(), Nayak(alpha))
    one, mean, square, cube = (float(rule.probabilities @ rule.heights**k) for k in range(4))
    assert (one, square) == (pytest.approx(1, rel=2e-14), pytest.approx(1, rel=2e-13))
    assert mean == pytest.approx(0, abs=1e-13)
    assert alpha != 2.0 or cube == pytest.approx(0.190, abs=5e-4)


@pytest.mark.parametrize("s", [-8.0, -2.6, -1.1, 0.3, 5.0])
def test_small_steps_keep_their_digits(s):
    law, t = Nayak(1.6), np.array([1e-9, 1e-4, 0.05])
    with mp.workdps(40):
        x, step = mp.mpf(float(law.over_rms(s))), [mp.mpf(law.std) * mp.mpf(v) for v in t.tolist()]
        exact = [float(mp.log(literal(1.6, x + d) / literal(1.6, x))) for d in step]
    assert law.log_ratio(np.array(s), t) == pytest.approx(exact, rel=1e-12, abs=5e-14)
