"""From a job to its file: its blocks are drawn, by whoever draws them, and merged."""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from threading import Event
from time import perf_counter
from typing import TYPE_CHECKING

from mcgw.ensemble.labelled import Labelled, values_of
from mcgw.ensemble.results import Tables
from mcgw.errors import RunError, StoppedError, StoreError, in_one_line
from mcgw.formats.files import state_of
from mcgw.formats.gate import open_h5
from mcgw.jobs.driver import By, Signals, drive, heed_signals
from mcgw.jobs.worker import commit_block, draw_block
from mcgw.store.blocks import Span
from mcgw.store.ensembles import described, open_results, statistics_in
from mcgw.store.h5_reading import pieces_of
from mcgw.store.h5_writing import Rows
from mcgw.store.lock import locked, parts_of
from mcgw.store.place import check_room, drop_leftovers, finished, put, tidy
from mcgw.store.run_plan import RECORD, Plan, remove_run, remove_unfinished

if TYPE_CHECKING:
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.sweeps.sweep import Sweep


def make(plan: Plan, by: By, part: tuple[int, int] | None = None) -> int:
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
    check_room(plan)
    if finished(plan) < plan.total:
        if part:
            tidy(plan.path)
        with heed_signals() as signals, locked(plan.folder, shared=part is not None) as new:
            by = replace(by, signals=signals)
            if not (part or new):
                drop_leftovers(plan.path)
            if finished(plan) < plan.total:  # no other process was faster
                try:
                    if part:
                        return _share(plan, by, part)
                    rows, begun = plan.reducers[0].rows, (plan.folder / RECORD).exists()
                    if by.executor is None and not plan.axes and plan.total <= rows > 1 and not begun:
                        _at_once(plan, by)
                    else:
                        _in_blocks(plan, by)
                except OSError as error:
                    raise RunError(
                        f"{in_one_line(error)}; finished blocks are kept in {plan.folder}; once this is "
                        "fixed, the same command resumes"
                    ) from None
                return 0
    tidy(plan.path)
    by.progress(sum(one.n_surfaces * one.work for one in plan.reducers))
    return 0


def _at_once(plan: Plan, by: By) -> None:
    """All surfaces of a scene in this thread, and their file in one step. Only with the lock."""
    started = perf_counter()

    def go_on(done: float) -> bool:
        by.signals.check("nothing was saved, because the run is one block; the same command starts it again")
        by.progress(done)
        return True

    by.progress(0)
    tables = plan.draw(Span(0, plan.total), by.threads, go_on)
    before = state_of(plan.path)
    finished(plan)  # else the file is another's
    found = plan.dataset([plan.reducers[0].held([tables])])
    put(plan, plan.contents(found.labelled(), perf_counter() - started, found._drawn()), before)


def _in_blocks(plan: Plan, by: By) -> None:
    """Draw missing shards, then make the file. Needs the lock."""
    plan.begin()
    shards, done = plan.shards(aside=True), finished(plan)
    n = max((shard.span.stop for shard in shards), default=0)
    if n > plan.total:  # blocks beyond those requested are kept
        raise StoreError(
            f"{plan.folder}: holds surfaces up to number {n} already, more than ensemble.n_surfaces = "
            f"{plan.total}; ask for as many or more, or choose another -o"
        )
    _draw_missing(plan, plan.missing(done, shards), by)
    make_file(plan, by.signals)


def _share(plan: Plan, by: By, part: tuple[int, int]) -> int:
    """Draw a share of the missing blocks; return how many surfaces are still missing. Needs the lock."""
    plan.begin(alone=False)
    done = finished(plan)
    _draw_missing(plan, plan.missing(done, plan.shards()), by, part)
    return sum(span.n for span in plan.missing(done, plan.shards()))


