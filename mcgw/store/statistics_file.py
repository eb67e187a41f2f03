"""Files that hold statistics over surfaces in the place of the surfaces.

The schema (``filetype = "mcgw-statistics"``, ``format = [1, 1]``)::

    /                     attributes: as of an ensemble (`mcgw.store`)
    /separation           float64 (separations,)              dimension scale: d/sigma
    /displacement         float64 (displacements,)            dimension scale: m, if the scene has some
    /probability          float64 (probabilities,)            dimension scale: 0 ... 1
    /load_mean            float64 (separations,) N            and load_std, load_skewness (1)
    /load_quantile        float64 (probabilities, separations) N; 0 and 1 are the extremes
    /column, /other_column int64  (columns,)                  dimension scales: see the next
    /covariance           float64 (columns, columns)          between all quantities and separations: its
                                                              attribute `columns` tells their order

(and so on for each quantity), and in ``/drawn``, from which all that follows and with which a run goes on, a
row for each joined block of surfaces::

    /drawn/block_n        int64   (blocks,)                   surfaces
    /drawn/block_mean     float64 (blocks, columns)
    /drawn/block_cubes    float64 (blocks, columns)           sums of the cubes of deviations
    /drawn/block_products float64 (blocks, pairs)             of products of deviations, a packed triangle
    /drawn/block_extremes float64 (blocks, 2, columns)        least and greatest value
    /drawn/block_at       int64   (blocks, 2, columns)        surfaces that have them
    /drawn/block_counts   int64   (blocks, columns, bins)     values in each bin (`mcgw.ensemble.bins`)

`digest` is over the scene and ``/drawn``.
"""

import hashlib
import io
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.over_surfaces import PROBABILITIES, STATISTICS_OF
from mcgw.ensemble.summarised import Summarised
from mcgw.ensemble.summary import ROW, Summary
from mcgw.errors import StoreError
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.store.chunks import PACKED
from mcgw.store.head import head_digest
from mcgw.store.layout import AXES, STATISTICS, describe, numbers, scales_of
from mcgw.store.shards import content_digest, in_memory
from mcgw.store.structure import check_plain
from mcgw.store.trailer import trailer_of

__all__ = ["body_of", "found_digest", "read_blocks", "shapes_of"]

FORMAT = (1, 1)

_DRAWN = "drawn"
_COLUMNS = ("column", "other_column")  # of the covariance
_AXES = ("separation", "displacement")


def body_of(ensemble: Ensemble, **attributes: Any) -> tuple[bytes, bytes]:
    """The file of an ensemble that keeps statistics, and its trailer."""
    sums = ensemble.sums
    assert isinstance(sums, Summarised)
    tables = _drawn(sums.blocks)

    def fill(file: h5py.File) -> None:
        _lay_out(file, ensemble)
        for name, values in tables.items():
            file.create_dataset(f"{_DRAWN}/{name}", data=values, **_packed(values))
        digest = _digest(ensemble.scene, tables)
        kind = {"filetype": STATISTICS, "format": FORMAT}
        describe(file, ensemble.scene, ensemble.sampler, digest, **{**attributes, **kind})

    body = in_memory(fill)
    with h5py.File(io.BytesIO(body), "r") as file:
        head = head_digest(file, check_plain(file))
    return body, trailer_of(body, head=head)


def read_blocks(path: Path) -> tuple[Summary, ...]:
    """The joined blocks that a file holds.

    Raises
    ------
    StoreError
        If they cannot be read.
    """
    try:
        with h5py.File(path, "r") as file:
            tables = {name: data[()] for name, data in file[_DRAWN].items()}
        return tuple(Summary.from_tables(tables, i) for i in range(len(tables[f"{ROW}n"])))
    except (OSError, RuntimeError, KeyError, IndexError, TypeError, ValueError) as error:
        raise StoreError(f"{path}: damaged, or of another version ({error})") from None


def found_digest(path: Path, scene: Scene) -> str:
    """Digest of what a file holds now."""
    with h5py.File(path, "r") as file:
        return _digest(scene, {name: data[()] for name, data in file[_DRAWN].items()})


def shapes_of(scene: Scene) -> dict[str, list[int]]:
    """Shapes that a scene declares of the tables of its statistics."""
    shapes = {"probability": [len(PROBABILITIES)], "covariance": [scene.width, scene.width]}
    shapes |= {name: [len(values)] for name, values in scales_of(scene).items() if name != "surface"}
    for name, shape in scene.shapes.items():
        shapes |= {f"{name}_{kind}": [*shape] for kind in STATISTICS_OF}
        shapes[f"{name}_quantile"] = [len(PROBABILITIES), *shape]
    return shapes


def _lay_out(file: h5py.File, ensemble: Ensemble) -> None:
    """What other programs read."""
    scene = ensemble.scene
    for name, scale in scales_of(scene).items():
        if name != "surface":
            _scale(file, name, numbers(scale), *AXES[name])
    _scale(file, "probability", np.array(PROBABILITIES), "1", "share of the surfaces that are below")
    for name in scene.shapes:
        q = quantity_of(name)
        for kind, words in STATISTICS_OF.items():
            values = getattr(ensemble, kind)(name)
            _table(
                file,
                f"{name}_{kind}",
                values,
                "1" if kind == "skewness" else q.unit,
                words.format(q.long_name),
            )
        quantiles = np.stack([ensemble.quantile(name, p) for p in PROBABILITIES])
        _table(file, f"{name}_quantile", quantiles, q.unit, f"quantiles of the {q.long_name}")
    _covariance(file, ensemble)


def _covariance(file: h5py.File, ensemble: Ensemble) -> None:
    shapes = ensemble.scene.shapes
    rows = []
    for name in shapes:
        size = int(np.prod(shapes[name]))
        rows.append([ensemble.covariance(name, other).reshape(size, -1) for other in shapes])
    data = file.create_dataset("covariance", data=np.block(rows), **PACKED)
    for axis, scale in enumerate(_COLUMNS):
        _scale(file, scale, np.arange(len(data)), "1", "quantity and separation")
        data.dims[axis].attach_scale(file[scale])
    columns = ", ".join(f"{name} {'x'.join(map(str, shape))}" for name, shape in shapes.items())
    data.attrs.update(units="product of units", long_name="covariance over surfaces", columns=columns)


def _table(file: h5py.File, name: str, values: NDArray[Any], unit: str, long_name: str) -> None:
    data = file.create_dataset(name, data=values, **_packed(values))
    data.attrs.update(units=unit, long_name=long_name)
    axes = ("probability", *_AXES) if name.endswith("_quantile") else _AXES
    for axis in range(values.ndim):
        data.dims[axis].attach_scale(file[axes[axis]])


def _scale(file: h5py.File, name: str, values: NDArray[Any], unit: str, long_name: str) -> None:
    scale = file.create_dataset(name, data=values)
    scale.attrs.update(units=unit, long_name=long_name)
    scale.make_scale(name)


def _drawn(blocks: Iterable[Summary]) -> dict[str, NDArray[Any]]:
    rows = [block.tables() for block in blocks]
    return {name: np.concatenate([row[name] for row in rows]) for name in rows[0]}


def _digest(scene: Scene, tables: dict[str, NDArray[Any]]) -> str:
    text = scene_text(scene, left_out=False)
    return hashlib.sha256("\0".join((text, content_digest(tables))).encode()).hexdigest()


def _packed(values: NDArray[Any]) -> dict[str, Any]:
    return dict(PACKED) if values.ndim and values.size else {}
