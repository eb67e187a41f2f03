"""Sweeps as HDF5 files: written in one step, opened and checked.

The schema (``filetype = "mcgw-sweep"``, ``format = [1, 0]``)::

    /                     attributes: filetype, format, title, scene (TOML text of the scene that all points
                          come from), axes (JSON), digest, run, draws, versions, commit, date, cpu,
                          wall_seconds
    /point                int64 (points,)                 dimension scale: the last axis fastest
    /separation           float64 (separations,)          dimension scale: d/sigma
    /load_mean, /load_std float64 (points, separations) N (and so on for each quantity)
    /KEY                  float64 (points,)               values of an axis, if they are numbers

and in ``/drawn``, from which the statistics follow::

    /drawn/groups         int64 (groups, 2)               surfaces drawn, and scenes computed, of each group
    /drawn/points         int64 (points, 3)               group, and one or two scenes of it (-1: one)
    /drawn/weights        float64 (points, 2)             of these, for what the modulus enters
    /drawn/edges          float64 (edges, 2)              group, and edge that its points got from others
    /drawn/load_means     float64 (scenes, separations)   of all groups, one after the other
    /drawn/load_products  float64 (pairs, separations)    sums of products of deviations, all pairs of each

`digest` is over the scene, the axes and ``/drawn``; `run` over all that they depend on: scene, axes and the
versions in `draws`. After the HDF5 data stands a trailer, as in the files of ensembles.
"""

import hashlib
import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from mcgw.errors import StoreError
from mcgw.formats.files import write_whole
from mcgw.formats.toml_text import loads
from mcgw.sampling.samplers import name_of
from mcgw.scene.section import SceneError
from mcgw.store.arithmetic import drawn_with
from mcgw.store.chunks import PACKED
from mcgw.store.head import head_digest
from mcgw.store.provenance import now, provenance
from mcgw.store.shards import content_digest, in_memory
from mcgw.store.structure import check_plain
from mcgw.store.trailer import read_trailer, trailer_of
from mcgw.store.untrusted import examine
from mcgw.sweeps.asked import Asked
from mcgw.sweeps.axes import Axes
from mcgw.sweeps.groups import Place
from mcgw.sweeps.points import Points
from mcgw.sweeps.pooled import Pooled
from mcgw.sweeps.sweep import STATISTICS, Sweep

__all__ = ["FILETYPE", "identity_of", "open_sweep", "read_attributes", "write_sweep"]

FILETYPE, FORMAT = "mcgw-sweep", (1, 0)

Tables = dict[str, NDArray[Any]]


def identity_of(asked: Asked) -> str:
    """SHA-256 of all that the numbers of a sweep depend on: scene, axes, what draws."""
    return hashlib.sha256("\0".join((*asked.texts(), _draws(asked))).encode()).hexdigest()


def _draws(asked: Asked) -> str:
    """Versions that draw, and the kind of processor if any point depends on it."""
    known = {drawn_with(scene, name_of(scene)) for group in asked.groups for scene in group.computed}
    return max(known, key=len)


def write_sweep(asked: Asked, pooled: Sequence[Pooled], path: Path, *, wall_seconds: float) -> None:
    """Write the file of a sweep in one atomic step, over none.

    Raises
    ------
    OSError
        If it cannot be written, or another file has this name.
    """
    sweep = asked.answered(pooled, STATISTICS)
    scene, axes = asked.texts()
    drawn = _drawn(sweep)

    def fill(file: h5py.File) -> None:
        _lay_out(file, sweep)
        for name, values in drawn.items():
            file.create_dataset(f"drawn/{name}", data=values, **_packed(values))
        file.attrs.update(
            filetype=FILETYPE,
            format=FORMAT,
            title=sweep.scenes[0].title,
            scene=scene,
            axes=axes,
            digest=_digest(scene, axes, drawn),
            run=identity_of(asked),
            draws=_draws(asked),
            date=now(),
            wall_seconds=wall_seconds,
            **provenance(),
        )

    body = in_memory(fill)
    with h5py.File(io.BytesIO(body), "r") as file:
        head = head_digest(file, check_plain(file))
    write_whole(path, (body, trailer_of(body, head=head)), expected=None)


def _lay_out(file: h5py.File, sweep: Sweep) -> None:
    """What other programs read: statistics by point and separation."""
    _scale(file, "point", np.arange(sweep.axes.size), "number of the point")
    _scale(file, "separation", sweep.separations, "mean-plane separation d/sigma")
    for key in sweep.axes.keys:
        values = [sweep.axes.at(point)[key] for point in sweep.axes.points()]
        if all(isinstance(value, int | float) for value in values):
            data = file.create_dataset(key, data=np.array(values, dtype=np.float64))
            data.dims[0].attach_scale(file["point"])
    for name in sweep.quantities:
        for kind in STATISTICS:
            values = getattr(sweep, kind)(name)
            values = values.reshape(sweep.axes.size, *values.shape[len(sweep.shape) :])
            data = file.create_dataset(f"{name}_{kind}", data=values, **_packed(values))
            data.attrs.update(units=quantity_of(name).unit, long_name=f"{kind} of {name}")
            for axis, scale in enumerate(("point", "separation")):
                data.dims[axis].attach_scale(file[scale])


