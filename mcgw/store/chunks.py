"""How tables are cut into chunks and packed.

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
MATLAB and HDFView read it, and LZF only h5py.
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

PACKED: Any = {"compression": "gzip", "compression_opts": 1, "shuffle": True, "fletcher32": True}
_PLAIN: Any = {"fletcher32": True}


def chunk_rows(rows: int, columns: int) -> int:
    """Rows of a chunk of a table."""
    fitting = max(_CHUNK // (8 * max(columns, 1)), 1)
    return min(CHUNK_ROWS, 1 << fitting.bit_length() - 1, rows)


def empty_table(file: h5py.File, path: str, rows: int, like: NDArray[Any]) -> h5py.Dataset:
    """Make a table of some rows like those of another, packed to suit its numbers."""
    shape = like.shape[1:]
    return file.create_dataset(
        path,
        (rows, *shape),
        like.dtype,
        chunks=(chunk_rows(rows, math.prod(shape)), *shape),
        **(PACKED if _shrinks(like) else _PLAIN),
    )


def _shrinks(table: NDArray[Any]) -> bool:
    """Whether compressing the first rows saves half of their size."""
    rows = max(_SAMPLE // max(8 * math.prod(table.shape[1:]), 1), 1)
    sample = np.ascontiguousarray(table[:rows])
    shuffled = sample.reshape(-1).view(np.uint8).reshape(-1, sample.itemsize).T.tobytes()
    return 2 * len(zlib.compress(shuffled, 1)) < len(shuffled)
