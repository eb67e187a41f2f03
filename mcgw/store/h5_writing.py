"""The one writer of HDF5 files: named tables with units and dimensions, attributes, checksums.

Files of results, the blocks of a run and its record are such files. Each table has the attribute `sha256`,
of its type, the shape of a row and all numbers; the root has `checksum`, of the attributes that this program
writes, and of name, type, shape, units, description and `sha256` of every table. So a changed bit is seen,
and the same numbers are good however another program has laid them out. `digest` is over the numbers and
what they are of.

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

import hashlib
import json
import math
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass
from io import FileIO
from itertools import chain
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.labelled import Labelled
from mcgw.ensemble.results import CHUNK_ROWS, Results, Tables
from mcgw.errors import StoreError

FILETYPE, BLOCK_TYPE, RUN_TYPE, FORMAT = "mcgw-results", "mcgw-block", "mcgw-run", [4, 0]
MOST_TEXT = 2**22  # characters of an attribute, such as the scene
_LIBVER = ("v108", "v110")  # checksums on all metadata, and every HDF5 of the last decade reads it
_CHUNK = 2**20  # bytes of a chunk, at most
_SAMPLE = 2**14  # bytes that tell whether compression pays
PACKED: Any = {"compression": "gzip", "compression_opts": 1, "shuffle": True, "fletcher32": True}
_PLAIN: Any = {"fletcher32": True}


@dataclass(frozen=True, eq=False)
class Rows(Results):
    """Values of surfaces on their way into a file: in pieces, some rows of all tables at a time, in order.

    Parameters
    ----------
    n : int
        How many rows all have together.
    pieces : iterator of Tables
        Read once, by who writes the file.
    """

    n: int
    pieces: Iterator[Tables]

    def __len__(self) -> int:
        """Return the number of rows."""
        return self.n

    rows = __len__

    def read(self, name: str, start: int, stop: int | None) -> Any:  # noqa: ARG002
        """Return these rows, which stand for any of the tables."""
        return self


class SteadyFile(FileIO):
    """A new file for the HDF5 library that never shows it an error, for it may crash on one.

    After the first error nothing more is written; `check` raises it.

    Parameters
    ----------
    path : Path
        Must not exist.
    """

    def __init__(self, path: Path) -> None:
        super().__init__(path, "x+")
        self._error: OSError | None = None

    def check(self) -> None:
        """Raise the first error, if there was one."""
        if self._error:
            raise self._error

    def write(self, data: Any) -> int:
        """Write all of it."""
        left = memoryview(data).cast("B")
        try:
            while left and not self._error:
                left = left[super().write(left) or 0 :]
        except OSError as error:
            self._error = error
        return memoryview(data).nbytes

    def truncate(self, size: int | None = None) -> int:
        """Set the length."""
        try:
            return super().truncate(size)
        except OSError as error:
            self._error = self._error or error
            return size or 0

    def readinto(self, buffer: Any) -> int:
        """Read; beyond the end there are zeros."""
        view = memoryview(buffer).cast("B")
        got = super().readinto(view) or 0
        view[got:] = bytes(len(view) - got)
        return len(view)


def write(path: Path, contents: Labelled, of: str = "", go_on: Callable[[], None] | None = None) -> None:
    """Write a new file, of whose tables those that come in pieces have one `Rows` as values.

    `of` says what the numbers are of, which `digest` is over as well; `go_on` is called often, and raises if
    this is to end.

    Raises
    ------
    OSError
        If the disk does not take it.
    """
    with closing(SteadyFile(path)) as raw:
        try:
            with h5py.File(raw, "w", libver=_LIBVER) as file:
                _fill(file, contents, of, raw, go_on)
        except Exception:  # HDF5 reports a full disk as any of a dozen
            raw.check()
            raise
        raw.check()


def _fill(
    file: h5py.File, contents: Labelled, of: str, raw: SteadyFile, go_on: Callable[[], None] | None
) -> None:
    variables = {**contents.coordinates, **contents.variables}
    inside = {name: one.values for name, one in variables.items() if not isinstance(one.values, Rows)}
    pieces = next((one.values.pieces for one in variables.values() if isinstance(one.values, Rows)), ())
    shas, filled = dict[str, Any](), dict.fromkeys(variables, 0)
    for tables in chain([inside], pieces):
        for name, piece in tables.items():
            values = np.ascontiguousarray(piece, piece.dtype.newbyteorder("<"))
            first, n = filled[name], len(variables[name].values)
            if not first:
                shas[name] = sha_of(values)
                empty_table(file, name, n, values)
            file[name][first : first + len(values)] = values
            shas[name].update(values.reshape(-1))
            filled[name] = first + len(values)
            raw.check()
            if go_on:
                go_on()
    heads: dict[str, Any] = {}
    for name, one in variables.items():
        if filled[name] != len(one.values):
            raise StoreError(f"{name}: {filled[name]} rows, not {len(one.values)}")
        data = file[name]
        about = {"units": one.units, "long_name": one.long_name, "sha256": shas[name].hexdigest()}
        _add_attributes(data, {key: text for key, text in about.items() if text})
        if one.dims == (name,):
            data.make_scale(name)
        for place, dim in enumerate(one.dims if one.dims != (name,) else ()):
            data.dims[place].attach_scale(file[dim])
        heads[name] = [data.dtype.kind, data.shape, *about.values()]
    lines = [f"{name} {head[1][0]} {head[-1]}" for name, head in sorted(heads.items())]
    digest = hashlib.sha256("\n".join([of, *lines]).encode()).hexdigest()
    attributes = {**contents.attributes, "digest": digest}
    _add_attributes(file, {**attributes, "checksum": checksum(attributes, heads)})


def _add_attributes(item: "h5py.File | h5py.Dataset", attributes: Mapping[str, Any]) -> None:
    """Give a file or a table attributes.

    Texts have their length: those of any length lie in a heap without checksums, where a changed bit may keep
    HDF5 from coming back.
    """
    for name, value in attributes.items():
        if isinstance(value, str):
            data = value.encode()
            value = np.array(data, h5py.string_dtype("utf-8", max(len(data), 1)))
        item.attrs[name] = value


def sha_of(table: "NDArray[Any] | h5py.Dataset") -> Any:
    """Return the beginning of a checksum: of the type of a table and the shape of its rows."""
    return hashlib.sha256(f"{table.dtype.newbyteorder('<').str} {table.shape[1:]}".encode())


def checksum(attributes: dict[str, Any], heads: dict[str, Any]) -> str:
    """Find the checksum of root attributes and of what tells each table."""
    text = json.dumps([attributes, heads], sort_keys=True, default=np.generic.item)
    return hashlib.sha256(text.encode()).hexdigest()


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
