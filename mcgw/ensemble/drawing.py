"""Draw surfaces block by block: block size, threads, and what is kept of them: here all their numbers.

Estimates of the time of a run, in seconds and in words.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from time import perf_counter
from typing import Any, TypeVar

import numba
import numpy as np

from analytic import quantity_of
from mcgw.ensemble.results import CHUNK_ROWS, Held, MemoryResults, Tables, joined
from mcgw.errors import StoreError
from mcgw.machine.in_threads import in_threads, pieces
from mcgw.machine.memory import check_memory
from mcgw.sampling.block import Block, Sampler, Source
from mcgw.sampling.counts import GROUP
from mcgw.sampling.expected import Expected, expected
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.scene import Scene

_Drawn = TypeVar("_Drawn")
# Called with the surfaces drawn so far, or their work; returns whether to go on.
GoOn = Callable[[float], bool]
_WORDS = 4_000_000  # numbers of a block that fit the outer cache
_MOST_WORDS = 20_000_000  # numbers a block may hold
_DRAWS = 1.5e8  # asperities a block may draw, so that a bar moves every second
_PER_COUNT, _PER_PRODUCT = 4e-8, 2.5e-10  # rough seconds per number and per pair, for statistics
_FILE_BYTES = 2**23  # of a block of a file: large enough that its flushing costs little
_FILE_DRAWS = 4e8  # numbers drawn for such a block: a second or so
_MOST = 2**63 - 1
_SHORT = 0.01  # s; times below are given in milliseconds
_TRIED = 0.05  # rough seconds per surface up to which a block is drawn on trial


def drawn_blocks(sampler: Source[_Drawn], first: int, stop: int, size: int) -> Iterator[_Drawn]:
    """Results of surfaces `first` ... `stop - 1`, in order, in blocks of at most `size`.

    Each thread draws its own blocks. Sharing the work within a block costs a wake-up per step, which pays
    only for a few, huge surfaces.
    """

    def block(ends: tuple[int, int]) -> _Drawn:
        return sampler.block(start + ends[0], ends[1] - ends[0])

    step = at_a_time(size)
    for start in range(first, stop, step):
        n = min(step, stop - start)
        yield from in_threads(block, pieces(n, GROUP if n >= GROUP * numba.get_num_threads() else 1))


def at_a_time(size: int) -> int:
    """Surfaces drawn side by side: a block for each thread, or one surface if that is a block."""
    return size * numba.get_num_threads() if size > 1 else 1  # it may fill the memory


def kept(scene: Scene, block: Block) -> dict[str, Any]:
    """Return what is kept of a block: its sums, contacts as whole numbers."""
    arrays = dict(block.sums)
    if scene.interaction is not None or scene.gas is not None:
        from mcgw.ensemble.half_space import answered  # for those scenes alone

        more = (*scene.other_separations, *scene.of_joint)
        arrays = answered(scene, arrays, more, np.array(scene.separations))
    for name in filter(lambda name: quantity_of(name).counts, scene.quantities):
        arrays[name] = np.rint(arrays[name]).astype(np.int64)
    return arrays


def block_size(scene: Scene, sampler: Source[Any]) -> int:
    """Surfaces per block, bounded by memory and time; if possible twice an odd number of `counts.GROUP`.

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
    """Set the number of threads of the loops, at most those available."""
    if threads is not None and not (isinstance(threads, int) and threads >= 1):
        raise ValueError(f"threads = {threads!r}: give a whole number >= 1")
    before = numba.get_num_threads()
    numba.set_num_threads(min(threads or before, before))
    try:
        yield
    finally:
        numba.set_num_threads(before)


def always(_: float) -> bool:
    """Return True: continue always."""
    return True


class Reducer(ABC):
    """Draws surfaces of one scene, or of several that share them, and keeps the requested part of each block.

    Blocks depend on the scenes alone and are joined in order: the same bits whoever draws them, and despite
    interruptions.
    """

    work = 1.0  # cost of a surface, in any unit
    disk = 0  # largest size of blocks and file in bytes

    @property
    @abstractmethod
    def n_surfaces(self) -> int:
        """How many surfaces are asked for."""

    @property
    @abstractmethod
    def rows(self) -> int:
        """Surfaces per block."""

    @abstractmethod
    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """Return what is kept of a block or its beginning, whatever the number of threads.

        `go_on` is called after each piece that fits the memory.
        """

    @abstractmethod
    def held(self, blocks: Iterable[Tables]) -> Any:
        """Return the result of all blocks, each read in its turn."""

    @abstractmethod
    def check(self, surfaces: int | None = None) -> None:
        """Refuse surfaces that do not fit the memory; with a file, only a block must fit.

        Raises
        ------
        StoreError
            With the numbers.
        """


