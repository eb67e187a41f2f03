"""What a worker does: draw a block of surfaces. The same, whoever asks and however often."""

from pathlib import Path
from time import perf_counter

import numpy as np

from mcgw.ensemble.simulation import block_size, drawn_blocks, kept, use_threads
from mcgw.errors import RunError
from mcgw.sampling.block import Sampler
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.scene import Scene
from mcgw.store.run_folder import Run, difference, identity_of
from mcgw.store.shards import Arrays, Span, commit_shard

__all__ = ["columns", "commit_block", "draw", "shard_size"]

_BYTES = 2**23  # of a shard: large enough that its flushing costs little
_OF_AN_EXTRA = 3  # asperity outside the cells: surface, height, weight
_DRAWS = 4e8  # asperities a shard: a second or so


def shard_size(scene: Scene, sampler: Sampler) -> int:
    """Surfaces a shard: a function of the scene alone, however many there are of them."""
    size, row = block_size(scene, sampler), 8 * columns(scene, sampler)
    return size * int(max(min(_BYTES / (size * row), _DRAWS / (size * (sampler.draws + 1))), 1))


def columns(scene: Scene, sampler: Sampler) -> int:
    """Numbers kept of a surface."""
    sums = len(scene.separations) * len(scene.quantities)
    if scene.keep == "sums":
        return sums
    return sums + sampler.moments + sampler.cells + _OF_AN_EXTRA


def draw(scene: Scene, sampler: Sampler, span: Span, threads: int | None) -> Arrays:
    """Results of some surfaces, in pieces that fit the memory.

    Parameters
    ----------
    scene : Scene
        What is asked.
    sampler : Sampler
        Its sampler.
    span : Span
        Which surfaces.
    threads : int or None
        How many to use; the result does not depend on it.

    Returns
    -------
    dict of str to ndarray
        What is kept of them.
    """
    with use_threads(threads):
        parts = [
            kept(scene, block)
            for block in drawn_blocks(sampler, span.first, span.stop, block_size(scene, sampler))
        ]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def commit_block(folder: str, first: int, n: int, threads: int | None = 1) -> str:
    """Draw a block and commit its shard, unless a valid one is there.

    Parameters
    ----------
    folder : str
        The run's, on a disk that all workers share.
    first, n : int
        The block.
    threads : int or None, optional
        How many to use.

    Returns
    -------
    str
        Digest of the contents.
    """
    run, span = Run.open(Path(folder)), Span(first, n)
    if shard := run.held(span):
        return shard.digest
    if identity_of(run.scene, run.sampler) != run.identity:
        why = difference(run.scene, run.drawn_with, run.scene, run.sampler)
        raise RunError(f"{folder}: this worker cannot draw for that run: {why}")
    started = perf_counter()
    arrays = draw(run.scene, _sampler(run), span, threads)
    path = run.shards_folder / span.file_name
    return commit_shard(path, run.identity, span, arrays, perf_counter() - started).digest


_SAMPLERS: dict[str, Sampler] = {}


def _sampler(run: Run) -> Sampler:
    """The sampler of the last run: preparing one may take as long as a block."""
    if run.identity not in _SAMPLERS:
        _SAMPLERS.clear()
        _SAMPLERS[run.identity] = sampler_of(run.scene)
    return _SAMPLERS[run.identity]
