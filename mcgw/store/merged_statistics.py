"""From the shards of a run that keeps statistics to its file: small, and made in memory."""

from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.summarised import Summarised
from mcgw.ensemble.summary import Summary
from mcgw.errors import StoreError
from mcgw.formats.files import write_whole
from mcgw.store.ensembles import read_attributes
from mcgw.store.run_folder import RunFolder
from mcgw.store.shards import Shard
from mcgw.store.statistics_file import blocks_of, body_of, read_blocks

__all__ = ["merge_statistics"]


def merge_statistics(folder: Path, target: Path, temporary: Path, check: Callable[[], None]) -> None:
    """Write the statistics of a run under a temporary name: blocks of `target`, then those of the shards.

    `check` is called often, and raises if this is to end.

    Raises
    ------
    StoreError
        If a shard is missing or damaged.
    OSError
        If the disk does not take it.
    """
    run = RunFolder.open(folder)
    ((_, size),) = run.plan.groups
    before, seconds = list[Summary](), 0.0
    if target.exists():
        held = read_blocks(target, run.scene).blocks
        before = [block for block in held if block.n % size == 0]
        seconds = float(read_attributes(target)["wall_seconds"])
    stop = sum(block.n for block in before)

    def following() -> Iterator[Shard]:
        nonlocal stop, seconds
        for shard in run.shards(bodies=False):
            if shard.span.first == stop:
                check()
                stop, seconds = shard.span.stop, seconds + shard.seconds
                yield shard

    results = Summarised.of(run.scene, chain(before, blocks_of(following())))
    if stop != run.scene.n_surfaces:
        raise StoreError(f"{folder}: surfaces from {stop} on are missing")
    ensemble = Ensemble(run.scene, run.sampler, results)
    of_run = {"run": run.identity, "draws": run.drawn_with, "wall_seconds": seconds}
    write_whole(temporary, body_of(ensemble, **of_run), expected=None)
