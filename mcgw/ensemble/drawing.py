"""Draw surfaces block by block: block size, threads, and what is kept of them: here all their numbers.

Or statistics over the surfaces, of a scene that keeps no surface: these take as much memory for ten
surfaces as for a billion.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import chain
from operator import add
from time import perf_counter
from typing import Any, TypeVar

import numpy as np

from analytic import quantity_of
from mcgw.ensemble.results import CHUNK_ROWS, Results, Tables, joined
from mcgw.machine.process import check_memory
from mcgw.machine.threads import THREADS, in_threads, pieces
from mcgw.sampling.block import GROUP, Source, Sums
from mcgw.sampling.expected import Expected
from mcgw.scene.scene import Scene

_Drawn = TypeVar("_Drawn")
# Called with the surfaces drawn so far, or their work; returns whether to go on.
GoOn = Callable[[float], bool]
_WORDS = 4_000_000  # numbers of a block that fit the outer cache
_MOST_WORDS = 20_000_000  # numbers a block may hold
_DRAWS = 1.5e8  # asperities a block may draw, so that a bar moves every second
_FILE_BYTES = 2**23  # of a block of a file: large enough that its flushing costs little
_FILE_DRAWS = 4e8  # numbers drawn for such a block: a second or so
_PIECE_ROWS = 2**13  # surfaces whose values lie in memory at once
_PIECE_BYTES = 2**26  # of these values
_PIECE_DRAWS = 1e9  # numbers drawn for a block: what an interruption may cost
_MOST_ROWS = 2**20  # surfaces of a block


def drawn_blocks(sampler: Source[_Drawn], first: int, stop: int, size: int) -> Iterator[_Drawn]:
    """Results of surfaces `first` ... `stop - 1`, in order, in blocks of at most `size`.

    Each thread draws its own blocks. Sharing the work within a block costs a wake-up per step, which pays
    only for a few, huge surfaces.
    """
    step = size * THREADS.get() if size > 1 else 1  # a surface that is a block may fill the memory
    for start in range(first, stop, step):
        n = min(step, stop - start)
        ends = pieces(n, GROUP if n >= GROUP * THREADS.get() else 1)
        yield from in_threads(lambda span: sampler.block(*span), [(start + a, b - a) for a, b in ends])


def kept(scene: Scene, sums: Sums) -> dict[str, Any]:
    """Return what is kept of a block: its sums, contacts as whole numbers."""
    arrays = dict(sums)
    if more := scene.tables[len(scene.quantities) :]:
        from mcgw.ensemble.at_load import answered  # for those scenes alone

        arrays = answered(scene, arrays, more, np.array(scene.separations))
    for name in filter(lambda name: quantity_of(name).counts, scene.quantities):
        arrays[name] = np.rint(arrays[name]).astype(np.int64)
    return {name: np.ascontiguousarray(rows) for name, rows in arrays.items()}  # means have the same bits


def block_size(scene: Scene, sampler: Source[Any]) -> int:
    """Surfaces per block, bounded by memory and time; if possible twice an odd number of `GROUP`.

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
    n = size * THREADS.get() if size > 1 else 1
    list(drawn_blocks(sampler, 0, n, size))
    times = []
    for _ in range(3):
        start = perf_counter()
        list(drawn_blocks(sampler, 0, n, size))
        times.append(perf_counter() - start)
    return float(np.median(times)) / n


