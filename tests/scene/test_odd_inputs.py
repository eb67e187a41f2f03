"""Odd scenes, files and places: each works, fails in one line that names it, or degrades as stated."""

import os
from pathlib import Path

import numpy as np
import pytest
from oracles.inside import Values, check_output, memory_available

import analytic
import mcgw
from mcgw.errors import StoreError


def test_beyond_64_bits(make_scene, tmp_path):
    scene = make_scene(n_surfaces=10**12, n_asperities=10**8, separations=(6.0,))
    with pytest.raises(StoreError, match=r"n_surfaces \* n_asperities = 1e\+20 is more than 2\^63 - 1"):
        mcgw.run(scene, tmp_path / "e.h5")
    assert not list(tmp_path.iterdir())


def test_more_asperities_than_memory(make_scene, tmp_path, monkeypatch):
    scene = make_scene(
        n_surfaces=4, n_asperities=memory_available() // 8, separations=(4.0,), sampler="aggregate"
    )
    assert mcgw.run(scene, tmp_path / "e.h5").n_surfaces == 4
    for sampler in ("cells", "direct"):
        with pytest.raises(ValueError, match=r"the heights of one surface needs .* GiB of memory but only"):
            mcgw.heights(scene.replace(sampler=sampler), 0, untouched=True)
    reducer = Values(scene)
    monkeypatch.setattr(type(scene), "width", memory_available())
    with pytest.raises(StoreError, match=r"a block of . surfaces needs .* GiB of memory"):
        reducer.check()


def test_more_than_the_disk(make_scene, tmp_path):
    scene = make_scene(n_surfaces=10**12, n_asperities=1000, separations=(3.0,))
    with pytest.raises(StoreError, match=r"needs up to .* GiB more on the disk while made and .* are free"):
        mcgw.run(scene, tmp_path / "e.h5")
    assert not list(tmp_path.iterdir())


def test_an_extreme_gamma(make_scene):
    for gamma in (1e300, 1e308):  # the sums of stiffness, or all, would be infinite
        with pytest.raises(mcgw.SceneError, match=r"grading.gamma = 1e\+30\d: .* overflow"):
            make_scene(grading=analytic.Exponential(gamma))
    for gamma in (0.0, 1e-300, 1e280):
        ensemble = mcgw.simulate(make_scene(grading=analytic.Exponential(gamma), n_surfaces=3))
        assert np.isfinite(ensemble.load).all()


def test_names_that_are_none(make_scene, tmp_path):
    for name in ("..", "a\0b", "x" * 300, "a\nb"):
        with pytest.raises(StoreError):
            mcgw.run(make_scene(n_surfaces=2), tmp_path / name)
    with pytest.raises(StoreError, match="is not a valid file name"):
        mcgw.run(make_scene(n_surfaces=2), "")
    assert not list(tmp_path.iterdir())


def test_inputs_that_are_no_files(make_scene, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, Path("/dev/zero")):
        with pytest.raises(mcgw.SceneError, match="is not a regular file"):
            mcgw.load_scene(path)
        with pytest.raises(StoreError, match=r"is not a regular file|Is a directory"):
            mcgw.open_ensemble(path)


def test_folders_that_are_none(make_scene, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(StoreError, match=r"cannot be written|Not a directory"):
        mcgw.run(make_scene(n_surfaces=2), tmp_path / "file" / "e.h5")
    folder = tmp_path / "closed"
    folder.mkdir(mode=0o500)
    if not os.access(folder, os.W_OK):  # the superuser may write anywhere
        with pytest.raises(StoreError, match="read-only"):
            check_output(folder / "e.h5")
    with pytest.raises(StoreError, match=r"0 GiB are free|cannot be written"):
        mcgw.run(make_scene(n_surfaces=2), "/proc/e.h5")
