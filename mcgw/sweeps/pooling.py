"""Means, variances and covariances of scenes that share their surfaces, drawn block by block."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache, reduce
from operator import add

from mcgw.ensemble.drawing import GoOn, Reducer, always, block_size, drawn, drawn_blocks, kept
from mcgw.ensemble.pooled import Pooled
from mcgw.ensemble.results import Tables, joined
from mcgw.machine.memory import check_memory
from mcgw.sampling.shared import Shared, shared
from mcgw.sweeps.groups import Group

_ROWS = 8192  # surfaces whose values are pooled at once, as an ensemble does
_BYTES = 2**28  # bytes of those values
_DRAWS = 1e10  # asperities per block: the cost of an interruption
_ANSWER = 3000  # cost of one scene per surface, in asperities drawn


@dataclass(frozen=True, eq=False)
class Pooling(Reducer):
    """Means, variances and covariances of the points of a sweep that share their surfaces."""

    group: Group

    @property
    def n_surfaces(self) -> int:
        """Number of shared surfaces."""
        return self.group.n_surfaces

    @property
    def rows(self) -> int:
        """Surfaces per block."""
        width = sum(scene.width for scene in self.group.computed)
        return max(min(_ROWS, _BYTES // (8 * width), int(_DRAWS / (self._touching + 1))), 1)

    @property
    def work(self) -> float:  # type: ignore[override]
        """Cost of a surface, in asperities drawn."""
        return self._touching + _ANSWER * len(self.group.computed)

    @property
    def _touching(self) -> float:
        return self.group.scenes[0].touching

    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """Statistics of a block, as `Pooled` stores them."""
        scenes, source = self.group.computed, _source_of(self)
        blocks = list(drawn_blocks(source, first, stop, block_size(scenes[0], source)))
        values = [joined([kept(scene, block[i]) for block in blocks]) for i, scene in enumerate(scenes)]
        go_on(stop)
        return Pooled.of(values).block()

    def held(self, blocks: Iterable[Tables]) -> Pooled:
        """Return the sum of all blocks."""
        return reduce(add, map(Pooled.from_block, blocks))

    def check(self, surfaces: int | None = None) -> None:  # noqa: ARG002
        """Refuse covariances that the memory cannot hold."""
        scenes = self.group.computed
        check_memory(
            f"sweep: covariances between {len(scenes)} points at {len(scenes[0].separations)} separations",
            2 * 8 * scenes[0].width * len(scenes) ** 2,
        )


@lru_cache(maxsize=1)  # blocks come in the order of groups
def _source_of(pooling: Pooling) -> Shared:
    return shared(pooling.group.computed, pooling.group.edges)


def weighted(
    reducers: Iterable[Reducer], tell: Callable[[float, float], object]
) -> Callable[[float], object]:
    """Convert work done to (done, total) surfaces, weighted by their cost."""
    each = [(one.n_surfaces, one.n_surfaces * one.work) for one in reducers]
    surfaces, work = map(sum, zip(*each, strict=True))
    return lambda done: tell(round(surfaces * done / work), surfaces)


def draw(groups: Iterable[Group], tell: Callable[[float, float], object]) -> list[Pooled]:
    """Draw all groups in memory and return their statistics.

    Raises
    ------
    StoreError
        If the memory is too small.
    """
    poolings, before, found = list(map(Pooling, groups)), 0.0, []
    for one in poolings:
        one.check()
    note = weighted(poolings, tell)
    note(0)
    for one in poolings:

        def go_on(done: int, one: Pooling = one, before: float = before) -> bool:
            note(before + done * one.work)
            return True

        found.append(drawn(one, go_on))
        before += one.n_surfaces * one.work
    return found
