"""Files that hold statistics over surfaces in place of the surfaces.

The schema (of a scene with ``keep = "statistics"``)::

    /                     attributes: as of an ensemble (`mcgw.store`)
    /separation           float64 (separations,)              dimension scale: d/sigma
    /displacement         float64 (displacements,)            dimension scale: m, if the scene has some
    /probability          float64 (probabilities,)            dimension scale: 0 ... 1
    /load_mean            float64 (separations,) N            and load_std, load_skewness (1)
    /load_quantile        float64 (probabilities, separations) N; 0 and 1 are the extremes
    /column, /other_column int64  (columns,)                  dimension scales: see the next
    /covariance           float64 (columns, columns)          between all quantities and separations: its
                                                              long_name tells their order

(and so on for each quantity), and in ``/drawn``, from which all that follows and with which a run goes on, a
row for each joined block of surfaces::

    /drawn/block_n        int64   (blocks,)                   surfaces
    /drawn/block_mean     float64 (blocks, columns)
    /drawn/block_cubes    float64 (blocks, columns)           sums of the cubes of deviations
    /drawn/block_products float64 (blocks, pairs)             of products of deviations, a packed triangle
    /drawn/block_extremes float64 (blocks, 2, columns)        least and greatest value
    /drawn/block_at       int64   (blocks, 2, columns)        surfaces that have them
    /drawn/block_counts   int64   (blocks, columns, bins)     values in each bin (`mcgw.ensemble.summary`)

`digest` is over the scene and ``/drawn``.
"""

import math
from pathlib import Path
from typing import Any

import numpy as np

from mcgw.ensemble.ensemble import STATISTICS, Ensemble
from mcgw.ensemble.labelled import Labelled, Variable
from mcgw.ensemble.results import PROBABILITIES
from mcgw.ensemble.summarised import Summarised
from mcgw.ensemble.summary import ROW, Summary
from mcgw.errors import StoreError
from mcgw.formats.gate import open_h5
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.store.layout import body_of_kept, drawn_tables, scales_of

_COLUMNS = ("column", "other_column")  # of the covariance


def body_of_statistics(ensemble: Ensemble, **attributes: Any) -> tuple[bytes, bytes]:
    """The file of an ensemble that keeps statistics, and its trailer."""
    sums, scene, found = ensemble.sums, ensemble.scene, ensemble.labelled()
    assert isinstance(sums, Summarised)
    rows = [block.tables() for block in sums.blocks]
    tables = {name: np.concatenate([row[name] for row in rows]) for name in rows[0]}
    columns, about = np.arange(scene.width), ("1", "quantity and separation")
    scales = {name: Variable((name,), columns, *about) for name in _COLUMNS}
    order = ", ".join(f"{name} {'x'.join(map(str, shape))}" for name, shape in scene.shapes.items())
    blocks = [
        [ensemble.covariance(one, other).reshape(math.prod(shape), -1) for other in scene.shapes]
        for one, shape in scene.shapes.items()
    ]
    covariance = Variable(_COLUMNS, np.block(blocks), "product of units", f"covariance of {order}")
    labelled = Labelled({**found.variables, "covariance": covariance}, {**found.coordinates, **scales})
    texts = (scene_text(scene, left_out=False),)
    return body_of_kept(labelled, tables, texts, scene, ensemble.sampler, **attributes)


def read_blocks(path: Path, scene: Scene) -> Summarised:
    """The joined blocks that a file holds.

    Raises
    ------
    StoreError
        If they cannot be read.
    """
    try:
        with open_h5(path) as file:
            tables = drawn_tables(file)
        rows = range(len(tables[f"{ROW}n"]))
        return Summarised(scene, tuple(Summary.from_tables(tables, i) for i in rows))
    except (OSError, RuntimeError, KeyError, IndexError, TypeError, ValueError) as error:
        raise StoreError(f"{path}: damaged, or of another version ({error})") from None


def shapes_of(scene: Scene) -> dict[str, list[int]]:
    """Shapes that a scene declares of the tables of its statistics."""
    shapes = {"probability": [len(PROBABILITIES)], "covariance": [scene.width, scene.width]}
    shapes |= {name: [len(values)] for name, values in scales_of(scene, 0).items() if name != "surface"}
    for name, shape in scene.shapes.items():
        shapes |= {f"{name}_{kind}": [*shape] for kind in STATISTICS}
        shapes[f"{name}_quantile"] = [len(PROBABILITIES), *shape]
    return shapes
