"""One HDF5 file: named tables with units and dimensions, attributes, checksums; written, and looked at.

Files of results and the blocks of a run are such files. Each table has the attribute `sha256`, of its type,
the shape of a row and all numbers; the root has `checksum`, of the attributes that this program writes, and
of name, type, shape, units, description and `sha256` of every table. So a changed bit is seen, and
the same numbers are good however another program has laid them out. `digest` is over the numbers and what
they are of.
"""

import hashlib
import json
import math
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.labelled import Variable
from mcgw.ensemble.results import Tables
from mcgw.errors import StoreError
from mcgw.formats.gate import open_h5
from mcgw.formats.named_files import open_regular
from mcgw.store.chunks import empty_table
from mcgw.store.disk import SteadyFile
from mcgw.store.structure import GROUP, attributes_in, table_names

FILETYPE, BLOCK_TYPE, FORMAT = "mcgw-results", "mcgw-block", [3, 0]
LARGE = 2**30  # bytes of a file, from which on its numbers are compared with their checksums on request alone
_LIBVER = ("v108", "v110")  # checksums on all metadata, and every HDF5 of the last decade reads it
_ABOUT = ("units", "long_name", "sha256")  # attributes of a table that this program writes
_PIECE = 2**23  # bytes of numbers processed at a time


@dataclass(frozen=True)
class Rows:
    """The values of a table that come in pieces.

    Parameters
    ----------
    n : int
        How many rows all have together.
    pieces : callable
        Gives them in order.
    """

    n: int
    pieces: Callable[[], Generator[NDArray[Any]]]

    def __len__(self) -> int:
        """Number of rows."""
        return self.n

    def __iter__(self) -> Iterator[NDArray[Any]]:
        """The pieces, each made while the one before is used."""
        from mcgw.machine.in_threads import one_ahead  # imports numba, which reading does without

        with closing(one_ahead(self.pieces())) as pieces:
            yield from pieces


@dataclass(frozen=True)
class Contents:
    """What a file holds, or is to hold.

    Parameters
    ----------
    variables : dict of str to Variable
        Its tables, those that are scales of others first; values may be `Rows`.
    attributes : dict of str to Any
        Root attributes.
    of : str
        What the numbers are of, in words that `digest` is over as well.
    """

    variables: Mapping[str, Variable]
    attributes: Mapping[str, Any]
    of: str = ""


@dataclass(frozen=True)
class Head:
    """What a file says of itself.

    Parameters
    ----------
    attributes : dict of str to Any
        Root attributes.
    shapes : dict of str to tuple of int
        Of its tables.
    """

    attributes: dict[str, Any]
    shapes: dict[str, tuple[int, ...]] = field(default_factory=dict)


def write(path: Path, contents: Contents, go_on: Callable[[], None] | None = None) -> None:
    """Write a new file; `go_on` is called often, and raises if this is to end.

    Raises
    ------
    OSError
        If the disk does not take it.
    """
    with closing(SteadyFile(path)) as raw:
        try:
            with h5py.File(raw, "w", libver=_LIBVER) as file:
                _fill(file, contents, raw, go_on)
        except Exception:  # HDF5 reports a full disk as any of a dozen
            raw.check()
            raise
        raw.check()


def _fill(file: h5py.File, contents: Contents, raw: SteadyFile, go_on: Callable[[], None] | None) -> None:
    heads: dict[str, Any] = {}
    for name, one in contents.variables.items():
        n, first = len(one.values), 0
        for piece in one.values if isinstance(one.values, Rows) else (one.values,):
            values = np.ascontiguousarray(piece, piece.dtype.newbyteorder("<"))
            if not first:
                data, sha = empty_table(file, name, n, values), _sha_of(values)
            data[first : first + len(values)] = values
            sha.update(values.reshape(-1))
            first += len(values)
            raw.check()
            if go_on:
                go_on()
        if first != n:
            raise StoreError(f"{name}: {first} rows, not {n}")
        about = {"units": one.units, "long_name": one.long_name, "sha256": sha.hexdigest()}
        _add_attributes(data, {key: text for key, text in about.items() if text})
        if one.dims == (name,):
            data.make_scale(name)
        for place, dim in enumerate(one.dims if one.dims != (name,) else ()):
            data.dims[place].attach_scale(file[dim])
        heads[name] = [data.dtype.kind, data.shape, *about.values()]
    lines = [f"{name} {head[1][0]} {head[-1]}" for name, head in sorted(heads.items())]
    digest = hashlib.sha256("\n".join([contents.of, *lines]).encode()).hexdigest()
    attributes = {**contents.attributes, "digest": digest}
    _add_attributes(file, {**attributes, "checksum": _checksum(attributes, heads)})


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


def _sha_of(table: "NDArray[Any] | h5py.Dataset") -> Any:
    """The beginning of a checksum: of the type of a table and the shape of its rows."""
    return hashlib.sha256(f"{table.dtype.newbyteorder('<').str} {table.shape[1:]}".encode())


