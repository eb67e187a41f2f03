"""What a scene will cost, and what it spares: told before anything is drawn."""

from dataclasses import dataclass

from analytic import QUANTITIES
from mcgw.ensemble.forecast import forecast
from mcgw.jobs.duration import in_words, seconds_for
from mcgw.machine.terminal import one_line
from mcgw.reports.elasticity import two_questions
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.contact_text import contact_facts
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene

__all__ = ["Plan", "plan_of", "plan_text"]


@dataclass(frozen=True)
class Plan:
    """What will be drawn.

    Parameters
    ----------
    sampler : str
        The one that ``auto`` stands for, too.
    surfaces : int
        How many will be drawn; with `rel_err` by `forecast`.
    asperities : float
        On a surface.
    touching : float
        Expected to touch at the lowest separation.
    drawn : float
        Uniforms (or normals) expected to be drawn for a surface.
    cells, moments : int
        Of a surface; 0 for samplers without cells.
    bytes : int
        Of the results of all surfaces, before compression.
    seconds : float
        Expected for all surfaces on this machine.
    """

    sampler: str
    surfaces: int
    asperities: float
    touching: float
    drawn: float
    cells: int
    moments: int
    bytes: int
    seconds: float


def plan_of(scene: Scene) -> Plan:
    """Look at what a scene needs, and time a small block of it, of which nothing is kept."""
    sampler = sampler_of(scene)
    columns = scene.width
    columns += (sampler.moments + sampler.cells) * (scene.keep == "moments")
    surfaces = forecast(scene).surfaces
    return Plan(
        sampler.name,
        surfaces,
        float(scene.n_asperities),
        scene.touching,
        sampler.draws,
        sampler.cells,
        sampler.moments,
        8 * columns * surfaces,
        seconds_for(scene, sampler, surfaces),
    )


def plan_text(scene: Scene, plan: Plan) -> str:
    """The plan in words, with what is not done and why."""
    lines = [
        one_line(scene.title) or "scene",
        f"  surfaces      {plan.surfaces} of {scene.n_asperities} asperities ({scene.count})",
        f"  sampler       {plan.sampler}" + (" (chosen by auto)" if scene.sampler == "auto" else ""),
        f"  touching      {plan.touching:.4g} of a surface, at the lowest d/sigma = {scene.lowest:g}",
        f"  drawn         {plan.drawn:.4g} of a surface",
        f"  cells         {plan.cells}, with {plan.moments} moments a surface",
        f"  quantities    {', '.join(scene.quantities)} at {len(scene.separations)} separations",
        *(f"  {word:13} {what}" for word, what in contact_facts(scene)),
        f"  results       {plan.bytes / 1e6:.4g} MB before compression",
        f"  time          about {in_words(plan.seconds)} on this machine",
        *(f"  {line}" for line in two_questions(scene.validity())),
        "not done:",
    ]
    spared = plan.asperities - plan.touching
    lines += [f"  {line.format(spared=spared)}" for line in promise_of(plan.sampler).not_done]
    if plan.cells and not plan.moments:
        lines.append("  no height is drawn: contacts follow from the numbers in the cells")
    left_out = [name for name in QUANTITIES if name not in scene.quantities]
    if left_out:
        lines.append(f"  {', '.join(left_out)}: not asked for")
    return "\n".join(lines)
