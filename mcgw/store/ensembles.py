"""Files of results, opened and verified: ensembles, sweeps, and what a run in progress has so far.

The sums of an ensemble where they lie: in its file, or in the blocks of a run in progress.
"""

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import GROUP
from mcgw.errors import StoreError
from mcgw.formats.files import parts_of
from mcgw.formats.named_files import open_regular
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_from
from mcgw.store.h5_reading import look, read_tables
from mcgw.store.h5_writing import RUN_TYPE
from mcgw.store.run_plan import RECORD, Plan, in_files

if TYPE_CHECKING:
    from mcgw.sweeps.sweep import Sweep

LARGE = 2**30  # bytes of a file, from which on its numbers are compared with their checksums on request alone


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
    found = open_results(Path(path))
    if not isinstance(found, Ensemble):
        raise StoreError(f"{path}: holds a sweep; mcgw.open_sweep opens it, mcgw compare and show take it")
    return found


def described(path: Path) -> tuple[dict[str, Any], Scene]:
    """Attributes and scene of a file, looked at once until it changes; of a sweep what its points come from.

    The numbers of a file of a gibibyte or more are not compared with their checksums.
    """
    with open(open_regular(path), "rb") as file:
        head, size = file.read(512), file.seek(0, 2)
    if path.suffix == ".toml" and b"\0" not in head:
        raise StoreError(f"{path}: is not a file of results; make one from a scene with mcgw run {path}")
    status = path.stat()
    return _described(path.resolve(), path, (status.st_ino, size, status.st_mtime_ns))


@lru_cache(maxsize=32)
def _described(_: Path, shown: Path, state: tuple[int, int, int]) -> tuple[dict[str, Any], Scene]:
    attributes = {**look(shown, numbers=state[1] < LARGE), "complete": True}
    try:
        return attributes, scene_from(str(attributes["scene"]))
    except ValueError as error:
        raise StoreError(f"{shown}: its scene cannot be read: {str(error).splitlines()[0]}") from None


def open_sweep(path: str | Path) -> "Sweep":
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
    found = open_results(Path(path))
    if isinstance(found, Ensemble):
        raise StoreError(f"{path}: not the file of a sweep; mcgw.open_ensemble opens it")
    return found


def open_results(path: Path) -> "Ensemble | Sweep":
    """Open an ensemble, a sweep or a run in progress; errors as of `open_ensemble` and `open_sweep`."""
    if (plan := unfinished(path)) is not None:
        if plan.axes:
            raise StoreError(
                f"{path}: is an unfinished sweep; mcgw show prints its progress, mcgw sweep resumes it"
            )
        if not (shards := plan.shards()):
            raise StoreError(f"{path}: no block of its run is finished yet")
        return Ensemble(plan.scene, plan.sampler, *plan.held(shards))
    attributes, scene = described(path)
    if "axes" in attributes:
        from mcgw.sweeps.points import sweep_of  # imports the samplers

        return sweep_of(attributes["scene"], attributes["axes"], read_tables(path, GROUP))
    sampler = str(attributes["sampler"])
    if scene.keep == "statistics":
        from mcgw.ensemble.pooled import Summarised, pooled_from  # for those scenes alone

        return Ensemble(scene, sampler, Summarised(scene.tables, pooled_from(read_tables(path, GROUP))))
    return Ensemble(scene, sampler, in_files([(path, scene.n_surfaces)], scene.tables))


def read_attributes(path: Path) -> dict[str, Any]:
    """Root attributes of a file of results; of a run in progress, those that are known."""
    plan = unfinished(path)
    if plan is None:
        return described(path)[0]
    said = look(plan.folder / RECORD, RUN_TYPE)
    seconds = sum(plan.shards().values())
    known = {"versions": plan.drawn_with, "commit": "unknown", "cpu": "its workers", "wall_seconds": seconds}
    known |= {"complete": False, "digest": "none until it is complete"}
    return {**{key: said[key] for key in ("scene", "sampler", "date")}, **known}


def unfinished(path: Path) -> Plan | None:
    """Return the run or sweep that makes a file which is not there yet, if there is one."""
    if path.exists() or not parts_of(path).is_dir():
        return None
    if not (parts_of(path) / RECORD).exists():  # one that is a single block leaves none
        raise StoreError(f"{path}: no block of its run is finished yet")
    return Plan.open(parts_of(path))


def verify(path: Path) -> tuple[str, str]:
    """Damage of a finished file, and its digest; the first is empty if every number is as it was written."""
    try:
        return "", str(look(path)["digest"])
    except StoreError as error:
        return str(error).removeprefix(f"{path}: "), "unreadable"
