"""A sweep on its way into a file: an engine, or several jobs, draw its chunks, which are then added up."""

from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

from mcgw.errors import RunError, StoreError
from mcgw.formats.files import check_output
from mcgw.formats.toml_text import loads
from mcgw.jobs.driver import Signals, heed_signals
from mcgw.jobs.engines import Engine
from mcgw.jobs.session import By, Part, Session
from mcgw.scene.scene import LeftOut, Scene
from mcgw.store.disk import parts_of
from mcgw.store.lock import locked
from mcgw.sweeps.asked import Asked
from mcgw.sweeps.axes import Axes
from mcgw.sweeps.chunk_task import Drawer, commit_chunk
from mcgw.sweeps.drawing import Chunk, Told, added_up, check_memory_of
from mcgw.sweeps.file import identity_of, open_sweep, read_attributes, write_sweep
from mcgw.sweeps.folder import SweepFolder, folder_of, remove_sweep, seed_of
from mcgw.sweeps.pooled import Pooled
from mcgw.sweeps.sweep import STATISTICS, Sweep

__all__ = ["merge_sweep", "recorded_seed", "sweep_in_file", "sweep_part"]

Tell = Callable[[float, float], object]
_ROUNDS = 3  # of adding up, if shards turn out damaged


def sweep_in_file(
    scene: Scene,
    axes: Axes,
    path: Path,
    statistics: tuple[str, ...],
    tell: Tell,
    *,
    threads: int | None = None,
    engine: Engine | None = None,
) -> Sweep:
    """As `mcgw.sweep` with a path: read it, go on with it, or begin it; the engine is left open."""
    asked = _asked(scene, axes, path)
    if not path.exists():
        told = Told(asked.groups, tell)
        with By(engine, threads, told).at_work() as session, locked(parts_of(path)):
            if not path.exists():  # another process may have been quicker
                _draw(SweepFolder.begin(path, asked), path, session, told)
    _refuse_another(path, asked)
    _tidy(path)
    return open_sweep(path, statistics)


def sweep_part(
    scene: Scene, axes: Axes, path: Path, part: Part, tell: Tell, *, threads: int | None = None
) -> int:
    """Draw one job's share of the chunks, and return how many surfaces are still missing of the whole.

    `merge_sweep` makes the file once all are there, on a disk that all jobs share.
    """
    asked = _asked(scene, axes, path)
    if not path.exists():
        told = Told(asked.groups, tell)
        with By(None, threads, told).at_work() as session, locked(parts_of(path), shared=True):
            if not path.exists():
                started = SweepFolder.begin(path, asked)
                _draw_missing(started, session, told, part)
                return sum(chunk.n for chunk in started.missing())
    _refuse_another(path, asked)
    return 0


def merge_sweep(path: Path) -> Sweep:
    """Make the file of a sweep whose chunks are all there.

    Raises
    ------
    StoreError
        If there is no such sweep.
    RunError
        If chunks are missing, or the disk does not take the file.
    """
    if not path.exists():
        with heed_signals() as signals, locked(parts_of(path)):
            if not path.exists():
                started = SweepFolder.open(folder_of(path))
                if gaps := started.missing():
                    total = sum(group.n_surfaces for group in started.asked.groups)
                    raise RunError(
                        f"{path}: {sum(chunk.n for chunk in gaps)} of {total} surfaces are missing, from "
                        f"{gaps[0]} on; run the jobs that make them again"
                    )
                if not _write(started, path, signals):
                    raise RunError(f"{started.folder}: a shard is damaged; run the jobs again")
    _tidy(path)
    return open_sweep(path, STATISTICS)


def recorded_seed(path: Path) -> int | None:
    """The seed of the sweep that is at a place, or in the making there."""
    if path.is_file():
        return int(loads(str(read_attributes(path)["scene"]))["ensemble"]["seed"])
    return seed_of(path)


def _asked(scene: Scene, axes: Axes, path: Path) -> Asked:
    """The question, checked, with the seed of what is there if nobody gave one."""
    if isinstance(scene.seed, LeftOut) and (seed := recorded_seed(path)) is not None:
        scene = scene.replace(seed=seed)
    asked = Asked.of(scene, axes)
    check_memory_of(asked.groups)
    check_output(path)
    return asked


def _refuse_another(path: Path, asked: Asked) -> None:
    if read_attributes(path)["run"] != identity_of(asked):
        raise StoreError(f"{path}: holds a different sweep; choose another -o, or remove it")


def _tidy(path: Path) -> None:
    """Remove the chunks of a file that is there: a process that was killed may have left them."""
    if folder_of(path).is_dir():
        with suppress(StoreError, OSError), locked(parts_of(path), patience=0):
            remove_sweep(path)


def _draw(started: SweepFolder, path: Path, session: Session, told: Told) -> None:
    """Chunks until none is missing, then the file. Only with the lock."""
    for _ in range(_ROUNDS):
        _draw_missing(started, session, told)
        if _write(started, path, session.signals):
            return
    raise RunError(f"{started.folder}: shards are damaged again and again; is the disk failing?")


def _draw_missing(started: SweepFolder, session: Session, told: Told, part: Part | None = None) -> None:
    """Commit every chunk that is missing, or of these a job's share."""
    missing = started.missing()
    done = sum(map(told.size, started.chunks)) - sum(map(told.size, missing))
    if part:
        missing = [chunk for chunk in missing if part.mine(chunk.number)]
    try:
        if session.alone:
            session.draw(missing, Drawer(started).draw, lambda chunk: (chunk,), done=done, size=told.size)
        else:
            folder = str(started.folder.resolve())
            session.draw(missing, commit_chunk, lambda chunk: (folder, chunk), done=done, size=told.size)
    except OSError as error:
        raise _kept(started, error) from None
    session.signals.check(f"what is done is kept in {started.folder}; the same command goes on")


def _write(started: SweepFolder, path: Path, signals: Signals) -> bool:
    """Make the file and remove the shards; False if one turned out damaged. Only with the lock."""
    seconds = 0.0

    def held() -> Iterator[tuple[Chunk, Pooled]]:
        nonlocal seconds
        for chunk in started.chunks:
            signals.check(f"all chunks are kept in {started.folder}; the same command goes on")
            if (found := started.held(chunk)) is None:
                raise _DamagedError
            seconds += found[1].seconds
            yield chunk, found[0]

    try:
        pooled = added_up(held())
    except _DamagedError:
        return False
    try:
        write_sweep(started.asked, pooled, path, wall_seconds=seconds)
    except OSError as error:
        raise _kept(started, error) from None
    remove_sweep(path)
    return True


class _DamagedError(Exception):
    """A shard is not there, or not whole."""


def _kept(started: SweepFolder, error: OSError) -> RunError:
    return RunError(
        f"{error.filename or started.folder}: {error.strerror or error}; what is done is kept in "
        f"{started.folder}, the same command goes on once that is mended"
    )
