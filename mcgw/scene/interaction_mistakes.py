"""Mistakes in scenes with asperity interaction."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from mcgw.scene.fields import Fields
from mcgw.scene.promises import promise_of

LOCATED = ("load", "area", "stiffness", "contacts", "conductance")
MOST_LOCATED = 20_000
_BEYOND = 1e-6  # of a side: places read from a file


def interaction_mistakes(scene: Fields) -> Iterator[str]:
    """One line for each mistake."""
    if scene.located:
        yield from _located(scene)
        return
    yield from list(_independent(scene)) or _balance(scene)


def _located(scene: Fields) -> Iterator[str]:
    """Features that summits with positions do not support."""
    key = 'interaction.reference = "located"'
    if not promise_of(scene.sampler).places:
        yield f'ensemble.sampler = "{scene.sampler}": {key} uses all asperities of a surface; use "direct"'
    if unknown := [name for name in scene.quantities if name not in LOCATED]:
        yield f"contact.quantities: {key} has {', '.join(LOCATED)}; leave out {', '.join(unknown)}"
    if scene.n_asperities > MOST_LOCATED:
        yield f"{key}: {scene.n_asperities:g} asperities a surface; give {MOST_LOCATED} or fewer"
    if scene.own_places:
        yield from _outside(scene.curvature, scene.surface.nominal_area)
    if scene.keep != "sums":
        yield f'ensemble.keep = "{scene.keep}": {key} keeps sums; use "sums"'
    if scene.rel_err is not None:
        yield f"ensemble.rel_err: no theory tells how {key} scatters; give n_surfaces"
    others = {
        "contact.unload_from": scene.unload_from,
        "contact: resistivity or conductivities": scene.film, "joint": scene.joint,
    }  # fmt: skip
    for other in (name for name, value in others.items() if value is not None):
        yield f"{other}: {key} does not go with it; leave out one of the two"
    if scene.negative == "allow":
        yield f'grading.negative = "allow": {key} needs loads that decrease with the separation; use "clip"'
    if _adheres(scene):
        yield f'contact.law = "{scene.law.name}": {key} needs loads that fall with the separation'


def _outside(listed: Any, area: float) -> Iterator[str]:
    """Places that do not fit into the cell, which repeats itself: where its corner is does not matter."""
    for name, at, side in zip("xy", listed.places, listed.sides(area), strict=True):
        if (extent := max(at) - min(at)) > side * (1 + _BEYOND):
            yield (
                f"summits.aspect = {listed.aspect:g}: places extend over {extent:.4g} m along {name}, but "
                f"the nominal area over {side:.4g} m; give the width over the height of the map, and its area"
            )


def _adheres(scene: Fields) -> bool:
    """Whether asperities adhere at first touch."""
    return float(np.min(scene.contact.load(0, np.zeros(1), np.ones(1)))) < 0


def _independent(scene: Fields) -> Iterator[str]:
    """Mistakes that do not depend on where the balance is."""
    if "load" not in scene.quantities:
        yield 'interaction: separations depend on the load; add "load" to contact.quantities'


def _balance(scene: Fields) -> Iterator[str]:
    """Mistake: separations at which the plane sinks faster than it is pressed."""
    theory: Any = scene.theory
    h = np.unique(scene.separations)
    try:
        rate = 1 + theory.compliance * theory.alone.slope("load", h)
    except ValueError as error:
        yield str(error)
        return
    if np.any(rate <= 0):
        yield (
            f"interaction: at d/sigma = {h[rate <= 0].max():g} the mean plane sinks faster than it is "
            "pressed, so the nominal separation is not unique; give larger separations"
        )
