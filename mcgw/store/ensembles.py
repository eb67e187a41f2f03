"""Ensemble files: opened and verified; the schema stands in `mcgw.store`.

The sums of an ensemble where they lie: in its file, or in the shards of a run in progress.
"""

from dataclasses import dataclass
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
from mcgw.store.h5_reading import examine, look
from mcgw.store.layout import read_statistics
from mcgw.store.lock import parts_of
from mcgw.store.run_folder import RECORD, RunFolder, Shard


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

        blocks = (shard.tables() for shard in shards)  # each read when its turn comes
        return Ensemble(run.scene, run.sampler, reducer_of(run.scene).held(blocks))
    attributes, scene = described(path)
    if "axes" in attributes:
        raise StoreError(f"{path}: holds a sweep; mcgw.open_sweep opens it, mcgw compare and show take it")
    results: Held = FileResults(path)
    if scene.keep == "statistics":
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
    """Return the folder of a sweep that is not yet in its file, if there is one."""
    if path.exists() or not (parts_of(path) / RECORD).is_file():
        return None
    run = RunFolder.open(parts_of(path))
    return run if run.axes else None


def _run_of(path: Path) -> RunFolder:
    """Return the run that makes a file; one that is a single block leaves no record."""
    if not (parts_of(path) / RECORD).exists():
        raise StoreError(f"{path}: no block of its run is finished yet")
    run = RunFolder.open(parts_of(path))
    if run.axes:
        raise StoreError(
            f"{path}: is an unfinished sweep; mcgw show prints its progress, mcgw sweep resumes it"
        )
    return run


def described(path: Path) -> tuple[dict[str, Any], Scene]:
    """Attributes and scene of a file that is as it was written."""
    attributes = {**examine(path), "complete": True}
    try:
        return attributes, scene_from(str(attributes["scene"]))
    except ValueError as error:
        raise StoreError(f"{path}: its scene cannot be read: {str(error).splitlines()[0]}") from None


def verify(path: Path) -> tuple[str, str]:
    """Damage of a finished file, and its digest; the first is empty if every number is as it was written."""
    try:
        return "", str(look(path)["digest"])
    except StoreError as error:
        return str(error).removeprefix(f"{path}: "), "unreadable"


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
        """Return the number of surfaces."""
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
                parts.append(shard.tables(name)[name][low:high])
            first += shard.span.n
        return np.concatenate(parts)

    def rows(self) -> int:
        """Return the number of surfaces."""
        return sum(shard.span.n for shard in self.shards)