def _draw_missing(plan: Plan, spans: list[Span], by: By, part: tuple[int, int] | None = None) -> None:
    """Draw and store every missing block, or a job's share of them: every so many-th block."""
    left = sum(span.n for span in spans)
    done = sum(map(plan.work, plan.blocks.missing(spans)))
    if part:
        number, of = part
        spans = [span for span in spans if plan.blocks.number(span) % of == number - 1]
    folder, ended = str(plan.folder.resolve()), Event()

    def note(span: Span, write: Callable[[], object] | None) -> None:
        nonlocal done, left
        if write:  # in this thread, while the other one draws the next block
            write()
        done, left = done + plan.work(span), left - span.n
        by.progress(done)

    def go_on(_: float) -> bool:
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
        f"{plan.total - left} of {plan.total} surfaces are kept in {plan.folder}; the same command resumes"
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
    path = Path(path)
    tidy(path)
    if not parts_of(path).exists():
        if path.exists():
            return open_results(path)
        raise StoreError(f"{path}: neither this file nor its blocks ({parts_of(path)}) exist")
    with heed_signals() as signals, locked(parts_of(path)):
        remove_unfinished(parts_of(path))
        plan = Plan.open(parts_of(path))
        gaps = plan.missing(finished(plan), plan.shards(aside=True))
        if gaps:
            raise RunError(
                f"{path}: {sum(span.n for span in gaps)} of {plan.total} surfaces are missing, "
                f"from {gaps[0].first} on; run the jobs that make them again"
            )
        make_file(plan, signals)
    return open_results(path)


def make_file(plan: Plan, signals: Signals) -> None:
    """Make the file of the shards, and remove them. Only with the lock."""
    before = state_of(plan.path)
    finished(plan)

    def check() -> None:
        signals.check(f"all blocks are kept in {plan.folder}; the same command merges them")

    try:
        put(plan, _merged(plan, check), before, check)
    except StoreError as error:
        raise RunError(
            f"{plan.folder}: a shard is damaged; run the jobs again to redraw it ({error})"
        ) from None
    remove_run(plan.folder)  # what identifies the run last


def _merged(plan: Plan, check: Callable[[], None]) -> Labelled:
    """Return what the surfaces of the file that is there, and then those of the shards, make.

    Raises
    ------
    StoreError
        If a shard is missing or damaged.
    """
    held, parts, seconds = _before(plan)
    shards = [shard for shard in plan.shards(numbers=False) if shard.span.first >= held]
    ends = [held, *(shard.span.stop for shard in shards)]
    if ends != [*(shard.span.first for shard in shards), plan.total]:
        raise StoreError(f"{plan.folder}: blocks are missing")
    seconds += sum(shard.seconds for shard in shards)

    def blocks() -> Iterator[tuple[int, Tables]]:
        yield from ((0, part) for part in parts)
        for shard in shards:
            check()
            yield plan.blocks.group(shard.span)[0], shard.tables()

    def pieces() -> Iterator[Tables]:
        if held:
            with open_h5(plan.path) as file:
                yield from pieces_of(file, plan.scene.tables)
        yield from (shard.tables() for shard in shards)

    if not plan.whole:
        rows = Rows(plan.total, pieces)
        return plan.contents(values_of(plan.scene, plan.total, lambda _: rows), seconds)
    groups = zip(plan.reducers, groupby(blocks(), itemgetter(0)), strict=True)
    found = plan.dataset([one.held(tables for _, tables in some) for one, (_, some) in groups])
    return plan.contents(found.labelled(), seconds, found._drawn())


def _before(plan: Plan) -> tuple[int, list[Tables], float]:
    """Of the file that is there: surfaces not drawn again, blocks of statistics, seconds that all took."""
    if plan.axes or not plan.path.exists():
        return 0, [], 0.0
    attributes, scene = described(plan.path)
    if not plan.whole:
        return scene.n_surfaces, [], attributes["wall_seconds"]
    from mcgw.ensemble.pooled import tables_of  # for those scenes alone

    ((_, size),) = plan.blocks.groups
    parts = [part for part in statistics_in(plan.path, scene).parts if part.n % size == 0]
    return sum(part.n for part in parts), [tables_of([part]) for part in parts], attributes["wall_seconds"]
