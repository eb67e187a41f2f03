"""The head of an HDF5 file: its attributes, the types and shapes of its tables, and its scales.

They are small and decide what the numbers mean. Their digest stands in the trailer of an ensemble file and
is computed again whenever the file is opened; what is large has checksums of its own, chunk by chunk.
"""

import hashlib
import json
import math
from collections.abc import Iterator, Sequence
from typing import Any

import h5py
import numpy as np

__all__ = ["MOST_SCALE", "MOST_TEXT", "head_digest"]

MOST_TEXT = 2**22  # characters of an attribute, such as the scene
MOST_SCALE = 2**20  # values of a scale up to which they are looked at on opening


def head_digest(file: h5py.File, names: Sequence[str]) -> str:
    """SHA-256 of the head, with tables of these paths; it does not depend on how HDF5 laid out the file."""
    lines = [*_attributes("/", file.attrs)]
    for name in sorted(names):
        lines += _table(name, file[name])
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def _table(name: str, data: h5py.Dataset) -> Iterator[str]:
    scales = [[scale.name for _, scale in axis.items()] for axis in data.dims]
    yield json.dumps([name, data.dtype.str, data.shape, scales])
    yield from _attributes(name, data.attrs)
    if data.ndim == 1 and math.prod(data.shape) <= MOST_SCALE:
        yield hashlib.sha256(data[()].tobytes()).hexdigest()


def _attributes(name: str, attributes: Any) -> Iterator[str]:
    """Those that are text or numbers; the others only tie the scales to the tables."""
    for key in sorted(attributes):
        value = attributes[key]
        if isinstance(value, str):
            yield json.dumps([name, key, value])
        elif isinstance(value, np.ndarray | np.generic) and value.dtype.kind in "iufbS":
            yield json.dumps([name, key, value.dtype.str, value.shape, value.tobytes().hex()])
