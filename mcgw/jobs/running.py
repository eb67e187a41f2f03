"""``mcgw.run``: from a scene to its file: begin, resume, extend, until its stop rule is met."""

from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from threading import Event
from time import monotonic, perf_counter
from typing import Any, overload

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.forecast import checkpoints, forecast, without_rule
from mcgw.errors import RunError, StoppedError, StoreError, in_one_line
from mcgw.formats.files import state_of
from mcgw.jobs.driver import By, Part, check_how, drive, heed_signals
from mcgw.jobs.job import Job, as_recorded, commit_block, draw_block
from mcgw.jobs.merging import merge_once
from mcgw.machine.progress import Progress, told
from mcgw.scene.arguments import check_object
from mcgw.scene.scene import Scene
from mcgw.store.ensembles import FileResults, open_ensemble
from mcgw.store.lock import locked
from mcgw.store.place import drop_leftovers, put, tidy
from mcgw.store.run_folder import RunFolder
from mcgw.store.spans import Span

_ROUNDS = 3  # attempts to merge, if shards turn out damaged


@overload
def run(
    scene: Scene,
    path: str | Path,
    *,
    threads: int | None = None,
    executor: Executor | None = None,
    shard: None = None,
    progress: Progress = None,
    **changes: Any,
) -> Ensemble: ...
@overload
def run(scene: Scene, path: str | Path, *, shard: str, **others: Any) -> int: ...
def run(
    scene: Scene,
    path: str | Path,
    *,
    threads: int | None = None,
    executor: Executor | None = None,
    shard: str | None = None,
    progress: Progress = None,
    **changes: Any,
) -> Ensemble | int:
    """Draw the ensemble of a scene into a file, or resume an earlier run.

    The same call again resumes, or extends the file if the scene now has more surfaces; if the scene has
    no seed, it uses that of the file.

    Parameters
    ----------
    scene : Scene
        What to simulate; `n_surfaces` is the total, or with `rel_err` or `max_seconds` the most.
    path : str or Path
        The file; it appears when it is complete. Until then, blocks lie in ``FILE.parts/``.
    threads : int, optional
        Of this process. Default: all cores. The data are the same for any number.
    executor : concurrent.futures.Executor, optional
        What draws the blocks in place of this process, one thread a block: a pool of processes or threads,
        that of a dask client (``client.get_executor()``) or of ``mpi4py.futures``. It stays open.
    shard : str, optional
        "2/8": draw only the second of eight shares, as one of eight jobs; then `mcgw.merge`.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) surfaces.
    **changes
        Fields of the scene to change: see `mcgw.Scene.replace`.

    Returns
    -------
    Ensemble
        Reads from the file; its scene states how many surfaces `rel_err` or `max_seconds` made. With
        `shard`: the number of surfaces of the whole that are still missing.

    Raises
    ------
    SceneError, TypeError
        As from `mcgw.Scene.replace`.
    ValueError
        If another argument is wrong.
    StoreError
        If the file cannot be written there, or the place belongs to another run.
    RunError
        If the run could not be finished; what is done is kept.

    Examples
    --------
    >>> import mcgw, tempfile
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     mcgw.run(scene, f"{folder}/demo.h5").n_surfaces
    ...     mcgw.run(scene, f"{folder}/demo.h5", n_surfaces=30).n_surfaces
    20
    30
    """
    check_object("run", scene, Scene)
    path = Path(path)
    scene = scene.replace(**changes) if changes else scene
    if shard is not None and scene.max_seconds is not None:
        raise ValueError("ensemble.max_seconds: the jobs of a run end at different times; give n_surfaces")
    total = forecast(scene).surfaces if progress else 0
    part = check_how(executor, threads, shard)
    with told(progress, "surfaces") as tell:
        by = By(executor, threads, lambda done: tell(done, total))
        scene = as_recorded(scene, path)
        if part:
            return make(Job.of(without_rule(scene) if scene.rel_err is not None else scene, path), by, part)
        started = monotonic()
        ruled = scene.rel_err is not None or scene.max_seconds is not None
        for stage in _stages(scene, path) if ruled else (scene,):
            job = Job.of(stage, path)
            make(job, by)
            if scene.max_seconds is not None and monotonic() - started > scene.max_seconds:
                break
    if scene.keep == "statistics":
        return open_ensemble(path)
    return Ensemble(job.record.scene, job.record.sampler, FileResults(path))


