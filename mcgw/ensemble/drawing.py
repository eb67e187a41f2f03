"""Surfaces block by block: how many at a time, by which threads, and what of a block is kept."""

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter
from typing import Any, TypeVar

import numba
import numpy as np

from analytic import quantity_of
from mcgw.machine.in_threads import in_threads, pieces
from mcgw.sampling.block import Block, Sampler, Source
from mcgw.sampling.counts import GROUP
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene

__all__ = [
    "answered",
    "at_a_time",
    "block_size",
    "blocks",
    "drawn_blocks",
    "kept",
    "seconds_per_surface",
    "use_threads",
]

_Drawn = TypeVar("_Drawn")

_WORDS = 4_000_000  # numbers of a block that stay in the outer cache
_MOST_WORDS = 20_000_000  # numbers a block may hold
_DRAWS = 1.5e8  # asperities a block may draw, so that a bar moves every second


def blocks(scene: Scene, sampler: Sampler) -> Iterator[Block]:
    """Results of all surfaces of a scene, block by block, in order."""
    yield from drawn_blocks(sampler, 0, scene.n_surfaces, block_size(scene, sampler))


def drawn_blocks(sampler: Source[_Drawn], first: int, stop: int, size: int) -> Iterator[_Drawn]:
    """Results of surfaces `first` ... `stop - 1`, in order, in blocks of at most `size`.

    Each thread draws blocks of its own. To share the work within a block, and wake the others for each
    step of it, takes longer; that is left to a few, huge surfaces.
    """

    def block(ends: tuple[int, int]) -> _Drawn:
        return sampler.block(start + ends[0], ends[1] - ends[0])

    step = at_a_time(size)
    for start in range(first, stop, step):
        n = min(step, stop - start)
        yield from in_threads(block, pieces(n, GROUP if n >= GROUP * numba.get_num_threads() else 1))


def at_a_time(size: int) -> int:
    """Surfaces drawn side by side: a block for each thread, but one surface if that is a block."""
    return size * numba.get_num_threads() if size > 1 else 1  # it may fill the memory


def kept(scene: Scene, block: Block) -> dict[str, Any]:
    """What of a block is kept: its sums, and its moments if the scene says so."""
    arrays = answered(scene, block.sums)
    if promise_of(scene.sampler).real_surfaces:
        for name in filter(lambda name: quantity_of(name).counts, scene.quantities):
            arrays[name] = np.rint(arrays[name]).astype(np.int64)
    if scene.keep == "moments":
        arrays |= {"moments": block.moments, "cells": block.counts, "extras": block.extras}
    return arrays


def answered(scene: Scene, sums: dict[str, Any]) -> dict[str, Any]:
    """What surfaces answer with these sums of their asperities."""
    if scene.interaction is None:
        return dict(sums)
    from mcgw.ensemble.interacting import with_interaction  # for those scenes alone

    return with_interaction(scene, sums)


def block_size(scene: Scene, sampler: Source[Any]) -> int:
    """Surfaces a block: bounded by memory and time, twice an odd number of `counts.GROUP` if it can be.

    Whole groups, so that no generator of the counts is made for two blocks; an odd number of pairs, since
    with a multiple of eight the rows of the moments would share their places in the innermost cache.
    """
    words = scene.width + sampler.words
    most = int(min(_MOST_WORDS / words, _DRAWS / (sampler.draws + 1), 30 * GROUP))
    size = min(most, max(_WORDS // words, GROUP))
    return (size // GROUP // 4 * 4 + 2) * GROUP if size > GROUP else max(size, 1)


def seconds_per_surface(scene: Scene, sampler: Source[Any]) -> float:
    """Median wall time of drawing one surface in a block, after a warm-up."""
    size = min(block_size(scene, sampler), 256)
    n = at_a_time(size)
    list(drawn_blocks(sampler, 0, n, size))
    times = []
    for _ in range(3):
        start = perf_counter()
        list(drawn_blocks(sampler, 0, n, size))
        times.append(perf_counter() - start)
    return float(np.median(times)) / n


@contextmanager
def use_threads(threads: int | None) -> Iterator[None]:
    """Let the loops use so many threads, at most as many as there are."""
    if threads is not None and not (isinstance(threads, int) and threads >= 1):
        raise ValueError(f"threads = {threads!r}: give a whole number >= 1")
    before = numba.get_num_threads()
    numba.set_num_threads(min(threads or before, before))
    try:
        yield
    finally:
        numba.set_num_threads(before)
