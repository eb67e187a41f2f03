"""What a worker does: draw a block of surfaces. The same, whoever asks and however often."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from time import perf_counter

from mcgw.ensemble.drawing import GoOn, always
from mcgw.errors import RunError
from mcgw.formats.files import State, state_of
from mcgw.store.blocks import Span, commit_shard
from mcgw.store.identity import difference
from mcgw.store.run_plan import RECORD, Plan


def commit_block(folder: str, first: int, n: int) -> None:
    """Draw a block of a run into its folder, unless a valid shard is there."""
    draw_block(folder, first, n)()


def draw_block(
    folder: str, first: int, n: int, threads: int | None = 1, go_on: GoOn = always
) -> Callable[[], object]:
    """Do the first half of `commit_block`; what it returns is the second, to be done beside the next."""
    plan = _prepared(folder, state_of(Path(folder) / RECORD))
    span = Span(first, n)
    if plan.held(span):
        return lambda: None
    started = perf_counter()
    tables = plan.draw(span, threads, go_on)
    path, seconds = plan.shards_folder / span.file_name, perf_counter() - started
    return lambda: commit_shard(path, plan.identity, span, tables, seconds)


@lru_cache(maxsize=1)
def _prepared(folder: str, _state: State | None) -> Plan:
    """Return the plan of a folder, kept while its record is the same: making it takes as long as a block."""
    there = Plan.open(Path(folder))
    here = there.again()
    if here.identity != there.identity:
        why = difference(there.question, here.question)
        raise RunError(f"{folder}: this worker cannot draw for that run: {why}")
    return here
