"""How an ensemble lies in its HDF5 file; the schema is written out in `mcgw.store`."""

import hashlib
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from analytic import ALL_QUANTITIES
from mcgw.errors import StoreError
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.store.head import MOST_TEXT, head_digest
from mcgw.store.provenance import now, provenance
from mcgw.store.shards import DRAWN, RAGGED, Span, Tables

__all__ = [
    "FILETYPE",
    "FORMAT",
    "build",
    "file_pieces",
    "scales_of",
    "stored_text",
    "trailer_notes",
    "values_digest",
    "where",
]

FILETYPE, FORMAT = "mcgw-ensemble", (1, 1)

_LONG_NAMES = {
    "moments": "sums of Chebyshev polynomials of the uniforms in each cell",
    "cells": "asperities in each cell",
    RAGGED: "asperities outside the cells: surface, height, weight",
}
_SCALES = {  # of the axes of tables, in their order: unit and long name
    "surface": ("1", "number of the surface"),
    "separation": ("1", "mean-plane separation d/sigma"),
    "displacement": ("m", "tangential displacement"),
}
_PIECE = 2**23  # bytes read at a time
_CHUNK, _CHUNK_ROWS = 2**20, 256
# A checksum makes a changed chunk an error, not a number; writing takes no longer, reading 6 %.
_STORED: Any = {"compression": "gzip", "compression_opts": 1, "shuffle": True, "fletcher32": True}


def build(
    file: h5py.File, scene: Scene, sampler: str, pieces: Iterable[tuple[Span, Tables]], **attributes: Any
) -> str:
    """Fill an empty HDF5 file with all surfaces of a scene, in order, and with more root attributes.

    Returns the digest of scene and data, computed from the pieces; it is also an attribute.

    Raises
    ------
    StoreError
        If the pieces are not all surfaces of the scene in order.
    """
    text = stored_text(scene)
    stop, digest = 0, _Digest(scene)
    for span, arrays in pieces:
        if span.first != stop:
            raise StoreError(f"surfaces {stop} ... {span.first - 1} are missing")
        if not stop:
            _lay_out(file, scene, arrays)
            for name, scale in scales_of(scene).items():
                digest.add(name, np.array(scale))
        for name, values in arrays.items():
            digest.add(name, values)
        _put(file, span, arrays)
        stop = span.stop
    if stop != scene.n_surfaces:
        raise StoreError(f"{stop} surfaces, not {scene.n_surfaces}")
    file.attrs.update(
        filetype=FILETYPE,
        format=FORMAT,
        title=scene.title,
        scene=text,
        seed=np.uint64(scene.seed),
        sampler=sampler,
        complete=True,
        digest=digest.hexdigest(),
        date=now(),
        **{**provenance(), **attributes},
    )
    return digest.hexdigest()


def where(name: str) -> str:
    """Path of a table in the file."""
    return f"drawn/{name}" if name in DRAWN else name


def tables(file: h5py.File) -> list[str]:
    """Names of the tables of results, in order."""
    return sorted(name for name in (*ALL_QUANTITIES, *DRAWN) if where(name) in file)


def stored_text(scene: Scene) -> str:
    """The scene as its file holds it.

    Raises
    ------
    StoreError
        If it is longer than the file may be told: a list of very many heights, or radii.
    """
    text = scene_text(scene)
    if len(text.encode()) > MOST_TEXT:
        raise StoreError(
            f"scene: its lists take {len(text)} characters, and a file of results holds {MOST_TEXT}; "
            "list fewer summits, or simulate in memory"
        )
    return text


def scales_of(scene: Scene) -> dict[str, Sequence[float]]:
    """What the axes of the tables count."""
    scales: dict[str, Sequence[float]] = {"surface": range(scene.n_surfaces), "separation": scene.separations}
    return scales if scene.tangential is None else {**scales, "displacement": scene.tangential.displacements}


def _scales(file: h5py.File) -> list[str]:
    return [name for name in _SCALES if name in file]


