"""Files that hold statistics over surfaces in place of the surfaces.

The schema (of a scene with ``keep = "statistics"``)::

    /                     attributes: as of an ensemble (`mcgw.store`)
    /separation           float64 (separations,)              dimension scale: d/sigma
    /load_mean, /load_std float64 (separations,) N            (and so on for each quantity)
    /column, /other_column int64  (columns,)                  dimension scales: see the next
    /covariance           float64 (columns, columns)          between all quantities and separations: its
                                                              long_name tells their order

and in ``/drawn``, from which all that follows and with which a run goes on, as in the file of a sweep whose
points are the columns: a row for all whole blocks of surfaces, and one for what is beyond::

    /drawn/block_n                int64   (rows, 1)           surfaces
    /drawn/block_numbers_means    float64 (rows, columns, 1)
    /drawn/block_numbers_products float64 (rows, pairs, 1)    sums of products of deviations, all pairs

`digest` is over the scene and ``/drawn``.
"""

from pathlib import Path
from typing import Any

import numpy as np

from mcgw.ensemble.ensemble import STATISTICS, Ensemble
from mcgw.ensemble.labelled import Labelled, Variable
from mcgw.ensemble.pooled import Pooled
from mcgw.ensemble.results import BLOCK, joined
from mcgw.ensemble.summarised import NUMBERS, Summarised
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
    columns, about = np.arange(scene.width), ("1", "quantity and separation")
    scales = {name: Variable((name,), columns, *about) for name in _COLUMNS}
    order = ", ".join(f"{name} {'x'.join(map(str, shape))}" for name, shape in scene.shapes.items())
    rows = [[ensemble.covariance(one, other) for other in scene.shapes] for one in scene.shapes]
    covariance = Variable(_COLUMNS, np.block(rows), "product of units", f"covariance of {order}")
    labelled = Labelled({**found.variables, "covariance": covariance}, {**found.coordinates, **scales})
    tables, texts = joined([part.block() for part in sums.parts]), (scene_text(scene, left_out=False),)
    return body_of_kept(labelled, tables, texts, scene, ensemble.sampler, **attributes)


def read_statistics(path: Path, scene: Scene) -> Summarised:
    """What a file holds.

    Raises
    ------
    StoreError
        If it cannot be read.
    """
    try:
        with open_h5(path) as file:
            tables = drawn_tables(file)
        rows = range(len(tables[f"{BLOCK}n"]))
        parts = tuple(Pooled.from_block(tables, row) for row in rows)
        if len(tables) != 3 or any(
            part.products[NUMBERS].shape != (scene.width, scene.width, 1) for part in parts
        ):
            raise ValueError("its tables are not those of the scene")
        return Summarised(scene, parts)
    except (OSError, RuntimeError, KeyError, IndexError, TypeError, ValueError) as error:
        raise StoreError(f"{path}: damaged, or of another version ({error})") from None


def shapes_of(scene: Scene) -> dict[str, list[int]]:
    """Shapes that a scene declares of the tables of its statistics."""
    shapes = {"covariance": [scene.width, scene.width]}
    shapes |= {name: [len(values)] for name, values in scales_of(scene, 0).items() if name != "surface"}
    return shapes | {
        f"{name}_{kind}": [*shape] for name, shape in scene.shapes.items() for kind in STATISTICS
    }
