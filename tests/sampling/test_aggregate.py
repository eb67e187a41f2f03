"""`aggregate` against the exact laws, and where it stops being right."""

import dataclasses

import numpy as np
import pytest
from oracles.law_of_crowds import distance, farthest
from scipy.integrate import quad
from scipy.stats import kstest, norm

import analytic
import mcgw
from mcgw.sampling import samplers
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.counted import counts_of
from mcgw.sampling.crowds import _FOURTH, _SQUARED, _THIRD, CROWDED, _partly, crowding
from mcgw.sampling.samplers import aggregate_of, distance_of, sampler_of


def test_where_the_approximation_begins_to_show(make_scene):
    """Cells are so narrow that even single asperities taken for Gaussian ones keep the four cumulants.

    What shows first are loads below zero at light contact: 1 % of the surfaces with a threshold of 1,
    none with the threshold in use.
    """
    scene = make_scene(separations=(1.0, 2.0), n_asperities=100, n_surfaces=20_000, sampler="aggregate")
    assert (mcgw.simulate(scene).load >= 0).all()
    single = samplers.aggregate_of(scene, crowded=1)
    share = (single.block(0, scene.n_surfaces)["load"] < 0).mean(axis=0)
    assert 0.005 < share[1] < 0.02


def test_terms_of_edgeworth_are_bounded_by_their_largest_values():
    x = np.linspace(-6, 6, 120_001)
    of_density = x**2 - 1, x**3 - 3 * x, x**5 - 10 * x**3 + 15 * x
    largest = [
        np.abs(terms * norm.pdf(x)).max() / k for terms, k in zip(of_density, (6, 24, 72), strict=True)
    ]
    np.testing.assert_allclose([_THIRD, _FOURTH, _SQUARED], largest, rtol=2e-4)


def test_price_does_not_depend_on_n(make_scene):
    """From 1e8 to 1e15 asperities the cells that are drawn one by one stay a few thousand asperities."""
    singly = []
    for n in (10**8, 10**12, 2**53):
        sampler = samplers.sampler_of(make_scene(n_asperities=n, sampler="aggregate"))
        counts = counts_of(sampler.scene, sampler.mesh, 0, 4).cells
        singly.append(counts[counts < CROWDED].sum() / 4)
    assert max(singly) < 3000


def dense(response):
    """Matrix of shape (quantities, moments, separations)."""
    return response @ np.eye(response.layout.sizes.sum())


def variance(sampler):
    """Of each quantity, with independent numbers in the cells: exactly what the Gaussian moments have."""
    response, layout = dense(sampler.response), sampler.response.layout
    total = 0.0
    for cell, start in enumerate(layout.starts[:-1]):
        orders = (
            x[cell] for x in (layout.plain, layout.rooted, *dataclasses.astuple(sampler.drawing.varying))
        )
        mean, root = _partly(*(int(n) for n in orders))
        rows = response[:, start : start + len(mean)]
        expected = sampler.scene.n_asperities * sampler.mesh.probability[cell]
        both = np.column_stack([mean, root])  # of T_0 a Poisson number has the variance n too
        total = total + expected * (np.einsum("qms,mk->qks", rows, both) ** 2).sum(axis=1)
    return total


def extras(sampler, name):
    """Variance of the asperities above all cells, at each separation."""
    scene, quantity = sampler.scene, analytic.QUANTITIES[name]

    def square(s, h):
        law = (s - h) ** quantity.exponent * (scene.grading(np.array(s)) if quantity.modulus else 1.0)
        return (quantity.scale(scene.surface) * law) ** 2 * np.exp(-s * s / 2) / np.sqrt(2 * np.pi)

    top = sampler.mesh.edges[-1]
    return [scene.n_asperities * quad(square, top, top + 4, args=(h,))[0] for h in scene.separations]


@pytest.mark.parametrize(("n", "grading", "separations"), [
    (10**9, analytic.Custom(lambda s: 2 + np.tanh(8 * (s - 1))), tuple(np.linspace(-0.5, 4, 7))),
    (10**15, analytic.Exponential(2.0), (0.0,)),
])  # fmt: skip
def test_moments_that_stay_at_their_means_hide_a_millionth_of_the_variance(
    make_scene, n, grading, separations
):
    """Without a random number. Where all vary nothing is hidden."""
    scene = make_scene(
        separations=separations, grading=grading, n_asperities=n, sampler="aggregate", count="poisson"
    )
    some = samplers.sampler_of(scene)
    all_vary = dataclasses.replace(some.drawing, varying=some.response.layout)
    every = dataclasses.replace(some, drawing=all_vary)
    assert some.drawing.varying.sizes.sum() < 0.6 * every.drawing.varying.sizes.sum()
    for q, name in enumerate(x for x in scene.quantities if x != "contacts"):
        exact = analytic.Model(scene.surface, grading=grading, n_asperities=n, count="poisson").cumulants(
            name, separations
        ).variance - extras(every, name)
        assert np.abs(variance(every)[q] / exact - 1).max() < 1e-11
        assert np.abs(variance(some)[q] / exact - 1).max() < 1e-6


@pytest.mark.parametrize("n", [10**3, pytest.param(10**6, marks=pytest.mark.slow)])
def test_a_promise_is_twice_the_distance_from_the_exact_law(make_scene, n):
    """By two transforms; of the value that is farthest off, where one term of the expansion is enough."""
    scene = make_scene(separations=(1.5, 2.5, 3.5), n_asperities=n, accuracy=1e-2, count="poisson")
    found = crowding(scene, mesh_of(scene, split=False))
    seen = farthest(scene, found.threshold)
    assert seen <= found.distance / 2 * 1.05
    if n >= 10**6:  # some cell is a crowd on all surfaces
        assert seen >= found.distance / 2 * 0.95


