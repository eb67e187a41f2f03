"""Cumulants and covariances of finite surfaces, against closed forms and quadrature at many digits."""

import math
from dataclasses import replace
from itertools import product

import mpmath as mp
import numpy as np
import pytest
from reference import F, F_power, cross, cumulants_of, error, exponential

import analytic
from analytic import Custom, Exponential

SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
UNIT = analytic.Surface(1.0, 1.0, 1.0, 1.0, 1.0)
N = 1000
H = (-20.0, -9.0, -2.0, 0.5, 3.0, 8.0, 30.0)
TOLERANCE = 5e-14  # the quadrature gives 1e-14; s is known to 1e-16 of 30, exp(-s^2/2) 30 times worse
QUANTITIES = list(analytic.QUANTITIES.values())


def raw_moments(q, h, gamma):
    return [F_power(k * mp.mpf(q.exponent), k * q.modulus, h, gamma) for k in (1, 2, 3, 4)]


@pytest.mark.parametrize("count", ["fixed", "poisson"])
@pytest.mark.parametrize("q", QUANTITIES, ids=lambda q: q.name)
def test_cumulants(q, count):
    values = analytic.cumulants(SURFACE, q.name, H, Exponential(2.0), n_asperities=N, count=count)
    scale = mp.mpf(q.scale(SURFACE))
    for i, h in enumerate(H):
        with mp.workdps(250 if h < -8 else 60):  # variance 1e-89 from moments that are all nearly 1
            moments = raw_moments(q, h, 2.0)
            k1, k2, k3, k4 = moments if count == "poisson" else cumulants_of(moments)
            skewness, kurtosis = k3 / k2**1.5 / mp.sqrt(N), k4 / k2**2 / N
        assert error(values.mean[i], N * scale * k1) < TOLERANCE
        assert error(values.variance[i], N * scale**2 * k2) < TOLERANCE
        # They pass through 0 where everything touches: absolute there.
        assert abs(float(values.skewness[i]) - skewness) < TOLERANCE * max(1, abs(skewness))
        assert abs(float(values.excess_kurtosis[i]) - kurtosis) < TOLERANCE * max(1, abs(kurtosis))


def test_contacts_are_binomial_or_poisson():
    for h in (-9.0, 0.7, 5.0):
        p = F(0, h)
        fixed = analytic.cumulants(UNIT, "contacts", h, n_asperities=N)
        assert error(fixed.variance, N * p * (1 - p)) < 1e-13
        assert error(fixed.skewness, (1 - 2 * p) / mp.sqrt(N * p * (1 - p))) < 1e-13
        free = analytic.cumulants(UNIT, "contacts", h, n_asperities=N, count="poisson")
        assert error(free.variance, N * p) < 1e-13
        assert error(free.excess_kurtosis, 1 / (N * p)) < 1e-13


def test_numbers_of_the_theory():
    """Section 3 of theory.md: N CV^2 and skewness sqrt(N) of the load, homogeneous."""
    c = analytic.cumulants(UNIT, "load", np.arange(6), n_asperities=1)
    assert c.variance / c.mean**2 == pytest.approx([3.3, 15, 122, 2209, 9.8e4, 1.1e7], rel=0.03)
    assert c.skewness == pytest.approx([2.7, 6.1, 18, 82, 559, 6068], rel=0.03)


def test_default_number_and_scaling():
    own = analytic.cumulants(SURFACE, "load", [[0.0], [1.0]])
    given = analytic.cumulants(SURFACE, "load", [[0.0], [1.0]], n_asperities=SURFACE.n_asperities)
    four = analytic.cumulants(replace(SURFACE, nominal_area=4e-6), "load", [[0.0], [1.0]])
    assert own.mean.shape == (2, 1)
    np.testing.assert_array_equal(own.variance, given.variance)
    np.testing.assert_allclose(four.variance, 4 * own.variance, rtol=1e-14)
    np.testing.assert_allclose(four.skewness, own.skewness / 2, rtol=1e-14)
    np.testing.assert_allclose(four.excess_kurtosis, own.excess_kurtosis / 4, rtol=1e-14)


def test_underflow_is_quiet_and_says_nan():
    c = analytic.cumulants(UNIT, "load", 60.0)
    assert c.mean == 0 == c.variance
    assert math.isnan(float(c.skewness))
    assert math.isnan(float(c.excess_kurtosis))


