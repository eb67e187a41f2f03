"""Measured error of the model of a scene against elasticity, or that there is none."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analytic import Homogeneous
from analytic.arrays import Array
from mcgw.formats.table import evenly
from mcgw.validity.error_table import COLUMNS, Expected, Grid, grid_of
from mcgw.validity.model_error import Validity
from mcgw.validity.place_in_table import Place, not_on_the_map, place_of, reduced_pressure

_MOST_SEPARATIONS = 64
_IN_WORDS = {  # x and loads of the kinds of maps, the maps, and what lighter loads approach
    "gaussian": ("alpha", "p/(E* g)", "Gaussian", "the limit of Bush, Gibson and Thomas"),
    "caps": ("eta R sigma", "p/(E* sqrt(sigma/R))", "separate caps", "Hertz's law"),
}
_NONE = 1.0  # contacts per surface; no statement for fewer


def validity_of(scene: Any, separations: ArrayLike | None = None) -> Validity:
    """Look up the error of a scene's model against elasticity.

    Parameters
    ----------
    scene : mcgw.Scene
        Whose geometry counts: a grading, a film and friction do not.
    separations : array_like, optional
        Reduced separations. Default: those of the scene, or 64 of them.

    Returns
    -------
    Validity
        At the separations, each once.
    """
    given = scene.separations if separations is None else separations
    h = np.unique(np.asarray(given, dtype=np.float64))
    h = h[evenly(len(h), _MOST_SEPARATIONS)]
    reason = not_on_the_map(scene)
    if reason is not None:
        return _nothing(h, f"not measured: {reason}")
    place = place_of(scene)
    grid = grid_of(place.kind, place.model, place.interaction)
    if not grid.holds(place.x):
        return _nothing(
            h, f"outside the measured range ({_IN_WORDS[place.kind][0]} = {place.x:.4g}; {_span(grid)})"
        )
    return _looked_up(scene, place, grid, h)


def _nothing(h: Array, why: str) -> Validity:
    none = np.full(len(h), np.nan)
    empty = dict.fromkeys(COLUMNS, none)
    return Validity(h, none, empty, empty, unknown=why)


def _looked_up(scene: Any, place: Place, grid: Grid, h: Array) -> Validity:
    p = reduced_pressure(scene, h) / place.slope
    found = grid.expected(place.x, p)
    share = _share(scene, place, found, h)
    bias, error = {}, {}
    for name in COLUMNS:
        off = found.farthest(name, share[name])
        unit = place.rms if name == "separation" else 1.0
        unit = np.nan if place.area_only and name != "area" else unit
        bias[name] = unit * found.bias[name]
        error[name] = np.abs(bias[name]) + unit * off
    loads = _loads(place, found, p)
    graded = not isinstance(scene.modulus, Homogeneous)
    where = _where(scene, place, grid, found.maps, loads)
    axis = _IN_WORDS[place.kind][1]
    found_at = Validity(h, p, error, bias, graded, axis, where, listed=place.kind == "caps")
    if found_at.measured.all():
        return found_at
    none = scene.n_asperities * scene.heights.sf(h) < _NONE
    why = ["outside the measured range"] * bool(np.any(~none & ~found_at.measured))
    why += ["fewer than one contact per surface"] * bool(none.any())
    if none.all():
        return replace(found_at, unknown="not stated, with fewer than one contact per surface")
    told = "" if found_at.measured.any() else f": {loads}"
    return replace(found_at, unknown=f"{' or '.join(why)}{told}")


def _share(scene: Any, place: Place, found: Expected, h: Array) -> dict[str, Array]:
    """Root of the contacts of a map over those of a surface; of waves, if fewer of them, for all but areas.

    A gap, and what follows from it, is as sure as the long waves are many, however many contacts lie on them.
    """
    area = scene.n_asperities / scene.surface.eta
    with np.errstate(divide="ignore", invalid="ignore"):
        own = scene.n_asperities * scene.heights.sf(h)
        contacts = np.sqrt(found.contacts / np.where(own < _NONE, np.nan, own))
    waves = np.sqrt(found.waves * place.correlation_area / area)
    return {name: contacts if name == "area" else np.fmax(contacts, waves) for name in COLUMNS}


def _span(grid: Grid) -> str:
    return f"measured: {grid.x[0]:g} to {grid.x[-1]:g}"


def _loads(place: Place, found: Expected, p: Array) -> str:
    low, high = found.loads
    _, axis, _, limit = _IN_WORDS[place.kind]
    told = f"{low:.2g} to {high:.2g}" if low <= high else "nothing in common"
    if p.min() < low and found.lightest < low:
        told += f"; lighter ones approach {limit}"
    here = " to ".join(dict.fromkeys(f"{x:.2g}" for x in (p.min(), p.max())))
    return f"{axis} = {here} (measured: {told})"


def _where(scene: Any, place: Place, grid: Grid, maps: int, loads: str) -> str:
    x, _, kind, _ = _IN_WORDS[place.kind]
    many = f"{maps} maps" if maps > 1 else "one map"
    by, alone = "", f"; nothing else: {place.area_only}" if place.area_only else ""
    if scene.fitted is not None:
        by = " from the fit"
    elif place.kind == "gaussian" and place.model == "one radius":
        by = f" as eta R sigma = {scene.surface.eta * scene.surface.radius * scene.surface.sigma:.3g} says"
    return (
        f"boundary elements on homogeneous half-spaces, {many} ({kind}) a point: {x} = {place.x:.3g}{by} "
        f"({_span(grid)}), {loads}{alone}"
    )
