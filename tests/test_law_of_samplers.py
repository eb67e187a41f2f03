"""All samplers have the exact law: means, variances, covariances, skewness, and each other's distribution.

Every gate is |z| < 5 with fixed seeds: false alarms 6e-7 a number. Each test has a companion that a
wrong law fails.
"""

import numpy as np
import pytest
from oracles import ensemble_arrays
from scipy.stats import ks_2samp

import analytic
import mcgw

GATE = 5.0
EXACT = ("direct", "tail", "cells")
M = 4000


@pytest.fixture(scope="module")
def ensembles():
    """One ensemble a sampler, fixed and Poisson."""
    from conftest import SURFACE

    from mcgw.scene.scene import Scene

    made = {}
    for count in ("fixed", "poisson"):
        for k, sampler in enumerate((*EXACT, "aggregate")):
            scene = Scene(
                surface=SURFACE,
                separations=(0.0, 0.5, 1.0, 2.0),
                grading=analytic.Exponential(1.5),
                quantities=("load", "area", "stiffness", "contacts", "conductance"),
                n_asperities=600,
                n_surfaces=M,
                count=count,
                sampler=sampler,
                seed=17 + k,
            )
            made[sampler, count] = mcgw.simulate(scene)
    return made


def scores(ensemble, *, gamma=None):
    """z-scores of means, variances and covariances of all quantities at all separations."""
    scene = ensemble.scene
    grading = scene.grading if gamma is None else analytic.Exponential(gamma)
    surface, h, n = scene.surface, scene.separations, scene.n_asperities
    mean, variance, kurtosis = [], [], []
    for name in scene.quantities:
        exact = analytic.cumulants(surface, name, h, grading, n_asperities=n, count=scene.count)
        mean.append(exact.mean)
        variance.append(exact.variance)
        kurtosis.append(exact.excess_kurtosis)
    mean, variance, kurtosis = (np.concatenate(part) for part in (mean, variance, kurtosis))
    exact = analytic.covariance(surface, scene.quantities, h, grading, n_asperities=n, count=scene.count)
    exact = exact.reshape(mean.size, mean.size) / np.sqrt(np.outer(variance, variance))

    values = np.concatenate([ensemble.values(name).astype(float) for name in scene.quantities], axis=1)
    standard = (values - mean) / np.sqrt(variance)
    m = len(values)
    z_mean = standard.mean(axis=0) * np.sqrt(m)
    z_variance = ((standard**2).mean(axis=0) - 1) / np.sqrt((2 + kurtosis) / m)
    products = standard[:, :, None] * standard[:, None, :]
    z_covariance = (products.mean(axis=0) - exact) / (products.std(axis=0) / np.sqrt(m))
    upper = np.triu_indices(mean.size, 1)
    return np.abs(z_mean).max(), np.abs(z_variance).max(), np.abs(z_covariance[upper]).max()


@pytest.mark.parametrize("count", ["fixed", "poisson"])
@pytest.mark.parametrize("sampler", [*EXACT, "aggregate"])
def test_means_variances_covariances(ensembles, sampler, count):
    assert max(scores(ensembles[sampler, count])) < GATE


def test_a_grading_off_by_2_percent_fails(ensembles):
    assert scores(ensembles["cells", "fixed"], gamma=1.53)[0] > GATE


def test_a_poisson_number_for_a_fixed_one_fails(ensembles):
    import dataclasses

    ensemble = ensembles["cells", "poisson"]
    scene = dataclasses.replace(ensemble.scene, count="fixed")
    assert scores(dataclasses.replace(ensemble, scene=scene))[1] > GATE


@pytest.mark.parametrize(
    ("flaw", "where"),
    [
        ({"exponent": 1.4}, 0),
        ({"heights": lambda s: s + 0.01}, 0),
        ({"heights": lambda s: np.minimum(s, 2.5)}, 1),
    ],
)
def test_a_wrong_law_fails(ensembles, flaw, where):
    """Exponent 1.4 for 3/2, normals biased by 0.01, a tail cut at 2.5 sigma."""
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.ensemble.results import MemoryResults

    scene = ensembles["direct", "fixed"].scene
    right = Ensemble(scene, "direct", MemoryResults(ensemble_arrays(scene, 5)))
    assert max(scores(right)) < GATE
    wrong = Ensemble(scene, "direct", MemoryResults(ensemble_arrays(scene, 5, **flaw)))
    assert scores(wrong)[where] > GATE


@pytest.mark.parametrize("quantity", ["load", "area", "stiffness", "contacts"])
def test_same_distribution_two_by_two(ensembles, quantity):
    """Kolmogorov-Smirnov at h = 0, 0.5, 1, 2: 12 comparisons a quantity at 1e-7 each."""
    for a, b in (("cells", "direct"), ("tail", "direct"), ("cells", "tail")):
        x, y = ensembles[a, "fixed"].values(quantity), ensembles[b, "fixed"].values(quantity)
        for k in range(x.shape[1]):
            assert ks_2samp(x[:, k], y[:, k]).pvalue > 1e-7


def test_kolmogorov_smirnov_sees_one_percent_more_spread(ensembles):
    """The companion: a load at h = 0 whose mean is off by a fifth of its spread fails."""
    x = ensembles["cells", "fixed"].load[:, 0]
    assert ks_2samp(x, ensembles["direct", "fixed"].load[:, 0] + 0.2 * x.std()).pvalue < 1e-7


def test_surfaces_are_independent(ensembles):
    """Correlation of each surface with the next, also across a group of counts."""
    for sampler in EXACT:
        load = ensembles[sampler, "fixed"].load[:, 0]
        load = (load - load.mean()) / load.std()
        for lag in (1, 2, 32, 64):
            assert abs((load[lag:] * load[:-lag]).mean()) * np.sqrt(M - lag) < GATE
    shared = np.repeat(load[: M // 2], 2)  # the companion: pairs of surfaces that share a stream
    assert abs((shared[1:] * shared[:-1]).mean()) * np.sqrt(M) > GATE


def test_skewness(ensembles):
    scene = ensembles["cells", "fixed"].scene
    exact = analytic.cumulants(scene.surface, "load", scene.separations, scene.grading, n_asperities=600)
    for sampler in EXACT:
        load = ensembles[sampler, "fixed"].load
        standard = (load - exact.mean) / np.sqrt(exact.variance)
        cubes = standard**3
        z = (cubes.mean(axis=0) - exact.skewness) / (cubes.std(axis=0) / np.sqrt(M))
        assert np.abs(z).max() < GATE
        z_if_gaussian = cubes.mean(axis=0) / (cubes.std(axis=0) / np.sqrt(M))
        assert np.abs(z_if_gaussian).max() > GATE


def test_rare_contacts_are_poisson(make_scene):
    """h = 5 with 1e6 asperities: 0.29 contacts a surface; the counts follow the exact binomial law."""
    scene = make_scene(separations=(5.0,), n_asperities=10**6, n_surfaces=20_000, quantities=("contacts",))
    contacts = mcgw.simulate(scene).contacts[:, 0]
    p = float(analytic.fn(0, 5.0))
    from scipy.stats import binom

    for k in range(3):
        share = binom.pmf(k, 10**6, p)
        z = ((contacts == k).mean() - share) / np.sqrt(share * (1 - share) / len(contacts))
        assert abs(z) < GATE
