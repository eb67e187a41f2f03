"""Surfaces block by block: how many at a time, by which threads, and what of a block is kept.

How long a run will take, in a moment and in words.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from time import perf_counter
from typing import Any, TypeVar

import numba
import numpy as np

from analytic import quantity_of
from mcgw.ensemble.results import Tables
from mcgw.machine.in_threads import in_threads, pieces
from mcgw.sampling.block import Block, Sampler, Source
from mcgw.sampling.counts import GROUP
from mcgw.sampling.expected import Expected, expected
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene

_Drawn = TypeVar("_Drawn")
GoOn = Callable[[int], bool]  # told the surface after those that are drawn, says whether to draw more
_WORDS = 4_000_000  # numbers of a block that stay in the outer cache
_MOST_WORDS = 20_000_000  # numbers a block may hold
_DRAWS = 1.5e8  # asperities a block may draw, so that a bar moves every second
_PER_COUNT, _PER_PRODUCT = 4e-8, 2.5e-10  # rough seconds of a number, and of two, for statistics
_TRIED = 0.05  # rough seconds of a surface up to which a block is drawn to see


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
    alone = scene.interaction is scene.joint is None
    arrays = dict(block.sums) if alone else answered(scene, block.sums)
    if promise_of(scene.sampler).real_surfaces:
        for name in filter(lambda name: quantity_of(name).counts, scene.quantities):
            arrays[name] = np.rint(arrays[name]).astype(np.int64)
    if scene.keep == "moments":
        arrays |= {"moments": block.moments, "cells": block.counts, "extras": block.extras}
    return arrays


def answered(scene: Scene, sums: dict[str, Any]) -> dict[str, Any]:
    """What surfaces answer with these sums of their asperities."""
    found = dict(sums)
    if scene.interaction is not None:
        from mcgw.ensemble.half_space import with_interaction  # for those scenes alone

        found = with_interaction(scene, sums)
    if scene.joint is not None:
        from mcgw.ensemble.half_space import with_joint  # for those scenes alone

        found |= with_joint(scene, found, scene.of_joint, np.array(scene.separations))
    return found


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


def always(_: int) -> bool:
    """Go on."""
    return True


class Reducer(ABC):
    """Draws surfaces of one scene, or of several that share them, and keeps of each block what is asked.

    Blocks are a function of the scenes alone and are joined in their order: the same bits whoever draws them,
    and wherever that was interrupted.
    """

    whole = True  # whether a block is of use as a whole only, since nothing is kept of a single surface
    work = 1.0  # what a surface takes, in any unit
    disk = 0  # bytes that blocks and their file take at most, as far as they count

    @property
    @abstractmethod
    def n_surfaces(self) -> int:
        """How many surfaces are asked for."""

    @property
    @abstractmethod
    def rows(self) -> int:
        """Surfaces of a block, however many of them are asked for."""

    @abstractmethod
    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """What is kept of a block, or of its beginning; it does not depend on the number of threads.

        `go_on` is asked after each piece that fits the memory.
        """

    @abstractmethod
    def held(self, blocks: Iterable[Tables]) -> Any:
        """What all blocks make, each read when its turn comes."""

    @abstractmethod
    def check(self, surfaces: int | None = None) -> None:
        """Refuse what does not fit the memory: so many surfaces, or if they go into a file a block.

        Raises
        ------
        StoreError
            With the numbers.
        """


def drawn(reducer: Reducer, go_on: GoOn) -> Any:
    """What is kept of all surfaces, or as many as `go_on` lets be drawn, in memory."""
    more = True

    def asked(done: int) -> bool:
        nonlocal more
        more = go_on(done)
        return more

    def blocks() -> Iterator[Tables]:
        n, rows = reducer.n_surfaces, reducer.rows
        for first in range(0, n, rows):
            if more:
                yield reducer.tables(first, min(first + rows, n), asked)

    return reducer.held(blocks())


@dataclass(frozen=True)
class OfScene(Reducer):
    """Of the surfaces of one scene, with a number of them; of a sampler that is only expected, its size."""

    scene: Scene
    expected: Expected | None = None

    @cached_property
    def sampler(self) -> Any:
        """The scene's."""
        return self.expected or sampler_of(self.scene)

    @property
    def n_surfaces(self) -> int:
        """How many surfaces are asked for."""
        return self.scene.n_surfaces

    @abstractmethod
    def joined_bytes(self, surfaces: int) -> int:
        """About what the file of so many surfaces takes, before compression."""


def seconds_for(scene: Scene, sampler: Sampler, surfaces: int, *, at_least: float = 0.0) -> float:
    """Expected wall time of drawing some surfaces on this machine, s.

    From a block drawn on trial where a surface takes little, unless a rough guess lies below `at_least`.
    """
    rough = rough_seconds(scene, 1)
    if rough * surfaces < at_least or rough > _TRIED:
        return rough * surfaces
    return surfaces * (seconds_per_surface(scene, sampler) + _for_statistics(scene))


def rough_seconds(scene: Scene, surfaces: int) -> float:
    """Expected wall time of drawing some surfaces, within a factor of two or so, by arithmetic alone, s."""
    return surfaces * (expected(scene).seconds / numba.get_num_threads() + _for_statistics(scene))


def _for_statistics(scene: Scene) -> float:
    """Of a surface whose numbers are counted, and not kept."""
    return scene.width * _PER_COUNT + scene.width**2 / 2 * _PER_PRODUCT if scene.keep == "statistics" else 0.0


def in_words(seconds: float) -> str:
    """A time as people say it.

    Examples
    --------
    >>> in_words(200), in_words(90_000), in_words(1e9)
    ('3.3 min', '25 h', '32 years')
    """
    for size, name in ((3.15576e7, "years"), (86_400 * 3, "days"), (3600.0, "h"), (60.0, "min")):
        if seconds >= size:
            return f"{seconds / (86_400 if name == 'days' else size):.2g} {name}"
    return f"{seconds:.2g} s"
