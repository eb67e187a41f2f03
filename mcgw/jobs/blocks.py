"""What a worker does: draw a block of surfaces. The same, whoever asks and however often."""

from pathlib import Path
from time import perf_counter

from mcgw.errors import RunError
from mcgw.jobs.job import Job
from mcgw.sampling.samplers import sampler_of
from mcgw.store.disk import file_of
from mcgw.store.run_folder import RunFolder, difference, identity_of
from mcgw.store.shards import Span, commit_shard

__all__ = ["commit_block"]


def commit_block(folder: str, first: int, n: int, threads: int | None = 1) -> str:
    """Draw a block of the run in a folder and commit its shard, unless a valid one is there: its digest."""
    run, span = RunFolder.open(Path(folder)), Span(first, n)
    if shard := run.held(span):
        return shard.digest
    if identity_of(run.scene, run.sampler) != run.identity:
        why = difference(run.scene, run.drawn_with, run.scene, run.sampler)
        raise RunError(f"{folder}: this worker cannot draw for that run: {why}")
    started = perf_counter()
    arrays = _job(run).draw(span, threads)
    path = run.shards_folder / span.file_name
    return commit_shard(path, run.identity, span, arrays, perf_counter() - started).digest


_JOBS: dict[str, Job] = {}


def _job(run: RunFolder) -> Job:
    """The job of the last run: preparing a sampler may take as long as a block."""
    if run.identity not in _JOBS:
        _JOBS.clear()
        _JOBS[run.identity] = Job(run.scene, sampler_of(run.scene), file_of(run.folder))
    return _JOBS[run.identity]
