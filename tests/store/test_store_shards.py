"""Shards: every changed number and every lost byte is noticed."""

from contextlib import closing, contextmanager

import h5py
import numpy as np
import pytest
from oracles.inside import Span, commit_shard, open_shard

import mcgw
from mcgw.errors import StoreError
from mcgw.store.h5_writing import SteadyFile

RUN, SPAN = "a" * 64, Span(40, 5)
FLIPS, TRUNCATIONS = 100, 50


def arrays():
    load = np.linspace(0, 1, 15).reshape(5, 3)
    return {"load": load, "contacts": np.arange(15).reshape(5, 3), "block_mean": np.array([[42.0, 3.5, 1.0]])}


@pytest.fixture
def shard(tmp_path):
    return commit_shard(tmp_path / SPAN.file_name, RUN, SPAN, arrays(), 1.5)


def test_a_shard_gives_back_what_was_put_in(shard):
    again = open_shard(shard.path, RUN)
    assert again == shard
    for name, values in arrays().items():
        np.testing.assert_array_equal(again.tables()[name], values)


@pytest.mark.parametrize("name", ["load", "contacts", "block_mean"])
def test_every_flipped_bit_of_a_number_is_noticed(name, tmp_path, shard):
    with h5py.File(shard.path) as file:
        chunk = file[name].id.get_chunk_info(0)
    data = shard.path.read_bytes()
    for at in range(chunk.byte_offset, chunk.byte_offset + chunk.size, 7):
        changed = bytearray(data)
        changed[at] ^= 1 << at % 8
        shard.path.write_bytes(changed)
        assert open_shard(shard.path, RUN, numbers=False) == shard
        for look in (lambda: open_shard(shard.path, RUN), lambda: shard.tables(name)):
            with pytest.raises(StoreError, match="damaged"):
                look()


def test_every_lost_byte_is_noticed(shard):
    data = shard.path.read_bytes()
    rng = np.random.default_rng(2)
    for length in [0, 1, len(data) - 1, *rng.choice(len(data), TRUNCATIONS, replace=False)]:
        shard.path.write_bytes(data[:length])
        with pytest.raises(StoreError):
            open_shard(shard.path, RUN)


def test_a_shard_of_another_run_or_block_is_refused(shard):
    with pytest.raises(StoreError, match="another run"):
        open_shard(shard.path, "b" * 64)
    other = shard.path.with_name(Span(45, 5).file_name)
    other.write_bytes(shard.path.read_bytes())
    with pytest.raises(StoreError, match="surfaces 40"):
        open_shard(other, RUN)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_not_finite_are_never_committed(tmp_path, bad):
    wrong = arrays()
    wrong["load"][2, 1] = bad
    with pytest.raises(StoreError, match="load holds numbers that are not finite"):
        commit_shard(tmp_path / SPAN.file_name, RUN, SPAN, wrong, 0.0)
    assert not list(tmp_path.iterdir())


def test_the_checksum_is_of_contents_alone(shard):
    """Laid out otherwise, by another program and in big-endian numbers, the numbers are as good."""
    with h5py.File(shard.path, "r+") as file:
        sha = file["load"].attrs["sha256"]
        del file["load"]
        file["load"] = arrays()["load"].astype(">f8")
        file["load"].attrs["sha256"] = sha
        file.attrs["comment"] = "seen"
    assert open_shard(shard.path, RUN) == shard
    with h5py.File(shard.path, "r+") as file:
        file["load"][0, 0] = -0.0  # equal to 0.0, and not the same bits
    for look in (lambda: open_shard(shard.path, RUN), lambda: shard.tables("load")):
        with pytest.raises(StoreError, match="checksum mismatch of load"):
            look()


@contextmanager
def room_for(size):
    """No file becomes larger."""
    resource = pytest.importorskip("resource")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.parametrize("how", ["write", "truncate"])
def test_a_full_disk_is_an_error_only_when_it_is_asked_for(tmp_path, how):
    """HDF5 sees none: it goes on, nothing more is written, and the first error is the one that is told."""
    with closing(SteadyFile(tmp_path / "a")) as file:
        with room_for(9):
            assert file.write(b"abcdef") == 6
            file.check()
            if how == "write":
                assert file.write(np.arange(2, dtype=np.int64)) == 16
            else:
                assert file.truncate(10) == 10
        assert file.write(b"xyz") == 3
        with pytest.raises(OSError, match="File too large"):
            file.check()
    assert (tmp_path / "a").read_bytes() == b"abcdef" + bytes(3) * (how == "write")


@pytest.mark.parametrize("lacking", [1, 100, 1500])
def test_what_does_not_fit_when_a_file_is_closed_is_an_error(lacking, make_scene, tmp_path):
    """HDF5 keeps the last bytes until then: a disk that lacks a single one is full."""
    drawn = mcgw.simulate(make_scene(separations=(2.0,), n_surfaces=8))
    mcgw.save(drawn, tmp_path / "whole.h5")
    size = (tmp_path / "whole.h5").stat().st_size - lacking
    with room_for(size), pytest.raises(mcgw.RunError, match=r"e\.h5: cannot be written"):
        mcgw.save(drawn, tmp_path / "e.h5")
    assert [path.name for path in tmp_path.iterdir()] == ["whole.h5"]
