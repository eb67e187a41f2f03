"""Packed chunks and blocks that become a file: the same numbers and digest, however chunks lie or fail."""

import io
import itertools
import os
import signal
from dataclasses import replace

import h5py
import numpy as np
import pytest
from oracles.begun_runs import SIZE, SURFACES, begun, digest, in_small_blocks

import mcgw
from mcgw.ensemble.simulation import Values
from mcgw.errors import RunError, StoppedError
from mcgw.jobs import merging
from mcgw.store import chunks, shards
from mcgw.store.chunks import add_rows, chunk_rows, empty_table, stored
from mcgw.store.disk import parts_of, read_checked, trailer_of

ROWS, COLUMNS = 40, 5


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch):
    """Of 16 surfaces, in chunks of 8."""
    in_small_blocks(monkeypatch)


def noise(rows=ROWS, *shape):
    return np.random.default_rng(1).random((rows, *(shape or (COLUMNS,))))


def counts(rows=ROWS):
    return np.random.default_rng(2).integers(0, 9, (rows, COLUMNS))


def file_with(**tables):
    """An open HDF5 file in memory."""
    file = h5py.File(io.BytesIO(), "w")
    for name, values in tables.items():
        stored(file, name, values)
    return file


def joined(values, sizes, *, rows=None):
    """A table made of the parts of another one that files hold, of so many rows each; and those files."""
    target = h5py.File(io.BytesIO(), "w")
    table = empty_table(target, "x", rows or len(values), values)
    sources, first = [], 0
    for size in sizes:
        sources.append(file_with(x=values[first : first + size]))
        add_rows(table, first, sources[-1]["x"])
        first += size
    return target, sources


def packed(table, row):
    return table.id.read_direct_chunk((row, *(0,) * (table.ndim - 1)))


# One; a chunk filled by two, the second of them begins within it; each alone; less than a chunk at the end.
SPLITS = [[40], [16, 5, 3, 16], [1] * 40, [16, 20, 4]]


@pytest.mark.parametrize("values", [noise(), counts(), noise(ROWS, 3, 2), noise(ROWS, 1)])
@pytest.mark.parametrize("sizes", SPLITS)
def test_parts_make_the_whole(values, sizes):
    file, _ = joined(values, sizes)
    assert file["x"].dtype == values.dtype
    np.testing.assert_array_equal(file["x"][()], values)


def test_every_cut_into_three_makes_the_whole():
    values = counts(20)
    for a, b in itertools.combinations(range(1, 20), 2):
        file, _ = joined(values, [a, b - a, 20 - b])
        np.testing.assert_array_equal(file["x"][()], values)


@pytest.mark.parametrize("values", [noise(), counts()])
def test_what_lines_up_is_not_unpacked(values, monkeypatch):
    """The bytes are those of the source, and a chunk that nothing can read goes the same way."""
    file, (first, second) = joined(values, [16, 24])
    assert packed(file["x"], 8) == packed(first["x"], 8)
    assert packed(file["x"], 32) == packed(second["x"], 16)
    broken = file_with(x=values)
    mask, data = packed(broken["x"], 8)
    broken["x"].id.write_direct_chunk((8, 0), bytes(len(data) - 1) + b"\1", mask)
    target = h5py.File(io.BytesIO(), "w")
    add_rows(empty_table(target, "x", ROWS, values), 0, broken["x"])
    np.testing.assert_array_equal(target["x"][16:], values[16:])
    with pytest.raises(OSError, match="Can't synchronously read"):
        _ = target["x"][8:16]  # its checksum went with it


@pytest.mark.parametrize("other", ["not in chunks", "other chunks", "other filters", "other type"])
def test_what_is_stored_otherwise_is_unpacked(other):
    values = counts()
    source, target = h5py.File(io.BytesIO(), "w"), h5py.File(io.BytesIO(), "w")
    ways = {
        "not in chunks": {},
        "other chunks": {"chunks": (16, COLUMNS), **chunks.PACKED},
        "other filters": {"chunks": (8, COLUMNS), "fletcher32": True},
        "other type": {"chunks": (8, COLUMNS), "dtype": ">i8", **chunks.PACKED},
    }
    source.create_dataset("x", data=values, **ways[other])
    table = empty_table(target, "x", ROWS, values)
    assert table.compression == "gzip"
    add_rows(table, 0, source["x"])
    np.testing.assert_array_equal(table[()], values)
    assert packed(table, 8) == packed(file_with(x=values)["x"], 8)


def test_large_tables_are_unpacked_in_pieces(monkeypatch):
    monkeypatch.setattr(chunks, "_PIECE", 3 * 8 * COLUMNS)
    values = noise()
    file, _ = joined(values, [13, 27])
    np.testing.assert_array_equal(file["x"][()], values)


