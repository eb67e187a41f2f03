"""What an HDF5 file of results must be before it is read: plain datasets at the root or in one group.

Nothing of it leads elsewhere, and it declares no more than it holds. That is looked at in this process on
every opening; a trailer is no signature, so it is looked at whoever wrote the file.
"""

import math
import os
from functools import lru_cache
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from mcgw.errors import StoreError
from mcgw.formats.gate import opened
from mcgw.formats.named_files import open_regular
from mcgw.store.disk import GROUP, check_trailer, head_digest, read_trailer

_FILTERS = {h5py.h5z.FILTER_DEFLATE, h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_FLETCHER32, h5py.h5z.FILTER_LZF}
_MOST_ATTRIBUTES = 64
_READ_ALL = 2**26  # stored bytes up to which all is read here first
_SMALL = 2**24  # bytes up to which all of a file is checked: a hundredth of a second
_MOST_EXPANSION = 1100  # deflate cannot shrink more
_MOST_CHUNK = 2**28
_DOCUMENTS = ("title", "scene", "axes")  # other texts are shown and exported as they stand
MOST_TEXT = 2**22  # characters of an attribute, such as the scene


class RefusedError(Exception):
    """The file is not as it must be."""


def check_plain(file: h5py.File, *, most: int = 128) -> list[str]:
    """Paths of the datasets of an open file, in order of name, each plain; at most so many.

    Raises
    ------
    RefusedError
        If there is a link that is not hard, a group but `GROUP`, a type other than float64 or int64,
        data stored elsewhere, an unknown filter, or more data declared than stored.
    """
    paths = [name for name in _hard(file, "", most) if name != GROUP]
    if GROUP in file:
        if not isinstance(file[GROUP], h5py.Group):
            raise RefusedError(f"{GROUP}: not a group")
        paths += _hard(file[GROUP], f"{GROUP}/", most)
    for path in paths:
        _check_dataset(path, h5py.h5o.open(file.id, path.encode()))
    return paths


def _hard(group: h5py.Group, prefix: str, most: int) -> list[str]:
    """Members of a group, all of them in this file."""
    if len(group) > most:
        raise RefusedError(f"{len(group)} datasets; at most {most} are allowed")
    for name in group:
        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            raise RefusedError(f"{prefix}{name}: a link to another place")
    return [prefix + name for name in sorted(group)]


def _check_dataset(name: str, item: Any) -> None:
    if not isinstance(item, h5py.h5d.DatasetID):
        raise RefusedError(f"{name}: not a dataset")
    dtype, plist, shape = item.dtype, item.get_create_plist(), item.shape
    if dtype.kind not in "fi" or dtype.itemsize != 8:
        raise RefusedError(f"{name}: type {dtype}, not 64-bit numbers")
    if item.get_space().get_simple_extent_type() != h5py.h5s.SIMPLE or not 1 <= len(shape) <= 4:
        raise RefusedError(f"{name}: not a table of one to four axes")
    if plist.get_external_count() or plist.get_layout() not in (h5py.h5d.CONTIGUOUS, h5py.h5d.CHUNKED):
        raise RefusedError(f"{name}: its data are in another file")
    filters = {plist.get_filter(i)[0] for i in range(plist.get_nfilters())}
    if not filters <= _FILTERS:
        raise RefusedError(f"{name}: unknown filter {sorted(filters - _FILTERS)}")
    _check_storage(name, item, plist)


def _check_storage(name: str, item: Any, plist: Any) -> None:
    """Every value declared must be stored, chunk by chunk."""
    declared, stored = math.prod(item.shape) * 8, item.get_storage_size()
    if plist.get_layout() == h5py.h5d.CONTIGUOUS:
        if stored != declared:
            raise RefusedError(f"{name}: {declared} bytes declared, {stored} stored")
        return
    chunk = item.get_create_plist().get_chunk()
    if math.prod(chunk) * 8 > _MOST_CHUNK:
        raise RefusedError(f"{name}: chunks of {math.prod(chunk) * 8} bytes")
    wanted = math.prod(-(-s // c) for s, c in zip(item.shape, chunk, strict=True))
    if wanted != item.get_num_chunks():
        raise RefusedError(f"{name}: {wanted} chunks declared, {item.get_num_chunks()} stored")
    if declared > stored * _MOST_EXPANSION + 2**20:
        raise RefusedError(f"{name}: {declared} bytes declared, {stored} stored")


def describe(path: str, *, read: bool = True) -> dict[str, Any]:
    """``{"attributes": {...}, "datasets": {name: [type, shape]}, "head": digest}`` of a file, all checked.

    If it is small, every number is read once, unless `read` is False: HDF5 may fail on any of them.

    Raises
    ------
    RefusedError
        If it is not plain.
    OSError
        If HDF5 cannot read it.
    """
    with opened(path) as file:
        names = check_plain(file)
        if len(file.attrs) > _MOST_ATTRIBUTES:
            raise RefusedError(f"{len(file.attrs)} attributes")
        attributes = {name: _plain_value(name, file.attrs) for name in file.attrs}
        if read and Path(path).stat().st_size <= _READ_ALL:
            for data in map(file.__getitem__, names):
                step = max(2**24 // (8 * math.prod(data.shape[1:]) or 8), 1)
                for start in range(0, data.shape[0], step):
                    data[start : start + step]
        found = {name: [file[name].dtype.str, list(file[name].shape)] for name in names}
        return {"attributes": attributes, "datasets": found, "head": head_digest(file)}


def _plain_value(name: str, attributes: Any) -> Any:
    """An attribute as text, number, or list of numbers."""
    identity = attributes.get_id(name)
    if identity.get_storage_size() > MOST_TEXT or math.prod(identity.shape or (1,)) > 64:
        raise RefusedError(f"attribute {name}: too large")
    value = attributes[name]
    if isinstance(value, str):
        if len(value) > MOST_TEXT:
            raise RefusedError(f"attribute {name}: too large")
        if name not in _DOCUMENTS and not value.isprintable():
            raise RefusedError(f"attribute {name}: not one line of text")
        return value
    if isinstance(value, np.ndarray | np.generic) and value.dtype.kind in "iufb":
        return value.tolist()
    raise RefusedError(f"attribute {name}: neither text nor number")


def examine(path: Path) -> dict[str, Any]:
    """Return what `describe` tells of a file, looked at once until it changes.

    Raises
    ------
    StoreError
        If it is not there, or no plain file of numbers, or damaged.
    """
    fd = open_regular(path)
    try:
        status, head = os.fstat(fd), os.read(fd, 512)
    finally:
        os.close(fd)
    if path.suffix == ".toml" and b"\0" not in head:
        raise StoreError(f"{path}: is not a file of results; make one from a scene with mcgw run {path}")
    return _examined(path.resolve(), path, (status.st_ino, status.st_size, status.st_mtime_ns))


@lru_cache(maxsize=32)
def _examined(path: Path, shown: Path, _state: tuple[int, int, int]) -> dict[str, Any]:
    try:
        return describe(str(path), read=not _as_written(path))
    except MemoryError:
        raise StoreError(f"{shown}: cannot be looked at: too little memory") from None
    except RefusedError as error:
        raise StoreError(f"{shown}: refused: {error}") from None
    except Exception:  # HDF5 reports damage as any of a dozen exceptions
        raise StoreError(f"{shown}: not an HDF5 file, or a damaged one") from None


def _as_written(path: Path) -> bool:
    """Whether the trailer holds; of a large file the head alone is compared with it, when it is opened."""
    try:
        (check_trailer if path.stat().st_size <= _SMALL else read_trailer)(path)
    except StoreError:
        return False
    return True