def checksum_of(file: h5py.File) -> str:
    """Checksum of the head of an open, plain file; it does not depend on how HDF5 laid it out."""
    heads = {}
    for name in table_names(file):
        data = file[name]
        heads[name] = [data.dtype.kind, data.shape, *(_text(data, key) for key in _ABOUT)]
    attributes = attributes_in(file)
    attributes.pop("checksum", None)
    return _checksum(attributes, heads)


def _checksum(attributes: dict[str, Any], heads: dict[str, Any]) -> str:
    text = json.dumps([attributes, heads], sort_keys=True, default=np.generic.item)
    return hashlib.sha256(text.encode()).hexdigest()


def _text(table: h5py.Dataset, key: str) -> str:
    value = table.attrs.get(key, "")
    return value.decode() if isinstance(value, bytes) else str(value)


def pieces_of(table: h5py.Dataset) -> Iterator[NDArray[Any]]:
    """All rows of a table of an open file, some at a time."""
    step = max(_PIECE // (8 * math.prod(table.shape[1:]) or 8), 1)
    for start in range(0, len(table), step):
        yield table[start : start + step]


def read_tables(path: Path, wanted: Iterable[str] | None = None) -> Tables:
    """Tables of a file, all or some, each compared with its checksum.

    Raises
    ------
    StoreError
        If the file is gone or damaged.
    """
    with _in_words(path), open_h5(path) as file:
        return {name: _whole(file[name]) for name in (table_names(file) if wanted is None else wanted)}


def drawn_tables(path: Path) -> Tables:
    """Of a file that holds no surfaces, all that its statistics follow from, read and compared."""
    with _in_words(path), open_h5(path) as file:
        return {name: _whole(table) for name, table in file[GROUP].items()}


def _whole(table: h5py.Dataset) -> NDArray[Any]:
    """All numbers of a table, compared with its checksum."""
    values = np.asarray(table[()])
    _compare(table, [values])
    return values


def _compare(table: h5py.Dataset, pieces: Iterable[NDArray[Any]]) -> None:
    sha = _sha_of(table)
    for values in pieces:
        sha.update(np.ascontiguousarray(values, values.dtype.newbyteorder("<")).reshape(-1))
    if sha.hexdigest() != _text(table, "sha256"):
        raise StoreError(f"damaged (checksum mismatch of {table.name.removeprefix('/')})")


def look(path: Path, filetype: str = FILETYPE, *, numbers: bool = True) -> Head:
    """Return what a file says of itself if it is as it was written; `numbers`: and all of its numbers are.

    Raises
    ------
    StoreError
        If it is not there, or no plain file of numbers, of another format, or damaged.
    """
    with _in_words(path), open_h5(path) as file:
        names, attributes = table_names(file), attributes_in(file)
        _check_format(attributes, filetype)
        if checksum_of(file) != attributes.get("checksum"):
            raise StoreError("damaged (checksum mismatch of its scene or attributes)")
        for name in names if numbers else ():
            _compare(file[name], pieces_of(file[name]))
        return Head(attributes, {name: file[name].shape for name in names})


@contextmanager
def _in_words(path: Path) -> Iterator[None]:
    """Errors of HDF5 as one of the store, that names the file."""
    try:
        yield
    except StoreError as error:
        text = str(error)
        raise StoreError(text if text.startswith(str(path)) else f"{path}: {text}") from None
    except MemoryError:
        raise StoreError(f"{path}: cannot be looked at: too little memory") from None
    except Exception:  # HDF5 reports damage as any of a dozen exceptions
        raise StoreError(f"{path}: not an HDF5 file, or a damaged one") from None


def _check_format(attributes: dict[str, Any], filetype: str) -> None:
    """Refuse files that are no results, or of a format that this version does not read."""
    found, known = str(attributes.get("filetype", "")), attributes.get("format")
    if found.startswith("mcgw-") and (found != filetype or known != FORMAT):
        raise StoreError(
            f"{found} {known} is not read by this version, which reads {filetype} {FORMAT}; "
            "run the scene in its attribute scene again"
        )
    if found != filetype:
        raise StoreError(f"holds no results of mcgw (its filetype is not {filetype!r})")


def examine(path: Path) -> Head:
    """As `look`, once until the file changes; the numbers of one of a gibibyte or more are not compared.

    Raises
    ------
    StoreError
        As of `look`.
    """
    with open(open_regular(path), "rb") as file:
        head, size = file.read(512), file.seek(0, 2)
    if path.suffix == ".toml" and b"\0" not in head:
        raise StoreError(f"{path}: is not a file of results; make one from a scene with mcgw run {path}")
    status = path.stat()
    return _examined(path.resolve(), path, (status.st_ino, size, status.st_mtime_ns))


@lru_cache(maxsize=32)
def _examined(path: Path, shown: Path, state: tuple[int, int, int]) -> Head:  # noqa: ARG001
    return look(shown, numbers=state[1] < LARGE)
