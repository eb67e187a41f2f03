"""The one writer of HDF5 files: named tables with units and dimensions, attributes, checksums.

Files of results, the blocks of a run and its record are such files. Each table has the attribute `sha256`,
of its type, the shape of a row and all numbers; the root has `checksum`, of the attributes that this program
writes, and of name, type, shape, units, description and `sha256` of every table. So a changed bit is seen,
and the same numbers are good however another program has laid them out. `digest` is over the numbers and
what they are of.

A chunk has a checksum, which HDF5 writes and checks: a changed chunk is an error, not a number. Blocks have
no chunks, for each of their tables is read at once, and compared with its own checksum. A chunk is compressed
where that saves half of it. Numbers of contacts shrink to an eighth; but for its first digits a load is
noise, of which compression saves a sixth and makes the writing take 25 times as long. Of load, area,
stiffness and contacts, all compressed are 0.65 of the bytes, at 55 MB of numbers a second and thread; where
only what shrinks by half is compressed 0.78, at 456 MB/s (``runs/bench/compression.py`` measures every way).
So a file is a fifth larger than if all were compressed, and written eight times as fast. Gzip, for netCDF,
MATLAB and HDFView read it, and LZF only h5py.
"""

import hashlib
import json
import math
import zlib
from collections.abc import Callable, Mapping
from contextlib import closing
from io import FileIO
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.results import CHUNK_ROWS, GROUP, Labelled, Variable

FILETYPE, BLOCK_TYPE, RUN_TYPE, FORMAT = "mcgw-results", "mcgw-block", "mcgw-run", [4, 0]
MOST_TEXT = 2**22  # characters of an attribute, such as the scene
_LIBVER = ("v108", "v110")  # checksums on all metadata, and every HDF5 of the last decade reads it
_CHUNK = 2**20  # bytes of a chunk, at most
PIECE = 2**23  # bytes of numbers processed at a time
_SAMPLE = 2**14  # bytes that tell whether compression pays
PACKED: Any = {"compression": "gzip", "compression_opts": 1, "shuffle": True, "fletcher32": True}
_PLAIN: Any = {"fletcher32": True}


class SteadyFile(FileIO):
    """A new file for the HDF5 library that never shows it an error, for it may crash on one.

    After the first `error` nothing more is written; who writes raises it.
    """

    error: OSError | None = None

    def write(self, data: Any) -> int:
        """Write all of it."""
        left = memoryview(data).cast("B")
        try:
            while left and not self.error:
                left = left[super().write(left) or 0 :]
        except OSError as error:
            self.error = error
        return memoryview(data).nbytes

    def truncate(self, size: int | None = None) -> int:
        """Set the length."""
        try:
            return super().truncate(size)
        except OSError as error:
            self.error = self.error or error
            return size or 0

    def readinto(self, buffer: Any) -> int:
        """Read; beyond the end there are zeros."""
        view = memoryview(buffer).cast("B")
        got = super().readinto(view) or 0
        view[got:] = bytes(len(view) - got)
        return len(view)


def write(
    path: Path,
    contents: Labelled,
    of: str = "",
    go_on: Callable[[], None] | None = None,
    *,
    chunked: bool = True,
) -> None:
    """Write a new file, some rows of a table at a time.

    `of` says what the numbers are of, which `digest` is over as well; `go_on` is called often, and raises if
    this is to end, as OSError is if the disk does not take it. What soon goes into another file is not
    `chunked`.
    """
    with closing(SteadyFile(path, "x+")) as raw:
        try:
            with h5py.File(raw, "w", libver=_LIBVER) as file:
                _fill(file, contents, of, raw, go_on, chunked)
        finally:
            if raw.error:  # which HDF5 reports as any of a dozen
                raise raw.error


def _fill(
    file: h5py.File,
    contents: Labelled,
    of: str,
    raw: SteadyFile,
    go_on: Callable[[], None] | None,
    chunked: bool,
) -> None:
    heads: dict[str, Any] = {}
    drawn = {f"{GROUP}/{name}": Variable((), values, "", "") for name, values in contents.drawn.items()}
    for name, one in {**contents.coordinates, **contents.variables, **drawn}.items():
        n, together = len(one.values), getattr(one.values, "together", 1)
        some = max(PIECE // (one.values[:1].nbytes * together), 1) * together
        for first in range(0, n, some):
            piece = one.values[first : first + some]
            values = np.ascontiguousarray(piece, piece.dtype.newbyteorder("<"))
            if not first:
                data, sha = empty_table(file, name, n, values, chunked), sha_of(values)
            data[first : first + some] = values
            sha.update(values.reshape(-1))
            if raw.error:
                raise raw.error
            if go_on:
                go_on()
        about = {"units": one.units, "long_name": one.long_name, "sha256": sha.hexdigest()}
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


def empty_table(
    file: h5py.File, path: str, rows: int, like: NDArray[Any], chunked: bool = True
) -> h5py.Dataset:
    """Make a table of some rows like those of another, packed if that halves the size of its first rows."""
    shape, columns = like.shape[1:], max(math.prod(like.shape[1:]), 1)
    if not chunked:
        return file.create_dataset(path, (rows, *shape), like.dtype)
    fitting = max(_CHUNK // (8 * columns), 1)
    chunk = min(CHUNK_ROWS, 1 << fitting.bit_length() - 1, rows)
    sample = np.ascontiguousarray(like[: max(_SAMPLE // (8 * columns), 1)])
    shuffled = sample.reshape(-1).view(np.uint8).reshape(-1, sample.itemsize).T.tobytes()
    how = PACKED if 2 * len(zlib.compress(shuffled, 1)) < len(shuffled) else _PLAIN
    return file.create_dataset(path, (rows, *shape), like.dtype, chunks=(chunk, *shape), **how)
