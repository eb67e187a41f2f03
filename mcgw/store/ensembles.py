"""Ensemble files: opened and verified; the schema stands in `mcgw.store`."""

import re
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np

from mcgw.ensemble.ensemble import Ensemble
from mcgw.errors import StoreError
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_from, scene_text
from mcgw.store.head import MOST_SCALE
from mcgw.store.identity import difference, identity_of
from mcgw.store.layout import FILETYPE, FORMAT, STATISTICS, numbers, scales_of, values_digest
from mcgw.store.run_folder import RunFolder, parts_of
from mcgw.store.shards import Shard
from mcgw.store.stored import FileResults, ShardResults
from mcgw.store.trailer import check_trailer, read_trailer
from mcgw.store.untrusted import examine

if TYPE_CHECKING:
    from mcgw.ensemble.summary import Summary

__all__ = [
    "StoreError",
    "filetype_of",
    "finished",
    "open_ensemble",
    "read_attributes",
    "recorded_scene",
    "recorded_seed",
    "verify",
]


def open_ensemble(path: str | Path) -> Ensemble:
    """Open an ensemble file, or what there is of it while its run goes on.

    Parameters
    ----------
    path : str or Path
        Written by `mcgw.jobs.running.run`, or by a stranger.

    Returns
    -------
    Ensemble
        Its arrays are read when they are asked for.

    Raises
    ------
    StoreError
        If it is not an ensemble file, damaged, or of another format; or if no block is finished yet.

    Examples
    --------
    >>> import mcgw, tempfile
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     e = mcgw.run(scene, f"{folder}/demo.h5")
    ...     bool((mcgw.open_ensemble(f"{folder}/demo.h5").load == e.load).all())
    True
    """
    path = Path(path)
    if not path.exists() and parts_of(path).is_dir():
        run = _run_of(path)
        shards = tuple(run.shards())
        if not shards:
            raise StoreError(f"{path}: no block of its run is finished yet")
        if run.scene.keep == "statistics":
            return _statistics(run.scene, run.sampler, _joined(shards))
        return Ensemble(run.scene, run.sampler, ShardResults(shards))
    attributes, scene = _described(path)
    if scene.keep == "statistics":
        from mcgw.store.statistics_file import read_blocks

        return _statistics(scene, str(attributes["sampler"]), read_blocks(path))
    return Ensemble(scene, str(attributes["sampler"]), FileResults(path), _drawn_for(path, attributes))


def _joined(shards: Iterable[Shard]) -> "tuple[Summary, ...]":
    """Blocks of a run in progress, those that are there."""
    from mcgw.ensemble.summary import Summary, push

    blocks: list[Summary] = []
    for shard in shards:
        push(blocks, Summary.from_tables(shard.arrays()))
    return tuple(blocks)


def _statistics(scene: Scene, sampler: str, blocks: "tuple[Summary, ...]") -> Ensemble:
    from mcgw.ensemble.summarised import Summarised  # for those scenes alone

    return Ensemble(scene, sampler, Summarised(scene, blocks))


def _drawn_for(path: Path, attributes: dict[str, Any]) -> Scene | None:
    """The scene that the surfaces were drawn for, if the file says that it is another one."""
    if "drawn_for" not in attributes:
        return None
    try:
        return scene_from(str(attributes["drawn_for"]))
    except ValueError as error:
        raise StoreError(
            f"{path}: its attribute drawn_for cannot be read: {str(error).splitlines()[0]}"
        ) from None


def read_attributes(path: Path) -> dict[str, Any]:
    """Root attributes of an ensemble file; of a run in progress, those that are known.

    Raises
    ------
    StoreError
        If it is not an ensemble file, damaged, or of another format.
    """
    if path.exists() or not parts_of(path).is_dir():
        return _described(path)[0]
    run = _run_of(path)
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


def filetype_of(path: Path) -> str:
    """What a file says it is; empty if there is none, it says nothing, or cannot be read."""
    try:
        return str(examine(path)["attributes"].get("filetype", "")) if path.is_file() else ""
    except (StoreError, OSError):
        return ""


def _run_of(path: Path) -> RunFolder:
    """The run that makes a file; one that is a single block says nothing of itself."""
    if (parts_of(path) / "sweep").is_dir():
        raise StoreError(f"{path}: is a sweep in the making; mcgw show tells how far, mcgw sweep goes on")
    if not (parts_of(path) / "run.toml").exists():
        raise StoreError(f"{path}: no block of its run is finished yet")
    return RunFolder.open(parts_of(path))


