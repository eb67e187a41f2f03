"""How an ensemble lies in its HDF5 file; the schema is written out in `mcgw.store`."""

import hashlib
import io
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from analytic import ALL_QUANTITIES
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.labelled import AXES, Labelled
from mcgw.ensemble.results import Tables
from mcgw.errors import StoreError
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.store.chunks import PACKED, add_rows, empty_table
from mcgw.store.disk import GROUP, head_digest, trailer_of
from mcgw.store.identity import commit, now, processor, versions
from mcgw.store.shards import LIBVER, Span, content_digest
from mcgw.store.structure import MOST_TEXT

FILETYPE, FORMAT = "mcgw-results", (2, 0)

Stored = Mapping[str, NDArray[Any] | h5py.Dataset]

_OF_SURFACES = ("surface", "separation")  # axes of tables with values
_PIECE = 2**23  # bytes read at a time
_SCALE_CHUNK = 2**17  # numbers


def fill(file: h5py.File, scene: Scene, pieces: Iterable[tuple[Span, Stored]]) -> None:
    """Fill an empty HDF5 file with the tables of all surfaces of a scene, that come in order.

    Raises
    ------
    StoreError
        If the pieces are not all surfaces of the scene in order.
    """
    stop = 0
    for span, tables in pieces:
        if span.first != stop:
            raise StoreError(f"surfaces {stop} ... {span.first - 1} are missing")
        if not stop:
            for name, scale in scales_of(scene, scene.n_surfaces).items():
                _scale(file, name, scale, *AXES[name])
            for name in sorted(tables):
                q = scene.quantity(name)
                data = empty_table(file, name, scene.n_surfaces, tables[name])
                data.attrs.update(units=q.unit, long_name=q.long_name)
                for axis, name_of_scale in enumerate(_OF_SURFACES[: data.ndim]):
                    data.dims[axis].attach_scale(file[name_of_scale])
        for name, table in tables.items():
            add_rows(file[name], span.first, table)
        stop += span.n
    if stop != scene.n_surfaces:
        raise StoreError(f"{stop} surfaces, not {scene.n_surfaces}")


def describe(file: h5py.File, scene: Scene, sampler: str, digest: str, /, **attributes: Any) -> None:
    """Give a file that is filled its root attributes, and more of them."""
    usual = {
        "filetype": FILETYPE,
        "format": FORMAT,
        "title": scene.title,
        "scene": stored_text(scene),
        "seed": np.uint64(scene.seed),
        "sampler": sampler,
        "complete": True,
        "digest": digest,
        "date": now(),
        "versions": versions(),
        "commit": commit(),
        "cpu": processor(),
    }
    if scene.accuracy:
        from mcgw.sampling.samplers import distance_of  # for those scenes alone

        usual["accuracy_spent"] = distance_of(scene)  # how far from the exact laws it went
    file.attrs.update(**{**usual, **attributes})


def stored_tables(file: h5py.File) -> dict[str, h5py.Dataset]:
    """The tables of results by their names, in order."""
    return {name: file[name] for name in sorted(ALL_QUANTITIES) if name in file}


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
            f"scene: its lists need {len(text)} characters, but a file of results holds at most {MOST_TEXT}; "
            "list fewer summits, or simulate in memory"
        )
    return text


def scales_of(scene: Scene, surfaces: int) -> dict[str, NDArray[Any]]:
    """What the axes of the tables count; of the surfaces only the first ones."""
    return {"surface": np.arange(surfaces), "separation": np.array(scene.separations)}


def body_of(ensemble: Ensemble, **about: Any) -> tuple[bytes, bytes]:
    """The file of an ensemble that holds surfaces, with more attributes, and its trailer."""
    scene = ensemble.scene
    arrays = {name: ensemble.sums.read(name, 0, None) for name in scene.shapes}
    made = io.BytesIO()
    with h5py.File(made, "w", libver=LIBVER) as file:
        fill(file, scene, [(Span(0, scene.n_surfaces), arrays)])
        describe(file, scene, ensemble.sampler, digest_of(file, scene, [arrays]), **about)
        head = head_digest(file)
    body = made.getvalue()
    return body, trailer_of(body, head=head)


