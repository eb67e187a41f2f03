"""What a sweep will take: told before anything is drawn."""

from time import perf_counter

from mcgw.ensemble.drawing import seconds_per_surface
from mcgw.jobs.duration import in_words
from mcgw.machine.terminal import one_line
from mcgw.sampling.shared import shared
from mcgw.sweeps.asked import Asked
from mcgw.sweeps.drawing import Pooling
from mcgw.sweeps.groups import Group

__all__ = ["plan_text"]


def plan_text(asked: Asked) -> str:
    """The plan in words; the group that takes the longest is tried out, of which nothing is kept."""
    groups = asked.groups
    title = str(asked.document["title"])
    computed = sum(len(group.computed) for group in groups)
    drawn = sum(group.n_surfaces * group.scenes[0].touching for group in groups)
    lines = [
        f"{one_line(title) or 'sweep'}: {asked.axes.size} scenes",
        *(f"  {key}  {asked.axes.summary(key)}" for key in asked.axes.keys),
        f"  groups      {len(groups)} that share their surfaces",
        f"  surfaces    {sum(group.n_surfaces for group in groups)}, with {drawn:.4g} asperities that touch",
        f"  computed    {computed} scenes; the others are weighted means of these",
        f"  edges       {sum(len(group.scenes[0].edges) for group in groups)} given to points by others",
        f"  time        about {in_words(_seconds(groups))} on this machine",
    ]
    return "\n".join(lines)


def _seconds(groups: list[Group]) -> float:
    """Of all groups, from the one that takes the longest."""
    work = [group.n_surfaces * Pooling(group).work for group in groups]
    longest = groups[work.index(max(work))]
    started = perf_counter()
    source = shared(longest.computed)
    preparing = perf_counter() - started
    each = seconds_per_surface(longest.computed[0], source)
    scenes = sum(len(group.computed) for group in groups)
    return preparing * scenes / len(longest.computed) + each * longest.n_surfaces * sum(work) / max(work)