def test_cumulants_of_a_step_that_was_not_declared():
    c = 0.7123
    grading = Custom(lambda s: np.where(s > c, 3.0, 1.0))
    first = lambda k: F(1.5 * k, c) * (3**k - 1)  # noqa: E731
    load = analytic.cumulants(UNIT, "load", c - 1e-13, grading, n_asperities=1, count="poisson")
    # All the contacts but a layer 1e-13 thick are above the step.
    assert error(load.variance, (mp.mpf(4) / 3) ** 2 * (first(2) + F(3, c))) < 1e-11


@pytest.mark.parametrize("gap", [1.0, 1e-3, 1e-9, 0.0])
@pytest.mark.parametrize("h", [-3.0, 4.0])
def test_covariance_of_everything_at_two_separations(h, gap):
    names = [q.name for q in QUANTITIES]
    upper = h + gap
    values = analytic.covariance(UNIT, names, [h, upper], Exponential(1.5), n_asperities=7, count="poisson")
    law, done = exponential(1.5), {}
    for (i, p), (j, q) in product(enumerate(QUANTITIES), repeat=2):
        m = p.modulus + q.modulus
        key = p.exponent, q.exponent, m
        if key not in done:
            done[key] = cross(p.exponent, h, q.exponent, upper, lambda s, m=m: law(s) ** m)
        truth = 7 * p.scale(UNIT) * q.scale(UNIT) * done[key]
        assert error(values[i, 0, j, 1], truth) < TOLERANCE
        assert values[i, 0, j, 1] == pytest.approx(values[j, 1, i, 0], rel=1e-15)


def test_covariance_with_a_whole_exponent_below_is_closed():
    h1, h2, gamma = 0.3, 1.9, 1.5
    gap = mp.mpf(h2) - mp.mpf(h1)
    values = analytic.covariance(
        UNIT, ["contacts", "area", "load"], [h1, h2], Exponential(gamma), n_asperities=1, count="poisson"
    )
    load = lambda q: mp.mpf(4) / 3 * F_power(q, 1, h2, gamma)  # noqa: E731
    assert error(values[0, 0, 2, 1], load(1.5)) < TOLERANCE
    assert error(values[1, 0, 2, 1], mp.pi * (load(2.5) + gap * load(1.5))) < TOLERANCE


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_covariance_diagonal_is_the_variance(count):
    h = [-20.0, -15.0, -9.0, 0.0, 2.5]
    names = ["load", "contacts"]
    matrix = analytic.covariance(SURFACE, names, h, Exponential(2.0), n_asperities=N, count=count)
    for i, name in enumerate(names):
        variance = analytic.cumulants(
            SURFACE, name, h, Exponential(2.0), n_asperities=N, count=count
        ).variance
        np.testing.assert_allclose(np.diag(matrix[i, :, i, :]), variance, rtol=1e-12)


def test_fixed_number_takes_the_product_of_the_means_off():
    h, names = np.array([-1.0, 0.5, 2.0]), ["load", "area"]
    g = Exponential(0.5)
    fixed, free = (
        analytic.covariance(UNIT, names, h, g, n_asperities=10, count=c) for c in ("fixed", "poisson")
    )
    mean = np.array([analytic.mean(UNIT, name, h, g) for name in names])  # of one asperity: UNIT has one
    np.testing.assert_allclose(free - fixed, 10 * np.multiply.outer(mean, mean), rtol=1e-12)


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_contacts_far_below_the_mean_height(count):
    """Almost all touch: the number that do not is Poisson, 1e-19 of a thousand."""
    h = [-9.0, -8.0]
    values = analytic.covariance(UNIT, ["contacts"], h, n_asperities=N, count=count)[0, :, 0, :]
    for (i, a), (j, b) in product(enumerate(h), repeat=2):
        with mp.workdps(60):
            truth = N * (F(0, max(a, b)) - (F(0, a) * F(0, b) if count == "fixed" else 0))
        assert error(values[i, j], truth) < 1e-12


def test_covariance_is_positive_definite_for_crowded_separations():
    h = np.linspace(0, 4, 9)
    matrix = analytic.covariance(UNIT, ["load", "area", "contacts"], h, Exponential(2.0)).reshape(27, 27)
    np.testing.assert_allclose(matrix, matrix.T, rtol=1e-14)
    scale = np.sqrt(np.diag(matrix))
    assert np.linalg.eigvalsh(matrix / np.outer(scale, scale)).min() > 0


def test_rule_knows_its_own_probability():
    for h in ([-5.0], [0.0, 1e-9, 2.0], [-40.0, 3.0]):
        rule = analytic.HeightRule.over(h, Exponential(1.0))
        assert rule.probabilities.sum() + rule.below == pytest.approx(1, rel=1e-14)
        assert np.all(np.diff(rule.heights) > 0)
