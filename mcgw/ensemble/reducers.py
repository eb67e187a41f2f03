"""What is kept of surfaces that are drawn block by block, and what many blocks make."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from numpy.typing import NDArray

from mcgw.ensemble.drawing import block_size, drawn_blocks, kept
from mcgw.ensemble.results import MemoryResults, joined
from mcgw.errors import StoreError
from mcgw.machine.memory import check_memory
from mcgw.sampling.samplers import Sampler, sampler_of
from mcgw.scene.scene import Scene

__all__ = ["CHUNK_ROWS", "GoOn", "OfScene", "Reducer", "Tables", "Values", "always", "drawn", "reducer_of"]

Tables = dict[str, NDArray[Any]]
GoOn = Callable[[int], bool]  # told the surface after those that are drawn, says whether to draw more

CHUNK_ROWS = 256  # surfaces of a chunk of a file; fewer, by powers of two, where a chunk would be too large
_BYTES = 2**23  # of a block: large enough that its flushing costs little
_DRAWS = 4e8  # numbers drawn for a block: a second or so
_OUTSIDE = 3  # numbers kept of an asperity outside the cells: surface, height, weight
_MOST = 2**63 - 1


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
    """Of the surfaces of one scene, with a number of them."""

    scene: Scene

    @cached_property
    def sampler(self) -> Sampler:
        """The scene's."""
        return sampler_of(self.scene)

    @property
    def n_surfaces(self) -> int:
        """How many surfaces are asked for."""
        return self.scene.n_surfaces

    @abstractmethod
    def joined_bytes(self, surfaces: int) -> int:
        """About what the file of so many surfaces takes, before compression."""


class Values(OfScene):
    """All numbers of every surface."""

    whole = False

    @cached_property
    def rows(self) -> int:
        """Surfaces of a block: whole chunks of a file."""
        size, row = block_size(self.scene, self.sampler), 8 * self.columns
        fitting = min(_BYTES / (size * row), _DRAWS / (size * (self.sampler.draws + 1)))
        rows = size * int(max(fitting, 1))
        return rows - rows % CHUNK_ROWS if rows > CHUNK_ROWS else rows

    @property
    def columns(self) -> int:
        """Numbers kept of a surface."""
        sums = self.scene.width
        if self.scene.keep != "moments":
            return sums
        return sums + self.sampler.moments + self.sampler.cells + _OUTSIDE

    @property
    def disk(self) -> int:  # type: ignore[override]
        """Bytes of the blocks, and of the file they are merged into."""
        return 2 * self.joined_bytes(self.n_surfaces)

    def joined_bytes(self, surfaces: int) -> int:
        """What the file of so many surfaces takes."""
        return 8 * surfaces * self.columns

    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """The numbers, a row a surface."""
        parts, done = [], first
        for block in drawn_blocks(self.sampler, first, stop, block_size(self.scene, self.sampler)):
            parts.append(kept(self.scene, block))
            done += len(parts[-1][self.scene.quantities[0]])
            if not go_on(done):
                break
        return joined(parts)

    def held(self, blocks: Iterable[Tables]) -> MemoryResults:
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
                raise StoreError(
                    f"ensemble: {what} = {value:.4g} is more than 2^63 - 1 can count; ask for less"
                )
        rows = min(self.rows, n)
        check_memory(f"contact.separations: a block of {rows} surfaces", 3 * 8 * rows * self.columns)


def reducer_of(scene: Scene) -> OfScene:
    """The one for what a scene keeps."""
    if scene.keep != "statistics":
        return Values(scene)
    from mcgw.ensemble.summarising import Statistics  # for those scenes alone

    return Statistics(scene)
