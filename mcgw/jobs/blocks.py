"""What a worker does: draw a block of surfaces. The same, whoever asks and however often."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from time import perf_counter

from mcgw.errors import RunError
from mcgw.formats.files import State, state_of
from mcgw.jobs.job import Job
from mcgw.store.identity import difference
from mcgw.store.run_folder import RunFolder
from mcgw.store.shards import Span, commit_shard

__all__ = ["commit_block", "draw_block"]


def commit_block(folder: str, first: int, n: int, threads: int | None = 1) -> str:
    """Draw a block of a run into its folder, unless a valid shard is there; returns its digest."""
    return draw_block(folder, first, n, threads)()


def draw_block(folder: str, first: int, n: int, threads: int | None = 1) -> Callable[[], str]:
    """The first half of `commit_block`; what it returns is the second, which another thread may do."""
    run, job = _prepared(folder, state_of(Path(folder) / "run.toml"))
    span = Span(first, n)
    if shard := run.held(span):
        digest = shard.digest
        return lambda: digest
    started = perf_counter()
    tables = job.draw(span, threads)
    path, seconds = run.shards_folder / span.file_name, perf_counter() - started
    return lambda: commit_shard(path, run.identity, span, tables, seconds).digest


@lru_cache(maxsize=1)
def _prepared(folder: str, _state: State | None) -> tuple[RunFolder, Job]:
    """A run and its job, as long as its run.toml is the same: preparing them may take as long as a block."""
    run = RunFolder.open(Path(folder))
    job = Job.again(run)
    if job.record.identity != run.identity:
        there, here = ((x.text, x.axes, x.drawn_with) for x in (run, job.record))
        raise RunError(f"{folder}: this worker cannot draw for that run: {difference(there, here)}")
    return run, job
