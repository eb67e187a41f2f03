"""Sweeps as HDF5 files: written in one step, opened and checked.

The schema (that of `mcgw.store` for many scenes)::

    /                     attributes: those of `mcgw.store` (filetype, format, title, scene, seed, sampler,
                          digest, checksum, run, draws, versions, commit, date, cpu, wall_seconds), where
                          scene is what all points come from, and axes (JSON)
    /point                int64 (points,)                 dimension scale: the last axis fastest
    /separation           float64 (separations,)          dimension scale: d/sigma
    /load_mean, /load_std float64 (points, separations) N (and so on for each quantity)
    /gamma                float64 (points,)               values of an axis, if they are numbers: by the last
                                                          word of its key; the root attribute
                                                          `coordinates` lists these

and in ``/drawn``, from which the statistics follow::

    /drawn/groups         int64 (groups, 2)               surfaces drawn, and scenes computed, of each group
    /drawn/points         int64 (points, 3)               group, and one or two scenes of it (-1: one)
    /drawn/weights        float64 (points, 2)             of these, for what the modulus enters
    /drawn/load_means     float64 (scenes, separations)   of all groups, one after the other
    /drawn/load_products  float64 (pairs, separations)    sums of products of deviations, all pairs of each

`run` is over all that they depend on: scene, axes and the versions in `draws`.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mcgw.ensemble.labelled import AXES, Labelled, Variable, axis
from mcgw.ensemble.pooled import Pooled
from mcgw.ensemble.results import BLOCK, Tables
from mcgw.errors import StoreError
from mcgw.formats.named_files import loads
from mcgw.store.ensembles import read_attributes
from mcgw.store.h5_reading import drawn_tables
from mcgw.store.h5_writing import Contents
from mcgw.store.layout import attributes_of, contents_of_kept
from mcgw.store.run_folder import RunFolder
from mcgw.sweeps.axes import Axes
from mcgw.sweeps.groups import Place
from mcgw.sweeps.points import Asked, Points
from mcgw.sweeps.sweep import Sweep


def contents_of_sweep(record: RunFolder, pooled: Sequence[Pooled], **about: Any) -> Contents:
    """Those of the file of a sweep, with more attributes."""
    text, axes = record.text, record.axes
    sweep = Asked.from_texts(text, axes).answered(pooled)
    attributes = attributes_of(record.scene, "", text, axes=axes, **about)
    return contents_of_kept(_by_point(sweep), _drawn(sweep), attributes, text, axes)


def _by_point(sweep: Sweep) -> Labelled:
    """Statistics by point and separation, and numeric axes, for other programs."""
    found = sweep.labelled()
    coordinates = {name: one for name, one in found.coordinates.items() if name in AXES}
    coordinates["point"] = axis("point", np.arange(sweep.axes.size))
    for key, name in sweep.axes.names.items():
        given = [sweep.axes.at(point)[key] for point in sweep.axes.points()]
        if all(isinstance(value, int | float) for value in given):
            coordinates[name] = Variable(("point",), np.array(given, dtype=np.float64), "", key)
    variables = {
        name: replace(one, dims=("point", "separation"), values=one.values.reshape(sweep.axes.size, -1))
        for name, one in found.variables.items()
    }
    return Labelled(variables, coordinates)


def _drawn(sweep: Sweep) -> Tables:
    """Return the data behind the statistics."""
    size = [len(next(iter(one.means.values()))) for one in sweep.groups]
    points = [(place.group, *place.scenes, -1)[:3] for place in sweep.places]
    weights = [(*place.weights, 0.0)[:2] for place in sweep.places]
    tables: Tables = {
        "groups": np.array([(one.n, n) for one, n in zip(sweep.groups, size, strict=True)], dtype=np.int64),
        "points": np.array(points, dtype=np.int64),
        "weights": np.array(weights, dtype=np.float64),
    }
    blocks = [one.block() for one in sweep.groups]
    for name in filter(lambda name: name != f"{BLOCK}n", blocks[0]):
        tables[name.removeprefix(BLOCK)] = np.concatenate([block[name][0] for block in blocks])
    return tables


def open_sweep(path: str | Path) -> Sweep:
    """Open the file of a sweep.

    Parameters
    ----------
    path : str or Path
        Written by `mcgw.sweep`.

    Returns
    -------
    Sweep
        In memory; the scene of a point is made when it is asked for.

    Raises
    ------
    StoreError
        If it is not the file of a sweep, damaged, or of another format.

    Examples
    --------
    >>> import mcgw, tempfile
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     sweep = mcgw.sweep(scene, {"grading.gamma": [1.0, 2.0]}, path=f"{folder}/gamma.h5")
    ...     mcgw.open_sweep(f"{folder}/gamma.h5").shape
    (2,)
    """
    path = Path(path)
    said = read_attributes(path)
    if "axes" not in said:
        raise StoreError(f"{path}: not the file of a sweep; mcgw.open_ensemble opens it")
    drawn = drawn_tables(path)
    axes, document = Axes.from_text(said["axes"]), loads(said["scene"])
    groups = tuple(_groups(drawn))
    rows = zip(drawn["points"].tolist(), drawn["points"][:, 1:], drawn["weights"], strict=True)
    places = tuple(Place(g, some[some >= 0], w[some >= 0]) for (g, *_), some, w in rows)
    of_points = [groups[place.group].n for place in places]
    return Sweep(axes, Points(document, axes, of_points), places, groups)


def _groups(drawn: Tables) -> Iterator[Pooled]:
    """Yield data of each group, from the rows of all groups."""
    first = pair = 0
    for n, scenes in drawn["groups"].tolist():
        block: Tables = {f"{BLOCK}n": np.array([[n]])}
        for name, values in drawn.items():
            if name.endswith("_means"):
                block[BLOCK + name] = values[None, first : first + scenes]
            elif name.endswith("_products"):
                block[BLOCK + name] = values[None, pair : pair + scenes**2]
        yield Pooled.from_block(block)
        first, pair = first + scenes, pair + scenes**2
