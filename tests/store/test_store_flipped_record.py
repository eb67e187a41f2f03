"""A flipped bit in the record of a run or a sweep: its blocks are whole, and the scene is at hand."""

import numpy as np
import pytest
from oracles.inside import RECORD, Plan, Values, parts_of

import mcgw
from mcgw.errors import StoreError


def flip(path, what):
    """A bit of something that stands in a file."""
    data = bytearray(path.read_bytes())
    data[data.index(what) + 1] ^= 1
    path.write_bytes(data)


@pytest.fixture
def begun(make_scene, tmp_path, monkeypatch):
    """A run of three blocks, two of which are drawn."""
    monkeypatch.setattr(Values, "rows", 4)
    scene = make_scene(separations=(2.0,), sampler="tail", n_surfaces=12)
    mcgw.run(scene, tmp_path / "e.h5", shard="1/2")
    return scene, tmp_path / "e.h5"


@pytest.mark.parametrize("what", [b"HDF", b"mcgw-run", b"seed = ", b"tail", b"numba "])
def test_a_run_goes_on_from_its_blocks(begun, what, monkeypatch):
    scene, path = begun
    flip(parts_of(path) / RECORD, what)
    with pytest.raises(StoreError, match=r"damaged.* resume with mcgw run or mcgw sweep"):
        Plan.open(parts_of(path))
    drawn, draw = [], Plan.draw
    monkeypatch.setattr(Plan, "draw", lambda job, span, *how: drawn.append(span) or draw(job, span, *how))
    made = mcgw.run(scene, path)
    assert [span.first for span in drawn] == [4]
    assert np.array_equal(made.load, mcgw.simulate(scene).load)


def test_another_scene_does_not_take_it(begun):
    scene, path = begun
    flip(parts_of(path) / RECORD, b"seed = ")
    with pytest.raises(StoreError, match="damaged"):
        mcgw.run(scene.replace(seed=2), path)
    assert len(list((parts_of(path) / "shards").glob("block-*.h5"))) == 2


@pytest.mark.parametrize("what", [b"HDF", b"grading.gamma", b"seed = ", b"checksum"])
def test_a_sweep_goes_on_from_its_shards(make_scene, what, tmp_path):
    path, scene = tmp_path / "s.h5", make_scene(separations=(2.0,), n_surfaces=8)
    axes = {"grading.gamma": [1.2, 1.5], "ensemble.seed": [1, 2]}
    mcgw.sweep(scene, axes, path=path, shard="1/2")
    before = Plan.open(parts_of(path))
    flip(parts_of(path) / RECORD, what)
    mcgw.sweep(scene, axes, path=path, shard="1/2")
    assert Plan.open(parts_of(path)).axes == before.axes