class _Digest:
    """SHA-256 over a scene and named tables that come in pieces: not over the bytes of a container."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene_text(scene, left_out=False)
        self._tables: dict[str, Any] = {}

    def add(self, name: str, values: NDArray[Any]) -> None:
        """More rows of a table."""
        plain = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
        if name not in self._tables:
            self._tables[name] = [hashlib.sha256(f"{plain.dtype.str} {plain.shape[1:]}".encode()), 0]
        table = self._tables[name]
        table[0].update(plain.tobytes())
        table[1] += len(plain)

    def hexdigest(self) -> str:
        """Of the scene, and of the names, numbers of rows, types and values of the tables."""
        lines = [f"{name} {rows} {sha.hexdigest()}" for name, (sha, rows) in sorted(self._tables.items())]
        return hashlib.sha256("\n".join([self._scene, *lines]).encode()).hexdigest()


def trailer_notes(file: h5py.File) -> dict[str, str]:
    """What the trailer of an ensemble file says besides its length and digest."""
    names = [*_scales(file), *(where(name) for name in tables(file))]
    return {"head": head_digest(file, names)}


def values_digest(file: h5py.File, scene: Scene) -> str:
    """Digest of what a file holds, read piece by piece."""
    digest = _Digest(scene)
    for name in (*_scales(file), *tables(file)):
        for start, stop in _steps(file[where(name)]):
            digest.add(name, file[where(name)][start:stop])
    return digest.hexdigest()


def file_pieces(file: h5py.File) -> Iterator[tuple[Span, Tables]]:
    """The surfaces of an ensemble file, some at a time."""
    data = {name: file[where(name)] for name in tables(file)}
    outside = data.pop(RAGGED)[()] if RAGGED in data else None
    rows = len(file["surface"])
    width = sum(8 * math.prod(table.shape[1:]) for table in data.values())
    step = max(_PIECE // max(width, 1), 1)
    for first in range(0, rows, step):
        span = Span(first, min(step, rows - first))
        arrays = {name: table[span.first : span.stop] for name, table in data.items()}
        if outside is not None:
            arrays[RAGGED] = outside[(outside[:, 0] >= span.first) & (outside[:, 0] < span.stop)]
        yield span, arrays


def _steps(data: h5py.Dataset) -> Iterator[tuple[int, int]]:
    width = data.dtype.itemsize * int(np.prod(data.shape[1:]))
    step = max(_PIECE // max(width, 1), 1)
    for start in range(0, max(data.shape[0], 1), step):
        yield start, min(start + step, data.shape[0])


def _lay_out(file: h5py.File, scene: Scene, arrays: Tables) -> None:
    """Empty datasets with their scales, units and names."""
    for name, scale in scales_of(scene).items():
        _scale(file, name, np.array(scale), *_SCALES[name])
    for name in sorted(arrays):
        values = arrays[name]
        q = ALL_QUANTITIES.get(name)
        ragged = name == RAGGED
        rows, shape = 0 if ragged else scene.n_surfaces, values.shape[1:]
        columns = math.prod(shape)
        data = file.create_dataset(
            where(name),
            (rows, *shape),
            values.dtype.newbyteorder("<"),
            maxshape=(None, *shape) if ragged else None,
            chunks=(_chunk_rows(rows, columns), *(max(size, 1) for size in shape)),
            **_STORED,
        )
        data.attrs.update(units=q.unit if q else "1", long_name=q.long_name if q else _LONG_NAMES[name])
        for axis, name_of_scale in enumerate(tuple(_SCALES)[: values.ndim] if q else ()):
            data.dims[axis].attach_scale(file[name_of_scale])


def _chunk_rows(rows: int, columns: int) -> int:
    fitting = max(_CHUNK // (8 * max(columns, 1)), 1)
    return min(_CHUNK_ROWS, fitting, rows or _CHUNK_ROWS)


def _scale(file: h5py.File, name: str, values: NDArray[Any], unit: str, long_name: str) -> None:
    chunks = (min(len(values), _CHUNK // 8),)
    scale = file.create_dataset(name, data=values, chunks=chunks, **_STORED)
    scale.attrs.update(units=unit, long_name=long_name)
    scale.make_scale(name)


def _put(file: h5py.File, span: Span, arrays: Tables) -> None:
    for name, values in arrays.items():
        data, first = file[where(name)], span.first
        if name == RAGGED:
            first = len(data)
            data.resize(first + len(values), axis=0)
        if len(values):
            data[first : first + len(values)] = values
