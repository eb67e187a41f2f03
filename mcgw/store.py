"""Ensembles as HDF5 files, and the runs that make them.

A file appears whole or not at all. Its schema (``filetype = "mcgw-ensemble"``, ``format = [1, 0]``)::

    /                     attributes: filetype, format, title, scene (TOML text of the resolved scene),
                          seed, sampler, complete, digest, versions, draws, run, commit, date, cpu,
                          wall_seconds
    /surface              int64 (surfaces,)               dimension scale: numbers of the surfaces
    /separation           float64 (separations,)          dimension scale: d/sigma
    /load                 float64 (surfaces, separations) N
    /area                 float64 (surfaces, separations) m^2
    /stiffness            float64 (surfaces, separations) N/m
    /contacts             int64   (surfaces, separations) 1   (float64 expectation if stratified)
    /conductance          float64 (surfaces, separations) m   (times 1/rho)

and, if the scene says ``keep = "moments"``, what `mcgw.regrade` starts from::

    /drawn/moments        float64 (surfaces, moments)     sums of Chebyshev polynomials, cell by cell
    /drawn/cells          float64 (surfaces, cells)       asperities in each cell
    /drawn/extras         float64 (extras, 3)             surface, height, weight of those outside

Every dataset has the attributes `units` and `long_name`; only quantities that the scene asks for are
there. Chunked, shuffled, compressed with gzip. `digest` is over scene and data, `run` over what the
numbers of a surface depend on (scene but for the number of surfaces, sampler, and the versions in
`draws`). After the HDF5 data stand 512 bytes, the seal (`mcgw.seal`), with the digest of the file's bytes.

A run that fits one block is written in one atomic step. Any other grows as shards in ``FILE.parts/``
(`mcgw.rundir`), which are merged at the end (`mcgw.merge`) and then removed.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from mcgw.disk import check_output, remove_stale, write_whole
from mcgw.ensemble import Ensemble
from mcgw.errors import RunError, StoreError
from mcgw.guard import examine, examine_all
from mcgw.layout import FILETYPE, FORMAT, build, values_digest, where
from mcgw.provenance import versions
from mcgw.rundir import Run, difference, identity_of, parts_of
from mcgw.scene import Scene
from mcgw.scene_file import scene_from, scene_text
from mcgw.seal import check_seal, seal_of
from mcgw.shards import DRAWN, RAGGED, Shard, Span

__all__ = [
    "StoreError",
    "finished",
    "open_ensemble",
    "read_attributes",
    "recorded_seed",
    "save",
    "verify",
]


@dataclass(frozen=True)
class FileSums:
    """The datasets of an ensemble file, opened for each reading."""

    path: Path

    def read(self, name: str, start: int, stop: int | None) -> NDArray[Any]:
        """Rows `start` to `stop` (None: to the end) of a dataset."""
        try:
            with h5py.File(self.path, "r") as file:
                return np.asarray(file[where(name)][start:stop])
        except OSError:
            raise StoreError(f"{self.path}: cannot be read; is it damaged? See mcgw show --verify") from None

    def rows(self) -> int:
        """Number of surfaces."""
        with h5py.File(self.path, "r") as file:
            return int(file["surface"].shape[0])


@dataclass(frozen=True)
class ShardSums:
    """The blocks that a run had committed when it was looked at."""

    shards: tuple[Shard, ...]

    def read(self, name: str, start: int, stop: int | None) -> NDArray[Any]:
        """Rows `start` to `stop` of what is there; of the ragged table all."""
        rows, parts, first = self.rows() if stop is None else stop, [], 0
        for shard in self.shards:
            low, high = max(start - first, 0), min(rows - first, shard.span.n)
            if name == RAGGED:
                parts.append(self._arrays(shard)[name])
            elif low < high:
                parts.append(self._arrays(shard)[name][low:high])
            first += shard.span.n
        return np.concatenate(parts)[slice(start, stop) if name == RAGGED else slice(None)]

    def rows(self) -> int:
        """Number of surfaces."""
        return sum(shard.span.n for shard in self.shards)

    @staticmethod
    def _arrays(shard: Shard) -> dict[str, NDArray[Any]]:
        if not shard.path.exists():
            raise StoreError(f"{shard.path}: is gone; its run has ended, open the file again")
        return shard.arrays()


def open_ensemble(path: str | Path) -> Ensemble:
    """Open an ensemble file, or what there is of it while its run goes on.

    Parameters
    ----------
    path : str or Path
        Written by `mcgw.running.run`. It may come from a stranger: a child process looks at it first.

    Returns
    -------
    Ensemble
        Its arrays are read when they are asked for.

    Raises
    ------
    StoreError
        If it is no ensemble file, damaged, or of another format; or if no block is finished yet.
    """
    path = Path(path)
    if not path.exists() and parts_of(path).is_dir():
        run = Run.open(parts_of(path))
        shards = tuple(run.shards())
        if not shards:
            raise StoreError(f"{path}: no block of its run is finished yet")
        examine_all([shard.path for shard in shards])
        return Ensemble(run.scene, run.sampler, ShardSums(shards))
    attributes, scene = _described(path)
    return Ensemble(scene, str(attributes["sampler"]), FileSums(path))


def read_attributes(path: Path) -> dict[str, Any]:
    """Root attributes of an ensemble file; of a run in progress, those that are known.

    Raises
    ------
    StoreError
        If it is no ensemble file, damaged, or of another format.
    """
    if path.exists() or not parts_of(path).is_dir():
        return _described(path)[0]
    run = Run.open(parts_of(path))
    seconds = sum(shard.seconds for shard in run.shards())
    known = {"versions": run.drawn_with, "commit": "unknown", "cpu": "its workers", "wall_seconds": seconds}
    return {
        **known,
        "scene": scene_text(run.scene),
        "sampler": run.sampler,
        "complete": False,
        "digest": "none before it is complete",
        "date": run.date,
    }


def _described(path: Path) -> tuple[dict[str, Any], Scene]:
    """Attributes and scene of a file whose datasets are those that its scene declares."""
    answer = examine(path)
    attributes, datasets = answer["attributes"], answer["datasets"]
    if attributes.get("filetype") != FILETYPE:
        raise StoreError(f"{path}: not an ensemble file (filetype is not {FILETYPE!r})")
    try:
        major, minor = (int(part) for part in attributes["format"])
        if major != FORMAT[0]:
            raise StoreError(f"{path}: format {major}.{minor}; this version reads {FORMAT[0]}.x")
        scene = scene_from(str(attributes["scene"]))
        for key in ("sampler", "digest", "complete", "date", "cpu", "versions", "commit"):
            attributes[key]
        float(attributes["wall_seconds"])
    except (KeyError, TypeError) as error:
        raise StoreError(f"{path}: an attribute is missing or of another type ({error})") from None
    except ValueError as error:
        if isinstance(error, StoreError):
            raise
        raise StoreError(f"{path}: its scene is none: {str(error).splitlines()[0]}") from None
    shapes = {"surface": [scene.n_surfaces], "separation": [len(scene.separations)]}
    shapes |= {name: [scene.n_surfaces, len(scene.separations)] for name in scene.quantities}
    for name, shape in shapes.items():
        if name not in datasets or datasets[name][1] != shape:
            found = datasets.get(name, ["", "none"])[1]
            raise StoreError(f"{path}: {name} has shape {found}, its scene declares {shape}")
    return attributes, scene


def verify(path: Path) -> tuple[str, str]:
    """What is wrong with an ensemble file, and the digest of what it holds now.

    Parameters
    ----------
    path : Path
        A finished file.

    Returns
    -------
    (str, str)
        The first is empty for a file that is bit by bit as it was written.
    """
    problem = ""
    try:
        check_seal(path)
    except StoreError as error:
        problem = str(error).removeprefix(f"{path}: ")
    try:
        attributes, scene = _described(path)
        with h5py.File(path, "r") as file:
            found = values_digest(file, scene)
        if found != attributes["digest"]:
            problem = problem or "its data have another digest than it says"
    except (OSError, RuntimeError, KeyError, ValueError) as error:
        if not problem:
            raise
        return f"{problem}; {error}", "unreadable"
    return problem, found


def recorded_seed(path: Path) -> int | None:
    """Seed of the ensemble or run that is at a place, for scenes that give none."""
    if path.is_file():
        return _described(path)[1].seed
    return Run.open(parts_of(path)).scene.seed if (parts_of(path) / "run.toml").is_file() else None


def finished(path: Path, scene: Scene, sampler: str) -> int:
    """Number of surfaces that a file holds of a scene; 0 if there is no file.

    Raises
    ------
    StoreError
        If the file is damaged, holds another ensemble, or more surfaces than asked for.
    """
    if not path.exists():
        return 0
    attributes, there = _described(path)
    if attributes.get("run") != identity_of(scene, sampler):
        what = difference(there, str(attributes.get("draws", "another version")), scene)
        raise StoreError(f"{path}: holds a different ensemble: {what}; choose another -o, or remove it")
    if there.n_surfaces > scene.n_surfaces:
        raise StoreError(
            f"{path}: holds {there.n_surfaces} surfaces already, more than ensemble.n_surfaces = "
            f"{scene.n_surfaces}; ask for as many or more, or choose another -o"
        )
    if there.n_surfaces < scene.n_surfaces:
        check_seal(path)  # it is about to be copied
    return there.n_surfaces


def save(ensemble: Ensemble, path: str | Path, *, wall_seconds: float = 0.0) -> Ensemble:
    """Write an ensemble that lies in memory, in one atomic step.

    Parameters
    ----------
    ensemble : Ensemble
        With all surfaces of its scene.
    path : str or Path
        The file.
    wall_seconds : float, optional
        What making it took.

    Returns
    -------
    Ensemble
        That reads from the file.

    Raises
    ------
    StoreError
        If the place cannot be written.
    RunError
        If the disk does not take it.
    """
    path, scene = Path(path), ensemble.scene
    check_output(path)
    remove_stale(path)
    names = [*scene.quantities, *(DRAWN if scene.keep == "moments" else ())]
    arrays = {name: ensemble.sums.read(name, 0, None) for name in names}
    with h5py.File("ensemble", "w-", driver="core", backing_store=False, libver=("v108", "v110")) as file:
        build(
            file,
            scene,
            ensemble.sampler,
            [(Span(0, ensemble.n_surfaces), arrays)],
            run=identity_of(scene, ensemble.sampler),
            draws=versions(of_draws=True),
            wall_seconds=wall_seconds,
        )
        file.flush()
        image = bytes(file.id.get_file_image())
    try:
        write_whole(path, (image, seal_of(image)))
    except OSError as error:
        raise RunError(
            f"{path}: cannot be written ({error.strerror or error}); make room and repeat"
        ) from None
    return open_ensemble(path)
