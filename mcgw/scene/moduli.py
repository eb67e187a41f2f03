"""Moduli against height, and your own laws: what is wrong with them, or perhaps in another unit.

Scenes with neither do not import this.
"""

from collections.abc import Iterator
from contextlib import suppress
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


def _reach(scene: Fields) -> Iterator[str]:
    """Find a Python function that does not take arrays, and series that end before heights that touch."""
    grading: Any = scene.grading
    if isinstance(grading, analytic.Custom):
        try:
            with np.errstate(all="ignore"):
                grading.function(np.array([scene.lowest, scene.highest]))
        except Exception as error:  # of any kind: it is the user's own code
            reason = brief(f"{type(error).__name__}: {error}")
            yield (
                f"grading: the function fails on an array of heights ({reason}); write it with numpy, or "
                "give np.vectorize of it"
            )
    elif isinstance(grading, analytic.PiecewiseSeries) and scene.lowest < scene.highest:
        low, high = max(scene.lowest, scene.least), scene.highest
        first, last = grading.edges[0], grading.edges[-1]
        if not (first <= low and high <= last):
            yield (
                f"grading.edges: the series reach from s = {first:.6g} to {last:.6g}, but heights from "
                f"{low:.6g} to {high:.6g} are needed; give the grading itself, or other separations"
            )


def _units(scene: Fields) -> Iterator[str]:
    """Refuse a grading or a custom contact law that is far from 1 at all heights that touch."""
    law: Any = scene.law
    grading = getattr(scene.grading, "grading", scene.grading)  # of a clipped one
    own_law = law.name == "custom" and getattr(law, "checked", True)
    own_grading = not isinstance(grading, _PARAMETERS) and getattr(grading, "checked", True)
    surface, h = scene.surface, min(scene.separations)
    if not (own_law or own_grading) or not scene.heights.sf(np.array(h)) > 0:
        return
    s = scene.heights.isf(_LOOKED_AT, h)
    try:
        e = np.asarray(scene.grading(s))
    except ValueError:
        return  # a later check reports it
    if own_grading and any(_given_in(e, surface.E_star / size) for size in _UNITS):
        yield (
            f"grading: E*(s)/E* is {_ends(e)} at all heights that touch; give a ratio near 1: moduli over "
            f"E_star = {surface.E_star:g} Pa, of s = z/sigma, sigma = {surface.sigma:g} m"
            f"{_WAYS_OUT.get(type(grading), '')}"
        )
    if not own_law or not np.all(e > 0):
        return
    y, delta_c = np.sqrt(s - h), law.critical * surface.sigma
    contacts = [*zip(piece_of(law, s - h, e).tolist(), y, e, strict=True)]
    hertz = 4 / 3 * surface.E_star * surface.radius**0.5 * delta_c**1.5
    load, area = (np.array([float(of(*each)) for each in contacts]) for of in (law.load, law.radius))
    for name, ratios, size, unit in (
        ("load", load / (e * y**3), hertz, "(4/3) E*(s) sqrt(R) delta_c^1.5 = {:.4g} N at E*"),
        ("area", (area / y) ** 2, np.pi * surface.radius * delta_c, "pi R delta_c = {:.4g} m^2 at E*"),
    ):
        if _given_in(ratios, size):
            yield (
                f"contact.law = {type(law).__name__}: its {name} is {_ends(ratios)} of Hertz's at all "
                f"penetrations that occur; divide it by {unit.format(size)}{_MEANT}checked=False"
            )


def _given_in(ratios: Array, size: float) -> bool:
    """Whether they are no ratios: all far above 1 or below, or what one gives in a unit."""
    ends = np.abs(ratios).min(), np.abs(ratios).max()
    near = np.all((ratios > size / _CLOSE) & (ratios < size * _CLOSE))
    apart = max(ends[0], 1 / ends[1] if ends[1] else np.inf)
    return bool(apart > _FARTHEST or (apart > _APART and near))


def _ends(values: Array) -> str:
    return " to ".join(dict.fromkeys(f"{end:.3g}" for end in (values.min(), values.max())))


def _values(scene: Fields) -> Iterator[str]:
    """Find moduli that are negative where contacts touch, make sums overflow, or have no variance."""
    grading, sticks, where = scene.grading, scene.law.name == _STICKS, None
    key = f"grading.gamma = {grading.gamma:g}" if isinstance(grading, analytic.Exponential) else "grading"
    try:
        if scene.negative == "error" or (scene.negative == "clip" and sticks):
            where = scene.negative_above(scene.lowest)
    except ValueError as error:
        yield str(error)
        return
    if where is not None and scene.negative == "clip":
        yield (
            f'grading.negative = "clip": from s = {where:.4g} asperities have no modulus, and contact.law = '
            f'"{_STICKS}" pulls them in without limit; increase the separations, or use another grading'
        )
    elif where is not None:
        if isinstance(grading, analytic.Exponential) and grading.gamma < 0:
            where = grading.zero
        yield (
            f"{key}: E*(s) is negative from s = {where:.4g}, which touches at h = {scene.lowest:g}; "
            'increase the separations, or set negative = "clip" or "allow" under [grading]'
        )
    else:
        units = [q.scale(scene.surface) for q in map(analytic.quantity_of, scene.quantities) if q.modulus]
        steepest = largest = 0.0
        with np.errstate(all="ignore"), suppress(ValueError):  # of a function, if negative ones are allowed
            steepest = float(np.abs(scene.modulus(np.array([*scene.separations, scene.highest]))).max())
            largest = max(units, default=0.0) * steepest * float(scene.n_asperities) * _SAFELY
        if not largest < np.finfo(float).max:
            yield f"{key}: E*(s)/E* reaches {steepest:.3g}, so sums overflow; give a smaller one"
        elif scene.keep == "statistics" and not grading.smooth:
            try:
                scene.alone.fluctuations(scene.quantities, np.array([scene.lowest]))
            except ValueError as error:
                yield f'ensemble.keep = "statistics": {error}; or use "sums"'


def modulus_mistakes(scene: Fields) -> Iterator[str]:
    """Find what is wrong with a grading, or a contact law of one's own: the first check that finds it."""
    known = isinstance(scene.grading, _PARAMETERS) and scene.law.name != "custom"
    for check in (_values,) if known else (_reach, _units, _values):
        if found := list(check(scene)):
            yield from found
            return


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
