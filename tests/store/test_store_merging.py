"""Tables in chunks, and blocks that become a file: the same numbers and digest, however that fails."""

import os
import signal
from pathlib import Path

import h5py
import numpy as np
import pytest
from oracles.begun_runs import SIZE, SURFACES, begun, digest, in_small_blocks
from oracles.flipped import flip_a_number
from oracles.inside import Values, parts_of

import mcgw
from mcgw.errors import RunError, StoppedError
from mcgw.jobs import making
from mcgw.store import h5_writing, place


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch):
    """Of 16 surfaces, in chunks of 8."""
    in_small_blocks(monkeypatch)


@pytest.mark.parametrize("columns", [0, 41, 512, 513, 2**17, 2**20])
def test_chunks_are_cut_at_powers_of_two_within_a_mebibyte(columns, monkeypatch):
    monkeypatch.setattr(h5_writing, "CHUNK_ROWS", 256)
    rows = h5_writing.chunk_rows(10**6, columns)
    assert 256 % rows == 0  # so that blocks of whole chunks of the largest kind are whole chunks of any
    assert rows == 1 or 8 * rows * columns <= 2**20
    assert rows == 256 or 16 * rows * columns > 2**20
    assert h5_writing.chunk_rows(7, columns) == min(rows, 7)


# --- blocks become a file -------------------------------------------------------------------------------


@pytest.fixture
def scene(make_scene):
    return make_scene(sampler="cells", n_surfaces=SURFACES)


@pytest.fixture
def expected(scene, tmp_path):
    """Digest of the ensemble that was drawn in memory and saved, without blocks."""
    mcgw.save(mcgw.simulate(scene), tmp_path / "whole.h5")
    return digest(tmp_path / "whole.h5")


@pytest.mark.parametrize("rows", [4, 12, 256])
def test_blocks_and_chunks_of_any_size_make_the_same(scene, tmp_path, expected, monkeypatch, rows):
    """The first three blocks as of a version with other blocks; the file is one of 37 surfaces that grows."""
    monkeypatch.setattr(h5_writing, "CHUNK_ROWS", rows)
    path = tmp_path / "e.h5"
    mcgw.run(scene.replace(n_surfaces=37), path)
    monkeypatch.setattr(Values, "rows", 20)
    assert mcgw.run(scene, path, shard="1/1") == 0
    monkeypatch.setattr(Values, "rows", SIZE)
    made, drawn = mcgw.run(scene, path), mcgw.simulate(scene)
    assert digest(path) == expected
    for name in scene.quantities:
        np.testing.assert_array_equal(made[name], drawn[name])


@pytest.mark.parametrize("keep", ["sums", "statistics"])
@pytest.mark.parametrize("damage", [flip_a_number, Path.unlink], ids=["flipped", "gone"])
def test_a_block_that_is_lost_late_never_comes_into_the_file(scene, tmp_path, keep, damage, monkeypatch):
    """After the shards were looked at."""
    path, merged, kept = tmp_path / "e.h5", making._merged, scene.replace(keep=keep)
    block = begun(kept, path)[2]

    def damaged_first(*words):
        damage(block)
        return merged(*words)

    with monkeypatch.context() as patch:
        patch.setattr(making, "_merged", damaged_first)
        with pytest.raises(RunError, match="a shard is damaged; run the jobs again to redraw it"):
            mcgw.merge(path)
    assert not path.exists()
    assert not list(parts_of(path).glob(".*.tmp"))
    mcgw.run(kept, path)
    mcgw.save(mcgw.simulate(kept), tmp_path / "whole.h5")
    assert digest(path) == digest(tmp_path / "whole.h5")


def test_numbers_that_go_to_another_place_are_seen(scene, tmp_path, monkeypatch):
    """Two chunks in the wrong order, each of them intact."""
    path, write = tmp_path / "e.h5", place.write
    begun(scene, path)

    def swapped(temporary, *words):
        write(temporary, *words)
        with h5py.File(temporary, "r+") as file:
            area = file["area"].id
            parts = [area.read_direct_chunk((row, 0))[1] for row in (32, 40)]
            for row, part in zip((40, 32), parts, strict=True):
                area.write_direct_chunk((row, 0), part)

    monkeypatch.setattr(place, "write", swapped)
    with pytest.raises(RunError, match="was not written correctly"):
        mcgw.merge(path)
    assert not path.exists()


@pytest.mark.parametrize("step", ["__setitem__", "__getitem__"])
def test_a_signal_while_merging_keeps_all_blocks(scene, tmp_path, expected, monkeypatch, step):
    """While the file is written, or read back."""
    path, work, struck = tmp_path / "e.h5", getattr(h5py.Dataset, step), []
    blocks = begun(scene, path)

    def signalled(*arguments):
        if not struck:
            struck.append(True)
            os.kill(os.getpid(), signal.SIGINT)
        return work(*arguments)

    with monkeypatch.context() as patch:
        patch.setattr(h5py.Dataset, step, signalled)
        with pytest.raises(StoppedError, match=r"all blocks are kept in .*; the same command merges them"):
            mcgw.merge(path)
    assert not path.exists()
    assert sorted(parts_of(path).glob("shards/*.h5")) == blocks
    assert not list(parts_of(path).glob(".*.tmp"))
    mcgw.merge(path)
    assert digest(path) == expected
