"""Sweeps: each point has the numbers that it has alone, and points over the same surfaces differ exactly."""

import numpy as np
import pytest
from oracles.drawn_together import check_points
from oracles.told import drawn

import mcgw
from mcgw.sweeps import groups
from mcgw.sweeps.axes import axes_of, label

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


@pytest.mark.parametrize(
    ("gammas", "count"),
    [(np.linspace(0.2, 1.6, 8), "poisson"), ([1.0, 0.4, 1.9, 0.9, 0.8, 0.7, 0.6, 0.5, 1.9], "fixed")],
)
def test_eight_gradings_are_means_of_the_softest_and_the_stiffest(gammas, count):
    """In any order; and the two themselves have the bits of single runs."""
    sweep = mcgw.sweep(SCENE.replace(n_surfaces=20, count=count), {GAMMA: gammas})
    assert len(sweep.groups[0].means["load"]) == 2  # of which all are weighted means
    assert same_bits(sweep, (int(np.argmin(gammas)),))
    assert same_bits(sweep, (int(np.argmax(gammas)),))
    check_points(sweep)
    for i in range(len(gammas)):
        alone = mcgw.simulate(sweep.scene(i))
        for found, expected in zip(sweep.interval("contacts"), alone.interval("contacts"), strict=True):
            np.testing.assert_allclose(found[i], expected, rtol=1e-12)


def test_a_table_among_many_exponential_gradings_keeps_its_numbers():
    """It is not taken for the homogeneous surface, a mean of two of them."""
    gradings = [*(mcgw.Exponential(gamma) for gamma in np.linspace(0.2, 2.0, 9)), KINKED[0]]
    check_points(mcgw.sweep(SCENE.replace(n_surfaces=20), {"grading": gradings}))


SEVERAL = {
    "separations again and unsorted": (SCENE.replace(separations=[2.0, 0.0, 1.0, 1.0]), {GAMMA: [0.5, 2.0]}),
    "without cells": (SCENE.replace(n_asperities=10), {GAMMA: [0.5, 2.0]}),
    "numbers of asperities": (SCENE, {GAMMA: [0.5, 1.0, 2.0], "ensemble.n_asperities": [50, 2000]}),
    "laws of heights": (SCENE, {"heights": [{"law": "weibull", "shape": 2.0}, {}], GAMMA: [0.5, 2.0]}),
    "radii": (SPECTRAL, {GAMMA: [0.5, 2.0, 3.0]}),
    "balance of many": (SCENE.replace(interaction="body", n_surfaces=20), {GAMMA: np.linspace(1.0, 2.0, 9)}),
    "a yielding law of many": (
        SCENE.replace(law=mcgw.KogutEtsion(critical=0.1), n_surfaces=5, n_asperities=10, sampler="tail"),
        {GAMMA: np.linspace(1.0, 2.0, 8)},
    ),
    "seven gradings": (SCENE.replace(n_surfaces=20), {GAMMA: [0.5, 0.7, 0.9, 1.1, 1.3, 1.5, 1.7, 0.5]}),
    "a function": (SCENE.replace(grading=lambda s: 1 + 0.3 * np.tanh(s)), {"surface.E_star": [7e10, 8e10]}),
}


@pytest.mark.parametrize("name", SEVERAL)
def test_any_kind_of_scene_has_its_bits(name):
    scene, over = SEVERAL[name]
    sweep = mcgw.sweep(scene, over)
    assert len(sweep.groups) == (2 if name in ("laws of heights", "numbers of asperities") else 1)
    assert all(same_bits(sweep, at) for at in np.ndindex(sweep.shape))


OF_OTHER_CELLS = {
    "tables with kinks": (SCENE, {"grading": KINKED}),
    "breaks where others begin": (
        SCENE.replace(law=mcgw.KogutEtsion(critical=0.1), separations=[0.0, 0.1, 0.2, 0.3, 0.5]),
        {"contact.law.critical": [0.05, 0.1, 0.2]},
    ),
    "not combinations": (  # for they are clipped
        SCENE.replace(separations=[-1.0, -0.5, 0.0, 1.0, 2.0], negative="clip", n_surfaces=20),
        {GAMMA: np.linspace(1.5, 3.0, 9)},
    ),
}


