"""The surfaces of a sweep, chunk by chunk, and what is kept of what they answer.

Chunks are a function of the sweep alone and are added up in their order: the same bits whoever draws them,
and wherever a sweep was interrupted.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

from mcgw.ensemble.drawing import block_size, drawn_blocks, kept
from mcgw.ensemble.results import joined
from mcgw.machine.memory import check_memory
from mcgw.sampling.shared import Alone, Shared, shared
from mcgw.sweeps.groups import Group
from mcgw.sweeps.pooled import Pooled

__all__ = ["Chunk", "Told", "added_up", "check_memory_of", "chunks_of", "draw", "pooled_chunk", "work_of"]

_ROWS = 8192  # surfaces whose values are pooled at once, as an ensemble does
_BYTES = 2**28  # of those values
_DRAWS = 1e10  # asperities of a chunk: what an interruption may cost
_ANSWER = 3000  # asperities that take as long to draw as a surface takes to answer one scene


@dataclass(frozen=True, order=True)
class Chunk:
    """Some surfaces of a group.

    Parameters
    ----------
    number : int
        Among all chunks of the sweep.
    group : int
        Of points that share these surfaces.
    first, n : int
        Surfaces `first` ... `first + n - 1`.
    """

    number: int
    group: int
    first: int
    n: int

    def __str__(self) -> str:
        return f"surfaces {self.first} ... {self.first + self.n - 1} of group {self.group}"


class Told:
    """How far a sweep is, told in surfaces, each weighted by what it takes.

    Parameters
    ----------
    groups : sequence of Group
        All groups of the sweep.
    tell : callable
        Told (done, total) surfaces.
    """

    def __init__(self, groups: Sequence[Group], tell: Callable[[float, float], object]) -> None:
        self._work, self._tell = [work_of(group) for group in groups], tell
        self._surfaces = sum(group.n_surfaces for group in groups)
        self._total = sum(group.n_surfaces * work for group, work in zip(groups, self._work, strict=True))

    def size(self, chunk: Chunk) -> float:
        """What a chunk takes."""
        return chunk.n * self._work[chunk.group]

    def __call__(self, done: float) -> None:
        """Tell that this much is done, in the unit of `size`."""
        self._tell(round(self._surfaces * done / self._total), self._surfaces)


def chunks_of(groups: Sequence[Group]) -> list[Chunk]:
    """All chunks of a sweep, group after group."""
    found: list[Chunk] = []
    for g, group in enumerate(groups):
        width = sum(scene.width for scene in group.computed)
        most = min(_ROWS, _BYTES // (8 * width), int(_DRAWS / (group.scenes[0].touching + 1)))
        rows, total = max(most, 1), group.n_surfaces
        for first in range(0, total, rows):
            found.append(Chunk(len(found), g, first, min(rows, total - first)))
    return found


def work_of(group: Group) -> float:
    """What a surface of a group takes, in asperities drawn."""
    return group.scenes[0].touching + _ANSWER * len(group.computed)


def draw(groups: Sequence[Group], tell: Callable[[float, float], object]) -> list[Pooled]:
    """Draw all, in memory: what is kept of each group.

    Raises
    ------
    StoreError
        If the memory is too small.
    """
    check_memory_of(groups)
    told, done = Told(groups, tell), 0.0
    told(done)

    def drawn() -> Iterator[tuple[Chunk, Pooled]]:
        nonlocal done
        for g, chunks in groupby(chunks_of(groups), lambda chunk: chunk.group):
            source = shared(groups[g].computed)
            for chunk in chunks:
                yield chunk, pooled_chunk(groups[g], source, chunk)
                done += told.size(chunk)
                told(done)

    return added_up(drawn())


def added_up(chunks: Iterable[tuple[Chunk, Pooled]]) -> list[Pooled]:
    """What is kept of each group, from all chunks in their order."""
    groups: list[Pooled] = []
    for chunk, pooled in chunks:
        if chunk.group == len(groups):
            groups.append(pooled)
        else:
            groups[-1] = groups[-1] + pooled
    return groups


def pooled_chunk(group: Group, source: Shared | Alone, chunk: Chunk) -> Pooled:
    """Draw a chunk, from what `mcgw.sampling.shared.shared` makes of the scenes of its group."""
    size = block_size(group.computed[0], source)
    blocks = list(drawn_blocks(source, chunk.first, chunk.first + chunk.n, size))
    return Pooled.of(
        [joined([kept(scene, block[i]) for block in blocks]) for i, scene in enumerate(group.computed)]
    )


def check_memory_of(groups: Sequence[Group]) -> None:
    """Refuse a sweep whose covariances the memory cannot hold.

    Raises
    ------
    StoreError
        With the numbers.
    """
    for group in groups:
        scenes = group.computed
        check_memory(
            f"sweep: covariances between {len(scenes)} points at {len(scenes[0].separations)} separations",
            2 * 8 * scenes[0].width * len(scenes) ** 2,
        )
