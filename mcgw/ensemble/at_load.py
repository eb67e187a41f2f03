"""Answers at given loads: the exact mean surface, and the gap between its planes.

Also the pressures that the separations of a scene span.
"""

from typing import Any

import numpy as np

from analytic import QUANTITIES, SEPARATIONS, quantity_of
from analytic.arrays import Array
from analytic.laws.elastic_plastic import ElasticPlastic
from mcgw.ensemble.separation import crossing
from mcgw.scene.scene import Scene

GAPS = ("mean_gap", "gap_to_summits")  # m: see `answers_at`
NEGATIVE = (
    "{} = {:g} {}: {} reaches it only with asperities of negative modulus, at s = {:.4g}; give less, "
    'or set negative = "clip" or "allow" under [grading]'
)
_DEEP = 8.0  # below a nominal separation, where the search for the other one ends


def mean_surface(scene: Scene, given: str, value: float) -> dict[str, float]:
    """Values of `Solution.theory`, without drawing any surface."""
    return answers_at(scene, theory_at(scene, given, value))


def theory_at(scene: Scene, given: str, value: float) -> dict[str, float]:
    """Separation and all quantities of the asperities of the mean surface."""
    alone, q = scene.alone, quantity_of(given)
    if given == "nominal_separation":
        h = nominal_of_mean(scene, value)
    else:
        h = float(alone.separation_at(given, value))
    if scene.negative == "error" and (where := scene.negative_above(h)) is not None:
        raise ValueError(NEGATIVE.format(q.name, value, q.unit, "the mean surface", where))
    return {"separation": h, **{name: float(alone.mean(name, h)) for name in quantities_at(scene)}}


def nominal_of_mean(scene: Scene, value: float) -> float:
    """Largest separation that the asperities feel at which the mean surface has a nominal one."""
    mean = scene.alone.mean
    sunk = scene.compliance / scene.surface.sigma
    high = value + max(float(sunk * mean("load", value)), 0.0)
    found = crossing(lambda h: value - h + sunk * mean("load", h), high, min(value, high) - _DEEP)
    if found is None:
        raise ValueError(f"nominal_separation = {value:g}: the mean surface does not reach it; give more")
    return found


def quantities_at(scene: Scene) -> tuple[str, ...]:
    """Names of all quantities of a loaded surface."""
    yielding = ("load_slope", "yielded") if isinstance(scene.law, ElasticPlastic) else ()
    return (*QUANTITIES, *yielding, *(() if scene.film is None else ("conductance_si",)))


def answers_at(scene: Scene, found: dict[str, Any]) -> dict[str, Any]:
    """Answers of a surface of the scene whose asperities, at a given load, have these sums.

    They include "mean_gap", m: the distance of the rigid plane from the mean plane of the surface, which
    Nayak's heights, a fit or `joint.rms` tell; where nothing does, it is "gap_to_summits", to the mean plane
    of the summits. With asperity interaction it is the effective
    separation, or the nominal one if that is measured from the mean plane itself
    (`reference = "mean-plane"`). Where current or heat is conducted, conductances per area and resistances
    are included.
    """
    if scene.interaction is not None:
        from mcgw.ensemble.half_space import at_loads  # for those scenes alone

        found = at_loads(scene, found)
    h = found["nominal_separation" if scene.from_mean_plane else "separation"]
    gap = scene.surface.sigma * (h + (scene.rise or 0.0))
    ahead = {name: found[name] for name in found if name in ("separation", *SEPARATIONS)}
    return {**ahead, scene.gap: gap, **found, **_conducted(scene, found)}


def _conducted(scene: Scene, found: dict[str, Any]) -> dict[str, Any]:
    """Conductances per nominal area, and resistances of spots and joint."""
    if scene.film is None:
        return {}
    area, spots = scene.surface.nominal_area, found["conductance_si"]
    answers = {"contact_conductance": spots / area}
    if scene.gas is not None:
        from mcgw.ensemble.half_space import with_joint  # for those scenes alone

        answers |= with_joint(scene, found, ("gap_conductance", "joint_conductance"), found["separation"])
    whole = answers.get("joint_conductance", answers["contact_conductance"])
    with np.errstate(divide="ignore"):
        name = "thermal_resistance" if scene.thermal else "contact_resistance"
        answers[name] = np.divide(1.0, whole * area)
        answers["specific_contact_resistance"] = np.divide(1.0, answers["contact_conductance"])
    return answers


def pressures_of(scene: Scene, number: int) -> Array:
    """Return pressures at a constant ratio, from the lowest to the highest at the scene's separations, Pa.

    They are those of the mean surface, where a specimen has a contact or more.

    Raises
    ------
    ValueError
        If fewer than two separations have such.
    """
    alone, h = scene.alone, np.array(scene.separations)
    pressures = np.asarray(alone.mean("pressure", h))
    pressures = pressures[(pressures > 0) & (np.asarray(alone.mean("contacts", h)) >= 1)]
    if len(np.unique(pressures)) < 2:
        raise ValueError(
            "contact.separations: give two or more at which a surface has a contact and carries a load"
        )
    return np.geomspace(pressures.min(), pressures.max(), number)
