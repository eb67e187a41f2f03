"""Answers at given loads: the exact mean surface, and the gap between its planes.

Also the answers of each surface of an ensemble at given nominal pressures, read off its own curve.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from analytic import QUANTITIES, SEPARATIONS, Quantity, quantity_of
from analytic.arrays import Array
from analytic.laws.elastic_plastic import ElasticPlastic
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.scene import Scene, drawn_by

GAPS = ("mean_gap", "gap_to_summits")  # m: see `answers_at`
NEGATIVE = (
    "{} = {:g} {}: {} reaches it only with asperities of negative modulus, at s = {:.4g}; give less, "
    'or set negative = "clip" or "allow" under [grading]'
)
_DRAWS = 1e9  # numbers drawn again for single surfaces: a second or two
_FEWEST = 20


def mean_surface(scene: Scene, given: str, value: float) -> dict[str, float]:
    """Values of `Solution.theory`, without drawing any surface."""
    return answers_at(scene, theory_at(asperities_of(scene), quantity_of(given), value))


def asperities_of(scene: Scene) -> Scene:
    """The scene without asperity interaction, which at a given load only changes the separation."""
    scene.ask_theory()
    together = scene.interaction is not None or scene.joint is not None
    return replace(scene, interaction=None, joint=None) if together else scene


def theory_at(scene: Scene, q: Quantity, value: float) -> dict[str, float]:
    """Separation and all quantities of the mean surface."""
    h = float(scene.theory.separation_at(q.name, value))
    if scene.negative == "error" and (where := scene.negative_above(h)) is not None:
        raise ValueError(NEGATIVE.format(q.name, value, q.unit, "the mean surface", where))
    return {"separation": h, **{name: float(scene.theory.mean(name, h)) for name in quantities_at(scene)}}


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
    if scene.joint is not None:
        from mcgw.ensemble.half_space import with_joint  # for those scenes alone

        answers |= with_joint(scene, found, ("gap_conductance", "joint_conductance"), found["separation"])
    whole = answers.get("joint_conductance", answers["contact_conductance"])
    with np.errstate(divide="ignore"):
        name = "thermal_resistance" if scene.thermal else "contact_resistance"
        answers[name] = np.divide(1.0, whole * area)
        answers["specific_contact_resistance"] = np.divide(1.0, answers["contact_conductance"])
    return answers


def at_pressures(ensemble: Ensemble, pressures: Array, quantities: tuple[str, ...]) -> dict[str, Array]:
    """Quantities of every surface at its own separation for each pressure.

    Between two separations of the ensemble, a quantity is interpolated as a power of the pressure, and the
    separation linearly in the logarithm of the pressure.

    Parameters
    ----------
    ensemble : Ensemble
        An ensemble that holds the load and these quantities.
    pressures : ndarray
        Load per nominal area, Pa, shape (pressures,).
    quantities : tuple of str
        Names, or "separation" (d/sigma).

    Returns
    -------
    dict of str to ndarray
        SI, shape (surfaces, pressures); nan where the curve of a surface does not reach.
    """
    order = np.argsort(-ensemble.separations, kind="stable")
    h, wanted = ensemble.separations[order], np.log(pressures)
    loads = ensemble.values("pressure")[:, order]
    found = {}
    for name in quantities:
        values = None if name == "separation" else ensemble.values(name)[:, order]
        rows = [
            _on_one(load, h if values is None else values[i], wanted, name == "separation")
            for i, load in enumerate(loads)
        ]
        found[name] = np.array(rows)
    return found


def _on_one(load: Array, values: Array, wanted: Array, linear: bool) -> Array:
    part = loaded_part(load)
    x, y = load[part], values[part]
    if x.size < 2 or (not linear and np.any(y <= 0)):
        return np.full(wanted.shape, np.nan)
    read = np.interp(wanted, np.log(x), y if linear else np.log(y), left=np.nan, right=np.nan)
    return read if linear else np.exp(read)


def loaded_part(load: Array) -> slice:
    """Part of a curve, along falling separations, where the load is positive and rises; it may be empty."""
    falls = np.flatnonzero((load[1:] <= load[:-1]) | (load[:-1] <= 0))
    start = int(falls[-1]) + 1 if falls.size else 0
    return slice(start, len(load) if load[-1] > 0 else start)


def common_pressures(ensemble: Ensemble) -> tuple[float, float] | None:
    """Lowest and highest pressure that the curves of all surfaces reach, Pa; None if there is none."""
    order = np.argsort(-ensemble.separations, kind="stable")
    loads = ensemble.values("pressure")[:, order]
    parts = [load[loaded_part(load)] for load in loads]
    if any(part.size < 2 for part in parts):
        return None
    low, high = max(float(p[0]) for p in parts), min(float(p[-1]) for p in parts)
    return (low, high) if low < high else None


def with_values(ensemble: Ensemble, most: int) -> Ensemble:
    """The ensemble itself; if it keeps only statistics, its first surfaces drawn again."""
    if ensemble.scene.keep != "statistics":
        return ensemble
    scene = replace(drawn_by(ensemble.scene, ensemble.sampler), keep="sums")
    fitting = int(_DRAWS / (sampler_of(scene).draws + 1))
    return simulate(replace(scene, n_surfaces=min(ensemble.n_surfaces, most, max(fitting, _FEWEST))))
