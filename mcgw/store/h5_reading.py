"""The one reader of what `mcgw.store.h5_writing` writes, and what files must be before they are read.

They are tables of 64-bit numbers at the root or in one group. That they are all inside the file, and declare
no more than it holds, is looked at by `mcgw.formats.gate`. A checksum is no signature, so that is looked at
whoever wrote the file.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array
from mcgw.ensemble.results import GROUP, Tables
from mcgw.errors import StoreError
from mcgw.formats.gate import open_h5, opened
from mcgw.store.h5_writing import FILETYPE, FORMAT, MOST_TEXT, PIECE, checksum, sha_of

_ATTRIBUTES = (  # that this program writes; another one may add its own, which are not looked at
    *("filetype", "format", "title", "scene", "axes", "seed", "sampler", "digest", "checksum", "date"),
    *("versions", "commit", "cpu", "accuracy_spent", "run", "draws", "wall_seconds", "first", "n"),
    "coordinates",
)
_MOST_TABLES, _MOST_NUMBERS = 128, 64
_DOCUMENTS = ("title", "scene", "axes")  # other texts are shown and exported as they stand
_ABOUT = ("units", "long_name", "sha256")  # attributes of a table that this program writes


def look(path: Path, filetype: str = FILETYPE, *, numbers: bool = True) -> dict[str, Any]:
    """Return the root attributes of a file if it is as it was written; `numbers`: and all of its numbers are.

    Raises
    ------
    StoreError
        If it is not there, or no plain file of numbers, of another format, or damaged.
    """
    with _opened(path) as file:
        names, attributes = table_names(file), attributes_in(file)
        found, known = str(attributes.get("filetype", "")), attributes.get("format")
        if found.startswith("mcgw-") and (found != filetype or known != FORMAT):
            raise StoreError(
                f"{found} {known} is not read by this version, which reads {filetype} {FORMAT}; "
                "run the scene in its attribute scene again"
            )
        if found != filetype:
            raise StoreError(f"holds no results of mcgw (its filetype is not {filetype!r})")
        if checksum_of(file) != attributes.get("checksum"):
            raise StoreError("damaged (checksum mismatch of its scene or attributes)")
        for name in names if numbers else ():
            table = file[name]
            some = max(PIECE // (8 * math.prod(table.shape[1:])), 1)
            _compare(table, (table[first : first + some] for first in range(0, len(table), some)))
        return attributes


def read_tables(path: Path, group: str = "") -> Tables:
    """All tables of a file, or of its group, each compared with its checksum."""
    found: Tables = {}
    with _opened(path) as file:
        for name in table_names(file):
            if name.startswith(group):
                found[name.removeprefix(f"{group}/")] = values = np.asarray(file[name][()])
                _compare(file[name], [values])
    return found


def read_rows(files: Sequence[tuple[Path, int]], name: str, rows: slice) -> Array:
    """Rows of a table in files that were looked at, of so many surfaces each.

    Of checksums those of chunks are compared, and that of a table without chunks, if all of it is read.
    """
    found, (start, stop, _) = list[Array](), rows.indices(sum(n for _, n in files))
    for path, n in files:
        if max(start, 0) < min(stop, n):
            with _opened(path, opened) as file:
                table = file[name]
                found.append(table[max(start, 0) : min(stop, n)])
                if not table.chunks and len(found[-1]) == len(table):
                    _compare(table, found[-1:])
        start, stop = start - n, stop - n
    return found[0] if len(found) == 1 else np.concatenate(found)


def _compare(table: h5py.Dataset, pieces: Iterable[NDArray[Any]]) -> None:
    sha = sha_of(table)
    for values in pieces:
        sha.update(np.ascontiguousarray(values, values.dtype.newbyteorder("<")).reshape(-1))
    if sha.hexdigest() != _text(table, "sha256"):
        raise StoreError(f"damaged (checksum mismatch of {table.name.removeprefix('/')})")


def checksum_of(file: h5py.File) -> str:
    """Checksum of the head of an open, plain file; it does not depend on how HDF5 laid it out."""
    heads = {}
    for name in table_names(file):
        data = file[name]
        heads[name] = [data.dtype.kind, data.shape, *(_text(data, key) for key in _ABOUT)]
    attributes = attributes_in(file)
    attributes.pop("checksum", None)
    return checksum(attributes, heads)


def _text(table: h5py.Dataset, key: str) -> str:
    value = table.attrs.get(key, "")
    return value.decode() if isinstance(value, bytes) else str(value)


@contextmanager
def _opened(path: Path, how: Callable[[Path], h5py.File] = open_h5) -> Iterator[h5py.File]:
    """Open a file; errors of HDF5 are one of the store, that names the file."""
    try:
        if not path.exists():
            raise StoreError("no longer exists; its run has ended, open the file again")
        with how(path) as file:
            yield file
    except StoreError as error:
        text = str(error)
        raise StoreError(text if text.startswith(str(path)) else f"{path}: {text}") from None
    except MemoryError:
        raise StoreError(f"{path}: cannot be looked at: too little memory") from None
    except Exception:  # HDF5 reports damage as any of a dozen exceptions
        raise StoreError(f"{path}: not an HDF5 file, or a damaged one") from None


def table_names(file: h5py.File) -> list[str]:
    """Names of the tables of an open file, in order, those of its group too; all of 64-bit numbers."""
    names = [name for name in file if name != GROUP]
    names += [f"{GROUP}/{name}" for name in file.get(GROUP, ())]
    if len(names) > _MOST_TABLES:
        raise StoreError(f"{len(names)} datasets; at most {_MOST_TABLES} are allowed")
    for name in names:
        item = file[name]
        if not (isinstance(item, h5py.Dataset) and item.shape and item.dtype.str[1:] in ("f8", "i8")):
            raise StoreError(f"{name}: not a table of 64-bit numbers")
    return sorted(names)


def attributes_in(file: h5py.File) -> dict[str, Any]:
    """Root attributes of an open file that this program writes: texts, numbers, lists of numbers."""
    attributes = file.attrs  # made anew whenever it is asked for
    return {name: _plain_value(name, attributes) for name in _ATTRIBUTES if name in attributes}


def _plain_value(name: str, attributes: Any) -> Any:
    identity = attributes.get_id(name)
    if identity.get_storage_size() > MOST_TEXT or math.prod(identity.shape or (1,)) > _MOST_NUMBERS:
        raise StoreError(f"attribute {name}: too large")
    value = attributes[name]
    if isinstance(value, bytes):
        value = value.decode()
    if isinstance(value, str):
        if len(value) > MOST_TEXT:
            raise StoreError(f"attribute {name}: too large")
        if name not in _DOCUMENTS and not value.isprintable():
            raise StoreError(f"attribute {name}: not one line of text")
        return value
    if isinstance(value, np.ndarray | np.generic) and value.dtype.kind in "iufb":
        return value.item() if value.size == 1 else value.tolist()  # netCDF has no single numbers
    raise StoreError(f"attribute {name}: neither text nor number")
