"""Random curvature of summits: published check values, mpmath, and four Gaussians.

Values of ``VALUES`` are exact integrals over the mean curvature at 25 digits: per summit, contacts,
A/(pi sqrt(m0)/q), P/((4/3) E* m0^(3/4) q^(-1/2)) and K/(2 E* m0^(1/4) q^(-1/2)) at d = x sqrt(m0) from the
surface's mean plane, q = sqrt(m4/3); last, kap in A/A_n = kap p/(E* sqrt(2 m2)).
"""

import math

import mpmath as mp
import numpy as np
import pytest
import scipy.stats

from analytic import HeightRule, Homogeneous, Nayak, RandomCurvature, SpectralMoments
from analytic.curvature import MEAN_CURVATURE

VALUES = {
    (1.6, 2): (0.3517724494908437, 0.04927359299064154, 0.07895799938442455, 0.122753436260124, 2.4332938),
    (100, 3): (
        0.002663262506931592, 0.0003674578406350325, 0.0003702569003428179, 0.0008624363327222108, 1.3762927,
    ),
}  # fmt: skip


def per_summit(alpha, x):
    """N, A, P and K of `VALUES` by sums over a rule of heights."""
    law = Nayak(alpha)
    mean_power = RandomCurvature(alpha).mean
    h = (x - law.mean) / law.std
    rule = HeightRule.over([h], Homogeneous(), law)
    depth = law.over_rms(rule.heights) - x
    return [
        float(rule.probabilities @ (depth**n * mean_power(q, rule.heights))) / MEAN_CURVATURE**q
        for n, q in ((0, 0), (1, 1), (1.5, 0.5), (0.5, 0.5))
    ]


@pytest.mark.parametrize(("alpha", "x"), VALUES)
def test_check_values(alpha, x):
    *exact, slope = VALUES[alpha, x]
    found = per_summit(alpha, x)
    assert found == pytest.approx(exact, rel=1e-12)
    area, load = found[1:3]
    kap = math.pi * area / (4 / 3 * load) * math.sqrt(2 * math.sqrt(3 / alpha))
    assert kap == pytest.approx(slope, abs=6e-8)


def test_moments_of_the_curvatures():
    """E tau, and the mean and the spread of g, free of alpha: means over heights of those at a height."""
    assert pytest.approx(2.60588006348224, rel=1e-14) == MEAN_CURVATURE
    law, rule = RandomCurvature(1.6), HeightRule.over([-60.0], Homogeneous(), Nayak(1.6))
    g, w = np.polynomial.legendre.leggauss(100)
    g, w = 10 * (1 + g), 10 * w
    marginal = law.pdf(g[:, None], rule.heights) @ rule.probabilities
    assert w @ marginal == pytest.approx(1, rel=1e-12)
    assert (w * g) @ marginal == pytest.approx(2.34902690068464, rel=1e-12)
    density = law.with_height(g[:, None], np.array([-3.0, 0.4]))
    product = law.pdf(g[:, None], [-3.0, 0.4]) * law.heights.pdf([-3.0, 0.4])
    np.testing.assert_allclose(density, product, atol=np.finfo(float).tiny)


def given_height(alpha, s):
    """Density of g at a height, unscaled, at 22 digits, and a normal one's peak to cut integrals at."""
    law = Nayak(alpha)
    x = mp.mpf(float(law.over_rms(s)))
    rho = mp.sqrt(mp.mpf(3) / (2 * mp.mpf(alpha)))
    mu, v = mp.sqrt(2) * rho * x, 2 * (1 - rho**2)

    def density(g):
        return g**3 * mp.exp(g * g / 2) * mp.erfc((g - mu / (1 + v)) / mp.sqrt(2 * v / (1 + v)))

    top = float(max(mu, 0) + 13 * mp.sqrt(v))
    return density, [c * top for c in (0, 0.01, 0.05, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1, 1.3)]


def points(density, cuts):
    """Gauss's points between the cuts, and the density at them times their weights, over a common unit."""
    a, b = np.array(cuts[:-1])[:, None], np.array(cuts[1:])[:, None]
    x, w = np.polynomial.legendre.leggauss(40)
    g = (a + (b - a) * (1 + x) / 2).ravel()
    unit = max(density(mp.mpf(c)) for c in cuts)
    with mp.workdps(22):
        values = np.array([float(density(mp.mpf(one)) / unit) for one in g.tolist()])
    return g, values * ((b - a) / 2 * w).ravel(), unit


