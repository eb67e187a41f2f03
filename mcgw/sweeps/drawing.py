"""The surfaces of a sweep, chunk by chunk, and what is kept of what they answer.

Chunks are a function of the sweep alone and are added up in their order: the same bits for any number of
threads, and wherever a sweep was interrupted.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from mcgw.ensemble.results import joined
from mcgw.ensemble.simulation import block_size, drawn_blocks, kept
from mcgw.machine.memory import check_memory
from mcgw.sampling.shared import Alone, Shared, shared
from mcgw.sweeps.groups import Group
from mcgw.sweeps.pooled import Pooled

__all__ = ["Chunk", "Keeper", "Memory", "chunks_of", "draw", "work_of"]

_ROWS = 8192  # surfaces whose values are pooled at once, as an ensemble does
_BYTES = 2**28  # of those values
_DRAWS = 1e10  # asperities of a chunk: what an interruption may cost
_ANSWER = 3000  # asperities that take as long to draw as a surface takes to answer one scene


@dataclass(frozen=True)
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


class Keeper(Protocol):
    """Where chunks lie that are done."""

    def held(self, chunk: Chunk) -> Pooled | None:
        """What is kept of a chunk, if it is done."""
        ...

    def keep(self, chunk: Chunk, pooled: Pooled) -> None:
        """Keep a chunk that is done."""
        ...


class Memory:
    """Keeps nothing."""

    def held(self, chunk: Chunk) -> Pooled | None:  # noqa: ARG002 - it has none
        """None is ever done."""
        return None

    def keep(self, chunk: Chunk, pooled: Pooled) -> None:
        """Nothing is kept."""


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


def draw(groups: Sequence[Group], keeper: Keeper, tell: Callable[[float, float], object]) -> list[Pooled]:
    """Draw what is not yet kept, and add it up for each group.

    Parameters
    ----------
    groups : sequence of Group
        All groups of the sweep.
    keeper : Keeper
        Of chunks.
    tell : callable
        Told (done, total) surfaces, each weighted by what it takes.

    Raises
    ------
    StoreError
        If the memory is too small.
    """
    chunks, found = chunks_of(groups), []
    surfaces, done = sum(group.n_surfaces for group in groups), 0.0
    total = sum(group.n_surfaces * work_of(group) for group in groups)
    tell(0, surfaces)
    for g, group in enumerate(groups):
        _check_memory(group)
        source, pooled = None, None
        for chunk in (chunk for chunk in chunks if chunk.group == g):
            some = keeper.held(chunk)
            if some is None:
                source = source or shared(group.computed)
                some = _pooled(group, source, chunk)
                keeper.keep(chunk, some)
            pooled = some if pooled is None else pooled + some
            done += chunk.n * work_of(group)
            tell(round(surfaces * done / total), surfaces)
        assert pooled is not None
        found.append(pooled)
    return found


def _pooled(group: Group, source: Shared | Alone, chunk: Chunk) -> Pooled:
    size = block_size(group.computed[0], source)
    blocks = list(drawn_blocks(source, chunk.first, chunk.first + chunk.n, size))
    return Pooled.of(
        [joined([kept(scene, block[i]) for block in blocks]) for i, scene in enumerate(group.computed)]
    )


def _check_memory(group: Group) -> None:
    scenes = group.computed
    check_memory(
        f"sweep: covariances between {len(scenes)} points at {len(scenes[0].separations)} separations",
        2 * 8 * scenes[0].width * len(scenes) ** 2,
    )
