"""Packed chunks that go from one file into another: the same numbers as when they are unpacked, always."""

import io
import itertools

import h5py
import numpy as np
import pytest

from mcgw.store import chunks
from mcgw.store.chunks import add_rows, chunk_rows, empty_table, stored

ROWS, COLUMNS = 40, 5


@pytest.fixture(autouse=True)
def _small_chunks(monkeypatch):
    monkeypatch.setattr(chunks, "CHUNK_ROWS", 8)


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


SPLITS = [
    [40],
    [8, 16, 16],
    [16, 16, 8],
    [13, 27],  # the second begins within a chunk
    [16, 5, 3, 16],  # a chunk filled by two, the second of them begins within it
    [1] * 40,
    [16, 20, 4],  # the last one is less than a chunk
    [9, 7, 24],  # out of step, and in step again
]


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
