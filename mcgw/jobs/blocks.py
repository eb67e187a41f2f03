"""What a worker does: draw a block of surfaces. The same, whoever asks and however often."""

from functools import lru_cache
from pathlib import Path
from time import perf_counter

from mcgw.errors import RunError
from mcgw.formats.files import State, state_of
from mcgw.jobs.job import Job
from mcgw.sampling.samplers import sampler_of
from mcgw.store.disk import file_of
from mcgw.store.identity import difference, identity_of
from mcgw.store.run_folder import RunFolder
from mcgw.store.shards import Span, commit_shard

__all__ = ["commit_block"]


def commit_block(folder: str, first: int, n: int, threads: int | None = 1) -> str:
    """Draw a block of a run into its folder, unless a valid shard is there; returns its digest."""
    run, job = _prepared(folder, state_of(Path(folder) / "run.toml"))
    span = Span(first, n)
    if shard := run.held(span):
        return shard.digest
    started = perf_counter()
    tables = job.draw(span, threads)
    path = run.shards_folder / span.file_name
    return commit_shard(path, run.identity, span, tables, perf_counter() - started).digest


@lru_cache(maxsize=1)
def _prepared(folder: str, _state: State | None) -> tuple[RunFolder, Job]:
    """A run and its job, as long as its run.toml is the same: preparing them may take as long as a block."""
    run = RunFolder.open(Path(folder))
    if identity_of(run.scene, run.sampler) != run.identity:
        why = difference(run.scene, run.drawn_with, run.scene, run.sampler)
        raise RunError(f"{folder}: this worker cannot draw for that run: {why}")
    return run, Job(run.scene, sampler_of(run.scene), file_of(run.folder))
