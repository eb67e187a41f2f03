"""Sweeps: each point has the numbers that it has alone, and points over the same surfaces differ exactly."""

import numpy as np
import pytest
from oracles.drawn_together import check_points
from oracles.inside import axes_of, home, label
from oracles.told import drawn

import mcgw

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
SCENE = mcgw.Scene(
    SURFACE,
    separations=[0.0, 0.4, 1.0, 1.5, 2.5],
    n_surfaces=300,
    ensemble=mcgw.Sampling(n_asperities=2000),
    seed=7,
)
GAMMA = "grading.gamma"
SPECTRAL = mcgw.Scene(
    mcgw.SpectralSurface(1e-12, 1e-3, 5e6, 1e-6, 78.6e9),
    separations=[0.0, 1.0, 1.5],
    n_surfaces=50,
    ensemble=mcgw.Sampling(n_asperities=2000),
    seed=7,
)
KINKED = [mcgw.Table((-1, kink, 6), (1.0, 1.5, 3.0)) for kink in (0.33, 0.7, 1.21)]


def same_bits(sweep, at):
    alone = mcgw.simulate(sweep.scene(at))
    return all(
        np.array_equal(sweep.mean(name)[at], alone.mean(name))
        and np.array_equal(sweep.std(name)[at], alone.std(name))
        for name in sweep.quantities
    )


def test_eight_gradings_are_means_of_the_softest_and_the_stiffest():
    """In any order; and the two themselves have the bits of single runs."""
    gammas = [1.0, 0.4, 1.9, 0.9, 0.8, 0.7, 0.6, 0.5, 1.9]
    sweep = mcgw.sweep(SCENE.replace(n_surfaces=20, count="poisson"), {GAMMA: gammas})
    assert len(sweep.groups[0].means["load"]) == 2  # of which all are weighted means
    assert same_bits(sweep, (1,))
    assert same_bits(sweep, (2,))
    check_points(sweep)
    for i in range(len(gammas)):
        alone = mcgw.simulate(sweep.scene(i))
        np.testing.assert_allclose(sweep.std("load")[i], alone.std("load"), rtol=1e-12)
        for found, expected in zip(sweep.interval("contacts"), alone.interval("contacts"), strict=True):
            np.testing.assert_allclose(found[i], expected, rtol=1e-12)


FEW = SCENE.replace(n_surfaces=20)
KOGUT = mcgw.KogutEtsion(critical=0.1)
SEVERAL = {
    "separations again and unsorted": (FEW.replace(separations=[2.0, 0.0, 1.0, 1.0]), {GAMMA: [0.5, 2.0]}),
    "without cells": (SCENE.replace(n_asperities=10), {GAMMA: [0.5, 2.0]}),
    "numbers of asperities": (FEW, {GAMMA: [0.5, 1.0, 2.0], "ensemble.n_asperities": [50, 2000]}),
    "laws of heights": (FEW, {"heights": [{"law": "weibull", "shape": 2.0}, {}], GAMMA: [0.5, 2.0]}),
    "radii": (SPECTRAL, {GAMMA: [0.5, 2.0, 3.0]}),
    "balance of many": (FEW.replace(interaction="body"), {GAMMA: np.linspace(1.0, 2.0, 9)}),
    "a yielding law of many": (
        FEW.replace(law=KOGUT, n_asperities=10, sampler="tail"), {GAMMA: np.linspace(1.0, 2.0, 8)}
    ),
    "seven gradings": (FEW, {GAMMA: [0.5, 0.7, 0.9, 1.1, 1.3, 1.5, 1.7, 0.5]}),
    "a function": (FEW.replace(grading=lambda s: 1 + 0.3 * np.tanh(s)), {"surface.E_star": [7e10, 8e10]}),
    "samplers": (FEW, {"ensemble.sampler": ["direct", "tail", "cells", "aggregate"]}),
}  # fmt: skip
GROUPS = {"laws of heights": 2, "numbers of asperities": 2, "samplers": 4}


