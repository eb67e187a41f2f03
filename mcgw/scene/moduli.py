"""Functions that are no ratios: moduli in pascals, heights in metres, a contact law in newtons."""

from collections.abc import Iterator
from typing import Any

import numpy as np

import analytic
from analytic.arrays import Array
from analytic.laws import piece_of
from mcgw.scene.fields import Fields

_FARTHEST = 1e3  # from 1: a ratio that differs from it by more at every height is none
_APART = 10.0  # and one that differs by as much is none if it is what another unit gives,
_CLOSE = 3.0  # within this factor
_LOOKED_AT = np.array([0.9, 0.75, 0.5, 0.25, 0.1, 0.01])  # shares of the contacts that are higher
_UNITS = (1.0, 1e6, 1e9)  # in which moduli are given, Pa
_PARAMETERS = (analytic.Homogeneous, analytic.Exponential)
_MEANT = "; if it is meant so, give "


def functions_in_units(scene: Fields) -> Iterator[str]:
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
        yield from _grading(scene, inner, e)
    if own_law and np.all(e > 0):
        yield from _law(scene, s - h, e)


def _far(ratios: Array, farthest: float = _FARTHEST) -> bool:
    """Whether all are far above 1, or all far below."""
    size = np.abs(ratios)
    return bool(np.all(size > farthest) or np.all(size < 1 / farthest))


def _given_in(ratios: Array, size: float) -> bool:
    """Whether they are no ratios: far from 1, or what one gives in a unit."""
    near = np.all((ratios > size / _CLOSE) & (ratios < size * _CLOSE))
    return _far(ratios) or (_far(ratios, _APART) and bool(near))


def _grading(scene: Fields, inner: Any, e: Array) -> Iterator[str]:
    E_star, sigma = scene.surface.E_star, scene.surface.sigma
    if not any(_given_in(e, E_star / size) for size in _UNITS):
        return
    way_out = ""
    if isinstance(inner, analytic.Table):
        way_out = "; a file names other units in its header, z (um),E_star (GPa)"
    elif isinstance(inner, analytic.Custom):
        way_out = f"{_MEANT}mcgw.Custom(function, checked=False)"
    elif isinstance(inner, analytic.PiecewiseSeries):
        way_out = f"{_MEANT}checked = false"
    yield (
        f"grading: E*(s)/E* is {_ends(e)} at all heights that touch; give a ratio near 1: moduli over E_star "
        f"= {E_star:g} Pa, of s = z/sigma, sigma = {sigma:g} m{way_out}"
    )


def _law(scene: Fields, penetration: Array, e: Array) -> Iterator[str]:
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
