"""Who draws the blocks of a run or sweep: the options that both have."""

import logging
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import TYPE_CHECKING, Annotated, Any

from mcgw.commands.kinds import AT_MOST_ONE, Kind

if TYPE_CHECKING:
    from concurrent.futures import Executor

Threads = Annotated[int | None, Kind("N", "number of threads; default: all cores; does not change results")]
Jobs = Annotated[int | None, Kind("N", "use N processes instead"), AT_MOST_ONE]
Dask = Annotated[
    str | None, Kind("ADDRESS", "use the workers of a dask scheduler, tcp:// or tls://"), AT_MOST_ONE
]
Share = Annotated[
    str | None, Kind("I/N", "draw the I-th of N shares, as one job of an array; then mcgw merge"), AT_MOST_ONE
]


@contextmanager
def drawing(
    threads: int | None, jobs: int | None, dask: str | None, shard: str | None
) -> Iterator[dict[str, Any]]:
    """Yield the arguments of `mcgw.run` and `mcgw.sweep` that say how.

    Libraries log nothing meanwhile: mcgw itself reports a lost worker or scheduler, in one line.
    """
    from mcgw.jobs.executors import Jobs as Processes, dask_executor

    chosen: AbstractContextManager[Executor | None] = nullcontext()
    if jobs is not None:
        chosen = Processes(jobs)
    elif dask is not None:
        chosen = dask_executor(dask)
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        with chosen as executor:
            yield {"threads": threads, **({"executor": executor} if shard is None else {"shard": shard})}
    finally:
        logging.disable(before)


def share_done(shard: str, path: object, left: int) -> str:
    """Say that a share is done and what remains."""
    then = f"{left} surfaces are still missing" if left else f"all are done: mcgw merge {path}"
    return f"{path}.parts: shard {shard} is done; {then}"
