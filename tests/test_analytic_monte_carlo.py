"""The exact statistics against surfaces that are drawn: plain sums over normal heights.

About 80 figures at |z| < 5: one false alarm in 2e4 seeds, and the seed is fixed.
"""

import numpy as np
import pytest

import analytic
from analytic import Exponential

UNIT = analytic.Surface(1.0, 1.0, 1.0, 1.0, 1.0)
GAMMA, N, SURFACES = 1.5, 200, 40_000
NAMES, H = ("load", "area", "stiffness", "contacts"), (0.5, 1.2)
GATE = 5.0


def asperity(name, s, h, *, exponent=None):
    """Hertz, written out: what an asperity of height s adds (E* = R = sigma = 1)."""
    x, e = np.maximum(s - h, 0), GAMMA - (GAMMA - 1) * np.exp(-s)
    match name:
        case "load":
            return 4 / 3 * x ** (1.5 if exponent is None else exponent) * e
        case "area":
            return np.pi * x
        case "stiffness":
            return 2 * np.sqrt(x) * e
        case _:
            return (s > h).astype(float)


@pytest.fixture(scope="module", params=["fixed", "poisson"])
def drawn(request):
    """All sums of all surfaces, (surface, 8), and those of the load with the exponent 1.4."""
    rng = np.random.default_rng(20240601 + (request.param == "poisson"))
    size = np.full(SURFACES, N) if request.param == "fixed" else rng.poisson(N, SURFACES)
    heights = rng.normal(size=size.sum())
    starts = np.concatenate([[0], np.cumsum(size)[:-1]])
    sums = [np.add.reduceat(asperity(name, heights, h), starts) for name in NAMES for h in H]
    wrong = np.add.reduceat(asperity("load", heights, H[1], exponent=1.4), starts)
    return request.param, np.array(sums).T, wrong


def exact(count):
    means = np.concatenate([analytic.mean(UNIT, name, H, Exponential(GAMMA)) for name in NAMES]) * N
    matrix = analytic.covariance(UNIT, NAMES, H, Exponential(GAMMA), n_asperities=N, count=count)
    return means, matrix.reshape(len(means), -1)


def z_of_mean(sample, mean, variance):
    return (sample.mean(axis=0) - mean) / np.sqrt(variance / SURFACES)


def z_of_products(x, y, value):
    products = x * y  # deviations from the exact means, so that the estimate is unbiased
    return (products.mean() - value) / (products.std() / np.sqrt(SURFACES))


def test_means(drawn):
    count, sums, _ = drawn
    means, matrix = exact(count)
    assert np.abs(z_of_mean(sums, means, np.diag(matrix))).max() < GATE


def test_covariances(drawn):
    count, sums, _ = drawn
    means, matrix = exact(count)
    deviations = sums - means
    z = [
        z_of_products(deviations[:, i], deviations[:, j], matrix[i, j])
        for i in range(len(means))
        for j in range(i + 1)
    ]
    assert np.abs(z).max() < GATE


def test_third_cumulant(drawn):
    count, sums, _ = drawn
    load = analytic.cumulants(UNIT, "load", H[0], Exponential(GAMMA), n_asperities=N, count=count)
    cubes = ((sums[:, 0] - load.mean) / np.sqrt(load.variance)) ** 3
    assert abs(cubes.mean() - load.skewness) / (cubes.std() / np.sqrt(SURFACES)) < GATE


def test_a_wrong_exponent_is_noticed(drawn):
    count, _, wrong = drawn
    means, matrix = exact(count)
    assert abs(z_of_mean(wrong, means[1], matrix[1, 1])) > 7  # 8.5 expected: 1.2 % of the mean


def test_the_wrong_count_is_noticed(drawn):
    count, sums, _ = drawn
    means, matrix = exact("poisson" if count == "fixed" else "fixed")
    area = sums[:, 2] - means[2]
    assert abs(z_of_products(area, area, matrix[2, 2])) > 2 * GATE


def test_gamma_one_is_noticed(drawn):
    count, sums, _ = drawn
    mean = N * float(analytic.load(UNIT, H[0]))
    variance = analytic.cumulants(UNIT, "load", H[0], n_asperities=N, count=count).variance
    assert abs(z_of_mean(sums[:, 0], mean, variance)) > 2 * GATE