def drawn(reducers: Sequence[Reducer], go_on: GoOn) -> list[Any]:
    """Return what each keeps of all its surfaces, or of as many as `go_on` allows, in memory.

    That is told of the work that is done, of all of them.
    """
    more, before, found = True, 0.0, []

    def blocks(one: Reducer) -> Iterator[Tables]:
        def asked(done: float) -> bool:
            nonlocal more
            more = go_on(before + done * one.work)
            return more

        for first in range(0, one.n_surfaces, one.rows):
            if more:
                yield one.tables(first, min(first + one.rows, one.n_surfaces), asked)

    for one in reducers:
        found.append(one.held(blocks(one)))
        before += one.n_surfaces * one.work
    return found


@dataclass(frozen=True)
class Values(Reducer):
    """All numbers of every surface of one scene.

    Parameters
    ----------
    scene : Scene
        With a fixed number of surfaces.
    expected : Expected, optional
        What stands for its sampler, to be asked its size.
    """

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

    @cached_property
    def rows(self) -> int:
        """Surfaces of a block: whole chunks of a file."""
        size, row = block_size(self.scene, self.sampler), 8 * self.scene.width
        fitting = min(_FILE_BYTES / (size * row), _FILE_DRAWS / (size * (self.sampler.draws + 1)))
        rows = size * int(max(fitting, 1))
        return rows - rows % CHUNK_ROWS if rows > CHUNK_ROWS else rows

    @property
    def disk(self) -> int:  # type: ignore[override]
        """Bytes of the blocks, and of the file they are merged into."""
        return 2 * self.joined_bytes(self.n_surfaces)

    def joined_bytes(self, surfaces: int) -> int:
        """Approximate size of the file of so many surfaces, before compression."""
        return 8 * surfaces * self.scene.width

    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """Return the numbers, a row a surface."""
        parts, done = [], first
        for block in drawn_blocks(self.sampler, first, stop, block_size(self.scene, self.sampler)):
            parts.append(kept(self.scene, block))
            done += len(parts[-1][self.scene.quantities[0]])
            if not go_on(done):
                break
        return joined(parts)

    def held(self, blocks: Iterable[Tables]) -> Held:
        """All of them, one below the other."""
        return MemoryResults(joined(list(blocks)))

    def check(self, surfaces: int | None = None) -> None:
        """Refuse what does not fit the memory."""
        scene, n, k = self.scene, self.n_surfaces, len(self.scene.separations)
        if surfaces is not None:
            what = f"ensemble.n_surfaces = {surfaces}: {len(scene.quantities)} quantities at {k} separations"
            check_memory(what, 2 * 8 * surfaces * scene.width)  # the blocks, and all of them joined
            return
        for what, value in (
            ("n_surfaces * n_asperities", n * scene.n_asperities),
            ("n_surfaces * n_asperities * separations", n * scene.n_asperities * k),
            ("bytes of the file", self.disk // 2),
        ):
            if value > _MOST:
                raise StoreError(f"ensemble: {what} = {value:.4g} is more than 2^63 - 1; reduce the scene")
        rows = min(self.rows, n)
        check_memory(f"contact.separations: a block of {rows} surfaces", 3 * 8 * rows * scene.width)


def seconds_for(scene: Scene, sampler: Sampler, surfaces: int, *, at_least: float = 0.0) -> float:
    """Return the expected wall time of drawing some surfaces on this machine, s.

    Measured on a trial block if surfaces are cheap, unless a rough estimate is below `at_least`.
    """
    rough = rough_seconds(scene, 1)
    if rough * surfaces < at_least or rough > _TRIED:
        return rough * surfaces
    return surfaces * (seconds_per_surface(scene, sampler) + _for_statistics(scene))


def rough_seconds(scene: Scene, surfaces: int) -> float:
    """Estimate the wall time of drawing some surfaces by arithmetic alone, s, within a factor of two."""
    return surfaces * (expected(scene).seconds / numba.get_num_threads() + _for_statistics(scene))


def _for_statistics(scene: Scene) -> float:
    """Rough seconds of a surface of which only statistics are kept."""
    return scene.width * _PER_COUNT + scene.width**2 / 2 * _PER_PRODUCT if scene.keep == "statistics" else 0.0


def in_words(seconds: float) -> str:
    """Return a time as people say it.

    Examples
    --------
    >>> in_words(3e-4), in_words(200), in_words(90_000), in_words(1e9)
    ('0.3 ms', '3.3 min', '25 h', '32 years')
    """
    for size, name in ((3.15576e7, "years"), (86_400 * 3, "days"), (3600.0, "h"), (60.0, "min")):
        if seconds >= size:
            return f"{seconds / (86_400 if name == 'days' else size):.2g} {name}"
    return f"{1e3 * seconds:.2g} ms" if seconds < _SHORT else f"{seconds:.2g} s"