@pytest.mark.parametrize("name", OF_OTHER_CELLS)
def test_points_that_need_other_cells_share_their_surfaces(name):
    """The same contacts on each; means by chance beyond 5 standard errors once in 1e5."""
    scene, over = OF_OTHER_CELLS[name]
    sweep = mcgw.sweep(scene.replace(n_surfaces=2000), over)
    assert len(sweep.groups) == 1
    check_points(sweep)
    mean, std = (
        {tuple(row) for row in x.reshape(-1, 5)} for x in (sweep.mean("contacts"), sweep.std("contacts"))
    )
    assert (len(mean), len(std)) == (1, 1)
    for quantity in ("load", "area"):
        z = (sweep.mean(quantity) - sweep.theory(quantity)) / sweep.stderr(quantity)
        assert np.abs(z).max() < 5
    alone = [mcgw.simulate(one.replace(n_surfaces=9)).contacts for one in sweep.scenes[:2]]
    assert not np.array_equal(*alone)  # what common cells are for


def test_what_no_cells_resolve_is_drawn_one_by_one_at_all_points(monkeypatch):
    monkeypatch.setattr("mcgw.sampling.samplers._CUTS", 0)
    steep = mcgw.Graded(mcgw.Exponential(-1.5), negative="clip")
    few = {"n_surfaces": 5, "n_asperities": 3000, "law": mcgw.KogutEtsion(critical=0.0018)}
    scene, over = (
        SCENE.replace(separations=[-1.2, 1.8], grading=steep, **few),
        {"surface.E_star": [7e10, 8e10]},
    )
    sweep = mcgw.sweep(scene, over)
    assert len(sweep.groups) == 1
    assert all(same_bits(sweep, (i,)) for i in range(2))
    with pytest.raises(ValueError, match='use sampler = "tail"'):
        mcgw.sweep(scene.replace(sampler="cells"), over)


@pytest.mark.parametrize("gammas", [[1.0, 1.001, 1.5], np.linspace(0.5, 1.7, 9)])
def test_slopes_from_pairs_are_those_of_theory(gammas):
    slopes = mcgw.sweep(SCENE, {"ensemble.count": ["fixed", "poisson"], GAMMA: gammas}).slopes("load", GAMMA)
    assert slopes.value.shape == (2, len(gammas) - 1, 5)
    assert np.abs((slopes.value - slopes.theory) / slopes.stderr).max() < 5
    assert (slopes.stderr < 0.05 * np.abs(slopes.value))[..., :3].all()  # so that a wrong sign would show
    e = mcgw.simulate(SCENE, grading=mcgw.Exponential(float(gammas[0])))
    other = mcgw.simulate(SCENE, grading=mcgw.Exponential(float(gammas[1])))
    step = gammas[1] - gammas[0]
    np.testing.assert_allclose(
        slopes.stderr[0, 0], (other.load - e.load).std(axis=0, ddof=1) / 300**0.5 / step, rtol=1e-8
    )
    assert "theory" in repr(slopes)


def test_quantities_that_the_modulus_does_not_enter_do_not_change():
    sweep = mcgw.sweep(SCENE, {GAMMA: np.linspace(0.5, 1.7, 9)})
    difference = sweep.difference("area", 0, 5)
    assert not difference.value.any()
    assert not difference.stderr.any()


def test_neither_threads_nor_blocks_change_a_bit(monkeypatch):
    over = {GAMMA: np.linspace(0.5, 1.7, 9), "surface.E_star": ["70 GPa", 8e10]}
    one, two = (mcgw.sweep(SCENE, over, threads=n) for n in (1, 2))
    assert all(np.array_equal(one.std(name), two.std(name)) for name in one.quantities)
    monkeypatch.setattr(groups, "_ROWS", 70)
    parts = mcgw.sweep(SCENE, over)
    np.testing.assert_allclose(parts.std("load"), one.std("load"), rtol=1e-13)
    np.testing.assert_allclose(parts.mean("load"), one.mean("load"), rtol=1e-14)


def test_scenes_that_share_nothing_are_simulated():
    over = {"ensemble.sampler": ["direct", "tail", "cells", "aggregate"]}
    sweep = mcgw.sweep(SCENE, over)
    assert len(sweep.groups) == 4
    assert all(same_bits(sweep, (i,)) for i in range(4))
    with pytest.raises(ValueError, match="have different surfaces"):
        sweep.difference("load", 0, 1)


