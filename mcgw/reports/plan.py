"""Cost of a scene, estimated before anything is drawn."""

from analytic import QUANTITIES
from mcgw.ensemble.drawing import reducer_of
from mcgw.ensemble.forecast import MOST_SURFACES, forecast, in_words, rough_seconds
from mcgw.ensemble.intervals import laws_are_quick, spread_of
from mcgw.machine.terminal import listed, one_line
from mcgw.sampling.expected import Expected, expected
from mcgw.scene.ensemble import PROMISES
from mcgw.scene.scene import Scene, storable, with_sampling
from mcgw.scene.writing import contact_facts

_WORTH, _CROWD = 1.5, 300  # times faster, to be told; asperities of a cell, for crowds to pay


def plan_text(scene: Scene) -> str:
    """Return the plan in words, with what is left out and why; nothing is drawn or compiled for it.

    Seconds are expected on a machine of the last years with so many cores, within a factor of two.
    """
    scene = storable(scene)
    known, surfaces = expected(scene), forecast(scene).surfaces
    seconds = rough_seconds(scene, surfaces)
    size = f"{reducer_of(scene, known).joined_bytes(surfaces) / 1e6:.4g} MB"
    kept = f"statistics alone, about {size}" if scene.keep == "statistics" else f"{size} before compression"
    facts = [
        ("surfaces", f"{surfaces} of {scene.n_asperities} asperities ({scene.count})"),
        ("sampler", known.name + (" (chosen by auto)" if scene.sampler == "auto" else "")),
        ("touching", f"{scene.touching:.4g} per surface, at the smallest d/sigma = {scene.lowest:g}"),
        ("drawn", f"{known.draws:.4g} per surface"),
        ("cells", f"about {known.cells}, with {known.moments} moments per surface"),
        ("quantities", f"{', '.join(scene.quantities)} at {len(scene.separations)} separations"),
        *contact_facts(scene),
        ("results", kept),
        ("time", f"about {in_words(seconds)}"),
        ("accuracy", _accuracy(scene, known, surfaces)),
    ]
    if scene.interaction is None and not scene.as_measured and laws_are_quick(scene):
        spreads = {name: spread_of(scene, name) for name in scene.quantities}
        for k, target in enumerate((1e-2, 1e-3)):  # 95 % bounds of means
            found = forecast(with_sampling(scene, rel_err=target, n_surfaces=MOST_SURFACES), spreads)
            some = f", all but {len(found.out_of_reach)} means" if found.out_of_reach else ""
            needed = f"{found.surfaces:.2g} surfaces, {in_words(seconds / surfaces * found.surfaces)}{some}"
            facts.append(("" if k else "for", f"rel_err = {target:g}: {needed}"))
        facts.append(("", "means alone: no surfaces, scene.theory is exact"))
    left_out = [name for name in QUANTITIES if name not in scene.quantities]
    not_done, spared = list[str](), scene.n_asperities - scene.touching
    if PROMISES[known.name].needs_density:  # which are those of the heights that touch
        not_done.append(f"{spared:.4g} asperities per surface lie below every separation and are not drawn")
    if not PROMISES[known.name].one_by_one:
        not_done.append("in crowded cells, Gaussian moments are drawn instead of asperities")
    if known.cells and not known.moments:
        not_done.append("no heights are drawn: contacts follow from the numbers in the cells")
    if left_out:
        not_done.append(f"{', '.join(left_out)}: not requested")
    lines = [one_line(scene.title) or "scene", *listed(facts, 12)]
    lines += [f"  {line}" for line in scene.validity().lines]
    return "\n".join([*lines, "not done:", *(f"  {line}" for line in not_done)])


def _accuracy(scene: Scene, known: Expected, surfaces: int) -> str:
    """How far laws may be from the exact ones, and what crowded cells, where ``auto`` has none, would buy."""
    given = f"up to {scene.accuracy:g} from the exact laws" if scene.accuracy else "0: exact laws"
    few = known.draws < _WORTH * _CROWD * known.cells  # as crowds are chosen
    if known.name != "cells" or scene.sampler != "auto" or scene.summits is not None or few:
        return given
    times = rough_seconds(scene.replace(sampler="aggregate"), surfaces) / rough_seconds(scene, surfaces)
    bought = "buys" if scene.accuracy else "1e-3 would buy"
    return f"{given}; {bought} crowded cells, {times:.2g} x the time" if times <= 1 / _WORTH else given