def test_a_fixed_number_of_asperities_is_farther_off(make_scene):
    """Its values vary less: by the generating function of the number."""
    scene = make_scene(separations=(0.0,), quantities=("stiffness",), n_asperities=1000, accuracy=1e-2)
    found = crowding(scene, mesh_of(scene, split=False))
    seen = distance(scene, "stiffness", 0.0, found.threshold)
    poisson = distance(scene.replace(count="poisson"), "stiffness", 0.0, found.threshold)
    assert 1.5 * poisson < seen
    assert found.distance / 2 * 0.9 < seen < found.distance / 2 * 1.05


def test_smaller_crowds_are_farther_off(make_scene):
    """The companion: sixteen asperities in place of 256 break the promise."""
    scene = make_scene(separations=(2.5, 3.5), n_asperities=10**4, count="poisson", accuracy=1e-2)
    assert farthest(scene, 16) > 3 * crowding(scene, mesh_of(scene, split=False)).distance


H = (0.0, 1.0, 2.0)
SURFACES = 100_000
ALARM = 1e-6  # that one of the distances below is above its limit by chance
QUANTITIES = ("load", "area", "stiffness")


def lot(scene):
    """Values of many surfaces, drawn with crowds."""
    sampler = aggregate_of(scene)
    blocks = [sampler.block(first, 2000) for first in range(0, SURFACES, 2000)]
    return {name: np.concatenate([block[name] for block in blocks]) for name in QUANTITIES}


@pytest.mark.slow
@pytest.mark.parametrize("n", [10**4, 10**9])
def test_drawn_values_have_the_exact_law(make_scene, n):
    """Within 1e-5 and what may be chance (Massart 1990); values that scatter 5 % less do not."""
    scene = make_scene(separations=H, n_asperities=n, seed=5)
    values, theory = lot(scene), scene.theory
    limit = 1e-5 + np.sqrt(np.log(2 * len(QUANTITIES) * len(H) / ALARM) / (2 * SURFACES))
    for name in QUANTITIES:
        for k, h in enumerate(H):
            law, drawn = theory.distribution(name, h), values[name][:, k]
            assert kstest(drawn, law.cdf).statistic < limit
            assert kstest(law.mean() + 0.95 * (drawn - law.mean()), law.cdf).statistic > limit


@pytest.mark.parametrize(("n", "accuracy"), [(10**4, 1e-2), (10**4, 1e-5), (10**6, 1e-3), (10**8, 1e-5)])
def test_a_crowd_keeps_what_is_asked_and_fewer_do_not(make_scene, n, accuracy):
    """The bound falls with the threshold, to nothing where no cell is crowded."""
    scene = make_scene(n_asperities=n, accuracy=accuracy)
    found = crowding(scene, mesh_of(scene, split=False))
    assert found.distance <= accuracy
    assert 0 <= found.alone <= scene.touching * (1 + 1e-9)
    stricter = scene.replace(accuracy=found.distance * 0.999)
    if stricter.accuracy > 0:
        less = crowding(stricter, mesh_of(stricter, split=False))
        assert less is None or (less.threshold > found.threshold and less.alone > found.alone)


def test_what_auto_takes(make_scene):
    """Crowds where they buy something; one by one where a handful touches, more with many separations."""
    many, crowd = tuple(np.linspace(0, 4, 601)), {"n_asperities": 10**6, "accuracy": 1e-3}
    names = {
        "aggregate": [crowd],
        "cells": [{}, {"n_asperities": 10**12}, {"separations": many}, {"n_asperities": 50},
                  {"separations": many, "n_asperities": 60}],
        "tail": [{"n_asperities": 1}, {"n_asperities": 8}, {"separations": many, "n_asperities": 36},
                 {"separations": many[300:], "n_asperities": 800}, {"n_asperities": 10, "accuracy": 1e-2}],
    }  # fmt: skip
    bought = {24_000: "cells", 30_000: "aggregate"}  # 300 a cell and those alone, by 1.5: 13 100; 13 600
    for name, scenes in names.items():
        assert {sampler_of(make_scene(**changes)).name for changes in scenes} == {name}
    for n, name in bought.items():
        assert sampler_of(make_scene(n_asperities=n, accuracy=1e-3)).name == name
    named = make_scene(n_asperities=10**6, accuracy=1e-3, sampler="cells")
    assert sampler_of(named).name == "cells"
    assert distance_of(named) == distance_of(make_scene()) == 0
    assert 0 < distance_of(make_scene(**crowd)) <= 1e-3
    assert sampler_of(make_scene(n_asperities=3000, accuracy=1e-9)).name == "cells"
    strict, high = (
        make_scene(n_asperities=10**15, accuracy=1e-12),
        make_scene(separations=9.0, accuracy=0.01),
    )
    for scene in (strict, high):  # no crowd is large enough, or there is no cell
        assert crowding(scene, mesh_of(scene, split=False)) is None


def test_compare_agrees_and_sees_another_gamma(make_scene):
    """By 1 %, which is far more than anybody allowed for."""
    scene = make_scene(n_surfaces=1000, accuracy=1e-2, n_asperities=10**6)
    ensemble = mcgw.simulate(scene)
    assert mcgw.compare(ensemble).verdict.agrees
    wrong = scene.replace(grading=analytic.Exponential(2.02))
    assert not mcgw.compare(dataclasses.replace(ensemble, scene=wrong)).verdict.agrees
