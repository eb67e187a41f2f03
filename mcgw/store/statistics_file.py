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

"""

from pathlib import Path
from typing import Any

import numpy as np

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.labelled import Labelled, Variable
from mcgw.ensemble.pooled import Pooled
from mcgw.ensemble.results import BLOCK, joined
from mcgw.ensemble.summarised import Summarised
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.store.h5_file import Contents, drawn_tables
from mcgw.store.layout import attributes_of, contents_of_kept, stored_text

_COLUMNS = ("column", "other_column")  # of the covariance


def contents_of_statistics(ensemble: Ensemble, **about: Any) -> Contents:
    """Those of the file of an ensemble that keeps statistics."""
    sums, scene, found = ensemble.sums, ensemble.scene, ensemble.labelled()
    assert isinstance(sums, Summarised)
    columns, words = np.arange(scene.width), ("1", "quantity and separation")
    scales = {name: Variable((name,), columns, *words) for name in _COLUMNS}
    order = ", ".join(f"{name} {'x'.join(map(str, shape))}" for name, shape in scene.shapes.items())
    rows = [[ensemble.covariance(one, other) for other in scene.shapes] for one in scene.shapes]
    covariance = Variable(_COLUMNS, np.block(rows), "product of units", f"covariance of {order}")
    labelled = Labelled({**found.variables, "covariance": covariance}, {**found.coordinates, **scales})
    drawn = joined([part.block() for part in sums.parts])
    attributes = attributes_of(scene, ensemble.sampler, stored_text(scene), **about)
    return contents_of_kept(labelled, drawn, attributes, scene_text(scene, left_out=False))


def read_statistics(path: Path, scene: Scene) -> Summarised:
    """What a file holds.

    Raises
    ------
    StoreError
        If it cannot be read.
    """
    tables = drawn_tables(path)
    rows = range(len(tables[f"{BLOCK}n"]))
    return Summarised(scene, tuple(Pooled.from_block(tables, row) for row in rows))
