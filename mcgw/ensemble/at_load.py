"""Answers at given loads: of the exact mean surface, and means over specimens that need no draw.

Also the gap between the planes of a surface, and the pressures that the separations of a scene span; what the
half-space makes of the sums of surfaces whose asperities press each other down, and these asperities by
themselves; and what gas in the gap adds to the spots of surfaces, each at its own distance of mean planes.
"""

from collections import UserDict
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from analytic import QUANTITIES, SEPARATIONS, quantity_of
from analytic.arrays import Array
from analytic.at_load import Moments, specimen_moments
from analytic.interaction import in_series
from mcgw.ensemble.results import Results
from mcgw.ensemble.separation import crossing
from mcgw.scene.scene import Scene

if TYPE_CHECKING:
    from mcgw.ensemble.ensemble import Ensemble

GAPS = ("mean_gap", "gap_to_summits")  # m: see `answers_at`
NEGATIVE = (
    "{} = {:g} {}: {} reaches it only with asperities of negative modulus, at s = {:.4g}; give less, "
    'or set negative = "clip" or "allow" under [grading]'
)
_ENOUGH = 10  # surfaces for each number that a control variate is fitted with
_DEEP = 8.0  # below a nominal separation, where the search for the other one ends


def mean_surface(scene: Scene, given: str, value: float) -> dict[str, float]:
    """Values of `Solution.theory`, without drawing any surface."""
    mean, q = scene.alone.mean, quantity_of(given)
    if given == "nominal_separation":  # the largest one that the asperities feel there
        sunk = scene.theory.compliance
        high = value + max(float(sunk * mean("load", value)), 0.0)
        lowest = min(value, high) - _DEEP
        (h,) = crossing(lambda x, _: value - x + sunk * mean("load", x), np.array([high]), lowest).tolist()
        if np.isnan(h):
            raise ValueError(f"nominal_separation = {value:g}: the mean surface does not reach it; give more")
    else:
        h = float(scene.alone.separation_at(given, value))
    if scene.negative == "error" and (where := scene.negative_above(h)) is not None:
        raise ValueError(NEGATIVE.format(q.name, value, q.unit, "the mean surface", where))
    return answers_at(scene, {"separation": h} | {x: float(mean(x, h)) for x in quantities_at(scene)})


def quantities_at(scene: Scene) -> tuple[str, ...]:
    """Names of all quantities of a loaded surface."""
    yielding = ("load_slope", "yielded") if scene.law.yields else ()
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
    felt, area, joint = found["separation"], scene.surface.nominal_area, dict[str, Any]()
    sums = {name: x for name, x in found.items() if name != "separation"}
    if scene.interaction is not None or scene.gas is not None:
        more = () if scene.interaction is None else ("nominal_separation",)
        in_gap = () if scene.gas is None else ("gap_conductance", "joint_conductance")
        sums = answered(scene, sums, (*more, *in_gap), felt)
        joint = {name: sums.pop(name) for name in in_gap}
    ahead = {"separation": felt} | {name: sums[name] for name in SEPARATIONS if name in sums}
    h = ahead["nominal_separation" if scene.from_mean_plane else "separation"]
    answers = {**ahead, scene.gap: scene.surface.sigma * (h + (scene.rise or 0.0)), **sums}
    if scene.film is not None:
        contact = sums["conductance_si"] / area
        answers |= {"contact_conductance": contact, **joint}
        with np.errstate(divide="ignore"):
            whole = joint.get("joint_conductance", contact) * area
            answers["thermal_resistance" if scene.thermal else "contact_resistance"] = np.divide(1.0, whole)
            answers["specific_contact_resistance"] = np.divide(1.0, contact)
    return answers


def pressures_of(scene: Scene, number: int) -> Array:
    """Return pressures at a constant ratio, from the lowest to the highest at the scene's separations, Pa.

    They are those of the mean surface, where a specimen has a contact or more.
    """
    alone, h = scene.alone, np.array(scene.separations)
    pressures = np.asarray(alone.mean("pressure", h))
    pressures = pressures[(pressures > 0) & (np.asarray(alone.mean("contacts", h)) >= 1)]
    if len(np.unique(pressures)) < 2:
        raise ValueError(
            "contact.separations: give two or more at which a surface has a contact and carries a load"
        )
    return np.geomspace(pressures.min(), pressures.max(), number)


class Answers(UserDict[str, Any]):
    """Answers by name, each found by its function whenever it is asked for."""

    def __getitem__(self, name: str) -> float:
        """Return an answer; KeyError if there is no such."""
        return float(self.data[name]())

    def __repr__(self) -> str:
        """Show all, as a dict."""
        return repr(dict(self.items()))