def _described(path: Path) -> tuple[dict[str, Any], Scene]:
    """Attributes and scene of a file that are as they were written, with the datasets that they declare."""
    answer = examine(path)
    attributes = answer["attributes"]
    if attributes.get("filetype") not in (FILETYPE, STATISTICS):
        raise StoreError(f"{path}: not an ensemble file (filetype is not {FILETYPE!r})")
    try:
        major, minor = (int(part) for part in attributes["format"])
        if major != FORMAT[0]:
            raise StoreError(f"{path}: format {major}.{minor}; this version reads {FORMAT[0]}.x")
        head = read_trailer(path).notes.get("head")
        if head != answer["head"] and (head or minor):  # files of format 1.0 have none
            raise StoreError(f"{path}: damaged (checksum mismatch of its scene, attributes or scales)")
        scene = scene_from(str(attributes["scene"]))
        for key in ("sampler", "digest", "complete", "date", "cpu", "versions", "commit"):
            attributes[key]
        float(attributes["wall_seconds"])
        if not re.fullmatch("[0-9a-f]{64}", str(attributes["digest"])):
            raise StoreError(f"{path}: its digest is not one")
    except (KeyError, TypeError) as error:
        raise StoreError(f"{path}: an attribute is missing or of another type ({error})") from None
    except ValueError as error:
        if isinstance(error, StoreError):
            raise
        raise StoreError(f"{path}: its scene cannot be read: {str(error).splitlines()[0]}") from None
    if (scene.keep == "statistics") != (attributes["filetype"] == STATISTICS):
        raise StoreError(f"{path}: its filetype is {attributes['filetype']}, its scene says otherwise")
    _check_tables(path, scene, answer["datasets"])
    return attributes, scene


def _check_tables(path: Path, scene: Scene, datasets: dict[str, Any]) -> None:
    """The datasets must have the shapes that the scene declares, and the scales its values."""
    scales = scales_of(scene)
    if scene.keep == "statistics":
        from mcgw.store.statistics_file import shapes_of

        del scales["surface"]
        shapes = shapes_of(scene)
    else:
        shapes = {name: [len(values)] for name, values in scales.items()}
        shapes |= {name: [scene.n_surfaces, *shape] for name, shape in scene.shapes.items()}
    for name, shape in shapes.items():
        if name not in datasets or datasets[name][1] != shape:
            found = datasets.get(name, ["", "none"])[1]
            raise StoreError(f"{path}: {name} has shape {found}, its scene declares {shape}")
    with h5py.File(path, "r") as file:
        for name, values in scales.items():
            if not np.array_equal(file[name][:MOST_SCALE], numbers(values, MOST_SCALE)):
                raise StoreError(f"{path}: {name} does not hold the values that its scene declares")


def verify(path: Path) -> tuple[str, str]:
    """What is wrong with a finished file, and the digest of what it holds now.

    The first is empty for a file that is bit by bit as it was written.
    """
    problem = ""
    try:
        check_trailer(path)
    except StoreError as error:
        problem = str(error).removeprefix(f"{path}: ")
    try:
        attributes, scene = _described(path)
        found = _digest_now(path, scene)
        if found != attributes["digest"]:
            problem = problem or "digest mismatch of its data"
    except (OSError, RuntimeError, KeyError, ValueError) as error:
        if not problem:
            raise
        return f"{problem}; {error}", "unreadable"
    return problem, found


def _digest_now(path: Path, scene: Scene) -> str:
    if scene.keep == "statistics":
        from mcgw.store.statistics_file import found_digest

        return found_digest(path, scene)
    with h5py.File(path, "r") as file:
        return values_digest(file, scene)


def recorded_scene(path: Path) -> Scene | None:
    """Scene of the ensemble or run that is at a place, if there is one."""
    if path.is_file():
        return _described(path)[1]
    return RunFolder.open(parts_of(path)).scene if (parts_of(path) / "run.toml").is_file() else None


def recorded_seed(path: Path) -> int | None:
    """Its seed, for scenes that give none."""
    there = recorded_scene(path)
    return there.seed if there else None


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
        what = difference(there, str(attributes.get("draws", "another version")), scene, sampler)
        raise StoreError(f"{path}: holds a different ensemble: {what}; choose another -o, or remove it")
    if there.n_surfaces > scene.n_surfaces:
        raise StoreError(
            f"{path}: holds {there.n_surfaces} surfaces already, more than ensemble.n_surfaces = "
            f"{scene.n_surfaces}; ask for as many or more, or choose another -o"
        )
    if there.n_surfaces < scene.n_surfaces:
        check_trailer(path)  # it is about to be copied
    return there.n_surfaces
