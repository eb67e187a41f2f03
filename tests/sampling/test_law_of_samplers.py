"""All samplers have the exact law: means, variances, covariances and distribution.

Every gate is |z| < 5 with fixed seeds: false alarms 6e-7 a number. Each test has a companion that a
wrong law fails.
"""

import dataclasses

import numpy as np
import pytest
from conftest import SURFACE
from scipy.stats import kstest

import analytic
import mcgw

GATE = 5.0
EXACT = ("direct", "tail", "cells")
M = 4000


@pytest.fixture(scope="module")
def ensembles():
    """One ensemble a sampler, fixed and Poisson."""
    made = {}
    for count in ("fixed", "poisson"):
        for k, sampler in enumerate((*EXACT, "aggregate")):
            scene = mcgw.Scene(
                surface=SURFACE,
                separations=(0.0, 0.5, 1.0, 2.0),
                grading=analytic.Exponential(1.5),
                contact=mcgw.Contact(quantities=("load", "area", "stiffness", "contacts", "conductance")),
                ensemble=mcgw.Sampling(n_asperities=600, count=count, sampler=sampler),
                n_surfaces=M,
                seed=17 + k,
            )
            made[sampler, count] = mcgw.simulate(scene)
    return made


def scores(ensemble, *, gamma=None):
    """z-scores of means, variances and covariances of all quantities at all separations."""
    scene = ensemble.scene if gamma is None else ensemble.scene.replace(grading=analytic.Exponential(gamma))
    exact = [scene.theory.cumulants(name, scene.separations) for name in scene.quantities]
    mean, variance, kurtosis = (
        np.concatenate([getattr(each, part) for each in exact])
        for part in ("mean", "variance", "excess_kurtosis")
    )
    exact = scene.theory.covariance(scene.quantities, scene.separations)
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
    ensemble = ensembles["cells", "poisson"]
    scene = ensemble.scene.replace(count="fixed")
    assert scores(dataclasses.replace(ensemble, scene=scene))[1] > GATE


@pytest.mark.parametrize("quantity", ["load", "stiffness"])
def test_each_value_has_its_exact_law(ensembles, quantity):
    """Kolmogorov-Smirnov at 1e-7 each; a mean that is off by 0.15 of the spread fails."""
    for sampler in EXACT:
        ensemble = ensembles[sampler, "fixed"]
        for k, h in enumerate(ensemble.separations):
            law, x = ensemble.scene.theory.distribution(quantity, h), ensemble.values(quantity)[:, k]
            assert kstest(x, law.cdf).pvalue > 1e-7
            assert kstest(x + 0.15 * law.std(), law.cdf).pvalue < 1e-7


def test_surfaces_are_independent(ensembles):
    """Correlation of each surface with the next, also across a group of counts."""
    for sampler in EXACT:
        load = ensembles[sampler, "fixed"].load[:, 0]
        load = (load - load.mean()) / load.std()
        for lag in (1, 2, 32, 64):
            assert abs((load[lag:] * load[:-lag]).mean()) * np.sqrt(M - lag) < GATE
    shared = np.repeat(load[: M // 2], 2)  # the companion: pairs of surfaces that share a stream
    assert abs((shared[1:] * shared[:-1]).mean()) * np.sqrt(M) > GATE
