"""From a scene to its file: begin, go on, extend, until its rule is met."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from time import monotonic, perf_counter
from typing import Any

from mcgw.ensemble.ensemble import Arrays, Ensemble
from mcgw.ensemble.forecast import checkpoints, without_rule
from mcgw.errors import RunError, StoreError
from mcgw.formats.files import check_output
from mcgw.jobs.blocks import columns, commit_block, draw, shard_size
from mcgw.jobs.disk_space import check_space
from mcgw.jobs.driver import Signals, drive, heed_signals
from mcgw.jobs.engines import Engine, Threads
from mcgw.jobs.merging import merge_once, missing_of
from mcgw.sampling.samplers import Sampler, sampler_of
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_from, scene_text
from mcgw.store.ensembles import finished, open_ensemble, write_ensemble
from mcgw.store.leftovers import drop_leftovers, tidy
from mcgw.store.lock import locked
from mcgw.store.run_folder import Run, parts_of
from mcgw.store.shards import Shard, Span

__all__ = ["Part", "run", "run_part"]

Progress = Callable[[int], Any]
_ROUNDS = 3  # of merging, if shards turn out damaged


@dataclass(frozen=True)
class Part:
    """One of several jobs that share the blocks of a run.

    Parameters
    ----------
    number, of : int
        ``1 <= number <= of``.

    Raises
    ------
    ValueError
        If it is no such part.
    """

    number: int
    of: int

    def __post_init__(self) -> None:
        if not 1 <= self.number <= self.of:
            raise ValueError(f"--shard {self.number}/{self.of}: give i/n with 1 <= i <= n")

    def mine(self, span: Span, size: int) -> bool:
        """Whether a block is this job's."""
        return span.first // size % self.of == self.number - 1


@dataclass(frozen=True)
class _Session:
    """How blocks are drawn this time."""

    engine: Engine
    threads: int | None
    progress: Progress
    signals: Signals


def run(
    scene: Scene,
    path: str | Path,
    *,
    threads: int | None = None,
    engine: Engine | None = None,
    progress: Progress | None = None,
) -> Ensemble:
    """Draw the ensemble of a scene into a file, going on where an earlier run stopped.

    Parameters
    ----------
    scene : Scene
        What is asked; `n_surfaces` is the total, or with `rel_err` or `max_seconds` the most.
    path : str or Path
        The file; it appears when it is complete. Until then, blocks lie in ``FILE.parts/``.
    threads : int, optional
        Left out: all there are. The data are the same for any number.
    engine : Engine, optional
        Who draws; left out: the threads of this process. It is left open.
    progress : callable, optional
        Called with the number of surfaces that are done: at the start, and after each block.

    Returns
    -------
    Ensemble
        That reads from the file. Where `rel_err` or `max_seconds` decided how many surfaces, its scene says
        their number instead. What a file holds already is never too much.

    Raises
    ------
    StoreError
        If the file cannot be written there, or the place belongs to another run.
    RunError
        If the run could not be finished; what is done is kept.
    """
    path = Path(path)
    started = monotonic()
    for stage in _stages(scene, path):
        ensemble = _run(stage, path, threads, engine, progress or _silent)
        if scene.max_seconds is not None and monotonic() - started > scene.max_seconds:
            break
    return ensemble


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


def _run(
    scene: Scene, path: Path, threads: int | None, engine: Engine | None, progress: Progress
) -> Ensemble:
    """Draw what is missing of a scene of a given number of surfaces."""
    sampler, size, done = _prepare(scene, path, threads)
    if done == scene.n_surfaces:
        tidy(path)
        progress(done)
        return open_ensemble(path)
    with heed_signals() as signals, _engine_or_threads(engine) as drawing:
        session = _Session(drawing, threads if engine is None else 1, progress, signals)
        with locked(parts_of(path)):
            drop_leftovers(path)
            begun = (parts_of(path) / "run.toml").exists()
            if engine is None and scene.n_surfaces <= size and not begun:
                _at_once(scene, sampler, path, session)
            else:
                _in_blocks(scene, sampler, path, size, session)
    return open_ensemble(path)


def run_part(
    scene: Scene,
    path: str | Path,
    part: Part,
    *,
    threads: int | None = None,
    progress: Progress | None = None,
) -> int:
    """Draw one job's share of the blocks; `mcgw.jobs.merging.merge` makes the file once all are there.

    Parameters
    ----------
    scene : Scene
        What is asked, of all jobs together.
    path : str or Path
        The file to be, on a disk that all jobs share.
    part : Part
        Which share.
    threads : int, optional
        Left out: all there are.
    progress : callable, optional
        Called with the number of surfaces that are done in this share.

    Returns
    -------
    int
        Surfaces still missing of the whole.

    Raises
    ------
    StoreError, RunError
        As `run`.
    """
    path = Path(path)
    if scene.max_seconds is not None:
        raise ValueError(
            "ensemble.max_seconds: jobs that share a run end at different times; give n_surfaces"
        )
    scene = without_rule(scene) if scene.rel_err is not None else scene
    sampler, size, done = _prepare(scene, path, threads)
    if done == scene.n_surfaces:
        return 0
    tidy(path)
    with (
        heed_signals() as signals,
        locked(parts_of(path), shared=True),
        _engine_or_threads(None) as drawing,
    ):
        done = finished(path, scene, sampler.name)  # again: the last of the jobs may have been merged
        started = Run.begin(parts_of(path), scene, sampler.name, size)
        gaps = missing_of(started, done, started.shards())
        _draw_missing(started, gaps, _Session(drawing, threads, progress or _silent, signals), part)
        return sum(span.n for span in missing_of(started, done, started.shards()))


