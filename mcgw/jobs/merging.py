"""Merge the blocks of a run into its file."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from mcgw.ensemble.results import Tables
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import state_of
from mcgw.formats.gate import open_h5
from mcgw.jobs.driver import Signals, heed_signals
from mcgw.jobs.job import Job
from mcgw.machine.in_threads import Items
from mcgw.store.disk import parts_of
from mcgw.store.ensembles import described
from mcgw.store.h5_file import Contents, Rows, pieces_of
from mcgw.store.layout import contents_of_values
from mcgw.store.lock import locked
from mcgw.store.place import put, tidy
from mcgw.store.run_folder import RunFolder

if TYPE_CHECKING:
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.sweeps.sweep import Sweep


def merge(path: str | Path) -> "Ensemble | Sweep":
    """Merge the blocks of a finished run or sweep into its file.

    Parameters
    ----------
    path : str or Path
        The file to be.

    Returns
    -------
    Ensemble or Sweep
        That reads from it.

    Raises
    ------
    StoreError
        If there is no such run.
    RunError
        If blocks are missing, or the disk does not take the file.

    Examples
    --------
    >>> import mcgw, tempfile
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> over = {"ensemble.n_asperities": [100, 200]}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     missing = [mcgw.run(scene, f"{folder}/demo.h5", shard=f"{i}/2") for i in (1, 2)]
    ...     missing[-1], mcgw.merge(f"{folder}/demo.h5").n_surfaces
    ...     missing = [mcgw.sweep(scene, over, path=f"{folder}/n.h5", shard=f"{i}/2") for i in (1, 2)]
    ...     missing, mcgw.merge(f"{folder}/n.h5").shape
    (0, 20)
    ([20, 0], (2,))
    """
    from mcgw.sweeps import open_results  # not needed by a run that merges its own blocks

    path = Path(path)
    tidy(path)
    if not parts_of(path).exists():
        if path.exists():
            return open_results(path)
        raise StoreError(f"{path}: neither this file nor its blocks ({parts_of(path)}) exist")
    with heed_signals() as signals, locked(parts_of(path)):
        job = Job.begun(RunFolder.open(parts_of(path)))
        started = job.record
        gaps = started.missing(job.done(), started.sweep())
        if gaps:
            raise RunError(
                f"{path}: {sum(span.n for span in gaps)} of {started.plan.total} surfaces are missing, "
                f"from {gaps[0].first} on; run the jobs that make them again"
            )
        if not merge_once(job, signals):
            raise RunError(f"{started.folder}: a shard is damaged; run the jobs again to redraw it")
    return open_results(path)


def merge_once(job: Job, signals: Signals) -> bool:
    """Make the file and remove the shards; False if a shard turned out damaged. Only with the lock."""
    run, before = job.record, state_of(job.record.path)
    job.done()

    def check() -> None:
        signals.check(f"all blocks are kept in {run.folder}; the same command merges them")

    try:
        put(run.path, _merged(job, check), before, check)
    except StoreError:
        return False
    run.remove()
    return True


def _merged(job: Job, check: Callable[[], None]) -> Contents:
    """What the surfaces of the file that is there, and then those of the shards, make.

    Raises
    ------
    StoreError
        If a shard is missing or damaged.
    """
    run = job.record
    held, before, seconds = _before(run)
    shards = [shard for shard in run.shards(numbers=False) if shard.span.first >= held]
    ends = [held, *(shard.span.stop for shard in shards)]
    if ends != [*(shard.span.first for shard in shards), run.plan.total]:
        raise StoreError(f"{run.folder}: blocks are missing")
    seconds += sum(shard.seconds for shard in shards)

    def blocks() -> Iterator[tuple[int, Tables]]:
        yield from ((0, block) for block in before)
        for shard in shards:
            check()
            yield run.plan.group(shard.span)[0], shard.tables()

    def pieces(name: str) -> Items[NDArray[Any]]:
        if held:
            with open_h5(run.path) as file:
                yield from pieces_of(file[name])
        for shard in shards:
            yield shard.tables(name)[name]

    if run.plan.whole:
        return job.contents(blocks(), seconds)

    def rows(name: str) -> Rows:
        return Rows(run.plan.total, partial(pieces, name))

    return contents_of_values(run.scene, run.sampler, rows, **job.about(seconds))


def _before(run: RunFolder) -> tuple[int, list[Tables], float]:
    """Of the file that is there: surfaces not drawn again, blocks of statistics, seconds that all took."""
    if run.axes or not run.path.exists():
        return 0, [], 0.0
    attributes, scene = described(run.path)
    if not run.plan.whole:
        return scene.n_surfaces, [], attributes["wall_seconds"]
    from mcgw.store.statistics_file import read_statistics  # for those scenes alone

    ((_, size),) = run.plan.groups
    parts = [part for part in read_statistics(run.path, scene).parts if part.n % size == 0]
    return sum(part.n for part in parts), [part.block() for part in parts], attributes["wall_seconds"]