@pytest.mark.parametrize("name", SEVERAL)
def test_any_kind_of_scene_has_its_bits(name):
    scene, over = SEVERAL[name]
    sweep = mcgw.sweep(scene, over)
    assert len(sweep.groups) == GROUPS.get(name, 1)
    assert all(same_bits(sweep, at) for at in np.ndindex(sweep.shape))


OF_OTHER_CELLS = {
    "tables with kinks": (SCENE, {"grading": KINKED}),
    "a table among many exponential ones": (  # not taken for the homogeneous surface, a mean of two of them
        SCENE, {"grading": [*map(mcgw.Exponential, np.linspace(0.2, 2.0, 9)), KINKED[0]]}
    ),
    "breaks where others begin": (
        SCENE.replace(law=KOGUT, separations=[0.0, 0.1, 0.2, 0.3, 0.5]),
        {"contact.law.critical": [0.05, 0.1, 0.2]},
    ),
    "not combinations": (  # for they are clipped
        SCENE.replace(separations=[-1.0, -0.5, 0.0, 1.0, 2.0], negative="clip"),
        {GAMMA: np.linspace(1.5, 3.0, 9)},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", OF_OTHER_CELLS)
def test_points_that_need_other_cells_share_their_surfaces(name):
    """The same contacts on each; means by chance beyond 5 standard errors once in 1e5."""
    scene, over = OF_OTHER_CELLS[name]
    sweep = mcgw.sweep(scene.replace(n_surfaces=500), over)
    assert len(sweep.groups) == 1
    check_points(sweep)
    for found in (sweep.mean("contacts"), sweep.std("contacts")):
        assert np.ptp(found, axis=0).max() == 0
    for quantity in ("load", "area"):
        z = (sweep.mean(quantity) - sweep.theory(quantity)) / sweep.stderr(quantity)
        assert np.abs(z).max() < 5
    alone = [mcgw.simulate(one.replace(n_surfaces=9)).contacts for one in sweep.scenes[-2:]]
    assert not np.array_equal(*alone)  # what common cells are for


@pytest.mark.parametrize("gammas", [[1.0, 1.001, 1.5], np.linspace(0.5, 1.7, 9)])
def test_slopes_from_pairs_are_those_of_theory(gammas):
    slopes = mcgw.sweep(SCENE, {"ensemble.count": ["fixed", "poisson"], GAMMA: gammas}).slopes("load", GAMMA)
    assert slopes.value.shape == (2, len(gammas) - 1, 5)
    assert np.abs((slopes.value - slopes.theory) / slopes.stderr).max() < 5
    assert (slopes.stderr < 0.05 * np.abs(slopes.value))[..., :3].all()  # so that a wrong sign would show
    one, other = (mcgw.simulate(SCENE, grading=mcgw.Exponential(float(x))).load for x in gammas[:2])
    error = (other - one).std(axis=0, ddof=1) / 300**0.5 / (gammas[1] - gammas[0])
    np.testing.assert_allclose(slopes.stderr[0, 0], error, rtol=1e-8)


def test_neither_threads_nor_blocks_nor_what_is_kept_change_a_bit(monkeypatch):
    over = {GAMMA: np.linspace(0.5, 1.7, 9), "surface.E_star": ["70 GPa", 8e10]}
    one, two = (
        mcgw.sweep(SCENE.replace(keep=keep), over, threads=n) for n, keep in ((1, "sums"), (2, "statistics"))
    )
    assert all(np.array_equal(one.std(name), two.std(name)) for name in one.quantities)
    same = one.difference("area", (0, 0), (5, 1))  # which the modulus does not enter
    assert not np.any([same.value, same.stderr])
    monkeypatch.setattr(home("Group"), "_ROWS", 70)
    parts = mcgw.sweep(SCENE, over)
    np.testing.assert_allclose(parts.std("load"), one.std("load"), rtol=1e-13)
    np.testing.assert_allclose(parts.mean("load"), one.mean("load"), rtol=1e-14)


def test_a_rule_of_stopping_is_one_number_for_all():
    ruled = mcgw.sweep(SCENE.replace(rel_err=0.05, n_surfaces=2000), {GAMMA: [1.0, 2.0]})
    for scene in ruled.scenes:
        assert scene.rel_err is None
        assert 300 < scene.n_surfaces == ruled.scenes[0].n_surfaces < 2000


MISTAKES = [
    ({GAMMA: [1, -3, 5]}, "negative from s = 0.2877.*at grading.gamma = -3"),
    ({"grading.gama": [1]}, "grading.gama: unknown key.*at grading.gama = 1"),
    ({"contact.separations": [[1]]}, "must be the same for all points"),
    ({"foo": [1]}, "'foo': give \"section.key\""),
    ({GAMMA: 2}, "grading.gamma = 2: give a list"),
    ({GAMMA: []}, "give a list of at least one"),
    ({"grading": [3]}, "grading = 3: must be a table"),
    ({"grading": [np.sin]}, "is negative from s = 3.143"),
    ({}, "at least one key"),
    ({"contact.unload_from": [0, "x"]}, "contact.unload_from = 'x'"),
    ({"ensemble.keep": ["sums", "statistics"]}, r"ensemble\.keep: must be the same for all points"),
    ({"ensemble.max_seconds": [3]}, "max_seconds: a sweep must be reproducible"),
    ({"ensemble.max_seconds": [3], GAMMA: [-3]}, "negative from s = 0.2877"),
    ({"ensemble.seed": [-k for k in range(1, 99)]}, r"and 78 more"),
    ({"contact.quantities": [["load"]]}, "contact.quantities: must be the same"),
    ({"grading": [lambda s: np.full_like(s, np.nan)]}, r"grading.*not finite"),
    ({GAMMA: [1, 2], "ensemble.seed": [1, 2, 3]}, r"zipped axes .* these have grading\.gamma 2, ens"),
]


@pytest.mark.parametrize(("over", "words"), MISTAKES)
def test_mistakes_name_the_point(over, words):
    with pytest.raises(mcgw.SceneError, match=words):
        mcgw.sweep(SCENE, over, zipped="zipped" in words)


def test_axes_have_names_of_their_own():
    both = axes_of({"heights.law": ["gaussian"], "grading.law": ["homogeneous"], GAMMA: [1]}, zipped=False)
    assert both.dims == ("heights.law", "grading.law", "gamma")
    told = {2: 2, 0.5: 0.5, "1 um": "1 um", True: "True"}
    assert {x: label(x) for x in told} == told
    assert label({"law": "weibull"}) == "law = weibull"
    for values in (["a", "b"], [1e-6], [1e-6, "2 um"], [1e-6, 2e-6, 2e-6]):
        with pytest.raises(ValueError, match=r"^surface\.sigma: slopes need at least two numbers"):
            axes_of({"surface.sigma": values}, zipped=False).numbers("surface.sigma")


def test_points_are_found_as_elements_of_a_list():
    """From the front and from the back, and none beyond either end."""
    over = {GAMMA: [1.0, 2.0, 3.0], "ensemble.seed": [1, 2, 3]}
    square, line = axes_of(over, zipped=False), axes_of(over, zipped=True)
    for i in range(-3, 3):
        assert line.place(i) == line.place((i,)) == range(3)[i]
        assert [square.place((i, k)) for k in range(-3, 3)] == [3 * range(3)[i] + k for k in 2 * [0, 1, 2]]
    assert line.place({GAMMA: 3.0}) == 2
    for axes, at in [(line, 3), (line, -4), (line, (0, 0)), (square, (0, 3)), (square, (-4, 0)), (square, 0)]:
        with pytest.raises(ValueError, match="there is no point"):
            axes.place(at)
    for at in ({GAMMA: 4.0}, {GAMMA: 1.0}, {"gamma": 1.0}):
        with pytest.raises(ValueError, match=r"points have|is no axis"):
            square.place(at)


def test_pictures(recorded):
    scene, over = SCENE.replace(separations=[1.0, 0.0, 2.0]), {"ensemble.seed": [1, 2], GAMMA: [1.0, 1.5]}
    sweep = mcgw.sweep(scene, over)
    slopes = sweep.slopes("load", GAMMA)
    said = [*drawn(sweep.plot(quantity="area")), *drawn(slopes.plot(k=2)), *repr(slopes).splitlines()]
    recorded("drawn.sweep", said)


def test_points_of_other_numbers_of_surfaces_have_errors_of_their_own():
    """Two groups, of 120 and of 30 surfaces: each divided by the root of its own number."""
    sweep = mcgw.sweep(SCENE, {GAMMA: [0.5, 2.0], "ensemble.n_surfaces": [120, 30]})
    assert len(sweep.groups) == 2
    for k, m in enumerate((120, 30)):
        loads = [mcgw.simulate(sweep.scene((i, k))).load for i in (0, 1)]
        for i, load in enumerate(loads):
            found = sweep.stderr("load")[i, k]
            np.testing.assert_allclose(found, load.std(axis=0, ddof=1) / m**0.5, rtol=1e-12)
            assert f"{found[0]:.1g}" in repr(sweep)
        error = (loads[1] - loads[0]).std(axis=0, ddof=1) / m**0.5
        np.testing.assert_allclose(sweep.difference("load", (1, k), (0, k)).stderr, error, rtol=1e-9)
        np.testing.assert_allclose(sweep.slopes("load", GAMMA).stderr[0, k], error / 1.5, rtol=1e-9)


def test_pressures_on_other_areas_differ_as_those_of_the_surfaces():
    """The same asperities on one area and on three times as much: value, error and gain from the surfaces."""
    areas = (1e-6, 3e-6)
    sweep = mcgw.sweep(SCENE, {"surface.nominal_area": areas})
    assert len(sweep.groups) == 1
    load = mcgw.simulate(SCENE).load
    found, pressure = sweep.difference("pressure", 1, 0), [load / area for area in areas]
    between = pressure[1] - pressure[0]
    np.testing.assert_allclose(found.value, between.mean(axis=0), rtol=1e-12)
    np.testing.assert_allclose(found.stderr, between.std(axis=0, ddof=1) / 300**0.5, rtol=1e-9)
    apart = sum(p.var(axis=0, ddof=1) for p in pressure) / between.var(axis=0, ddof=1)
    np.testing.assert_allclose(found.gain, apart, rtol=1e-9)


def test_points_have_the_tables_and_verdicts_of_single_runs():
    sweep = mcgw.sweep(SCENE, {GAMMA: [0.5, 2.0], "ensemble.n_asperities": [50, 2000]})
    frame, alone, point = sweep.to_dataframe(), mcgw.simulate(sweep.scene((1, 0))), sweep.ensemble((1, 0))
    assert frame.index.names == ["gamma", "n_asperities", "separation"]
    assert frame.loc[2.0, 50].load_std.tolist() == alone.std("load").tolist()
    assert mcgw.compare(point).verdict == mcgw.compare(alone).verdict
    for ask in (point.values, lambda q: point.quantile(q, 0.5), point.covariance):
        with pytest.raises(ValueError, match=r"load: a sweep only keeps mean and .* surfaces of that scene"):
            ask("load")


def test_progress_counts_what_a_group_takes():
    """By hand: an asperity that touches at the lowest separation is one, a scene of a surface 3000."""
    told, over = [], {"ensemble.n_asperities": [200, 40_000], GAMMA: [1.0, 1.5, 2.0]}
    sweep = mcgw.sweep(SCENE.replace(n_surfaces=40), over, progress=lambda *pair: told.append(pair))
    work = [n / 2 + 3000 * 3 for n in (200, 40_000)]  # half of the asperities lie above d = 0
    assert len(sweep.groups) == 2
    assert told == [(0, 80), (round(80 * work[0] / sum(work)), 80), (80, 80)]
