"""The surfaces of a sweep, block by block, and what is kept of what they answer."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import lru_cache, reduce
from operator import add

from mcgw.ensemble.drawing import GoOn, Reducer, always, block_size, drawn, drawn_blocks, kept
from mcgw.ensemble.results import Tables, joined
from mcgw.ensemble.summary import size_of
from mcgw.machine.memory import check_memory
from mcgw.sampling.shared import Shared, shared
from mcgw.sweeps.groups import Group
from mcgw.sweeps.pooled import Pooled

_ROWS = 8192  # surfaces whose values are pooled at once, as an ensemble does
_BYTES = 2**28  # of those values
_DRAWS = 1e10  # asperities of a block: what an interruption may cost
_ANSWER = 3000  # asperities that take as long to draw as a surface takes to answer one scene


@dataclass(frozen=True, eq=False)
class Pooling(Reducer):
    """Means, variances and covariances of the points of a sweep that share their surfaces."""

    group: Group

    @property
    def n_surfaces(self) -> int:
        """How many surfaces they share."""
        return self.group.n_surfaces

    @property
    def rows(self) -> int:
        """Surfaces of a block."""
        width = sum(scene.width for scene in self.group.computed)
        return max(min(_ROWS, _BYTES // (8 * width), int(_DRAWS / (self._touching + 1))), 1)

    @property
    def work(self) -> float:  # type: ignore[override]
        """What a surface takes, in asperities drawn."""
        return self._touching + _ANSWER * len(self.group.computed)

    @property
    def _touching(self) -> float:
        return self.group.scenes[0].touching

    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """What `Pooled` keeps of a block."""
        scenes, source = self.group.computed, _source_of(self)
        blocks = list(drawn_blocks(source, first, stop, block_size(scenes[0], source)))
        values = [joined([kept(scene, block[i]) for block in blocks]) for i, scene in enumerate(scenes)]
        pooled = Pooled.of(values)
        if scenes[0].keep == "statistics":
            from mcgw.ensemble.summarising import summary_of_values  # for those scenes alone

            each = zip(scenes, values, self.group.bins, strict=True)
            blocks_of_each = tuple((summary_of_values(*one[:2], first, one[2]),) for one in each)
            pooled = replace(pooled, blocks=blocks_of_each)
        go_on(stop)
        return pooled.shard()

    def held(self, blocks: Iterable[Tables]) -> Pooled:
        """All of them, added up."""
        return reduce(add, map(Pooled.from_shard, blocks))

    def check(self, surfaces: int | None = None) -> None:  # noqa: ARG002
        """Refuse covariances that the memory cannot hold."""
        scenes = self.group.computed
        check_memory(
            f"sweep: covariances between {len(scenes)} points at {len(scenes[0].separations)} separations",
            2 * 8 * scenes[0].width * len(scenes) ** 2,
        )
        if scenes[0].keep == "statistics":
            what = f'ensemble.keep = "statistics": {len(scenes)} points of {scenes[0].width} numbers'
            check_memory(what, 4 * len(scenes) * size_of(scenes[0].width))


@lru_cache(maxsize=1)  # blocks come group after group
def _source_of(pooling: Pooling) -> Shared:
    return shared(pooling.group.computed)


def weighted(
    reducers: Iterable[Reducer], tell: Callable[[float, float], object]
) -> Callable[[float], object]:
    """Tells (done, total) surfaces, each weighted by what it takes, out of how much work is done."""
    each = [(one.n_surfaces, one.n_surfaces * one.work) for one in reducers]
    surfaces, work = map(sum, zip(*each, strict=True))
    return lambda done: tell(round(surfaces * done / work), surfaces)


def draw(groups: Iterable[Group], tell: Callable[[float, float], object]) -> list[Pooled]:
    """Draw all, in memory: what is kept of each group.

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
