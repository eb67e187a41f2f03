"""What the file of an ensemble holds; the schema is written out in `mcgw.store`.

Files may hold statistics over surfaces in place of the surfaces. The schema (of a scene with
``keep = "statistics"``)::

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

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.labelled import Labelled, Variable, values_of
from mcgw.ensemble.results import BLOCK, Tables, joined
from mcgw.scene.scene import Scene
from mcgw.store.h5_writing import FILETYPE, FORMAT, GROUP, Contents
from mcgw.store.identity import Written, commit, now, processor, versions

if TYPE_CHECKING:
    from mcgw.ensemble.summarised import Summarised

_COLUMNS = ("column", "other_column")  # of the covariance


def contents_of(ensemble: Ensemble, written: Written, **about: Any) -> Contents:
    """Those of the file of an ensemble in memory, with more attributes."""
    if written.scene.keep == "statistics":
        return _contents_of_statistics(ensemble, written, **about)
    return contents_of_values(written, partial(ensemble.sums.read, start=0, stop=None), **about)


def contents_of_values(written: Written, values: Callable[[str], Any], **about: Any) -> Contents:
    """Those of a scene of which the values of every surface are kept: arrays, or `Rows`."""
    found = values_of(written.scene, written.scene.n_surfaces, values)
    variables = {**found.coordinates, **dict(sorted(found.variables.items()))}
    attributes = attributes_of(written.scene, written.sampler, written.text, **about)
    return Contents(variables, attributes, written.of_all)


def contents_of_kept(
    labelled: Labelled, drawn: Tables, attributes: Mapping[str, Any], *texts: str
) -> Contents:
    """Those of a file without surfaces: what others read, and in one group what that follows from."""
    scales = {name: one for name, one in labelled.coordinates.items() if one.dims == (name,)}
    others = [name for name in labelled.coordinates if name not in scales]
    named = {"coordinates": " ".join(others)} if others else {}  # by which xarray knows them
    drawn_from = {f"{GROUP}/{name}": Variable((), values, "", "") for name, values in drawn.items()}
    variables = {**scales, **labelled.coordinates, **labelled.variables, **drawn_from}
    return Contents(variables, {**attributes, **named}, "\0".join(texts))


def attributes_of(scene: Scene, sampler: str, text: str, /, **about: Any) -> dict[str, Any]:
    """Root attributes of a file, where a text describes the scene, and more of them."""
    usual = {
        "filetype": FILETYPE,
        "format": FORMAT,
        "title": scene.title,
        "scene": text,
        "seed": np.uint64(scene.seed),
        "sampler": sampler,
        "date": now(),
        "versions": versions(),
        "commit": commit(),
        "cpu": processor(),
    }
    if scene.accuracy:
        from mcgw.sampling.samplers import distance_of  # for those scenes alone

        usual["accuracy_spent"] = distance_of(scene)  # how far from the exact laws it went
    return {**usual, **about}


def _contents_of_statistics(ensemble: Ensemble, written: Written, **about: Any) -> Contents:
    from mcgw.ensemble.summarised import Summarised  # for those scenes alone

    sums, scene, found = ensemble.sums, ensemble.scene, ensemble.labelled()
    assert isinstance(sums, Summarised)
    columns, words = np.arange(scene.width), ("1", "quantity and separation")
    scales = {name: Variable((name,), columns, *words) for name in _COLUMNS}
    order = ", ".join(f"{name} {len(scene.separations)}" for name in scene.tables)
    rows = [[ensemble.covariance(one, other) for other in scene.tables] for one in scene.tables]
    covariance = Variable(_COLUMNS, np.block(rows), "product of units", f"covariance of {order}")
    labelled = Labelled({**found.variables, "covariance": covariance}, {**found.coordinates, **scales})
    drawn = joined([part.block() for part in sums.parts])
    attributes = attributes_of(scene, ensemble.sampler, written.text, **about)
    return contents_of_kept(labelled, drawn, attributes, written.of_all)


def read_statistics(path: Path, scene: Scene) -> "Summarised":
    """Return what a file holds.

    Raises
    ------
    StoreError
        If it cannot be read.
    """
    from mcgw.ensemble.pooled import Pooled  # for those scenes alone
    from mcgw.ensemble.summarised import Summarised
    from mcgw.store.h5_reading import drawn_tables

    tables = drawn_tables(path)
    rows = range(len(tables[f"{BLOCK}n"]))
    return Summarised(scene, tuple(Pooled.from_block(tables, row) for row in rows))