def _prepare(scene: Scene, path: Path, threads: int | None) -> tuple[Sampler, int, int]:
    """Sampler, surfaces a block, and surfaces already in the file; everything checked."""
    if threads is not None and threads < 1:
        raise ValueError(f"threads = {threads}: give a whole number >= 1")
    try:
        as_read = scene_from(scene_text(scene))
    except ValueError:
        as_read = None
    if as_read != scene:
        raise StoreError(f"{path}: this scene cannot be written to a file; give its grading as a table")
    sampler = sampler_of(scene)
    check_output(path)
    done = finished(path, scene, sampler.name)
    size = shard_size(scene, sampler)
    check_space(scene, path, rows=size, columns=columns(scene, sampler), held=_bytes_of(path))
    return sampler, size, done


def _bytes_of(path: Path) -> int:
    """What lies there already: the file, and shards of a run."""
    files = [path, *parts_of(path).glob("shards/block-*.h5")]
    return sum(file.stat().st_size for file in files if file.is_file())


def _silent(done: int) -> None:
    """Tell nobody."""


@contextmanager
def _engine_or_threads(engine: Engine | None) -> Iterator[Engine]:
    """The engine given, left open; or our own threads."""
    if engine is not None:
        yield engine
        return
    own = Threads()
    try:
        yield own
    finally:
        own.close()


def _at_once(scene: Scene, sampler: Sampler, path: Path, session: _Session) -> None:
    """The whole ensemble as one block, and its file in one step. Only with the lock."""
    if finished(path, scene, sampler.name) == scene.n_surfaces:  # another process was quicker
        return
    answers: list[Any] = []
    started = perf_counter()
    session.progress(0)
    drive(
        session.engine,
        [Span(0, scene.n_surfaces)],
        draw,
        lambda span: (scene, sampler, span, session.threads),
        lambda _, arrays: answers.append(arrays),
        session.signals,
    )
    session.signals.check("nothing was kept, the run is one block; the same command starts it again")
    ensemble = Ensemble(scene, sampler.name, Arrays(answers[0]))
    write_ensemble(ensemble, path, wall_seconds=perf_counter() - started)
    session.progress(scene.n_surfaces)


def _in_blocks(scene: Scene, sampler: Sampler, path: Path, size: int, session: _Session) -> None:
    """Shards until none is missing, then the file. Only with the lock."""
    try:
        started = Run.begin(parts_of(path), scene, sampler.name, size)
        started.freeze()
        for _ in range(_ROUNDS):
            shards = started.sweep()
            done = finished(path, scene, sampler.name)
            _refuse_more(started, shards)
            _draw_missing(started, missing_of(started, done, shards), session)
            if merge_once(started, path, session.signals):
                return
    except OSError as error:
        raise RunError(
            f"{error.filename or path}: {error.strerror or error}; finished blocks are kept in "
            f"{parts_of(path)}, the same command goes on once that is mended"
        ) from None
    raise RunError(f"{parts_of(path)}: shards are damaged again and again; is the disk failing?")


def _refuse_more(started: Run, shards: list[Shard]) -> None:
    """Blocks beyond what is asked are not thrown away."""
    n, wanted = max((shard.span.stop for shard in shards), default=0), started.scene.n_surfaces
    if n > wanted:
        raise StoreError(
            f"{started.folder}: holds surfaces up to number {n} already, more than ensemble.n_surfaces = "
            f"{wanted}; ask for as many or more, or choose another -o"
        )


def _draw_missing(started: Run, spans: list[Span], session: _Session, part: Part | None = None) -> None:
    """Commit every block that is missing, or of these a job's share."""
    count = started.scene.n_surfaces - sum(span.n for span in spans)
    if part:
        spans = [span for span in spans if part.mine(span, started.size)]
    session.progress(count)

    def note(span: Span, _: str) -> None:
        nonlocal count
        count += span.n
        session.progress(count)

    folder = str(started.folder.resolve())
    drive(
        session.engine,
        spans,
        commit_block,
        lambda span: (folder, span.first, span.n, session.threads),
        note,
        session.signals,
    )
    total = started.scene.n_surfaces
    session.signals.check(
        f"{count} of {total} surfaces are kept in {started.folder}; the same command goes on"
    )
