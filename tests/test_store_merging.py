"""Blocks that become a file: the same digest, however their chunks lie and whatever is wrong with one."""

import os
import signal
from dataclasses import replace

import h5py
import numpy as np
import pytest

import mcgw
from mcgw.errors import RunError, StoppedError
from mcgw.jobs import merging
from mcgw.jobs.job import Job
from mcgw.jobs.merging import merge
from mcgw.jobs.running import run, run_part
from mcgw.jobs.session import Part
from mcgw.store import chunks, ensembles, shards, structure
from mcgw.store.run_folder import parts_of
from mcgw.store.trailer import read_checked, trailer_of

SIZE, SURFACES = 16, 100  # seven blocks, the last one short


@pytest.fixture(autouse=True)
def _small_blocks_in_this_process(monkeypatch):
    monkeypatch.setattr(Job, "rows", SIZE)
    monkeypatch.setattr(chunks, "CHUNK_ROWS", SIZE // 2)
    monkeypatch.setattr(ensembles, "examine", lambda path: structure.describe(str(path)))


@pytest.fixture
def scene(make_scene):
    return make_scene(sampler="cells", keep="moments", n_surfaces=SURFACES)


@pytest.fixture
def expected(scene, tmp_path, monkeypatch):
    """Digest of the ensemble that was drawn in memory and saved, without blocks."""
    return digest(tmp_path / "whole.h5", lambda path: mcgw.save(mcgw.simulate(scene), path))


@pytest.fixture
def copied(monkeypatch):
    """How many rows went as packed chunks, table by table."""
    rows, add = [], chunks._add_chunks

    def counted(target, first, source):
        if not target.name.endswith("extras"):  # whose rows are not surfaces
            rows.append(len(source))
        add(target, first, source)

    monkeypatch.setattr(chunks, "_add_chunks", counted)
    return rows


def digest(path, make=None):
    if make:
        make(path)
    problem, found = ensembles.verify(path)
    assert problem == ""
    return found


def begun(scene, path):
    """All blocks, and nothing of the file."""
    assert run_part(scene, path, Part(1, 1)) == 0
    return sorted(parts_of(path).glob("shards/*.h5"))


@pytest.mark.parametrize(("rows", "direct"), [(1, 7), (4, 7), (8, 6), (16, 6), (12, 2), (256, 0)])
def test_blocks_of_any_number_of_chunks_make_the_same(
    scene, tmp_path, expected, copied, monkeypatch, rows, direct
):
    """Blocks of 16 rows and one of 4: whole chunks go as they are; of 12 rows only two begin in step."""
    monkeypatch.setattr(chunks, "CHUNK_ROWS", rows)
    path = tmp_path / "e.h5"
    assert digest(path, lambda path: run(scene, path)) == expected
    tables = len(scene.quantities) + 2  # moments and cells
    assert len(copied) == direct * tables
    for name, values in mcgw.simulate(scene).sums.arrays.items():
        np.testing.assert_array_equal(mcgw.open_ensemble(path).sums.read(name, 0, None), values)


def test_blocks_that_begin_within_a_chunk_go_on_as_well(scene, tmp_path, expected, copied, monkeypatch):
    """As in a run that another version began: blocks of 20, every second one in step with chunks of 8."""
    monkeypatch.setattr(Job, "rows", 20)
    path = tmp_path / "e.h5"
    begun(scene, path)
    monkeypatch.setattr(Job, "rows", SIZE)
    assert digest(path, lambda path: run(scene, path)) == expected
    assert sum(copied) == 60 * (len(scene.quantities) + 2)


def test_a_run_that_an_older_version_began_goes_on(scene, tmp_path, expected, copied, monkeypatch):
    """Its shards are not in chunks."""
    path = tmp_path / "e.h5"
    with monkeypatch.context() as patch:
        patch.setattr(shards, "stored", lambda file, name, values: file.create_dataset(name, data=values))
        assert run_part(scene, path, Part(1, 2)) > 0
    assert digest(path, lambda path: run(scene, path)) == expected
    assert copied


@pytest.mark.parametrize("old", ["of this version", "all compressed"])
def test_a_file_is_extended_whatever_it_is_packed_with(scene, tmp_path, expected, copied, monkeypatch, old):
    path = tmp_path / "e.h5"
    with monkeypatch.context() as patch:
        if old == "all compressed":  # as before compression was chosen by what it saves
            patch.setattr(chunks, "_shrinks", lambda _: True)
        run(replace(scene, n_surfaces=37), path)
    with h5py.File(path) as file:
        assert (file["load"].compression == "gzip") == (old == "all compressed")
    copied.clear()
    assert digest(path, lambda path: run(scene, path)) == expected
    assert copied.count(37) == (6 if old == "of this version" else 2)  # contacts and cells shrink


def chunk_of(path, name, number=1):
    """Where a chunk lies in a file."""
    with h5py.File(path) as file:
        info = file[name].id.get_chunk_info(number)
    return info.byte_offset, info.size


def damaged(path, name, *, sealed):
    """A byte in the middle of a packed chunk changes; `sealed`: and the trailer says that this is right."""
    trailer, body = read_checked(path)
    offset, size = chunk_of(path, name)
    changed = bytearray(body)
    changed[offset + size // 2] ^= 16
    tail = trailer_of(bytes(changed), **trailer.notes) if sealed else path.read_bytes()[len(body) :]
    path.write_bytes(changed + tail)


@pytest.mark.parametrize("name", ["load", "contacts"])
@pytest.mark.parametrize("sealed", [False, True])
def test_a_damaged_chunk_is_never_copied_into_the_file(scene, tmp_path, expected, name, sealed, monkeypatch):
    """Found by the trailer, and where that was made anew by HDF5's checksum of the chunk that was copied."""
    path, merged = tmp_path / "e.h5", merging.merge_into
    begun(scene, path)

    def damage_first(folder, *rest):
        monkeypatch.setattr(merging, "merge_into", merged)
        damaged(sorted(folder.glob("shards/*.h5"))[2], name, sealed=sealed)
        merged(folder, *rest)

    monkeypatch.setattr(merging, "merge_into", damage_first)
    with pytest.raises(RunError, match="a shard is damaged; run the jobs again"):
        merge(path)
    assert not path.exists()
    assert not list(parts_of(path).glob(".*.tmp"))
    if not sealed:
        assert digest(path, lambda path: run(scene, path)) == expected


def test_numbers_that_go_to_another_place_are_seen(scene, tmp_path, monkeypatch):
    """Two chunks in the wrong order, each of them intact."""
    path, add = tmp_path / "e.h5", chunks._add_chunks
    begun(scene, path)

    def swapped(target, first, source):
        add(target, first, source)
        if target.name == "/area" and first == 32:
            parts = [target.id.read_direct_chunk((row, 0))[1] for row in (32, 40)]
            for row, part in zip((40, 32), parts, strict=True):
                target.id.write_direct_chunk((row, 0), part)

    monkeypatch.setattr(chunks, "_add_chunks", swapped)
    with pytest.raises(RunError, match="reads otherwise than written"):
        merge(path)
    assert not path.exists()


@pytest.mark.parametrize("where", ["writing", "reading back"])
def test_a_signal_while_merging_keeps_all_blocks(scene, tmp_path, expected, monkeypatch, where):
    path = tmp_path / "e.h5"
    blocks = begun(scene, path)
    target = (shards.Shard, "body") if where == "writing" else (h5py.Dataset, "__getitem__")
    work, struck = getattr(*target), []

    def signalled(*arguments):
        if not struck:
            struck.append(True)
            os.kill(os.getpid(), signal.SIGINT)
        return work(*arguments)

    with monkeypatch.context() as patch:
        patch.setattr(*target, signalled)
        with pytest.raises(StoppedError, match=r"all blocks are kept in .*; the same command merges them"):
            merge(path)
    assert not path.exists()
    assert sorted(parts_of(path).glob("shards/*.h5")) == blocks
    assert not list(parts_of(path).glob(".*.tmp"))
    assert digest(path, merge) == expected