def _scale(file: h5py.File, name: str, values: NDArray[Any], long_name: str) -> None:
    scale = file.create_dataset(name, data=values)
    scale.attrs.update(units="1", long_name=long_name)
    scale.make_scale(name)


def _packed(values: NDArray[Any]) -> dict[str, Any]:
    return dict(PACKED) if values.size else {}


def _drawn(sweep: Sweep) -> Tables:
    """All that the statistics follow from."""
    size = [len(next(iter(one.means.values()))) for one in sweep.groups]
    points = [(place.group, *place.scenes, -1)[:3] for place in sweep.places]
    weights = [(*place.weights, 0.0)[:2] for place in sweep.places]
    edges = [(g, s) for g, some in enumerate(sweep.edges) for s in some]
    tables: Tables = {
        "groups": np.array([(one.n, n) for one, n in zip(sweep.groups, size, strict=True)], dtype=np.int64),
        "points": np.array(points, dtype=np.int64),
        "weights": np.array(weights, dtype=np.float64),
        "edges": np.array(edges, dtype=np.float64).reshape(-1, 2),
    }
    for one in map(Pooled.tables, sweep.groups):
        for name, values in one.items():
            if name != "n":
                tables[name] = np.concatenate([tables[name], values]) if name in tables else values
    return tables


def _digest(scene: str, axes: str, drawn: Tables) -> str:
    return hashlib.sha256("\0".join((scene, axes, content_digest(drawn))).encode()).hexdigest()


def read_attributes(path: Path) -> dict[str, Any]:
    """Root attributes of the file of a sweep.

    Raises
    ------
    StoreError
        If it is none, damaged, or of another format.
    """
    answer = examine(path)
    attributes: dict[str, Any] = answer["attributes"]
    if attributes.get("filetype") != FILETYPE:
        raise StoreError(f"{path}: not the file of a sweep (filetype is not {FILETYPE!r})")
    if attributes["format"][0] != FORMAT[0]:
        raise StoreError(f"{path}: format {attributes['format']}; this version reads {FORMAT[0]}.x")
    if read_trailer(path).notes.get("head") != answer["head"]:
        raise StoreError(f"{path}: damaged (checksum mismatch of its scene, attributes or scales)")
    return attributes


def open_sweep(path: str | Path, statistics: tuple[str, ...] = STATISTICS) -> Sweep:
    """Open the file of a sweep.

    Parameters
    ----------
    path : str or Path
        Written by `mcgw.sweep`.
    statistics : tuple of {"mean", "std"}, optional
        What `Sweep.to_xarray` tells.

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
    try:
        with h5py.File(path, "r") as file:
            drawn = {name: data[()] for name, data in file["drawn"].items()}
        if _digest(said["scene"], said["axes"], drawn) != said["digest"]:
            raise StoreError(f"{path}: damaged (digest mismatch of its data)")
        axes, document = Axes.from_text(said["axes"]), loads(said["scene"])
        groups = tuple(_groups(drawn))
        group, height = drawn["edges"].T
        edges = tuple(tuple(height[group == g].tolist()) for g in range(len(groups)))
        places = tuple(_place(*row) for row in zip(drawn["points"], drawn["weights"], strict=True))
        of_points = [(groups[place.group].n, edges[place.group]) for place in places]
        return Sweep(axes, Points(document, axes, of_points), places, groups, edges, statistics)
    except (OSError, RuntimeError, KeyError, IndexError, TypeError, ValueError) as error:
        if isinstance(error, StoreError):
            raise
        what = error.problems[0] if isinstance(error, SceneError) else error
        raise StoreError(f"{path}: damaged, or of another version ({what})") from None


def _place(point: NDArray[np.int64], weights: NDArray[np.float64]) -> Place:
    some = point[1:] >= 0
    return Place(int(point[0]), point[1:][some], weights[some])


def _groups(drawn: Tables) -> Iterator[Pooled]:
    """What is kept of each group, out of the rows of all."""
    first = pair = 0
    for n, scenes in drawn["groups"].tolist():
        tables: Tables = {"n": np.array([n])}
        for name, values in drawn.items():
            if name.endswith("_means"):
                tables[name] = values[first : first + scenes]
            elif name.endswith("_products"):
                tables[name] = values[pair : pair + scenes**2]
        yield Pooled.from_tables(tables)
        first, pair = first + scenes, pair + scenes**2