def _stages(scene: Scene, path: Path) -> Iterator[Scene]:
    """The scene with a number of surfaces in place of its stop rules; with `max_seconds`, growing numbers."""
    held = min(open_ensemble(path).n_surfaces, scene.n_surfaces) if path.is_file() else 0
    fixed = without_rule(scene)
    last = max(fixed.n_surfaces, held)
    if scene.max_seconds is not None:
        if held:
            yield replace(fixed, n_surfaces=held)
        for n in checkpoints(last):
            if held < n < last and n >= 2 * held:
                yield replace(fixed, n_surfaces=n)
                held = n
    if held < last or scene.max_seconds is None:
        yield replace(fixed, n_surfaces=last)


def make(job: Job, by: By, part: Part | None = None) -> int:
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
    run, total = job.record, sum(one.n_surfaces for one in job.reducers)
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
                    one, begun = job.reducers[0], (run.folder / "run.toml").exists()
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
    tables = job.draw(Span(0, run.scene.n_surfaces), by.threads, go_on)
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


def _share(job: Job, by: By, part: Part) -> int:
    """Draw a share of the missing blocks; return how many surfaces are still missing. Needs the lock."""
    started, done = job.record.begin(), job.done()
    missing = started.missing(done, started.shards())
    _draw_missing(job, started, missing, by, part)
    return sum(span.n for span in started.missing(done, started.shards()))


def _draw_missing(job: Job, started: RunFolder, spans: list[Span], by: By, part: Part | None = None) -> None:
    """Draw and store every missing block, or a job's share of them."""
    plan, left = started.plan, sum(span.n for span in spans)
    done = sum(map(job.work, plan.missing(spans)))
    if part:
        spans = [span for span in spans if part.mine(plan.number(span))]
    folder = str(started.folder.resolve())

    def note(span: Span, _: object) -> None:
        nonlocal done, left
        done, left = done + job.work(span), left - span.n
        by.progress(done)

    by.progress(done)
    if by.executor:
        drive(by.executor, spans, commit_block, lambda s: (folder, s.first, s.n), note, by.signals)
    else:
        with _Overlapped(by.threads) as threads:
            drive(threads, spans, draw_block, lambda s: (folder, s.first, s.n), note, by.signals)
    by.signals.check(
        f"{plan.total - left} of {plan.total} surfaces are kept in {started.folder}; the same command resumes"
    )


class _Overlapped(Executor):
    """One thread of this process draws block after block, another one writes what is drawn."""

    in_hand = 3  # one waits, one is drawn, one is written

    def __init__(self, threads: int | None) -> None:
        self._draws, self._writes = (ThreadPoolExecutor(1, thread_name_prefix="mcgw-blocks") for _ in "12")
        self._threads, self._ended = threads, Event()

    def submit(self, attempt: Callable[..., Any], draw: Callable[..., Any], /, *block: Any) -> Future[Any]:  # type: ignore[override]
        """Submit the drawing of a block, and the writing that this returns."""
        drawn = self._draws.submit(draw, *block, self._threads, self._go_on)
        return self._writes.submit(attempt, lambda: drawn.result()())

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = True) -> None:
        """End both; a long block does not keep an interrupted run alive."""
        self._ended.set()
        for pool in (self._draws, self._writes):
            pool.shutdown(wait=wait, cancel_futures=cancel_futures)

    def _go_on(self, _: int) -> bool:
        if self._ended.is_set():
            raise StoppedError("the run has ended")
        return True
