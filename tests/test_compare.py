"""The verdict: it holds for what follows the theory, and fails for what does not."""

import dataclasses

import numpy as np
import pytest
from oracles import ensemble_arrays

import analytic
import mcgw
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import MemoryResults
from mcgw.figures.comparison import save_comparison
from mcgw.sampling.samplers import sampler_of
from mcgw.statistics.comparison import FALSE_ALARM, compare, verdict


def ensembles(scene, seeds):
    """As `simulate` draws them, by a sampler that is prepared once."""
    sampler = sampler_of(scene)
    for seed in seeds:
        sums = sampler.with_seed(seed).block(0, scene.n_surfaces).sums
        yield Ensemble(dataclasses.replace(scene, seed=seed), sampler.name, MemoryResults(sums))


def test_ensembles_of_a_prepared_sampler_are_those_of_simulate(make_scene):
    scene = make_scene(n_surfaces=20)
    for seed, ensemble in enumerate(ensembles(scene, range(3))):
        whole = mcgw.simulate(scene, seed=seed)
        assert ensemble.scene == whole.scene
        assert ensemble.sampler == whole.sampler
        for name in scene.quantities:
            np.testing.assert_array_equal(ensemble.values(name), whole.values(name))


@pytest.mark.slow
@pytest.mark.parametrize("gamma", [0.2, 0.5, 1.0, 1.5, 2.0])
def test_holds_for_20_seeds_of_20(make_scene, gamma):
    """100 verdicts at a false-alarm rate of 1e-3 each: a right program fails this in 1 of 10 choices of
    seeds, and these are fixed."""
    scene = make_scene(
        grading=analytic.Exponential(gamma),
        separations=tuple(np.linspace(0, 4, 41)),
        n_asperities=30_000,
        n_surfaces=500,
    )
    p = [verdict(ensemble).p for ensemble in ensembles(scene, range(20))]
    assert min(p) > FALSE_ALARM
    assert max(p) > 0.5  # a chi-square that is far too small is as wrong as one too large


@pytest.mark.slow
def test_p_values_are_uniform(make_scene):
    """400 seeds at few contacts: the share of p < 0.1 is 0.1 within 5 standard errors."""
    scene = make_scene(n_asperities=2000, n_surfaces=50)
    p = [verdict(ensemble).p for ensemble in ensembles(scene, range(400))]
    assert abs(np.mean(np.array(p) < 0.1) - 0.1) < 5 * np.sqrt(0.09 / 400)
    assert abs(np.mean(np.array(p) < 0.5) - 0.5) < 5 * np.sqrt(0.25 / 400)


@pytest.mark.parametrize("count", ["fixed", "poisson"])
@pytest.mark.parametrize("sampler", ["direct", "tail", "cells", "aggregate"])
def test_holds_for_every_sampler(make_scene, sampler, count):
    assert verdict(mcgw.simulate(make_scene(sampler=sampler, count=count, seed=3))).agrees


@pytest.mark.parametrize(
    "flaw",
    [
        {"exponent": 1.4},
        {"exponent": 1.49},
        {"heights": lambda s: s + 0.01},
        {"heights": lambda s: 1.005 * s},
    ],
)
def test_fails_for_a_wrong_law(make_scene, flaw):
    scene = make_scene(n_surfaces=500)
    assert verdict(Ensemble(scene, "direct", MemoryResults(ensemble_arrays(scene, 2)))).agrees
    assert not verdict(Ensemble(scene, "direct", MemoryResults(ensemble_arrays(scene, 2, **flaw)))).agrees


def test_fails_for_a_grading_off_by_2_percent(make_scene):
    ensemble = mcgw.simulate(make_scene(n_asperities=30_000))
    other = dataclasses.replace(ensemble.scene, grading=analytic.Exponential(2.04))
    assert verdict(ensemble).agrees
    assert not verdict(dataclasses.replace(ensemble, scene=other)).agrees


def test_curves_hold_what_they_say(make_scene):
    ensemble = mcgw.simulate(make_scene())
    curve = compare(ensemble).curves["load"]
    load = ensemble.load
    np.testing.assert_allclose(curve.mean, load.mean(axis=0), rtol=1e-13)
    np.testing.assert_allclose(ensemble.std("load"), load.std(axis=0, ddof=1), rtol=1e-12)
    exact = analytic.load(ensemble.scene.surface, ensemble.separations, ensemble.scene.grading) / 10
    np.testing.assert_allclose(curve.theory, exact, rtol=1e-12)  # 3000 asperities of 30 000
    inside = (curve.low < curve.mean) & (curve.mean < curve.high)
    assert inside[:-1].all()
    np.testing.assert_allclose(curve.residual * curve.stderr, curve.mean - curve.theory, rtol=1e-9)


def test_no_contact_at_all(make_scene, tmp_path):
    comparison = compare(mcgw.simulate(make_scene(separations=(9.0, 30.0))))
    assert comparison.verdict.agrees
    assert comparison.verdict.degrees == 0
    save_comparison(comparison, tmp_path / "none.png")


def test_one_surface(make_scene):
    comparison = compare(mcgw.simulate(make_scene(n_surfaces=1)))
    curve = comparison.curves["load"]
    assert 0 < curve.low[0] < curve.mean[0] < curve.high[0]
    assert np.isnan(curve.low[-1])  # h = 4: too few contacts
    assert np.isfinite(comparison.verdict.p)


def test_stratified_is_no_ensemble(make_scene):
    with pytest.raises(ValueError, match="takes another sampler"):
        compare(mcgw.simulate(make_scene(sampler="stratified")))