@pytest.mark.parametrize(("alpha", "s"), [(1.6, 9.0), (5.0, 0.3), (100.0, -5.0)])
def test_the_law_at_a_height_against_quadrature(alpha, s):
    law = RandomCurvature(alpha)
    density, cuts = given_height(alpha, s)
    ends = [1e-3 * cuts[-2], cuts[3], cuts[5], cuts[7], cuts[9]]
    g, p, unit = points(density, sorted({*cuts, *ends}))
    for power in (0.5, 1, 2, 3):
        exact = MEAN_CURVATURE**power * (p @ g**-power) / p.sum()
        # 1e-14 of what the last digit of the height leaves known
        assert float(law.mean(power, s)) == pytest.approx(exact, rel=2e-14 * (1 + s * s / 10)), power
    for end in ends:
        below, above = p[g < end].sum(), p[g > end].sum()
        if end == ends[0]:  # far out: a rule of its own
            _, own, other = points(density, [0.0, end / 2, end])
            below = own.sum() * float(other / unit)
        if below < above:
            exact, found = below / p.sum(), law.cdf(end, s)
        else:
            exact, found = above / p.sum(), law.sf(end, s)
        assert float(found) == pytest.approx(exact, rel=1e-12)


def four_gaussians(alpha, rng, n):
    """Heights and curvatures of summits: points of a surface, weighted by their Hessian (m0 = 1, q = 1)."""
    m2 = math.sqrt(3 / alpha)
    root = np.linalg.cholesky(np.array([[1, -m2, -m2], [-m2, 3, 1], [-m2, 1, 3]]))
    z, xx, yy = root @ rng.standard_normal((3, n))
    xy = rng.standard_normal(n)
    return z, xx + yy, xx * yy - xy * xy


def test_same_law_as_four_gaussians():
    """The weight of a point decides whether it is kept. p > 1e-4 for a fixed seed: a false alarm in 5000."""
    alpha, rng = 5.0, np.random.default_rng(4)
    z, trace, det = four_gaussians(alpha, rng, 400_000)
    kept = (det > 0) & (trace < 0) & (rng.random(det.size) * 30 < det)  # above 30 one in 1e5
    assert kept.sum() > 7000
    law, heights = RandomCurvature(alpha), Nayak(alpha)
    s = (z[kept] - heights.mean) / heights.std
    assert scipy.stats.kstest(heights.cdf(s), "uniform").pvalue > 1e-4
    assert scipy.stats.kstest(law.cdf(np.sqrt(det[kept]), s), "uniform").pvalue > 1e-4


def test_draws_follow_the_law():
    """Heights and ratios, which are drawn together: p > 1e-4, a false alarm in 3000."""
    heights, law = Nayak(3.0), RandomCurvature(3.0)
    s, ratio = law.summits(np.random.default_rng(8), 8_000)
    g = MEAN_CURVATURE / ratio
    assert scipy.stats.kstest(heights.cdf(s), "uniform").pvalue > 1e-4
    assert scipy.stats.kstest(law.cdf(g, s), "uniform").pvalue > 1e-4
    assert scipy.stats.pearsonr(heights.cdf(s), law.cdf(g, s)).pvalue > 1e-4


def test_bounded_radii():
    """`largest` holds ratios down: means by a plain sum over the quantiles of the law."""
    bounded, free, s = RandomCurvature(2.0, largest=2.0), RandomCurvature(2.0), np.array([-2.0, 0.0, 3.0])
    x, w = np.polynomial.legendre.leggauss(200)
    kink = MEAN_CURVATURE / 2
    g = np.concatenate([kink * (1 + x) / 2, kink + (14 - kink) * (1 + x) / 2])
    weights = np.concatenate([kink / 2 * w, (14 - kink) / 2 * w])
    for power in (0.5, 2, 4):
        sums = (weights * bounded.ratio(g) ** power) @ free.pdf(g[:, None], s)
        assert bounded.mean(power, s) == pytest.approx(sums, rel=1e-12)
    assert np.all(bounded.mean(1, s) < free.mean(1, s))
    assert bounded.summits(np.random.default_rng(1), 500)[1].max() == 2.0


def test_the_surface_of_spectral_moments():
    moments = SpectralMoments(2e-12, 3e-3, 7e7)
    surface = moments.surface(1e-6, 2e9)
    law = Nayak(moments.alpha)
    assert surface.sigma == pytest.approx(law.std * math.sqrt(moments.m0), rel=1e-14)
    assert moments.mean_height == pytest.approx(law.mean * math.sqrt(moments.m0), rel=1e-14)
    assert 1 / surface.radius == pytest.approx(MEAN_CURVATURE * math.sqrt(moments.m4 / 3), rel=1e-14)
    eta = 7e7 / (6 * math.sqrt(3) * math.pi * 3e-3)  # Nayak 1971
    assert surface.eta == pytest.approx(eta, rel=1e-14)
    assert (surface.nominal_area, surface.E_star) == (1e-6, 2e9)
