"""From a scene to its file: begin, go on, extend, merge."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

from mcgw.child import ChildError, run_child
from mcgw.disk import check_output, remove_stale, sync, temporary_beside
from mcgw.driver import Signals, drive, heed_signals
from mcgw.engines import Engine, Threads
from mcgw.ensemble import Arrays, Ensemble
from mcgw.errors import RunError, StoreError
from mcgw.room import check_room
from mcgw.rundir import Run, missing, parts_of
from mcgw.samplers import Sampler, sampler_of
from mcgw.scene import Scene
from mcgw.scene_file import scene_from, scene_text
from mcgw.shards import Span
from mcgw.store import finished, open_ensemble, save
from mcgw.work import columns, commit_block, draw, shard_size

__all__ = ["Part", "merge", "run", "run_part"]

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
        What is asked; `n_surfaces` is the total.
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
        That reads from the file.

    Raises
    ------
    StoreError
        If the file cannot be written there, or the place belongs to another run.
    RunError
        If the run could not be finished; what is done is kept.
    """
    path = Path(path)
    sampler, size, done = _prepare(scene, path, threads)
    if done == scene.n_surfaces:
        _clear(path, scene, sampler)
        (progress or _silent)(done)
        return open_ensemble(path)
    with heed_signals() as signals, _engine_or_threads(engine) as drawing:
        session = _Session(drawing, threads if engine is None else 1, progress or _silent, signals)
        if engine is None and scene.n_surfaces <= size and not parts_of(path).exists():
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
    """Draw one job's share of the blocks; `merge` makes the file once all are there.

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
    sampler, size, done = _prepare(scene, path, threads)
    if done == scene.n_surfaces:
        return 0
    started = Run.begin(parts_of(path), scene, sampler.name, size)
    with heed_signals() as signals, started.locked(shared=True), _engine_or_threads(None) as drawing:
        _draw_missing(started, done, _Session(drawing, threads, progress or _silent, signals), part)
        return sum(span.n for span in _missing(started, done))


def merge(path: str | Path) -> Ensemble:
    """Make the file of a run whose blocks are all there.

    Parameters
    ----------
    path : str or Path
        The file to be.

    Returns
    -------
    Ensemble
        That reads from it.

    Raises
    ------
    StoreError
        If there is no such run.
    RunError
        If blocks are missing, or the disk does not take the file.
    """
    path = Path(path)
    if path.exists() and not parts_of(path).exists():
        return open_ensemble(path)
    started = Run.open(parts_of(path))
    with heed_signals() as signals, started.locked():
        done = finished(path, started.scene, started.sampler)
        shards = started.sweep()
        gaps = missing(started.scene.n_surfaces, started.size, _held(done, shards))
        if gaps:
            raise RunError(
                f"{path}: {sum(span.n for span in gaps)} of {started.scene.n_surfaces} surfaces are missing, "
                f"from {gaps[0].first} on; run the jobs that make them again"
            )
        _merge_once(started, path, signals)
    return open_ensemble(path)


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
    check_room(scene, path, rows=size, columns=columns(scene, sampler), held=_bytes_of(path))
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
    """The whole ensemble as one block, and its file in one step."""
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
    save(ensemble, path, wall_seconds=perf_counter() - started)
    session.progress(scene.n_surfaces)


def _in_blocks(scene: Scene, sampler: Sampler, path: Path, size: int, session: _Session) -> None:
    """Shards until none is missing, then the file."""
    try:
        started = Run.begin(parts_of(path), scene, sampler.name, size)
        with started.locked():
            started.freeze()
            for _ in range(_ROUNDS):
                started.sweep()
                done = finished(path, scene, sampler.name)
                _draw_missing(started, done, session)
                if _merge_once(started, path, session.signals):
                    return
    except OSError as error:
        raise RunError(
            f"{error.filename or path}: {error.strerror or error}; finished blocks are kept in "
            f"{parts_of(path)}, the same command goes on once that is mended"
        ) from None
    raise RunError(f"{parts_of(path)}: shards are damaged again and again; is the disk failing?")


def _held(done: int, shards: Any) -> list[Span]:
    return [*([Span(0, done)] if done else []), *(shard.span for shard in shards)]


def _missing(started: Run, done: int) -> list[Span]:
    return missing(started.scene.n_surfaces, started.size, _held(done, started.shards()))


def _draw_missing(started: Run, done: int, session: _Session, part: Part | None = None) -> None:
    """Commit every block that is missing, or of these a job's share."""
    spans = _missing(started, done)
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


def _merge_once(started: Run, path: Path, signals: Signals) -> bool:
    """Make the file and remove the shards; False if a shard turned out damaged."""
    temporary = temporary_beside(started.folder / path.name)
    try:
        _merge_in_child(started.folder, path, temporary)
        os.replace(temporary, path)
        sync(path.parent)
    except ChildError as error:
        signals.check(f"all blocks are kept in {started.folder}; the same command merges them")
        if error.how == "exit code 3":
            return False
        raise RunError(
            f"{path}: cannot be merged ({error}); is the disk full? All blocks are kept in "
            f"{started.folder}, the same command goes on"
        ) from None
    finally:
        with suppress(OSError):
            temporary.unlink()
    started.remove()
    return True


def _merge_in_child(folder: Path, path: Path, temporary: Path) -> None:
    run_child("mcgw.merge", str(folder), str(path), str(temporary))


def _clear(path: Path, scene: Scene, sampler: Sampler) -> None:
    """Remove the folder of a run whose file was finished just before it died."""
    remove_stale(path)
    folder = parts_of(path)
    if (folder / "run.toml").is_file():
        left = Run.begin(folder, scene, sampler.name, 1)
        with left.locked():
            left.remove()
    for empty in (folder / "shards", folder):
        with suppress(OSError):  # it is not there, or not empty
            empty.rmdir()
