"""From a job to its file: its blocks are drawn, by whoever draws them, and merged."""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from threading import Event
from time import perf_counter
from typing import TYPE_CHECKING

from mcgw.ensemble.results import Tables
from mcgw.errors import RunError, StoppedError, StoreError, in_one_line
from mcgw.formats.files import state_of
from mcgw.formats.gate import open_h5
from mcgw.jobs.driver import By, Signals, drive, heed_signals
from mcgw.jobs.job import Job, commit_block, draw_block
from mcgw.machine.in_threads import Items
from mcgw.store.ensembles import described
from mcgw.store.h5_reading import pieces_of
from mcgw.store.h5_writing import Contents, Rows
from mcgw.store.layout import contents_of_values, read_statistics
from mcgw.store.lock import locked, parts_of
from mcgw.store.place import drop_leftovers, put, tidy
from mcgw.store.run_folder import RECORD, RunFolder, Span, remove_run

if TYPE_CHECKING:
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.sweeps.sweep import Sweep

_ROUNDS = 3  # attempts to merge, if shards turn out damaged


def make(job: Job, by: By, part: tuple[int, int] | None = None) -> int:
    """Draw what is missing of a file and make it; or of its blocks a share, for `mcgw.merge` to make it of.

    Returns
    -------
    int
        How many surfaces are then missing of the whole.

    Raises
    ------
    StoreError
        If the place belongs to something else, or the memory or the disk does not suffice.
    RunError
        If it could not be finished; what is done is kept.
    """
    job.check()
    run, total = job.record, job.total
    if job.done() < total:
        if part:
            tidy(run.path)
        with heed_signals() as signals, locked(run.folder, shared=part is not None) as new:
            by = replace(by, signals=signals)
            if not (part or new):
                drop_leftovers(run.path)
            if job.done() < total:  # no other process was faster
                try:
                    if part:
                        return _share(job, by, part)
                    one, begun = job.reducers[0], (run.folder / RECORD).exists()
                    if by.executor is None and not run.axes and total <= one.rows > 1 and not begun:
                        _at_once(job, by)
                    else:
                        _in_blocks(job, by)
                except OSError as error:
                    raise RunError(
                        f"{in_one_line(error)}; finished blocks are kept in {run.folder}; once this is "
                        "fixed, the same command resumes"
                    ) from None
                return 0
    tidy(run.path)
    by.progress(sum(one.n_surfaces * one.work for one in job.reducers))
    return 0


def _at_once(job: Job, by: By) -> None:
    """All surfaces of a scene in this thread, and their file in one step. Only with the lock."""
    run, started = job.record, perf_counter()

    def go_on(done: int) -> bool:
        by.signals.check("nothing was saved, because the run is one block; the same command starts it again")
        by.progress(done)
        return True

    by.progress(0)
    tables = job.draw(Span(0, job.total), by.threads, go_on)
    before = state_of(run.path)
    job.done()  # else the file is another's
    put(run.path, job.contents([(0, tables)], perf_counter() - started), before)


def _in_blocks(job: Job, by: By) -> None:
    """Draw missing shards, then make the file. Needs the lock."""
    started = job.record.begin()
    started.freeze()
    for _ in range(_ROUNDS):
        shards = started.sweep()
        done = job.done()
        n, wanted = max((shard.span.stop for shard in shards), default=0), started.plan.total
        if n > wanted:  # blocks beyond those requested are kept
            raise StoreError(
                f"{started.folder}: holds surfaces up to number {n} already, more than ensemble.n_surfaces = "
                f"{wanted}; ask for as many or more, or choose another -o"
            )
        _draw_missing(job, started, started.missing(done, shards), by)
        if merge_once(replace(job, record=started), by.signals):
            return
    raise RunError(f"{job.record.folder}: shards are repeatedly damaged; is the disk failing?")


def _share(job: Job, by: By, part: tuple[int, int]) -> int:
    """Draw a share of the missing blocks; return how many surfaces are still missing. Needs the lock."""
    started, done = job.record.begin(), job.done()
    missing = started.missing(done, started.shards())
    _draw_missing(job, started, missing, by, part)
    return sum(span.n for span in started.missing(done, started.shards()))


def _draw_missing(
    job: Job, started: RunFolder, spans: list[Span], by: By, part: tuple[int, int] | None = None
) -> None:
    """Draw and store every missing block, or a job's share of them: every so many-th block."""
    plan, left = started.plan, sum(span.n for span in spans)
    done = sum(map(job.work, plan.missing(spans)))
    if part:
        number, of = part
        spans = [span for span in spans if plan.number(span) % of == number - 1]
    folder, ended = str(started.folder.resolve()), Event()

    def note(span: Span, write: Callable[[], object] | None) -> None:
        nonlocal done, left
        if write:  # in this thread, while the other one draws the next block
            write()
        done, left = done + job.work(span), left - span.n
        by.progress(done)

    def go_on(_: int) -> bool:
        if ended.is_set():  # a long block does not keep an interrupted run alive
            raise StoppedError("the run has ended")
        return True

    by.progress(done)
    if by.executor:
        drive(by.executor, spans, commit_block, lambda s: (folder, s.first, s.n), note, by.signals)
    else:
        with ThreadPoolExecutor(1, thread_name_prefix="mcgw-blocks") as thread:
            try:
                how = by.threads, go_on
                drive(thread, spans, draw_block, lambda s: (folder, s.first, s.n, *how), note, by.signals, 2)
            finally:
                ended.set()
    by.signals.check(
        f"{plan.total - left} of {plan.total} surfaces are kept in {started.folder}; the same command resumes"
    )


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
        started = RunFolder.open(parts_of(path))
        job = replace(Job.again(started), record=started)
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
    remove_run(run.folder)  # what identifies the run last
    return True


def _merged(job: Job, check: Callable[[], None]) -> Contents:
    """Return what the surfaces of the file that is there, and then those of the shards, make.

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

    def pieces() -> Items[Tables]:
        if held:
            with open_h5(run.path) as file:
                yield from pieces_of(file, job.written.scene.tables if job.written else ())
        yield from (shard.tables() for shard in shards)

    if run.plan.whole or not job.written:
        return job.contents(blocks(), seconds)
    rows = Rows(run.plan.total, pieces)
    return contents_of_values(job.written, lambda _: rows, **job.about(seconds))


def _before(run: RunFolder) -> tuple[int, list[Tables], float]:
    """Of the file that is there: surfaces not drawn again, blocks of statistics, seconds that all took."""
    if run.axes or not run.path.exists():
        return 0, [], 0.0
    attributes, scene = described(run.path)
    if not run.plan.whole:
        return scene.n_surfaces, [], attributes["wall_seconds"]
    ((_, size),) = run.plan.groups
    parts = [part for part in read_statistics(run.path, scene).parts if part.n % size == 0]
    return sum(part.n for part in parts), [part.block() for part in parts], attributes["wall_seconds"]
