"""What an HDF5 file of results must be before its numbers are read: plain tables of 64-bit numbers.

They stand at the root or in one group, and none is a link. That they are all inside the file, and declare no
more than it holds, is looked at by `mcgw.formats.gate`. A checksum is no signature, so that is looked at
whoever wrote the file.
"""

import math
from typing import Any

import h5py
import numpy as np

from mcgw.errors import StoreError

GROUP = "drawn"  # the one group that a file may have
MOST_TEXT = 2**22  # characters of an attribute, such as the scene
_ATTRIBUTES = (  # that this program writes; another one may add its own, which are not looked at
    *("filetype", "format", "title", "scene", "axes", "seed", "sampler", "digest", "checksum", "date"),
    *("versions", "commit", "cpu", "accuracy_spent", "run", "draws", "wall_seconds", "first", "n"),
)
_MOST_TABLES, _MOST_NUMBERS = 128, 64
_DOCUMENTS = ("title", "scene", "axes")  # other texts are shown and exported as they stand


def table_names(file: h5py.File) -> list[str]:
    """Names of the tables of an open file, in order, each plain.

    Raises
    ------
    StoreError
        If there are too many, a link that is not hard, a group but `GROUP`, or a type but float64 or int64.
    """
    names = [name for name in _hard(file, "") if name != GROUP]
    if GROUP in file:
        if not isinstance(file[GROUP], h5py.Group):
            raise StoreError(f"{GROUP}: not a group")
        names += _hard(file[GROUP], f"{GROUP}/")
    for name in names:
        item = file[name]
        if not isinstance(item, h5py.Dataset):
            raise StoreError(f"{name}: not a dataset")
        if item.dtype.kind not in "fi" or item.dtype.itemsize != 8:
            raise StoreError(f"{name}: type {item.dtype}, not 64-bit numbers")
        if not 1 <= len(item.shape or ()) <= 4:
            raise StoreError(f"{name}: not a table of one to four axes")
    return sorted(names)


def _hard(group: h5py.Group, prefix: str) -> list[str]:
    """Members of a group, all of them in this file."""
    if len(group) > _MOST_TABLES:
        raise StoreError(f"{len(group)} datasets; at most {_MOST_TABLES} are allowed")
    for name in group:
        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            raise StoreError(f"{prefix}{name}: a link to another place")
    return [prefix + name for name in group]


def attributes_in(file: h5py.File) -> dict[str, Any]:
    """Root attributes of an open file that this program writes: texts, numbers, lists of numbers.

    Raises
    ------
    StoreError
        If one is too large, something else, or a text of several lines.
    """
    return {name: _plain_value(name, file.attrs) for name in _ATTRIBUTES if name in file.attrs}


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
