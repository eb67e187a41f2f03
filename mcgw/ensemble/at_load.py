"""The exact mean surface at a given load or area, and what lies between its planes there."""

from dataclasses import replace
from typing import Any

from analytic import QUANTITIES, SEPARATIONS, Nayak, Quantity, quantity_of
from analytic.laws.elastic_plastic import ElasticPlastic
from mcgw.scene.scene import Scene

NEGATIVE = (
    "{} = {:g} {}: {} does not reach it without asperities of negative modulus, at s = {:.4g}; give less, "
    'or say negative = "clip" or "allow" under [grading]'
)


def mean_surface(scene: Scene, given: str, value: float) -> dict[str, float]:
    """What `Solution.theory` holds, without a surface."""
    alone = replace(scene, interaction=None)
    found = with_mean_gap(alone, theory_at(alone, quantity_of(given), value))
    return found if scene.interaction is None else on_half_space(scene, found)


def theory_at(scene: Scene, q: Quantity, value: float) -> dict[str, float]:
    """Separation and all quantities of the mean surface."""
    h = float(scene.theory.separation_at(q.name, value))
    if scene.negative == "error" and (where := scene.negative_above(h)) is not None:
        raise ValueError(NEGATIVE.format(q.name, value, q.unit, "the mean surface", where))
    return {"separation": h, **{name: float(scene.theory.mean(name, h)) for name in quantities_at(scene)}}


def quantities_at(scene: Scene) -> tuple[str, ...]:
    """All that a surface that is loaded has."""
    yielding = ("load_slope", "yielded") if isinstance(scene.law, ElasticPlastic) else ()
    return (*QUANTITIES, *yielding, *(() if scene.film is None else ("conductance_si",)))


def on_half_space(scene: Scene, found: dict[str, Any]) -> dict[str, Any]:
    """The same of what holds at given loads."""
    from mcgw.ensemble.half_space import at_loads  # for those scenes alone

    return with_mean_gap(scene, at_loads(scene, {k: v for k, v in found.items() if k != "mean_gap"}))


def with_mean_gap(scene: Scene, found: dict[str, Any]) -> dict[str, Any]:
    """The same of what holds at given loads: with "mean_gap", m, after the separations.

    That is how far the rigid plane lies from the mean plane of the surface, or from that of its summits where
    the scene does not tell the other. Where asperities press each other down it is the separation that they
    feel, or the nominal one if that counts from the mean plane itself (`reference = "mean-plane"`).
    """
    nominal = scene.interaction is not None and scene.interaction.reference == "mean-plane"
    h = found["nominal_separation" if nominal else "separation"]
    gap = scene.surface.sigma * (h + (rise_of_summits(scene) or 0.0))
    ahead = {name: found[name] for name in found if name in ("separation", *SEPARATIONS)}
    return {**ahead, "mean_gap": gap, **found}


def rise_of_summits(scene: Scene) -> float | None:
    """Of the mean plane of the summits above that of the surface, over sigma; None if no one told."""
    heights = scene.heights
    return heights.mean / heights.std if isinstance(heights, Nayak) else None
