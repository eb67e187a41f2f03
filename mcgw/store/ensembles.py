"""Ensemble files: opened and verified; the schema stands in `mcgw.store`.

The sums of an ensemble where they lie: in its file, or in the shards of a run in progress.
"""

import re
import warnings
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Held, Results
from mcgw.errors import StoreError
from mcgw.formats.gate import open_h5
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_from, scene_text
from mcgw.store.disk import MOST_SCALE, check_trailer, parts_of, read_trailer, rewritten
from mcgw.store.layout import (
    FILETYPE,
    FORMAT,
    digest_of,
    drawn_digest,
    drawn_tables,
    file_pieces,
    scales_of,
)
from mcgw.store.run_folder import RunFolder
from mcgw.store.shards import Shard
from mcgw.store.structure import examine


def open_ensemble(path: str | Path) -> Ensemble:
    """Open an ensemble file, or the finished part of one whose run continues.

    Parameters
    ----------
    path : str or Path
        Written by `mcgw.jobs.running.run`, or by a stranger.

    Returns
    -------
    Ensemble
        Its arrays are read when needed.

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
        if run.scene.keep != "statistics":
            return Ensemble(run.scene, run.sampler, ShardResults(shards))
        from mcgw.ensemble.simulation import reducer_of  # for those scenes alone

        blocks = (shard.arrays() for shard in shards)  # each read when its turn comes
        return Ensemble(run.scene, run.sampler, reducer_of(run.scene).held(blocks))
    attributes, scene = described(path)
    if "axes" in attributes:
        raise StoreError(f"{path}: holds a sweep; mcgw.open_sweep opens it, mcgw compare and show take it")
    results: Held = FileResults(path)
    if scene.keep == "statistics":
        from mcgw.store.statistics_file import read_statistics

        results = read_statistics(path, scene)
    return Ensemble(scene, str(attributes["sampler"]), results)


def read_attributes(path: Path) -> dict[str, Any]:
    """Root attributes of an ensemble file; of a run in progress, those that are known.

    Raises
    ------
    StoreError
        If it is not an ensemble file, damaged, or of another format.
    """
    if path.exists() or not parts_of(path).is_dir():
        return described(path)[0]
    run = _run_of(path)
    seconds = sum(shard.seconds for shard in run.shards())
    known = {"versions": run.drawn_with, "commit": "unknown", "cpu": "its workers", "wall_seconds": seconds}
    return {
        **known,
        "scene": scene_text(run.scene),
        "sampler": run.sampler,
        "complete": False,
        "digest": "none until it is complete",
        "date": run.date,
    }


def unfinished_sweep(path: Path) -> RunFolder | None:
    """The folder of a sweep that is not yet in its file, if there is one."""
    if path.exists() or not (parts_of(path) / "run.toml").is_file():
        return None
    run = RunFolder.open(parts_of(path))
    return run if run.axes else None


def _run_of(path: Path) -> RunFolder:
    """The run that makes a file; one that is a single block leaves no record."""
    if not (parts_of(path) / "run.toml").exists():
        raise StoreError(f"{path}: no block of its run is finished yet")
    run = RunFolder.open(parts_of(path))
    if run.axes:
        raise StoreError(
            f"{path}: is an unfinished sweep; mcgw show prints its progress, mcgw sweep resumes it"
        )
    return run


def described(path: Path) -> tuple[dict[str, Any], Scene]:
    """Return attributes and scene of an unchanged file; one without a trailer is read through for that."""
    head = _head_of(path)
    if rewritten(path):
        status = path.stat()
        _check_rewritten(path.resolve(), path, (status.st_ino, status.st_size, status.st_mtime_ns))
    return head


def _head_of(path: Path) -> tuple[dict[str, Any], Scene]:
    """Return attributes and scene of a file whose head is unchanged."""
    answer = examine(path)
    attributes = answer["attributes"]
    _check_format(path, attributes)
    if not rewritten(path) and read_trailer(path).notes.get("head") != answer["head"]:
        raise StoreError(f"{path}: damaged (checksum mismatch of its scene, attributes or scales)")
    try:
        scene = scene_from(str(attributes["scene"]))
        for key in ("sampler", "digest", "complete", "date", "cpu", "versions", "commit"):
            attributes[key]
        float(attributes["wall_seconds"])
        if not re.fullmatch("[0-9a-f]{64}", str(attributes["digest"])):
            raise StoreError(f"{path}: its digest is invalid")
    except (KeyError, TypeError) as error:
        raise StoreError(f"{path}: an attribute is missing or of another type ({error})") from None
    except ValueError as error:
        if isinstance(error, StoreError):
            raise
        raise StoreError(f"{path}: its scene cannot be read: {str(error).splitlines()[0]}") from None
    if "axes" not in attributes:
        _check_tables(path, scene, answer["datasets"])
    return attributes, scene


@lru_cache(maxsize=32)
def _check_rewritten(path: Path, shown: Path, _state: tuple[int, int, int]) -> None:
    """Compare the numbers of a file without a trailer with their digest, once until it changes.

    Raises
    ------
    StoreError
        If they are others.
    """
    attributes = examine(path)["attributes"]
    try:
        found = _present_digest(path, attributes, scene_from(str(attributes["scene"])))
    except (OSError, RuntimeError, KeyError, ValueError) as error:
        raise StoreError(f"{shown}: damaged ({error})") from None
    if found != attributes["digest"]:
        raise StoreError(f"{shown}: damaged: it has no trailer, and its numbers are not those of its digest")
    warnings.warn(f"{shown}: was rewritten by another program; its numbers are whole", stacklevel=3)


def check_whole(path: Path) -> None:
    """Refuse a file, already opened by `described`, of which a bit has changed.

    Raises
    ------
    StoreError
        If one has; of a file that another program wrote anew, one of its numbers.
    """
    if not rewritten(path):
        check_trailer(path)


def _present_digest(path: Path, attributes: dict[str, Any], scene: Scene) -> str:
    """Return the digest of what a file holds now."""
    with open_h5(path) as file:
        if "axes" in attributes:
            return drawn_digest(drawn_tables(file), str(attributes["scene"]), str(attributes["axes"]))
        if scene.keep == "statistics":
            return drawn_digest(drawn_tables(file), scene_text(scene, left_out=False))
        return digest_of(file, scene, (arrays for _, arrays in file_pieces(file)))


def _check_format(path: Path, attributes: dict[str, Any]) -> None:
    """Refuse files that are no results, or of a format that this version does not read."""
    filetype, known = str(attributes.get("filetype", "")), attributes.get("format")
    if filetype.startswith("mcgw-") and (filetype != FILETYPE or known != list(FORMAT)):
        raise StoreError(
            f"{path}: {filetype} {known} is not read by this version, which reads {FILETYPE} {list(FORMAT)}; "
            f"run the scene in its attribute scene again"
        )
    if filetype != FILETYPE:
        raise StoreError(f"{path}: holds no results of mcgw (its filetype is not {FILETYPE!r})")


def _check_tables(path: Path, scene: Scene, datasets: dict[str, Any]) -> None:
    """The datasets must have the shapes that the scene declares, and the scales its values."""
    scales = scales_of(scene, min(scene.n_surfaces, MOST_SCALE))
    if scene.keep == "statistics":
        from mcgw.store.statistics_file import shapes_of

        del scales["surface"]
        shapes = shapes_of(scene)
    else:
        shapes = {name: [len(values)] for name, values in scales.items()} | {"surface": [scene.n_surfaces]}
        shapes |= {name: [scene.n_surfaces, *shape] for name, shape in scene.shapes.items()}
    for name, shape in shapes.items():
        if name not in datasets or datasets[name][1] != shape:
            found = datasets.get(name, ["", "none"])[1]
            raise StoreError(f"{path}: {name} has shape {found}, its scene declares {shape}")
    with open_h5(path) as file:
        for name, values in scales.items():
            if not np.array_equal(file[name][:MOST_SCALE], values[:MOST_SCALE]):
                raise StoreError(f"{path}: {name} does not hold the values that its scene declares")


def verify(path: Path) -> tuple[str, str]:
    """Damage of a finished file, and the digest of its present contents.

    The first is empty if every bit is as written.
    """
    problem = ""
    try:
        check_whole(path)
    except StoreError as error:
        problem = str(error).removeprefix(f"{path}: ")
    try:
        attributes, scene = _head_of(path)
        found = _present_digest(path, attributes, scene)
        if found != attributes["digest"]:
            problem = problem or "digest mismatch of its data"
    except (OSError, RuntimeError, KeyError, ValueError) as error:
        if not problem and not rewritten(path):
            raise
        said = str(error).removeprefix(f"{path}: ")
        return "; ".join(filter(None, [problem, said])), "unreadable"
    return problem, found


@dataclass(frozen=True)
class FileResults(Results):
    """The datasets of an ensemble file, opened for each reading."""

    path: Path

    def read(self, name: str, start: int, stop: int | None) -> NDArray[Any]:
        """Rows `start` to `stop` (None: to the end) of a dataset."""
        try:
            with open_h5(self.path) as file:
                return np.asarray(file[name][start:stop])
        except OSError:
            raise StoreError(f"{self.path}: cannot be read; is it damaged? See mcgw show --verify") from None

    def rows(self) -> int:
        """Number of surfaces."""
        with open_h5(self.path) as file:
            return int(file["surface"].shape[0])


@dataclass(frozen=True)
class ShardResults(Results):
    """The blocks that a run had committed when it was looked at."""

    shards: tuple[Shard, ...]

    def read(self, name: str, start: int, stop: int | None) -> NDArray[Any]:
        """Rows `start` to `stop` of what is there."""
        rows, parts, first = self.rows() if stop is None else stop, [], 0
        for shard in self.shards:
            low, high = max(start - first, 0), min(rows - first, shard.span.n)
            if low < high:
                parts.append(self._arrays(shard)[name][low:high])
            first += shard.span.n
        return np.concatenate(parts)

    def rows(self) -> int:
        """Number of surfaces."""
        return sum(shard.span.n for shard in self.shards)

    @staticmethod
    def _arrays(shard: Shard) -> dict[str, NDArray[Any]]:
        if not shard.path.exists():
            raise StoreError(f"{shard.path}: no longer exists; its run has ended, open the file again")
        return shard.arrays()
