"""Moduli against height, and your own laws: what is wrong with them, or perhaps in another unit.

Scenes with neither do not import this.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

import analytic
from analytic.arrays import Array
from analytic.laws import piece_of
from mcgw.machine.terminal import brief
from mcgw.scene.fields import Fields

_FARTHEST = 1e3  # from 1: a ratio that differs from it by more at every height is none
_APART = 10.0  # and one that differs by as much is none if it is what another unit gives,
_CLOSE = 3.0  # within this factor
_LOOKED_AT = np.array([0.9, 0.75, 0.5, 0.25, 0.1, 0.01])  # shares of the contacts that are higher
_UNITS = (1.0, 1e6, 1e9)  # in which moduli are given, Pa
_PARAMETERS = (analytic.Homogeneous, analytic.Exponential)
_STICKS = "johnson-kendall-roberts"  # a law that pulls asperities without a modulus in without limit
_SAFELY = 1e4  # factor by which the sum over all asperities stays below the largest number
_FARTHEST_HEIGHT = 50.0  # reduced, of which no surface has one
_UNTOLD = 0.1  # share of the contacts at a separation that a table may leave to the value of its end
_MEANT = "; if it is meant so, give "
_WAYS_OUT = {
    analytic.Table: "; a file names other units in its header, z (um),E_star (GPa)",
    analytic.Custom: f"{_MEANT}mcgw.Custom(function, checked=False)",
    analytic.PiecewiseSeries: f"{_MEANT}checked = false",
}


def checks_of(scene: Fields) -> list[Any]:
    """Return what its moduli are asked: checks one after another, with whether they are needed."""
    grading = scene.grading
    return [
        {_function: isinstance(grading, analytic.Custom)},
        {_range: isinstance(grading, analytic.PiecewiseSeries) and scene.lowest < scene.highest},
        {_units: not isinstance(grading, _PARAMETERS) or scene.law.name == "custom"},
        {_modulus: scene.negative == "error" or (scene.negative == "clip" and scene.law.name == _STICKS)},
        {_sums: True},
        {_fluctuating: scene.keep == "statistics" and not grading.smooth},
    ]


def _function(scene: Fields) -> Iterator[str]:
    """Find a Python function that does not take arrays."""
    grading: Any = scene.grading
    try:
        with np.errstate(all="ignore"):
            grading.function(np.array([scene.lowest, scene.highest]))
    except Exception as error:  # of any kind: it is the user's own code
        reason = brief(f"{type(error).__name__}: {error}")
        yield (
            f"grading: the function fails on an array of heights ({reason}); write it with numpy, or "
            "give np.vectorize of it"
        )


def _range(scene: Fields) -> Iterator[str]:
    """Heights that touch and that the series of a grading do not reach."""
    grading: Any = scene.grading
    low, high = max(scene.lowest, scene.least), scene.highest
    first, last = grading.edges[0], grading.edges[-1]
    if not (first <= low and high <= last):
        yield (
            f"grading.edges: the series reach from s = {first:.6g} to {last:.6g}, but heights from {low:.6g} "
            f"to {high:.6g} are needed; give the grading itself, or other separations"
        )


def _units(scene: Fields) -> Iterator[str]:
    """Refuse a grading or a custom contact law that is far from 1 at all heights that touch."""
    own_law = scene.law.name == "custom" and getattr(scene.law, "checked", True)
    inner = getattr(scene.grading, "grading", scene.grading)  # of a clipped one
    own_grading = not isinstance(inner, _PARAMETERS) and getattr(inner, "checked", True)
    h = min(scene.separations)
    if not (own_law or own_grading) or not scene.heights.sf(np.array(h)) > 0:
        return
    s = scene.heights.isf(_LOOKED_AT, h)
    try:
        e = np.asarray(scene.grading(s))
    except ValueError:
        return  # a later check reports it
    if own_grading:
        yield from _no_ratio(scene, inner, e)
    if own_law and np.all(e > 0):
        yield from _no_law(scene, s - h, e)


def _given_in(ratios: Array, size: float) -> bool:
    """Whether they are no ratios: all far above 1 or below, or what one gives in a unit."""
    ends = np.abs(ratios).min(), np.abs(ratios).max()
    near = np.all((ratios > size / _CLOSE) & (ratios < size * _CLOSE))
    apart = max(ends[0], 1 / ends[1] if ends[1] else np.inf)
    return bool(apart > _FARTHEST or (apart > _APART and near))


def _no_ratio(scene: Fields, inner: Any, e: Array) -> Iterator[str]:
    E_star, sigma = scene.surface.E_star, scene.surface.sigma
    if not any(_given_in(e, E_star / size) for size in _UNITS):
        return
    yield (
        f"grading: E*(s)/E* is {_ends(e)} at all heights that touch; give a ratio near 1: moduli over E_star "
        f"= {E_star:g} Pa, of s = z/sigma, sigma = {sigma:g} m{_WAYS_OUT.get(type(inner), '')}"
    )


def _no_law(scene: Fields, penetration: Array, e: Array) -> Iterator[str]:
    law: Any = scene.law
    surface, y = scene.surface, np.sqrt(penetration)
    delta_c = law.critical * surface.sigma
    hertz = 4 / 3 * surface.E_star * surface.radius**0.5 * delta_c**1.5
    at = list(zip(piece_of(law, penetration, e).tolist(), y, e, strict=True))
    loads = np.array([float(law.load(*each) / (each[2] * each[1] ** 3)) for each in at])
    areas = np.array([float(law.radius(*each) / each[1]) ** 2 for each in at])
    for name, ratios, size, unit in (
        ("load", loads, hertz, "(4/3) E*(s) sqrt(R) delta_c^1.5 = {:.4g} N at E*"),
        ("area", areas, np.pi * surface.radius * delta_c, "pi R delta_c = {:.4g} m^2 at E*"),
    ):
        if _given_in(ratios, size):
            yield (
                f"contact.law = {type(law).__name__}: its {name} is {_ends(ratios)} of Hertz's at all "
                f"penetrations that occur; divide it by {unit.format(size)}{_MEANT}checked=False"
            )


def _ends(values: Array) -> str:
    return " to ".join(dict.fromkeys(f"{end:.3g}" for end in (values.min(), values.max())))


def _modulus(scene: Fields) -> Iterator[str]:
    """Negative moduli among the heights that touch; none where contacts stick."""
    try:
        where = scene.negative_above(scene.lowest)
    except ValueError as error:
        yield str(error)
        return
    if where is None:
        return
    if isinstance(scene.grading, analytic.Exponential) and scene.grading.gamma < 0:
        where = scene.grading.zero
    if scene.negative == "clip":
        yield (
            f'grading.negative = "clip": from s = {where:.4g} asperities have no modulus, and contact.law = '
            f'"{scene.law.name}" pulls them in without limit; increase the separations, or use another '
            "grading"
        )
    else:
        yield (
            f"{_key(scene)}: E*(s) is negative from s = {where:.4g}, which touches at h = {scene.lowest:g}; "
            'increase the separations, or set negative = "clip" or "allow" under [grading]'
        )


def _sums(scene: Fields) -> Iterator[str]:
    """Find the sums that the grading makes larger than double precision holds."""
    ends = np.array(sorted({scene.highest, *scene.separations}))
    stiff = [q for q in map(analytic.quantity_of, scene.quantities) if q.modulus]
    with np.errstate(all="ignore"):
        try:
            steepest = float(np.max(np.abs(scene.modulus(ends))))
        except ValueError:
            return  # `_modulus` says why, unless negative moduli are allowed
        sums = [q.scale(scene.surface) * steepest * float(scene.n_asperities) * _SAFELY for q in stiff]
    if not all(value < np.finfo(float).max for value in sums):
        yield f"{_key(scene)}: E*(s)/E* reaches {steepest:.3g}, so sums overflow; give a smaller one"


def _fluctuating(scene: Fields) -> Iterator[str]:
    """Find a Python function that has no variance."""
    try:
        scene.alone.fluctuations(scene.quantities, np.array([scene.lowest]))
    except ValueError as error:
        yield f'ensemble.keep = "statistics": {error}; or use "sums"'


def _key(scene: Fields) -> str:
    """Find the key of a grading, and its value if that is one number."""
    grading = scene.grading
    return f"grading.gamma = {grading.gamma:g}" if isinstance(grading, analytic.Exponential) else "grading"


def doubts_of_table(table: analytic.Table, scene: Fields) -> Iterator[str]:
    """Heights of a table in other units, and contacts beyond its ends."""
    farthest = max(table.s, key=abs)
    if abs(farthest) > _FARTHEST_HEIGHT:
        yield (
            f"grading: a point lies at s = {farthest:.3g} sigma, where there are no summits; s is z/sigma, "
            "and z is in m unless the header of the file says z (um)"
        )
    low, high = min(scene.separations), max(scene.separations)
    touch, from_first, over_last = scene.heights.sf(np.maximum(low, (low, table.s[0], table.s[-1])))
    share = float(touch - from_first + over_last) / float(touch) if touch > 0 else 0.0
    if share > _UNTOLD or high > table.s[-1]:
        where, share = (high, 1.0) if high > table.s[-1] else (low, share)
        fraction = "all" if share == 1 else f"{share:.0%} of the"
        yield (
            f"grading: {fraction} contacts at d/sigma = {where:g} are outside the table, which reaches from "
            f"s = {table.s[0]:.3g} to {table.s[-1]:.3g}; the modulus at its end is used for them"
        )
