"""A stop rule in a run with a file: it goes on, it extends, and its numbers are those of any run."""

import dataclasses

import numpy as np
import pytest

import mcgw
from mcgw.errors import StoreError
from mcgw.running import run
from mcgw.until_known import run_until_known


@pytest.fixture
def scene(make_scene):
    return make_scene(rel_err=0.01, n_surfaces=10**6, separations=(0.0, 1.0), n_asperities=300)


def widest(ensemble):
    """Largest half-width of a 95 % interval relative to its mean."""
    found = [
        np.abs(ensemble.interval(name)[1] / ensemble.mean(name) - 1).max()
        for name in ensemble.scene.quantities
    ]
    return max(found)


def test_every_mean_is_known_and_the_surfaces_are_those_of_any_run(scene, tmp_path):
    ensemble = run_until_known(scene, tmp_path / "a.h5")
    assert widest(ensemble) <= 0.01
    assert ensemble.scene.rel_err is None
    plain = mcgw.simulate(dataclasses.replace(scene, rel_err=None, n_surfaces=ensemble.n_surfaces))
    for name in scene.quantities:
        np.testing.assert_array_equal(ensemble.values(name), plain.values(name))
    few = dataclasses.replace(scene, rel_err=None, n_surfaces=ensemble.n_surfaces // 2)
    assert widest(mcgw.simulate(few)) > 0.01  # half of them would not do


def test_the_same_again_draws_nothing_and_a_tighter_rule_extends(scene, tmp_path):
    path = tmp_path / "a.h5"
    first = run_until_known(scene, path)
    before = path.stat().st_mtime_ns
    assert run_until_known(scene, path).n_surfaces == first.n_surfaces
    assert path.stat().st_mtime_ns == before
    load = first.load
    tighter = run_until_known(dataclasses.replace(scene, rel_err=0.005), path)
    assert tighter.n_surfaces > 3 * len(load)
    assert widest(tighter) <= 0.005
    np.testing.assert_array_equal(tighter.load[: len(load)], load)


def test_the_limit_and_the_time_hold(scene, tmp_path):
    assert run_until_known(dataclasses.replace(scene, n_surfaces=200), tmp_path / "a.h5").n_surfaces == 200
    hasty = dataclasses.replace(scene, rel_err=None, n_surfaces=10**7, max_seconds=0.2)
    assert 64 <= run_until_known(hasty, tmp_path / "b.h5").n_surfaces < 10**7


def test_another_scene_there_is_refused(scene, make_scene, tmp_path):
    run(make_scene(), tmp_path / "a.h5")
    with pytest.raises(StoreError, match="different ensemble"):
        run_until_known(scene, tmp_path / "a.h5")