def test_compressed_is_what_shrinks_by_half():
    """Noise does not, small whole numbers and columns of zeros do; each chunk has a checksum."""
    mostly_zero = noise() * (noise() > 0.9)
    file = file_with(noise=noise(), counts=counts(), zero=mostly_zero)
    assert {name: file[name].compression for name in file} == {
        "noise": None,
        "counts": "gzip",
        "zero": "gzip",
    }
    assert all(file[name].fletcher32 for name in file)
    assert file["counts"].id.get_storage_size() < counts().nbytes / 2


def test_a_table_of_no_rows_has_no_chunk():
    assert file_with(x=np.empty((0, 3)))["x"].shape == (0, 3)


@pytest.mark.parametrize("columns", [0, 1, 41, 512, 513, 5000, 2**17, 2**20])
def test_chunks_are_cut_at_powers_of_two_within_a_mebibyte(columns, monkeypatch):
    monkeypatch.setattr(chunks, "CHUNK_ROWS", 256)
    rows = chunk_rows(10**6, columns)
    assert 256 % rows == 0  # so that blocks of whole chunks of the largest kind are whole chunks of any
    assert rows == 1 or 8 * rows * columns <= 2**20
    assert chunk_rows(7, columns) == min(rows, 7)
    assert chunk_rows(0, columns) == rows


# --- blocks become a file -------------------------------------------------------------------------------


@pytest.fixture
def scene(make_scene):
    return make_scene(sampler="cells", n_surfaces=SURFACES)


@pytest.fixture
def expected(scene, tmp_path, monkeypatch):
    """Digest of the ensemble that was drawn in memory and saved, without blocks."""
    mcgw.save(mcgw.simulate(scene), tmp_path / "whole.h5")
    return digest(tmp_path / "whole.h5")


@pytest.fixture
def copied(monkeypatch):
    """How many rows went as packed chunks, table by table."""
    rows, add = [], chunks._add_chunks

    def counted(target, first, source):
        rows.append(len(source))
        add(target, first, source)

    monkeypatch.setattr(chunks, "_add_chunks", counted)
    return rows


def made(way, *words):
    """Digest of the file that comes out."""
    way(*words)
    return digest(words[-1])


@pytest.mark.parametrize(("rows", "direct"), [(4, 7), (8, 6), (12, 2), (256, 0)])
def test_blocks_of_any_number_of_chunks_make_the_same(
    scene, tmp_path, expected, copied, monkeypatch, rows, direct
):
    """Blocks of 16 rows and one of 4: whole chunks go as they are; of 12 rows only two begin in step."""
    monkeypatch.setattr(chunks, "CHUNK_ROWS", rows)
    path = tmp_path / "e.h5"
    assert made(mcgw.run, scene, path) == expected
    tables = len(scene.quantities)
    assert len(copied) == direct * tables
    for name, values in mcgw.simulate(scene).sums.arrays.items():
        np.testing.assert_array_equal(mcgw.open_ensemble(path).sums.read(name, 0, None), values)


def test_blocks_that_begin_within_a_chunk_go_on_as_well(scene, tmp_path, expected, copied, monkeypatch):
    """As in a run that another version began: blocks of 20, every second one in step with chunks of 8."""
    monkeypatch.setattr(Values, "rows", 20)
    path = tmp_path / "e.h5"
    begun(scene, path)
    monkeypatch.setattr(Values, "rows", SIZE)
    assert made(mcgw.run, scene, path) == expected
    assert sum(copied) == 60 * len(scene.quantities)


@pytest.mark.parametrize("old", ["of this version", "all compressed"])
def test_a_file_is_extended_whatever_it_is_packed_with(scene, tmp_path, expected, copied, monkeypatch, old):
    path = tmp_path / "e.h5"
    with monkeypatch.context() as patch:
        if old == "all compressed":  # as before compression was chosen by what it saves
            patch.setattr(chunks, "_shrinks", lambda _: True)
        mcgw.run(replace(scene, n_surfaces=37), path)
    with h5py.File(path) as file:
        assert (file["load"].compression == "gzip") == (old == "all compressed")
    copied.clear()
    assert made(mcgw.run, scene, path) == expected
    assert copied.count(37) == (4 if old == "of this version" else 1)  # contacts shrink


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

    def damage_first(run_of, *rest):
        monkeypatch.setattr(merging, "merge_into", merged)
        damaged(sorted(run_of.folder.glob("shards/*.h5"))[2], name, sealed=sealed)
        merged(run_of, *rest)

    monkeypatch.setattr(merging, "merge_into", damage_first)
    with pytest.raises(RunError, match="a shard is damaged; run the jobs again"):
        mcgw.merge(path)
    assert not path.exists()
    assert not list(parts_of(path).glob(".*.tmp"))
    if not sealed:
        assert made(mcgw.run, scene, path) == expected


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
    with pytest.raises(RunError, match="was not written correctly"):
        mcgw.merge(path)
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
            mcgw.merge(path)
    assert not path.exists()
    assert sorted(parts_of(path).glob("shards/*.h5")) == blocks
    assert not list(parts_of(path).glob(".*.tmp"))
    assert made(mcgw.merge, path) == expected
