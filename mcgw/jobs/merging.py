"""Merge the blocks of a run into its file."""

from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from mcgw.ensemble.results import Tables
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import rename_over, state_of, sync, temporary_beside, write_whole
from mcgw.jobs.driver import Signals, heed_signals
from mcgw.jobs.job import Job
from mcgw.store.disk import parts_of
from mcgw.store.lock import locked
from mcgw.store.place import tidy, whole_blocks
from mcgw.store.run_folder import RunFolder
from mcgw.store.saving import merge_into

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
    started, path = job.record, job.record.path
    temporary, before = temporary_beside(started.folder / path.name), state_of(path)
    job.done()

    def check() -> None:
        signals.check(f"all blocks are kept in {started.folder}; the same command merges them")

    try:
        if started.plan.whole:
            _merge_in_memory(job, temporary, check)
        else:
            merge_into(started, path, temporary, check)
        rename_over(temporary, path, before)
        sync(path.parent)
    except StoreError:
        return False
    except RunError:
        raise
    except FileExistsError as error:
        raise RunError(
            f"{path}: {error.strerror}; it is left as it is. All blocks are kept in {started.folder}: move "
            "that file away, the same command resumes"
        ) from None
    except (OSError, RuntimeError) as error:
        said = error.strerror if isinstance(error, OSError) else None
        why = said or next(iter(str(error).splitlines()), type(error).__name__)
        raise RunError(
            f"{path}: cannot be merged ({why}); is the disk full? All blocks are kept in {started.folder}; "
            f"the same command resumes"
        ) from None
    finally:
        with suppress(OSError):
            temporary.unlink()
    started.remove()
    return True


def _merge_in_memory(job: Job, temporary: Path, check: Callable[[], None]) -> None:
    """Write a file that holds no surfaces: of the blocks in the one that is there, then those of the shards.

    Raises
    ------
    StoreError
        If a shard is missing or damaged.
    OSError
        If the disk does not take it.
    """
    run = job.record
    before, seconds = whole_blocks(job.record.path, run)
    shards = {shard.span: shard for shard in run.shards(bodies=False)}
    spans = run.missing(sum(part.n for part in before), [])
    if lost := [span for span in spans if span not in shards]:
        raise StoreError(f"{run.folder}: {lost[0]} are missing")

    def blocks() -> Iterator[tuple[int, Tables]]:
        yield from ((0, part.block()) for part in before)
        for span in spans:
            check()
            yield run.plan.group(span)[0], shards[span].arrays()

    seconds += sum(shards[span].seconds for span in spans)
    write_whole(temporary, job.body(blocks(), seconds), expected=None)
