"""The blocks of a plan: drawn by whoever draws them, and merged to its file."""

from collections.abc import Callable, Iterable
from concurrent.futures import Executor, ThreadPoolExecutor
from functools import lru_cache, partial
from pathlib import Path
from threading import Event
from time import perf_counter
from typing import TYPE_CHECKING, Any

from mcgw.ensemble.results import Labelled
from mcgw.errors import RunError, StoppedError, StoreError
from mcgw.formats.files import State, parts_of, state_of
from mcgw.jobs.executors import drive
from mcgw.machine.process import Signals, heed_signals
from mcgw.store.ensembles import described, open_results
from mcgw.store.ownership import difference, locked
from mcgw.store.place import finished, put, remove_run, tidy
from mcgw.store.run_plan import RECORD, Plan, Span, commit_shard

if TYPE_CHECKING:
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.sweeps.sweep import Sweep

Done = Callable[[float], Any]  # is told of the work that is done


def commit_block(folder: str, first: int, n: int) -> None:
    """Draw a block of a run into its folder, unless a valid shard is there: what a worker does."""
    _drawn(_prepared(folder, state_of(Path(folder) / RECORD)), Span(first, n), 1)()


@lru_cache(maxsize=1)
def _prepared(folder: str, _state: State | None) -> Plan:
    """Return the plan of a folder, kept while its record is the same: making it takes as long as a block."""
    there = Plan.open(Path(folder))
    here = Plan(there.asked, there.path)
    if here.identity != there.identity:
        why = difference(there.question, here.question)
        raise RunError(f"{folder}: this worker cannot draw for that run: {why}")
    return here


def _drawn(plan: Plan, span: Span, threads: int | None, *go_on: Done) -> Callable[[], object]:
    """Draw a block, unless it is there; what this returns writes it, to be done while the next is drawn."""
    path = plan.shard_path(span)
    if (held := plan.shard(path)) and held[0].n >= span.n:
        return lambda: None
    started = perf_counter()
    tables = plan.draw(span, threads, *go_on)
    return partial(commit_shard, path, plan.identity, span, tables, perf_counter() - started)


def in_blocks(
    plan: Plan,
    executor: Executor | None,
    threads: int | None,
    part: tuple[int, int] | None,
    progress: Done,
    signals: Signals,
) -> int:
    """Draw missing shards, every so many-th of a share; then make the file, but of a share. With the lock."""
    plan.begin()
    shards, done = plan.shards(), finished(plan)
    n = max((span.stop for span in shards), default=0)
    if n > plan.total and not part:  # blocks beyond those requested are kept
        raise StoreError(
            f"{plan.folder}: holds surfaces up to number {n} already, more than ensemble.n_surfaces = "
            f"{plan.total}; ask for as many or more, or choose another -o"
        )

    def work(spans: Iterable[Span]) -> float:
        return sum(span.n * plan.reducers[plan.blocks[span][0]].work for span in spans)

    spans = plan.missing(done, shards)
    left, worked = sum(span.n for span in spans), work(plan.blocks) - work(spans)
    if part:
        own = set(list(plan.blocks)[part[0] - 1 :: part[1]])
        spans = [span for span in spans if span in own]

    def note(span: Span, write: Callable[[], object] | None) -> None:
        nonlocal left, worked
        if write:  # in this thread, while the other one draws the next block
            write()
        left, worked = left - span.n, worked + work([span])
        progress(worked)

    progress(worked)
    if executor:
        folder = str(plan.folder.resolve())
        drive(executor, spans, commit_block, lambda span: (folder, span.first, span.n), note, signals)
    else:
        _by_a_thread(plan, spans, threads, note, signals)
    signals.check(
        f"{plan.total - left} of {plan.total} surfaces are kept in {plan.folder}; the same command resumes"
    )
    if part:
        return sum(span.n for span in plan.missing(done, plan.shards()))
    make_file(plan, signals)
    return 0


def _by_a_thread(
    plan: Plan, spans: list[Span], threads: int | None, note: Callable[[Span, Any], None], signals: Signals
) -> None:
    """Draw blocks, one after the other, in a thread that ends within a block when this one ends."""
    ended = Event()

    def go_on(_: float) -> bool:
        if ended.is_set():
            raise StoppedError("the run has ended")
        return True

    with ThreadPoolExecutor(1, thread_name_prefix="mcgw-blocks") as thread:
        try:
            drive(thread, spans, _drawn, lambda span: (plan, span, threads, go_on), note, signals, in_hand=2)
        finally:
            ended.set()


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
    path = Path(path)
    tidy(path)
    if not parts_of(path).exists() and path.exists():
        return open_results(path)
    if not parts_of(path).exists():
        raise StoreError(f"{path}: neither this file nor its blocks ({parts_of(path)}) exist")
    with heed_signals() as signals, locked(parts_of(path)):
        plan = Plan.open(parts_of(path))
        gaps = plan.missing(finished(plan), plan.shards())
        if gaps:
            raise RunError(
                f"{path}: {sum(span.n for span in gaps)} of {plan.total} surfaces are missing, "
                f"from {gaps[0].first} on; run the jobs that make them again"
            )
        make_file(plan, signals)
    return open_results(path)


def make_file(plan: Plan, signals: Signals) -> None:
    """Make the file of the shards, and remove them. Only with the lock."""

    def check() -> None:
        signals.check(f"all blocks are kept in {plan.folder}; the same command merges them")

    finished(plan)  # a file of another run is no damaged shard
    try:
        put(plan, lambda: _merged(plan, check), check)
    except StoreError as error:
        raise RunError(
            f"{plan.folder}: a shard is damaged; run the jobs again to redraw it ({error})"
        ) from None
    remove_run(plan.folder)  # what identifies the run last


def _merged(plan: Plan, check: Callable[[], None]) -> Labelled:
    """Return what the surfaces of the file that is there, and then those of the shards, make."""
    held, seconds = 0, 0.0
    if not plan.axes and plan.path.exists():
        attributes, there = described(plan.path)
        held, seconds = plan.kept(there.n_surfaces), attributes["wall_seconds"]
    # Their numbers are compared with their checksums when they are read.
    shards = {span: took for span, took in plan.shards(numbers=False).items() if span.first >= held}
    if [held, *(span.stop for span in shards)] != [*(span.first for span in shards), plan.total]:
        raise StoreError(f"{plan.folder}: blocks are missing")
    seconds += sum(shards.values())
    return plan.contents(plan.held(shards, held, check), seconds)
