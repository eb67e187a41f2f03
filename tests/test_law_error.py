"""Laws of values with crowds (`law_error`) against those of `cells`, and against exact cumulants."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ndtr
from scipy.stats import ks_2samp, kstest
from test_aggregate import GATE, scores

import analytic
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import MemoryResults
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.crowding import crowding
from mcgw.sampling.samplers import aggregate_of, cells_of, law_error_of, sampler_of

H = (0.0, 1.0, 2.0)
SURFACES = 100_000
ALARM = 1e-6  # that one of the distances below is above its limit by chance
QUANTITIES = ("load", "area", "stiffness")


def limit(distances, samples=2):
    """What the largest of some distances between samples of SURFACES stays below, if their laws are alike.

    Massart, "The tight constant in the Dvoretzky-Kiefer-Wolfowitz inequality" (1990), for each sample.
    """
    return samples * np.sqrt(np.log(2 * samples * distances / ALARM) / (2 * SURFACES))


def distance(one, other):
    """Largest difference of the distributions of any value in two lots of surfaces."""
    return max(
        ks_2samp(one[name][:, k], other[name][:, k]).statistic for name in QUANTITIES for k in range(len(H))
    )


def lot(sampler):
    """Values of many surfaces."""
    blocks = [sampler.block(first, 2000).sums for first in range(0, SURFACES, 2000)]
    return {name: np.concatenate([block[name] for block in blocks]) for name in QUANTITIES}


def crowded(scene):
    """With the smallest crowds that keep what is asked, even if `auto` would not take them for so few."""
    found = crowding(scene, mesh_of(scene, split=False))
    assert found.distance <= scene.law_error
    return aggregate_of(scene, found.threshold, found.distance)


@pytest.mark.slow
@pytest.mark.parametrize("n", [10**4, 10**6])
def test_laws_are_those_of_cells(make_scene, n):
    """Of other surfaces: a hundred thousand with crowds, and as many without."""
    scene = make_scene(separations=H, n_asperities=n, seed=5)
    exact = lot(cells_of(replace(scene, seed=6)))
    for law_error in (1e-2, 1e-3):
        crowds = lot(crowded(replace(scene, law_error=law_error)))
        assert distance(crowds, exact) <= law_error + limit(len(QUANTITIES) * len(H))


@pytest.mark.slow
def test_one_asperity_is_no_crowd(make_scene):
    """The companion: at light contact single asperities that count as Gaussian show."""
    scene = make_scene(separations=H, n_asperities=5, count="poisson", seed=5)
    exact, most = lot(cells_of(replace(scene, seed=6))), 1e-3 + limit(len(QUANTITIES) * len(H))
    assert distance(lot(cells_of(scene)), exact) <= most
    assert distance(lot(aggregate_of(scene, crowded=1)), exact) > most


@pytest.mark.slow
@pytest.mark.parametrize("n", [10**4, 10**6, 10**9])
def test_four_cumulants(make_scene, n):
    scene = make_scene(separations=H, n_asperities=n, n_surfaces=SURFACES, law_error=1e-3, seed=11)
    ensemble = Ensemble(scene, "aggregate", MemoryResults(lot(crowded(scene))))
    assert max(scores(ensemble, name).max() for name in QUANTITIES) < GATE


def edgeworth(x, skewness, kurtosis):
    """Distribution function of a standardised value by its cumulants (Petrov 1975, VI.1)."""
    hermite = (x**2 - 1, x**3 - 3 * x, x**5 - 10 * x**3 + 15 * x)
    third, fourth, both = hermite
    terms = third * skewness / 6 + fourth * kurtosis / 24 + both * skewness**2 / 72
    return ndtr(x) - np.exp(-x * x / 2) / np.sqrt(2 * np.pi) * terms


@pytest.mark.slow
@pytest.mark.parametrize(("spread", "right"), [(1.0, True), (0.95, False)])
def test_laws_of_very_many_asperities(make_scene, spread, right):
    """A billion, against the expansion by exact cumulants; a standard deviation that is 5 % less is seen."""
    scene = make_scene(separations=H, n_asperities=10**9, law_error=1e-3, seed=12)
    values, found = lot(sampler_of(scene)), []
    for name in QUANTITIES:
        exact = analytic.cumulants(scene.surface, name, H, scene.grading, n_asperities=10**9)
        x = (values[name] - exact.mean) / (spread * np.sqrt(exact.variance))
        for k, cumulants in enumerate(zip(exact.skewness, exact.excess_kurtosis, strict=True)):
            found.append(kstest(x[:, k], edgeworth, args=cumulants).statistic)
    assert (max(found) <= 1e-3 + limit(len(found), samples=1)) == right


@pytest.mark.parametrize("law_error", [1e-2, 1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("n", [10**4, 10**6, 10**8])
def test_a_crowd_keeps_what_is_asked_and_fewer_do_not(make_scene, n, law_error):
    """The bound falls with the threshold, to nothing where no cell is crowded."""
    scene = make_scene(n_asperities=n, law_error=law_error)
    found = crowding(scene, mesh_of(scene, split=False))
    assert found.distance <= law_error
    assert 0 <= found.alone <= scene.touching * (1 + 1e-9)
    stricter = scene.replace(law_error=found.distance * 0.999)
    if stricter.law_error > 0:
        less = crowding(stricter, mesh_of(stricter, split=False))
        assert less is None or (less.threshold > found.threshold and less.alone > found.alone)


def test_what_auto_takes(make_scene):
    """Crowds where they buy something; `cells` where nobody may err, few touch, or a sampler is named."""
    names = {
        "aggregate": {"n_asperities": 10**6, "law_error": 1e-3},
        "cells": {"n_asperities": 10**6},
        "tail": {"n_asperities": 10, "law_error": 1e-2},
    }
    for name, changes in names.items():
        assert sampler_of(make_scene(**changes)).name == name
    named = make_scene(n_asperities=10**6, law_error=1e-3, sampler="cells")
    assert sampler_of(named).name == "cells"
    assert law_error_of(named) == law_error_of(make_scene()) == 0
    assert 0 < law_error_of(make_scene(**names["aggregate"])) <= 1e-3
    assert sampler_of(make_scene(n_asperities=3000, law_error=1e-9)).name == "cells"
