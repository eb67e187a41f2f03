"""How tables are cut into chunks and packed, and how packed chunks go from one file into another as they are.

A chunk has a checksum, which HDF5 writes and checks: a changed chunk is an error, not a number. It is
compressed where that saves half of it. Numbers of contacts shrink to an eighth; but for its first digits a
load is noise, of which compression saves a sixth and makes the writing take 25 times as long. Of 1e4
asperities and 41 separations, share of the bytes and megabytes of numbers a second, written and read by one
thread (``runs/bench/compression.py``, on a busy machine):

=====================  ================  ================  ===============================
stored as              loads             contacts          load, area, stiffness, contacts
=====================  ================  ================  ===============================
as it is               1.00   965   911  1.00   981   962
shuffle + LZF          0.86    83   230  0.14   189   293
gzip 1                 0.91    38   153  0.26   108   295
shuffle + gzip 1       0.82    39   151  0.13   209   442  0.65    55   234
shuffle + gzip 2       0.82    35   171  0.13   221   452
shuffle + gzip 4       0.82    41   193  0.13   124   258
what shrinks by half                                       0.78   456   667
=====================  ================  ================  ===============================

So a file is a fifth larger than if all were compressed, and written eight times as fast. Gzip, for netCDF,
MATLAB and HDFView read it, and LZF only h5py. Shards are cut and packed as the file is, so that those that
begin at a multiple of `CHUNK_ROWS` are merged without unpacking anything.
"""

import math
import zlib
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.results import CHUNK_ROWS

_CHUNK = 2**20  # bytes of a chunk, at most
_SAMPLE = 2**14  # bytes that tell whether compression pays
_PIECE = 2**23  # bytes of numbers processed at a time

PACKED: Any = {"compression": "gzip", "compression_opts": 1, "shuffle": True, "fletcher32": True}
_PLAIN: Any = {"fletcher32": True}


def chunk_rows(rows: int, columns: int) -> int:
    """Rows of a chunk of a table; of one that grows if `rows` is 0."""
    fitting = max(_CHUNK // (8 * max(columns, 1)), 1)
    return min(CHUNK_ROWS, 1 << fitting.bit_length() - 1, rows or CHUNK_ROWS)


def empty_table(
    file: h5py.File, path: str, rows: int | None, like: "NDArray[Any] | h5py.Dataset"
) -> h5py.Dataset:
    """Make a table like another, packed to suit its numbers; rows None: it will grow."""
    shape = like.shape[1:]
    return file.create_dataset(
        path,
        (rows or 0, *shape),
        like.dtype.newbyteorder("<"),
        maxshape=(None, *shape) if rows is None else None,
        chunks=(chunk_rows(rows or 0, math.prod(shape)), *(max(size, 1) for size in shape)),
        **(PACKED if _shrinks(like) else _PLAIN),
    )


def stored(file: h5py.File, name: str, values: NDArray[Any]) -> None:
    """Store a table as `empty_table` cuts and packs it."""
    if len(values):
        empty_table(file, name, len(values), values)[()] = values
    else:
        file.create_dataset(name, data=values)  # a chunk has at least one row


def _shrinks(table: "NDArray[Any] | h5py.Dataset") -> bool:
    """Whether compressing the first rows saves half of their size."""
    rows = max(_SAMPLE // max(8 * math.prod(table.shape[1:]), 1), 1)
    sample = np.ascontiguousarray(table[:rows])
    shuffled = sample.reshape(-1).view(np.uint8).reshape(-1, sample.itemsize).T.tobytes()
    return 2 * len(zlib.compress(shuffled, 1)) < len(shuffled)


def add_rows(target: h5py.Dataset, first: int, source: "NDArray[Any] | h5py.Dataset") -> None:
    """Copy all rows of a table into another, from row `first`; as packed chunks if possible."""
    if isinstance(source, h5py.Dataset) and first % target.chunks[0] == 0 and _cut(source) == _cut(target):
        _add_chunks(target, first, source)
        return
    step = max(_PIECE // max(8 * math.prod(source.shape[1:]), 1), 1)
    for start in range(0, len(source), step):
        rows = source[start : start + step]
        target[first + start : first + start + len(rows)] = rows


def _cut(table: h5py.Dataset) -> Any:
    """Properties that two tables must share to exchange chunks."""
    plist = table.id.get_create_plist()
    filters = [plist.get_filter(i) for i in range(plist.get_nfilters())]
    return table.dtype, table.shape[1:], table.chunks, [(code, values) for code, _, values, _ in filters]


def _add_chunks(target: h5py.Dataset, first: int, source: h5py.Dataset) -> None:
    """A last chunk that is not full holds zeros beyond its rows; the rows that follow are put over them."""
    others = (0,) * (source.ndim - 1)
    for start in range(0, len(source), source.chunks[0]):
        mask, packed = source.id.read_direct_chunk((start, *others))
        target.id.write_direct_chunk((first + start, *others), packed, mask)