def test_what_nobody_gave_follows():
    follows = SCENE.replace(n_asperities=None)
    sweep = mcgw.sweep(follows, {"surface.nominal_area": ["1 mm^2", "2 mm^2"]})
    assert [scene.n_asperities for scene in sweep.scenes] == [300, 600]
    assert len({scene.seed for scene in sweep.scenes}) == 1


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
    ({"ensemble.seed": [-k for k in range(1, 99)]}, r"and 78 more"),
    (
        {"contact.unload_from": [-1.0], "contact.quantities": [["load"]]},
        "contact.quantities: must be the same",
    ),
    (
        {GAMMA: [1, 2], "ensemble.seed": [1, 2, 3]},
        r"zipped axes .* these have grading\.gamma 2, ensemble\.seed 3",
    ),
]


@pytest.mark.parametrize(("over", "words"), MISTAKES)
def test_mistakes_name_the_point(over, words):
    with pytest.raises(mcgw.SceneError, match=words):
        mcgw.sweep(SCENE, over, zipped="zipped" in words)


def test_points_that_are_none():
    sweep = mcgw.sweep(SCENE, {GAMMA: [1.0, 2.0], "ensemble.seed": [1, 2]})
    for at in ({GAMMA: 3.0}, {GAMMA: 1.0}, {"gamma": 1.0}, (0, 2), 0):
        with pytest.raises(ValueError, match=r"point|axis"):
            sweep.scene(at)
    with pytest.raises(KeyError, match="'depth' is not in this sweep"):
        sweep.mean("depth")


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
        assert line.place(i) == line.place((i,)) == (range(3)[i],)
        assert [square.place((i, k)) for k in range(-3, 3)] == [(range(3)[i], k) for k in 2 * [0, 1, 2]]
    assert line.place({GAMMA: 3.0}) == (2,)
    for axes, at in (
        (line, 3),
        (line, -4),
        (square, (0, 3)),
        (square, (-4, 0)),
        (square, (0,)),
        (line, (0, 0)),
    ):
        with pytest.raises(ValueError, match="there is no point"):
            axes.place(at)


def test_what_is_shown_of_slopes_is_what_there_is():
    """Slopes at the first separation and the first values of other keys."""
    over = {"ensemble.count": ["fixed", "poisson"], GAMMA: [1.0, 1.5, 2.5, 3.0, 3.5]}
    sweep = mcgw.sweep(SCENE.replace(n_surfaces=20, separations=[1.0, 0.0], quantities=["load"]), over)
    slopes = sweep.slopes("load", GAMMA)
    _, head, *lines = repr(slopes).splitlines()
    assert head.split() == [GAMMA, "slope", "stderr", "theory"]
    errors = [float(f"{x:.1g}") for x in slopes.stderr[0, :, 0]]
    expected = [[1.25, 2.0, 2.75, 3.25], slopes.value[0, :, 0], errors, slopes.theory[0, :, 0]]
    shown = np.transpose([[float(word) for word in line.split()] for line in lines])
    np.testing.assert_allclose(shown, expected, rtol=1e-4)


def test_progress_counts_what_a_group_takes():
    """By hand: an asperity that touches at the lowest separation is one, a scene of a surface 3000."""
    told, over = [], {"ensemble.n_asperities": [200, 40_000], GAMMA: [1.0, 1.5, 2.0]}
    sweep = mcgw.sweep(SCENE.replace(n_surfaces=40), over, progress=lambda *pair: told.append(pair))
    work = [n / 2 + 3000 * 3 for n in (200, 40_000)]  # half of the asperities lie above d = 0
    assert len(sweep.groups) == 2
    assert told == [(0, 80), (round(80 * work[0] / sum(work)), 80), (80, 80)]


def test_pictures(recorded):
    """What is drawn is recorded; one bar is held to its ends by hand."""
    import matplotlib as mpl

    mpl.use("agg")
    sweep = mcgw.sweep(
        SCENE.replace(separations=[1.0, 0.0, 2.0]), {"ensemble.seed": [1, 2], GAMMA: [1.0, 1.5]}
    )
    axes, slopes = sweep.plot(quantity="area"), sweep.slopes("load", GAMMA).plot(k=2)
    recorded("drawn.sweep", [*drawn(axes), *drawn(slopes)])
    mean, error = (x[0, 0][[1, 0, 2]] for x in (sweep.mean("area"), sweep.stderr("area")))
    (bars,) = axes.containers[0].lines[2]
    ends = np.stack([mean - 1.96 * error, mean + 1.96 * error], axis=1)
    np.testing.assert_allclose([segment[:, 1] for segment in bars.get_segments()], ends)