def body_of_kept(
    labelled: Labelled, tables: Tables, texts: Sequence[str], scene: Scene, sampler: str, /, **attributes: Any
) -> tuple[bytes, bytes]:
    """A file without surfaces, and its trailer: what others read, and in one group what that follows from.

    The digest is over these tables, and over the texts that say what they are of.
    """
    made = io.BytesIO()
    with h5py.File(made, "w", libver=LIBVER) as file:
        for name, one in labelled.coordinates.items():
            if one.dims == (name,):
                _scale(file, name, one.values, one.units, one.long_name)
        for name, one in (*labelled.coordinates.items(), *labelled.variables.items()):
            if one.dims == (name,):
                continue
            data = file.create_dataset(name, data=one.values, **_packed(one.values))
            data.attrs.update(one.about)
            for place, dim in enumerate(one.dims):
                data.dims[place].attach_scale(file[dim])
        for name, values in tables.items():
            file.create_dataset(f"{GROUP}/{name}", data=values, **_packed(values))
        describe(file, scene, sampler, drawn_digest(tables, *texts), **attributes)
        head = head_digest(file)
    body = made.getvalue()
    return body, trailer_of(body, head=head)


def _packed(values: NDArray[Any]) -> dict[str, Any]:
    return dict(PACKED) if values.ndim and values.size else {}


def digest_of(file: h5py.File, scene: Scene, pieces: Iterable[Tables]) -> str:
    """SHA-256 of a scene, of the scales in its file, and of tables that come in pieces, in order.

    Over names, types, numbers of rows and values: not over the bytes of a container.
    """
    scales = (
        {name: file[name][start : start + _PIECE // 8]}
        for name in filter(file.__contains__, _OF_SURFACES)
        for start in range(0, len(file[name]), _PIECE // 8)
    )
    tables: dict[str, Any] = {}
    for arrays in chain(scales, pieces):
        for name, values in arrays.items():
            plain = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
            if name not in tables:
                tables[name] = [hashlib.sha256(f"{plain.dtype.str} {plain.shape[1:]}".encode()), 0]
            tables[name][0].update(plain.reshape(-1))
            tables[name][1] += len(plain)
    lines = [f"{name} {rows} {sha.hexdigest()}" for name, (sha, rows) in sorted(tables.items())]
    return hashlib.sha256("\n".join([scene_text(scene, left_out=False), *lines]).encode()).hexdigest()


def drawn_tables(file: h5py.File) -> Tables:
    """Of a file that holds no surfaces, all that its statistics follow from."""
    return {name: data[()] for name, data in file[GROUP].items()}


def drawn_digest(tables: Tables, *texts: str) -> str:
    """Digest of that, and of the scene, and axes, that it is of."""
    return hashlib.sha256("\0".join((*texts, content_digest(tables))).encode()).hexdigest()


def file_pieces(file: h5py.File) -> Iterator[tuple[Span, Tables]]:
    """The surfaces of an ensemble file, some at a time."""
    rows = len(file["surface"])
    width = sum(8 * math.prod(table.shape[1:]) for table in stored_tables(file).values())
    step = max(_PIECE // max(width, 1), 1)
    return rows_of(file, (Span(first, min(step, rows - first)) for first in range(0, rows, step)))


def rows_of(file: h5py.File, spans: Iterable[Span]) -> Iterator[tuple[Span, Tables]]:
    """Some surfaces of an ensemble file after the other."""
    data = stored_tables(file)
    for span in spans:
        yield span, {name: table[span.first : span.stop] for name, table in data.items()}


def _scale(file: h5py.File, name: str, values: NDArray[Any], unit: str, long_name: str) -> None:
    chunks = (min(len(values), _SCALE_CHUNK),)
    scale = file.create_dataset(name, data=values, chunks=chunks, **PACKED)
    scale.attrs.update(units=unit, long_name=long_name)
    scale.make_scale(name)
