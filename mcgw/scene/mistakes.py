"""What is wrong with the values of a scene: a line for each mistake, with its key and what to give."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

import analytic
from mcgw.scene.fields import Fields
from mcgw.scene.parts import promise_of

_LEAST = 1e-100  # next to it, powers of a distance are beyond double precision
_MOST_ASPERITIES = 2**53  # counts are exact in double precision up to here
_SAFELY = 1e4  # factor by which the sum over all asperities stays below the largest number


def mistakes(scene: Fields) -> list[str]:
    """All that is wrong with what it has, later checks only where the earlier ones find nothing."""
    stages: list[Any] = [
        {
            _values: True,
            _history: scene.unload_from is not None,
            _measured: isinstance(scene.heights, analytic.MeasuredHeights),
            _radii: scene.summits is not None,
            _wishes: scene.rel_err is not None,
        },
        {_scales: True},
        {
            _law: not scene.hertzian,
            _gas: scene.joint.gas is not None,
            _pressed: scene.interaction is not None,
        },
    ]
    if not isinstance(scene.grading, analytic.Homogeneous) or scene.law.name == "custom":
        from mcgw.scene.moduli import checks_of  # for those scenes alone

        stages += checks_of(scene)
    for checks in stages:
        if found := [line for check, there in checks.items() if there for line in check(scene)]:
            return found
    return []


def _values(scene: Fields) -> Iterator[str]:
    if "conductance_si" in scene.quantities and scene.film is None:
        need = "joint.resistivity, or joint.conductivities = [k1, k2]"
        yield f'contact.quantities: "conductance_si" needs {need}'
    if tiny := [h for h in scene.separations if 0 < abs(h) < _LEAST]:
        yield f"contact.separations: {tiny[0]:g} is too close to 0; give 0, or at least {_LEAST:g}"
    for name in scene.quantities:
        if name in analytic.UNLOADING and scene.unload_from is None:
            yield f"contact.quantities: {name!r} needs unloading; give unload_from too"
    if not 1 <= scene.n_asperities <= _MOST_ASPERITIES:
        yield (
            f"ensemble.n_asperities = {scene.n_asperities}: must lie between 1 and 2^53; "
            "change it, or surface.eta and surface.nominal_area"
        )
    if scene.law.elastic and "yielded" in scene.quantities:
        yield f'contact.quantities: "yielded": no contact yields with law = "{scene.law.name}"; leave it out'


def _history(scene: Fields) -> Iterator[str]:
    """Unloading that nobody has fitted, or from above where the surface is."""
    assert scene.unload_from is not None
    if scene.unload_from > min(scene.separations, default=math.inf):
        yield (
            f"contact.unload_from = {scene.unload_from:g}: the separation {scene.lowest:g} is smaller; "
            'give the smallest that was reached, or "loop"'
        )
    try:
        steep = "stiffness", "load_slope"
        scene.reduced_law.unloading(0.0)
        stiff = [name for name in steep if name in scene.quantities]
        if stiff and not scene.law.stiff:
            rest = [x for x in scene.quantities if x not in steep and x not in analytic.UNLOADING]
            listed = str(rest or ["load"]).replace("'", '"')
            yield (
                f"contact.quantities: {stiff[0]!r} has no variance if contacts break off (law = "
                f'"{scene.law.name}"); give {listed}, or leave out unload_from'
            )
    except ValueError as error:
        yield f"contact.unload_from = {scene.unload_from:g}: {error}"


def _law(scene: Fields) -> Iterator[str]:
    """Find a law that means nothing for this surface."""
    try:
        with np.errstate(all="ignore"):
            limits = scene.reduced_law.limits(np.ones(1))
    except ValueError as error:
        yield f'contact.law = "{scene.law.name}": {error}'
        return
    if not np.all(np.isfinite(limits)) or np.any(limits <= 0):
        yield f'contact.law = "{scene.law.name}": yields at {limits.flat[0]:.3g} sigma; check its constants'
    if scene.negative == "allow":
        yield (
            f'grading.negative = "allow": contact.law = "{scene.law.name}" needs a modulus >= 0; use "clip"'
        )


def _gas(scene: Fields) -> Iterator[str]:
    """Gas that nobody knows the gap of."""
    try:
        assert scene.filled is not None
    except ValueError as error:
        yield f"joint.{error}"


def _pressed(scene: Fields) -> Iterator[str]:
    """Asperities that press each other down where that finds no balance."""
    if "load" not in scene.quantities:
        yield 'interaction: separations depend on the load; add "load" to contact.quantities'
        return
    h = np.unique(scene.separations)
    try:
        sinking = 1 + scene.compliance / scene.surface.sigma * scene.alone.slope("load", h) <= 0
    except ValueError as error:
        yield str(error)
        return
    if np.any(sinking):
        yield (
            f"interaction: at d/sigma = {h[sinking].max():g} the mean plane sinks faster than it is pressed, "
            "so the nominal separation is not unique; give larger separations"
        )


def _scales(scene: Fields) -> Iterator[str]:
    """Products of parameters that leave the range of double precision."""
    for name in scene.quantities:
        with np.errstate(all="ignore"):
            try:
                one = analytic.quantity_of(name).scale(scene.surface)
            except OverflowError:
                one = math.inf
            ends = (one * 1e-12, one * float(scene.n_asperities) * _SAFELY)
        if not (np.finfo(float).tiny < ends[0] and ends[1] < np.finfo(float).max):
            yield (
                f"surface: the {name} of an asperity would be {one:.3g} {analytic.quantity_of(name).unit}, "
                "beyond double precision; check sigma, radius and E_star"
            )


def _measured(scene: Fields) -> Iterator[str]:
    """Measured heights are one surface, added up and not drawn; or drawn one by one, in pairs with radii."""
    assert isinstance(scene.heights, analytic.MeasuredHeights)
    table = "heights" if scene.summits is None else "summits"
    if promise_of(scene.sampler).needs_density:
        yield (
            f'ensemble.sampler = "{scene.sampler}": it draws from a density, which measured heights do '
            'not have; use "direct"'
        )
    if not scene.as_measured:
        if scene.summits is None:
            yield "heights: heights that are resampled without radii have a smooth law; use mcgw.HeightTable"
        return
    number = len(scene.heights.heights)
    if scene.n_asperities != number:
        yield (
            f"ensemble.n_asperities = {scene.n_asperities}: there are {number} measured heights; give that "
            f"number, or {table}.resample = true"
        )
    for key, wanted in (("n_surfaces", 1), ("count", "fixed")):
        if getattr(scene, key) != wanted:
            yield (
                f"ensemble.{key} = {getattr(scene, key)!r}: measured heights as they are need {wanted!r}; "
                f"or set resample = true under [{table}]"
            )


def _radii(scene: Fields) -> Iterator[str]:
    """Radii of summits that do not go with their heights, or that a sampler does not draw."""
    assert scene.summits is not None
    if isinstance(scene.summits, analytic.MeasuredRadii):
        if scene.heights != scene.summits.heights:
            yield "heights: they differ from those of the measured summits; leave them out"
        return
    if not isinstance(scene.heights, analytic.Nayak) or scene.heights.alpha != scene.summits.alpha:
        yield (
            'summits.curvature = "random": it needs heights.law = "nayak", alpha = '
            f'{scene.summits.alpha:g}; use these heights, or curvature = "mean"'
        )
    promise = promise_of(scene.sampler)
    if not promise.one_by_one:
        yield (
            f'ensemble.sampler = "{scene.sampler}": sums over summits with individual radii are far '
            'from Gaussian; use "cells", or summits.curvature = "mean"'
        )
    if not scene.hertzian and not promise.own_laws:
        yield (
            f'ensemble.sampler = "{scene.sampler}": summits with individual radii have different breaks of '
            f'contact.law = "{scene.law.name}"; use sampler = "tail", or summits.curvature = "mean"'
        )


def _wishes(scene: Fields) -> Iterator[str]:
    """Wanted accuracies that the scene cannot have."""
    given = scene.rel_err if isinstance(scene.rel_err, Mapping) else {"": scene.rel_err}
    if not given:
        yield "ensemble.rel_err = {}: name at least one quantity, or give one number for all"
    for name, value in given.items():
        key = f"ensemble.rel_err.{name}" if name else "ensemble.rel_err"
        if name and name not in scene.quantities:
            yield f"{key}: is not one of contact.quantities; give one of {', '.join(scene.quantities)}"
        if isinstance(value, list) and len(value) != len(scene.separations):
            yield f"{key}: has {len(value)} values; give one for each of {len(scene.separations)} separations"
