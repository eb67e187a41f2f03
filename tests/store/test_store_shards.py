"""Shards: every changed number and every lost byte is noticed."""

from types import SimpleNamespace

import h5py
import numpy as np
import pytest
from oracles.inside import Plan, Span, commit_shard, read_rows, read_tables

import mcgw
from mcgw.errors import StoreError

RUN, SPAN = "a" * 64, Span(40, 5)


def open_shard(path, run, **how):
    """What a plan of this run, with a block like that, makes of a shard."""
    plan = SimpleNamespace(identity=run, axes="", blocks={SPAN: (0, 40)}, reducers=[SimpleNamespace(rows=5)])
    return Plan.shard(plan, path, **how)


def arrays():
    load = np.linspace(0, 1, 15).reshape(5, 3)
    return {"load": load, "contacts": np.arange(15).reshape(5, 3), "block_mean": np.array([[42.0, 3.5, 1.0]])}


@pytest.fixture
def shard(tmp_path):
    commit_shard(tmp_path / SPAN.file_name, RUN, SPAN, arrays(), 1.5)
    return tmp_path / SPAN.file_name


@pytest.mark.parametrize("name", ["load", "contacts", "block_mean"])
def test_every_flipped_bit_of_a_number_is_noticed(name, tmp_path, shard):
    with h5py.File(shard) as file:
        first, size = file[name].id.get_offset(), file[name].id.get_storage_size()
    data = shard.read_bytes()
    for at in range(first, first + size, 7):
        changed = bytearray(data)
        changed[at] ^= 1 << at % 8
        shard.write_bytes(changed)
        assert open_shard(shard, RUN, numbers=False) == (SPAN, 1.5)
        assert open_shard(shard, RUN) is None
        with pytest.raises(StoreError, match="damaged"):
            read_tables(shard)


def test_every_lost_byte_and_flipped_bit_is_noticed(shard):
    """But for bits in room that HDF5 leaves and nobody reads."""
    data, dice = shard.read_bytes(), np.random.default_rng(2)
    for length in [0, 1, len(data) - 1, *dice.choice(len(data), 50, replace=False)]:
        shard.write_bytes(data[:length])
        assert open_shard(shard, RUN) is None
    for at in dice.choice(len(data), 50, replace=False):
        changed = bytearray(data)
        changed[at] ^= 1 << int(dice.integers(8))
        shard.write_bytes(changed)
        if (found := open_shard(shard, RUN)) is not None:
            assert found == (SPAN, 1.5)
            assert all(np.array_equal(read_tables(shard)[name], values) for name, values in arrays().items())


def test_a_shard_of_another_run_or_block_is_refused(shard):
    assert open_shard(shard, "b" * 64) is None
    other = shard.with_name(Span(45, 5).file_name)
    other.write_bytes(shard.read_bytes())
    assert open_shard(other, RUN) is None


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_not_finite_are_never_committed(tmp_path, bad):
    wrong = arrays()
    wrong["load"][2, 1] = bad
    with pytest.raises(StoreError, match="load holds numbers that are not finite"):
        commit_shard(tmp_path / SPAN.file_name, RUN, SPAN, wrong, 0.0)
    assert not list(tmp_path.iterdir())


def test_the_checksum_is_of_contents_alone(shard):
    """Laid out otherwise, by another program and in big-endian numbers, the numbers are as good."""
    with h5py.File(shard, "r+") as file:
        sha = file["load"].attrs["sha256"]
        del file["load"]
        file["load"] = arrays()["load"].astype(">f8")
        file["load"].attrs["sha256"] = sha
        file.attrs["comment"] = "seen"
    assert open_shard(shard, RUN) == (SPAN, 1.5)
    with h5py.File(shard, "r+") as file:
        file["load"][0, 0] = -0.0  # equal to 0.0, and not the same bits
    assert open_shard(shard, RUN) is None
    with pytest.raises(StoreError, match="checksum mismatch of load"):
        read_tables(shard)


@pytest.mark.parametrize("lacking", [1, 100, 1500])
def test_what_does_not_fit_when_a_file_is_closed_is_an_error(lacking, make_scene, tmp_path):
    """HDF5 keeps the last bytes until then: a disk that lacks a single one is full."""
    resource = pytest.importorskip("resource")
    drawn = mcgw.simulate(make_scene(separations=(2.0,), n_surfaces=8))
    mcgw.save(drawn, tmp_path / "whole.h5")
    size = (tmp_path / "whole.h5").stat().st_size - lacking
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        with pytest.raises(mcgw.RunError, match=r"e\.h5: cannot be written \(File too large"):
            mcgw.save(drawn, tmp_path / "e.h5")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert [path.name for path in tmp_path.iterdir()] == ["whole.h5"]


def test_rows_that_lie_in_several_files_are_read_in_their_order(tmp_path):
    rows, files = np.arange(9), [(tmp_path / f"{k}.h5", 3) for k in range(3)]
    for (path, _), some in zip(files, rows.reshape(3, 3), strict=True):
        with h5py.File(path, "w") as file:
            file.create_dataset("load", data=some, chunks=True)
    for part in (slice(None), slice(2, 4), slice(3, 6), slice(4, 9)):
        np.testing.assert_array_equal(read_rows(files, "load", part), rows[part])