def controlled(x: Array, known: Sequence[tuple[Array, float]]) -> tuple[float, float, int]:
    """Mean of what is no sum, less what the surfaces drawn have too much of those whose mean is known.

    Its standard error, and the degrees of freedom of that.
    """
    m = len(x)
    known = known if m >= _ENOUGH * (1 + len(known)) else ()
    columns = np.stack([np.ones(m), *((y - exact) / (y.std() or 1.0) for y, exact in known)], axis=1)
    fitted = np.linalg.lstsq(columns, x, rcond=1e-9)[0]
    left, freedom = x - columns @ fitted, max(m - 1 - len(known), 1)
    return float(fitted[0]), float(np.sqrt(left @ left / freedom / m)), freedom


def exact_moments(scene: Scene, given: str, amount: float) -> Moments:
    """Means and standard deviations over specimens that need no draw: by quadrature, in SI units.

    Of sums, and of answers that are linear in one of them or in the separation; of what is given alone, where
    the rest is not known or takes longer than to draw.
    """
    known = Moments({given: amount}, {given: 0.0})
    if scene.summits is not None or scene.as_measured or given == "nominal_separation":
        return known
    sums = [x for x in quantities_at(scene) if quantity_of(x).base != "load_slope"]
    try:
        with np.errstate(all="ignore"):
            found = specimen_moments(scene.alone, given, amount, [name for name in sums if name != given])
    except (ValueError, IndexError):  # far up, where hardly any asperity of any surface is
        return known
    if not np.isfinite([*found.mean.values(), *found.std.values()]).all():
        return known
    mean, std = found.mean | known.mean, found.std | known.std
    at, above = (answers_at(scene, x) for x in (mean, {name: mean[name] + std[name] for name in mean}))
    linear = {name for name in mean if name == "separation" or not scene.series(name)}
    if scene.interaction is None:
        linear |= {scene.gap, "contact_conductance"}
        if scene.filled is not None and scene.filled.gas is None:
            linear |= {"gap_conductance", "joint_conductance"}
    elif given == "load":
        linear |= {"nominal_separation", *GAPS}
    linear &= at.keys()
    return Moments({name: at[name] for name in linear}, {name: above[name] - at[name] for name in linear})


def answered(scene: Scene, sums: dict[str, Any], names: Iterable[str], h: Any) -> dict[str, Any]:
    """Return sums of asperities, those of stiffness and conductance in series with the half-space; and more.

    Nominal separations follow from the load of each surface, without a search. Each surface of a joint is
    one network, ``1/h_j = 1/(h_spots + h_gas) + R_bodies A_n``: what passes the gas is constricted by the
    bodies as a whole like what passes the spots. The distance of the mean planes is the separation that the
    asperities feel, `h`, or the nominal one if it is measured from the mean plane itself.

    To the `sums` of the asperities, SI, `names` of `analytic.SEPARATIONS` and `analytic.JOINT` are added, in
    d/sigma and W/(m^2 K).
    """
    filled: Any = scene.filled
    sunk = scene.theory.compliance
    found = {name: in_series(x, scene.series(name)) for name, x in sums.items()}
    for name in names:
        back = "_unloading" * name.endswith("_unloading")
        nominal = h - sunk * sums[f"load{back}"] if scene.interaction else h
        if name in SEPARATIONS:
            found[name] = nominal
        else:
            apart = nominal if scene.from_mean_plane else h
            spots = found[f"conductance_si{back}"]
            if name.startswith("joint"):
                found[name] = joint_conductance(scene, spots, apart)
            else:
                found[name] = filled(apart) + 0 * spots
    return found


def joint_conductance(scene: Scene, spots: Any, apart: Any) -> Any:
    """Return what spots and gas conduct side by side, in series with the bodies, W/(m^2 K): see `answered`.

    `spots` is the conductance of the spots, and of the bodies in series with them, SI; `apart` how far the
    mean planes are from each other, d/sigma.
    """
    assert scene.filled is not None
    assert scene.film is not None
    contact = spots / scene.surface.nominal_area
    bodies = 0.0 if scene.interaction is None else scene.interaction.bodies(scene.surface, scene.film.rho)
    return in_series(in_series(contact, -bodies) + scene.filled(apart), bodies)


def asperities_alone(ensemble: "Ensemble") -> "Ensemble":
    """Return the ensemble of the sums of the asperities.

    Of one that keeps no values those that are not in series with the half-space.
    """
    scene, sums, quantities = ensemble.scene, ensemble.sums, ensemble.scene.quantities
    if isinstance(sums, Results):
        sums = sums.changed(lambda name, rows: np.asarray(in_series(rows, -scene.series(name))))
    else:  # of what is in series only each surface's would tell
        quantities = tuple(name for name in quantities if not scene.series(name))  # the load at least
    return replace(ensemble, scene=scene.replace(quantities=quantities, interaction=None), sums=sums)
