"""The surfaces of a sweep, block by block, and what is kept of what they answer.

Blocks are a function of the sweep alone and are added up in their order: the same bits whoever draws them,
and wherever a sweep was interrupted.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace

from mcgw.ensemble.drawing import block_size, drawn_blocks, kept
from mcgw.ensemble.results import joined
from mcgw.ensemble.summary import size_of
from mcgw.machine.memory import check_memory
from mcgw.sampling.shared import Alone, Shared, shared
from mcgw.store.plan import Plan
from mcgw.sweeps.groups import Group
from mcgw.sweeps.pooled import Pooled

__all__ = ["added_up", "check_memory_of", "draw", "plan_of", "pooled_of", "weighted", "work_of"]

_ROWS = 8192  # surfaces whose values are pooled at once, as an ensemble does
_BYTES = 2**28  # of those values
_DRAWS = 1e10  # asperities of a block: what an interruption may cost
_ANSWER = 3000  # asperities that take as long to draw as a surface takes to answer one scene


def plan_of(groups: Sequence[Group]) -> Plan:
    """All blocks of a sweep, group after group."""
    found = []
    for group in groups:
        width = sum(scene.width for scene in group.computed)
        most = min(_ROWS, _BYTES // (8 * width), int(_DRAWS / (group.scenes[0].touching + 1)))
        found.append((group.n_surfaces, max(most, 1)))
    return Plan(tuple(found), whole=True)


def work_of(group: Group) -> float:
    """What a surface of a group takes, in asperities drawn."""
    return group.scenes[0].touching + _ANSWER * len(group.computed)


def weighted(groups: Sequence[Group], tell: Callable[[float, float], object]) -> Callable[[float], object]:
    """Tells (done, total) surfaces, each weighted by what it takes, out of how much work is done."""
    surfaces = sum(group.n_surfaces for group in groups)
    work = sum(group.n_surfaces * work_of(group) for group in groups)
    return lambda done: tell(round(surfaces * done / work), surfaces)


def draw(groups: Sequence[Group], tell: Callable[[float, float], object]) -> list[Pooled]:
    """Draw all, in memory: what is kept of each group.

    Raises
    ------
    StoreError
        If the memory is too small.
    """
    check_memory_of(groups)
    note, plan, done = weighted(groups, tell), plan_of(groups), 0.0
    note(done)

    def drawn() -> Iterator[tuple[int, Pooled]]:
        nonlocal done
        source, last = None, -1
        for span in plan.missing([]):
            g, first = plan.group(span)
            if source is None or g != last:
                source, last = shared(groups[g].computed), g
            yield g, pooled_of(groups[g], source, first, span.n)
            done += span.n * work_of(groups[g])
            note(done)

    return added_up(drawn())


def added_up(blocks: Iterable[tuple[int, Pooled]]) -> list[Pooled]:
    """What is kept of each group, from all blocks in their order, each with the number of its group."""
    groups: list[Pooled] = []
    for g, pooled in blocks:
        if g == len(groups):
            groups.append(pooled)
        else:
            groups[-1] = groups[-1] + pooled
    return groups


def pooled_of(group: Group, source: Shared | Alone, first: int, n: int) -> Pooled:
    """Draw a block, from what `mcgw.sampling.shared.shared` makes of the scenes of its group."""
    size = block_size(group.computed[0], source)
    blocks = list(drawn_blocks(source, first, first + n, size))
    values = [joined([kept(scene, block[i]) for block in blocks]) for i, scene in enumerate(group.computed)]
    pooled = Pooled.of(values)
    if group.computed[0].keep != "statistics":
        return pooled
    from mcgw.ensemble.summarising import summary_of_values  # for those scenes alone

    each = zip(group.computed, values, group.bins, strict=True)
    return replace(pooled, blocks=tuple((summary_of_values(*one[:2], first, one[2]),) for one in each))


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
        if scenes[0].keep == "statistics":
            what = f'ensemble.keep = "statistics": {len(scenes)} points of {scenes[0].width} numbers'
            check_memory(what, 4 * len(scenes) * size_of(scenes[0].width))