@dataclass(frozen=True, eq=False)
class Values:
    """Draws the surfaces of one scene, of a fixed number, and keeps of each all its numbers.

    Others keep statistics, of one scene or of several that share their surfaces. Blocks depend on the scenes
    alone and are joined in order: the same bits whoever draws them, and despite interruptions.
    """

    scene: Scene
    expected: Expected | None = None  # stands for a sampler, to be asked its size
    work = 1.0  # cost of a surface, in any unit

    @cached_property
    def sampler(self) -> Any:
        """The scene's."""
        if self.expected:
            return self.expected
        from mcgw.sampling.samplers import sampler_of  # compiled loops, which are not needed to ask for sizes

        return sampler_of(self.scene)

    @cached_property
    def rows(self) -> int:
        """Surfaces of a block: whole chunks of a file."""
        size, row = block_size(self.scene, self.sampler), 8 * self.scene.width
        fitting = min(_FILE_BYTES / (size * row), _FILE_DRAWS / (size * (self.sampler.draws + 1)))
        rows = size * int(max(fitting, 1))
        return rows - rows % CHUNK_ROWS if rows > CHUNK_ROWS else rows

    @property
    def disk(self) -> int:
        """Bytes of the blocks, and of the file they are merged into."""
        return 2 * 8 * self.scene.n_surfaces * self.scene.width

    def joined_bytes(self, surfaces: int) -> int:
        """Approximate size of the file of so many surfaces, before compression."""
        return 8 * surfaces * self.scene.width

    def tables(self, first: int, stop: int, go_on: GoOn | None = None) -> Tables:
        """Return what is kept of a block or its beginning, whatever the number of threads.

        `go_on` is called after each piece that fits the memory.
        """
        found, done = Tables(), first
        for block in drawn_blocks(self.sampler, first, stop, block_size(self.scene, self.sampler)):
            part, start = kept(self.scene, block), done - first
            done += len(part[self.scene.quantities[0]])
            for name, rows in part.items():
                if not start:
                    found[name] = np.empty((stop - first, *rows.shape[1:]), rows.dtype)
                found[name][start : done - first] = rows
            if go_on and not go_on(done):
                break
        return {name: rows[: done - first] for name, rows in found.items()}

    def held(self, blocks: Iterable[Tables]) -> Any:
        """Return the results of all blocks, each read in its turn."""
        return Results(joined(list(blocks)))

    def check(self, surfaces: int | None = None) -> None:
        """Refuse surfaces that do not fit the memory, or without a number of them blocks of a file."""
        scene, row = self.scene, 8 * self.scene.width
        if surfaces is None:
            rows = min(self.rows, scene.n_surfaces)
            check_memory(f"contact.separations: a block of {rows} surfaces", 3 * rows * row)
        else:  # the blocks, and all of them joined
            held = f"{len(scene.quantities)} quantities at {len(scene.separations)} separations"
            check_memory(f"ensemble.n_surfaces = {surfaces}: {held}", 2 * surfaces * row)


class Statistics(Values):
    """Count, means and covariances of the numbers of a scene's surfaces."""

    @cached_property
    def rows(self) -> int:
        """Surfaces of a block: a power of two of pieces."""
        most = min(_MOST_ROWS, _PIECE_DRAWS / (self.sampler.draws + 1))
        return self._piece << max(int(np.log2(most / self._piece)), 0)

    @property
    def _piece(self) -> int:
        most = _PIECE_DRAWS / (self.sampler.draws + 1)
        return max(int(min(_PIECE_ROWS, _PIECE_BYTES // (8 * self.scene.width), most)), 1)

    def tables(self, first: int, stop: int, go_on: GoOn | None = None) -> Tables:
        """Return the statistics of a block."""
        from mcgw.ensemble.pooled import NUMBERS, Pooled, tables_of  # for those scenes alone

        parts = list[Pooled]()
        for start in range(first, stop, self._piece):
            end = min(start + self._piece, stop)
            values = super().tables(start, end)
            table = np.concatenate([values[name] for name in self.scene.tables], axis=1)
            parts.append(Pooled.of_columns(NUMBERS, table))
            if go_on and not go_on(end):
                break
        return tables_of([reduce(add, parts)])

    def held(self, blocks: Iterable[Tables]) -> Any:
        """All of them: whole blocks added up in their order, and the rest."""
        from mcgw.ensemble.pooled import Pooled, Summarised, pooled_from  # as above

        whole, rest = list[Pooled](), list[Pooled]()
        for block in chain.from_iterable(map(pooled_from, blocks)):
            if block.n % self.rows:
                rest = [block]
            else:  # with what an earlier rest held
                whole, rest = [reduce(add, [*whole, block])], []
        return Summarised(self.scene.tables, (*whole, *rest))

    def check(self, surfaces: int | None = None) -> None:  # noqa: ARG002
        """Refuse covariances that do not fit the memory."""
        width = self.scene.width
        size = 4 * 8 * width * (width + 1) + 3 * _PIECE_BYTES
        check_memory(f'ensemble.keep = "statistics": covariances between {width} numbers', size)

    @property
    def disk(self) -> int:
        """What blocks take, until they are added up, and then their file."""
        n = self.scene.n_surfaces
        return -(-n // self.rows) * self._block_bytes + self.joined_bytes(n)

    def joined_bytes(self, surfaces: int) -> int:
        """Return what the file of so many surfaces takes: whole blocks, the rest, and the covariance."""
        parts = (surfaces >= self.rows) + (surfaces % self.rows > 0)
        return parts * self._block_bytes + 8 * self.scene.width**2

    @property
    def _block_bytes(self) -> int:
        width = self.scene.width
        return 8 * width * (width + 1)


def reducer_of(scene: Scene, expected: Expected | None = None) -> Values:
    """Return the one for what a scene keeps; of a sampler that is only expected, to be asked its size."""
    return (Statistics if scene.keep == "statistics" else Values)(scene, expected)
