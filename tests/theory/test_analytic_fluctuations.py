"""Cumulants and covariances of finite surfaces: closed forms, quadrature at many digits, and enumeration."""

import math
from itertools import product

import mpmath as mp
import numpy as np
import pytest
from oracles.reference import F, F_power, cross, cumulants_of, error, exponential

import analytic
from analytic import Custom, Exponential, MeasuredHeights, Model

SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
UNIT = analytic.Surface(1.0, 1.0, 1.0, 1.0, 1.0)
N = 1000
H = (-20.0, -2.0, 0.5, 30.0)
TOLERANCE = 5e-14  # the quadrature gives 1e-14; s is known to 1e-16 of 30, exp(-s^2/2) 30 times worse
QUANTITIES = analytic.QUANTITIES


def raw_moments(q, h, gamma):
    return [F_power(k * mp.mpf(q.exponent), k * q.modulus, h, gamma) for k in (1, 2, 3, 4)]


@pytest.mark.parametrize("name", ["load", "area", "contacts"])
def test_cumulants(name):
    q = QUANTITIES[name]
    fixed, free = (
        analytic.Model(SURFACE, grading=Exponential(2.0), n_asperities=N, count=count).cumulants(name, H)
        for count in ("fixed", "poisson")
    )
    scale = mp.mpf(q.scale(SURFACE))
    for i, h in enumerate(H):
        with mp.workdps(250 if h < -8 else 60):  # variance 1e-89 from moments that are all nearly 1
            moments = raw_moments(q, h, 2.0)
            for found, (k1, k2, k3, k4) in ((fixed, cumulants_of(moments)), (free, moments)):
                skewness, kurtosis = k3 / k2**1.5 / mp.sqrt(N), k4 / k2**2 / N
                assert error(found.mean[i], N * scale * k1) < TOLERANCE
                assert error(found.variance[i], N * scale**2 * k2) < TOLERANCE
                # They pass through 0 where everything touches: absolute there.
                assert abs(float(found.skewness[i]) - skewness) < TOLERANCE * max(1, abs(skewness))
                assert abs(float(found.excess_kurtosis[i]) - kurtosis) < TOLERANCE * max(1, abs(kurtosis))


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_all_surfaces_of_few_asperities_one_by_one(count):
    """Asperities of three heights, three on a surface or as many as Poisson has it: no formula of sums."""
    law, h, names = MeasuredHeights([-1.0, 0.4, 2.0]), (-0.9, 0.2), ("load", "contacts")
    model = Model(UNIT, grading=Exponential(1.5), heights=law, n_asperities=3.0, count=count)
    s = np.array(law.heights)
    one = [4 / 3 * np.maximum(s - x, 0) ** 1.5 * (1.5 - 0.5 * np.exp(-s)) for x in h]
    one = np.array([*one, *(1.0 * (s > x) for x in h)])  # shape (columns, heights)
    numbers = np.array(
        [k for k in product(range(30), repeat=3) if sum(k) < 30 and (count == "poisson" or sum(k) == 3)]
    )
    n, factorials = numbers.sum(axis=1), np.array([float(math.factorial(k)) for k in range(30)])
    of_this_size = math.exp(-3) * 3.0**n / factorials[n] if count == "poisson" else 1.0
    weights = of_this_size * factorials[n] / factorials[numbers].prod(axis=1) / 3.0**n
    sums = numbers @ one.T
    assert weights.sum() == pytest.approx(1, rel=1e-14)
    mean = weights @ sums
    off = sums - mean
    k2, k3, k4 = (weights @ off**k for k in (2, 3, 4))
    for i, name in enumerate(names):
        found, here = model.cumulants(name, h), slice(2 * i, 2 * i + 2)
        np.testing.assert_allclose(found.mean, mean[here], rtol=1e-12)
        np.testing.assert_allclose(found.variance, k2[here], rtol=1e-12)
        np.testing.assert_allclose(found.skewness, (k3 / k2**1.5)[here], rtol=1e-10, atol=1e-12)
        np.testing.assert_allclose(found.excess_kurtosis, (k4 / k2**2 - 3)[here], rtol=1e-10)
    matrix = model.covariance(names, h).reshape(4, 4)
    np.testing.assert_allclose(matrix, (off.T * weights) @ off, rtol=1e-12)


def test_cumulants_of_a_step_that_was_not_declared():
    c = 0.7123
    grading = Custom(lambda s: np.where(s > c, 3.0, 1.0))
    first = lambda k: F(1.5 * k, c) * (3**k - 1)  # noqa: E731
    load = analytic.Model(UNIT, grading=grading, n_asperities=1, count="poisson").cumulants("load", c - 1e-13)
    # All the contacts but a layer 1e-13 thick are above the step.
    assert error(load.variance, (mp.mpf(4) / 3) ** 2 * (first(2) + F(3, c))) < 1e-11


PAIRS = [  # separations and quantities at either of them
    (-3.0, 1e-9, "stiffness", "load"),
    (-3.0, 1e-3, "conductance", "contacts"),
    (4.0, 1.0, "area", "stiffness"),
    (4.0, 0.0, "load", "conductance"),
]


@pytest.mark.parametrize(("h", "gap", "lower", "higher"), PAIRS)
def test_covariance_at_two_separations(h, gap, lower, higher):
    names, upper, law = list(QUANTITIES), h + gap, exponential(1.5)
    values = analytic.Model(UNIT, grading=Exponential(1.5), n_asperities=7, count="poisson").covariance(
        names, [h, upper]
    )
    p, q = QUANTITIES[lower], QUANTITIES[higher]
    one = cross(p.exponent, h, q.exponent, upper, lambda s: law(s) ** (p.modulus + q.modulus))
    i, j = names.index(lower), names.index(higher)
    assert error(values[i, 0, j, 1], 7 * p.scale(UNIT) * q.scale(UNIT) * one) < TOLERANCE
    np.testing.assert_allclose(values, values.transpose(2, 3, 0, 1), rtol=1e-15)


def test_covariance_diagonal_is_the_variance():
    h, names, model = [-20.0, -9.0, 0.0, 2.5], ["load", "contacts"], Model(SURFACE, grading=Exponential(2.0))
    matrix = model.covariance(names, h)
    for i, name in enumerate(names):
        np.testing.assert_allclose(np.diag(matrix[i, :, i, :]), model.cumulants(name, h).variance, rtol=1e-12)


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_contacts_far_below_the_mean_height(count):
    """Almost all touch: the number that do not is Poisson, 1e-19 of a thousand."""
    h = [-9.0, -8.0]
    values = analytic.Model(UNIT, n_asperities=N, count=count).covariance(["contacts"], h)[0, :, 0, :]
    for (i, a), (j, b) in product(enumerate(h), repeat=2):
        with mp.workdps(60):
            truth = N * (F(0, max(a, b)) - (F(0, a) * F(0, b) if count == "fixed" else 0))
        assert error(values[i, j], truth) < 1e-12
