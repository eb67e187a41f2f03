"""How an ensemble lies in its HDF5 file; the schema is written out in `mcgw.store`."""

import hashlib
from collections.abc import Iterable, Iterator
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from analytic import ALL_QUANTITIES
from mcgw.errors import StoreError
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.store.head import head_digest
from mcgw.store.provenance import now, provenance
from mcgw.store.shards import DRAWN, RAGGED, Span, Tables

__all__ = ["FILETYPE", "FORMAT", "build", "file_pieces", "trailer_notes", "values_digest", "where"]

FILETYPE, FORMAT = "mcgw-ensemble", (1, 1)

_LONG_NAMES = {
    "moments": "sums of Chebyshev polynomials of the uniforms in each cell",
    "cells": "asperities in each cell",
    RAGGED: "asperities outside the cells: surface, height, weight",
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
    stop, digest = 0, _Digest(scene)
    for span, arrays in pieces:
        if span.first != stop:
            raise StoreError(f"surfaces {stop} ... {span.first - 1} are missing")
        if not stop:
            _lay_out(file, scene, arrays)
            digest.add("surface", np.arange(scene.n_surfaces))
            digest.add("separation", np.array(scene.separations))
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
        scene=scene_text(scene),
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
    names = ["surface", "separation", *(where(name) for name in tables(file))]
    return {"head": head_digest(file, names)}


def values_digest(file: h5py.File, scene: Scene) -> str:
    """Digest of what a file holds, read piece by piece."""
    digest = _Digest(scene)
    for name in ("surface", "separation", *tables(file)):
        for start, stop in _steps(file[where(name)]):
            digest.add(name, file[where(name)][start:stop])
    return digest.hexdigest()


def file_pieces(file: h5py.File) -> Iterator[tuple[Span, Tables]]:
    """The surfaces of an ensemble file, some at a time."""
    data = {name: file[where(name)] for name in tables(file)}
    outside = data.pop(RAGGED)[()] if RAGGED in data else None
    rows = len(file["surface"])
    width = sum(8 * table.shape[1] for table in data.values())
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
    _scale(file, "surface", np.arange(scene.n_surfaces), "number of the surface")
    _scale(file, "separation", np.array(scene.separations), "mean-plane separation d/sigma")
    for name in sorted(arrays):
        values = arrays[name]
        q = ALL_QUANTITIES.get(name)
        ragged = name == RAGGED
        rows, columns = 0 if ragged else scene.n_surfaces, values.shape[1]
        data = file.create_dataset(
            where(name),
            (rows, columns),
            values.dtype.newbyteorder("<"),
            maxshape=(None, columns) if ragged else None,
            chunks=(_chunk_rows(rows, columns), max(columns, 1)),
            **_STORED,
        )
        data.attrs.update(units=q.unit if q else "1", long_name=q.long_name if q else _LONG_NAMES[name])
        for axis, scale in enumerate(("surface", "separation") if q else ()):
            data.dims[axis].attach_scale(file[scale])


def _chunk_rows(rows: int, columns: int) -> int:
    fitting = max(_CHUNK // (8 * max(columns, 1)), 1)
    return min(_CHUNK_ROWS, fitting, rows or _CHUNK_ROWS)


def _scale(file: h5py.File, name: str, values: NDArray[Any], long_name: str) -> None:
    chunks = (min(len(values), _CHUNK // 8),)
    scale = file.create_dataset(name, data=values, chunks=chunks, **_STORED)
    scale.attrs.update(units="1", long_name=long_name)
    scale.make_scale(name)


def _put(file: h5py.File, span: Span, arrays: Tables) -> None:
    for name, values in arrays.items():
        data, first = file[where(name)], span.first
        if name == RAGGED:
            first = len(data)
            data.resize(first + len(values), axis=0)
        if len(values):
            data[first : first + len(values)] = values