def test_points_of_other_numbers_of_surfaces_have_errors_of_their_own():
    """Two groups, of 30 and of 120 surfaces, in either order: each divided by the root of its own number."""
    for numbers in ([30, 120], [120, 30]):
        sweep = mcgw.sweep(SCENE, {GAMMA: [0.5, 2.0], "ensemble.n_surfaces": numbers})
        assert len(sweep.groups) == 2
        for i, gamma in enumerate((0.5, 2.0)):
            for k, m in enumerate(numbers):
                load = mcgw.simulate(SCENE, grading=mcgw.Exponential(gamma), n_surfaces=m).load
                found = sweep.stderr("load")[i, k]
                np.testing.assert_allclose(found, load.std(axis=0, ddof=1) / m**0.5, rtol=1e-12)
                assert f"{found[0]:.1g}" in repr(sweep)
        for k, m in enumerate(numbers):
            loads = [mcgw.simulate(sweep.scene((i, k))).load for i in (1, 0)]
            error = (loads[0] - loads[1]).std(axis=0, ddof=1) / m**0.5
            np.testing.assert_allclose(sweep.difference("load", (1, k), (0, k)).stderr, error, rtol=1e-9)
            np.testing.assert_allclose(sweep.slopes("load", GAMMA).stderr[0, k], error / 1.5, rtol=1e-9)


@pytest.mark.parametrize("areas", [(1e-6, 3e-6), (3e-6, 1e-6)])
def test_pressures_on_other_areas_are_each_divided_by_its_own(areas):
    """The same asperities on one area and on three times as much: value, error and gain from the surfaces."""
    sweep = mcgw.sweep(SCENE, {"surface.nominal_area": areas})
    assert len(sweep.groups) == 1
    load = mcgw.simulate(SCENE).load
    for i, area in enumerate(areas):
        np.testing.assert_allclose(sweep.mean("pressure")[i], load.mean(axis=0) / area, rtol=1e-13)
        np.testing.assert_allclose(sweep.stderr("pressure")[i] * 300**0.5 * area, load.std(axis=0, ddof=1))
        exact = SCENE.theory.mean("load", sweep.separations) / area
        np.testing.assert_allclose(sweep.theory("pressure")[i], exact, rtol=1e-13)
    found, pressure = sweep.difference("pressure", 1, 0), [load / area for area in areas]
    between = pressure[1] - pressure[0]
    np.testing.assert_allclose(found.value, between.mean(axis=0), rtol=1e-12)
    np.testing.assert_allclose(found.stderr, between.std(axis=0, ddof=1) / 300**0.5, rtol=1e-9)
    apart = sum(p.var(axis=0, ddof=1) for p in pressure) / between.var(axis=0, ddof=1)
    np.testing.assert_allclose(found.gain, apart, rtol=1e-9)


def test_points_have_the_intervals_and_tables_of_single_runs():
    sweep = mcgw.sweep(SCENE, {GAMMA: [0.5, 2.0], "ensemble.n_asperities": [50, 2000]})
    frame, alone, point = sweep.to_dataframe(), mcgw.simulate(sweep.scene((1, 0))), sweep.ensemble((1, 0))
    assert frame.index.names == ["gamma", "n_asperities", "separation"]
    assert frame.loc[2.0, 50].load_std.tolist() == alone.std("load").tolist()
    for found, expected in zip(sweep.interval("pressure", 0.9), alone.interval("pressure", 0.9), strict=True):
        np.testing.assert_allclose(found[1, 0], expected, rtol=1e-12)
    assert mcgw.compare(point).verdict == mcgw.compare(alone).verdict
    for ask in (point.values, lambda q: point.quantile(q, 0.5), point.covariance):
        with pytest.raises(ValueError, match=r"load: a sweep only keeps mean and .* surfaces of that scene"):
            ask("load")


def test_what_a_scene_keeps_changes_no_sweep():
    kept, over = SCENE.replace(keep="statistics"), {GAMMA: [0.5, 2.0]}
    assert np.array_equal(mcgw.sweep(kept, over).std("load"), mcgw.sweep(SCENE, over).std("load"))
