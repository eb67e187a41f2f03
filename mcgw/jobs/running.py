"""From a scene to its file: begin, go on, extend, until its rule is met."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from time import monotonic, perf_counter
from typing import Any

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.forecast import checkpoints, without_rule
from mcgw.errors import RunError, StoreError
from mcgw.jobs.blocks import commit_block, draw_block
from mcgw.jobs.driver import drive
from mcgw.jobs.engines import Engine
from mcgw.jobs.job import Job, Making, as_recorded
from mcgw.jobs.merging import merge_once
from mcgw.jobs.session import By, Part, Progress, Session
from mcgw.scene.scene import Scene
from mcgw.store.ensembles import open_ensemble
from mcgw.store.leftovers import drop_leftovers, tidy
from mcgw.store.lock import locked
from mcgw.store.run_folder import RunFolder
from mcgw.store.shards import Shard, Span

__all__ = ["make", "run", "run_part"]

_ROUNDS = 3  # of merging, if shards turn out damaged


def run(
    scene: Scene,
    path: str | Path,
    *,
    threads: int | None = None,
    engine: Engine | None = None,
    progress: Progress | None = None,
) -> Ensemble:
    """As `mcgw.run`: draw the ensemble of a scene into a file; the engine is left open.

    `progress` is called with the number of surfaces that are done: at the start, and after each block. What
    a file holds already is never too much. Of a grading that is a Python function the file keeps its series
    and its name, and never the function.
    """
    path, by = Path(path), By(engine, threads, progress or _silent)
    scene = as_recorded(scene, path)
    started = monotonic()
    for stage in _stages(scene, path):
        make(Job.of(stage, path), by)
        if scene.max_seconds is not None and monotonic() - started > scene.max_seconds:
            break
    return open_ensemble(path)


def _stages(scene: Scene, path: Path) -> Iterator[Scene]:
    """The scene with a number of surfaces in place of its rules; with `max_seconds`, ever more of them."""
    if scene.rel_err is None and scene.max_seconds is None:
        yield scene
        return
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


def make(making: Making, by: By, part: Part | None = None) -> int:
    """Draw what is missing of a file and make it; or of its blocks a share, for `mcgw.merge` to make it of.

    Returns
    -------
    int
        How many surfaces are then missing of the whole.
    """
    total, blocks = making.plan.total, making.plan.missing([])
    if making.done() < total:
        if part:
            tidy(making.path)
        with by.at_work() as session, locked(making.folder, shared=part is not None):
            if not part:
                drop_leftovers(making.path)
            if making.done() < total:  # no other process was quicker
                return _make(making, session, part, at_once=by.engine is None and len(blocks) == 1)
    tidy(making.path)
    by.progress(sum(map(making.work, blocks)))
    return 0


def _make(making: Making, session: Session, part: Part | None, *, at_once: bool) -> int:
    """Only with the lock."""
    with _what_is_kept(making):
        if part:
            started, done = making.record.begin(), making.done()
            _draw_missing(making, started, started.missing(done, started.shards()), session, part)
            return sum(span.n for span in started.missing(done, started.shards()))
        if at_once and not (making.folder / "run.toml").exists():
            _at_once(making, session)
        else:
            _in_blocks(making, session)
        return 0


def run_part(
    scene: Scene,
    path: str | Path,
    part: Part,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> int:
    """Draw one job's share of the blocks, and return how many surfaces are still missing of the whole.

    `mcgw.merge` makes the file once all are there, on a disk that all jobs share.
    """
    if scene.max_seconds is not None:
        raise ValueError(
            "ensemble.max_seconds: jobs that share a run end at different times; give n_surfaces"
        )
    by = By(None, threads, progress or _silent)
    scene = as_recorded(scene, Path(path))
    job = Job.of(without_rule(scene) if scene.rel_err is not None else scene, Path(path))
    return make(job, by, part)


def _silent(done: int) -> None:
    """Tell nobody."""


def _at_once(making: Making, session: Session) -> None:
    """All surfaces as one block, and their file in one step. Only with the lock."""
    answers: list[Any] = []
    started, (span,) = perf_counter(), making.plan.missing([])
    session.progress(0)
    drive(
        session.engine,
        [span],
        making.draw,
        lambda span: (span, session.threads),
        lambda _, tables: answers.append(tables),
        session.signals,
    )
    session.signals.check("nothing was kept, the run is one block; the same command starts it again")
    making.write(answers[0], perf_counter() - started)
    session.progress(making.work(span))


def _in_blocks(making: Making, session: Session) -> None:
    """Shards until none is missing, then the file. Only with the lock."""
    started = making.record.begin()
    started.freeze()
    for _ in range(_ROUNDS):
        shards = started.sweep()
        done = making.done()
        _refuse_more(started, shards)
        _draw_missing(making, started, started.missing(done, shards), session)
        if merge_once(started, making.path, session.signals):
            return
    raise RunError(f"{making.folder}: shards are damaged again and again; is the disk failing?")


@contextmanager
def _what_is_kept(making: Making) -> Iterator[None]:
    """An error of the disk, with what it leaves."""
    try:
        yield
    except OSError as error:
        raise RunError(
            f"{error.filename or making.path}: {error.strerror or error}; finished blocks are kept in "
            f"{making.folder}, the same command goes on once that is mended"
        ) from None


def _refuse_more(started: RunFolder, shards: list[Shard]) -> None:
    """Blocks beyond what is asked are not thrown away."""
    n, wanted = max((shard.span.stop for shard in shards), default=0), started.plan.total
    if n > wanted:
        raise StoreError(
            f"{started.folder}: holds surfaces up to number {n} already, more than ensemble.n_surfaces = "
            f"{wanted}; ask for as many or more, or choose another -o"
        )


def _draw_missing(
    making: Making, started: RunFolder, spans: list[Span], session: Session, part: Part | None = None
) -> None:
    """Commit every block that is missing, or of these a job's share."""
    plan, left = started.plan, sum(span.n for span in spans)
    done = sum(map(making.work, plan.missing(spans)))
    if part:
        spans = [span for span in spans if part.mine(plan.number(span))]
    folder = str(started.folder.resolve())

    def note(span: Span, _: str) -> None:
        nonlocal done, left
        done, left = done + making.work(span), left - span.n
        session.progress(done)

    session.progress(done)
    drive(
        session.engine,
        spans,
        draw_block if session.alone else commit_block,
        lambda span: (folder, span.first, span.n, session.threads),
        note,
        session.signals,
    )
    session.signals.check(
        f"{plan.total - left} of {plan.total} surfaces are kept in {started.folder}; the same command goes on"
    )
