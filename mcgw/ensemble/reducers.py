"""What is kept of the surfaces of a scene as they are drawn: all their numbers, or what statistics need."""

from collections.abc import Iterable
from functools import cached_property

from mcgw.ensemble.drawing import GoOn, OfScene, always, block_size, drawn_blocks, kept
from mcgw.ensemble.results import CHUNK_ROWS, MemoryResults, Tables, joined
from mcgw.errors import StoreError
from mcgw.machine.memory import check_memory
from mcgw.scene.scene import Scene

__all__ = ["Values", "reducer_of"]

_BYTES = 2**23  # of a block: large enough that its flushing costs little
_DRAWS = 4e8  # numbers drawn for a block: a second or so
_MOST = 2**63 - 1


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
        return sums + self.sampler.moments + self.sampler.cells

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
