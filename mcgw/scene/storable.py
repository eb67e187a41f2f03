"""A scene with nothing left open: numbers in place of functions, and the sampler that drew it."""

from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from analytic import extent, is_data, resolved
from analytic.laws import ContactLaw
from mcgw.scene.fields import Fields
from mcgw.scene.samplers import promise_of
from mcgw.scene.section import SceneError

AnyScene = TypeVar("AnyScene", bound=Fields)

_LOOKED_AT, _BEYOND = 4001, 1.1  # heights for the stiffest; and how much farther series reach
_MARGIN = 1 / 16  # the lowest that is felt is a multiple of this, and may change by one with the series


def storable(scene: AnyScene) -> AnyScene:
    """The scene with its grading and contact law resolved, unless a file holds them as they are.

    All samplers draw with this one, so that in memory, in a file, and resumed from there, a scene has
    the same bits. A Python function becomes an `analytic.PiecewiseSeries` over all heights that count.

    Raises
    ------
    SceneError
        If the grading cannot be resolved, as one that is noisy.
    """
    if scene.law.is_data and is_data(scene.grading):
        return scene
    return replace(scene, **in_numbers(scene))


def in_numbers(scene: Fields) -> dict[str, Any]:
    """What of a scene a file does not hold as it is, resolved; raises as `storable`."""
    changes: dict[str, Any] = {} if scene.law.is_data else {"law": _resolved_law(scene)}
    if is_data(scene.grading):
        return changes
    try:
        return changes | {"grading": resolved(scene.grading, *_extent(scene))}
    except ValueError as error:
        raise SceneError([str(error)]) from None


def _extent(scene: Fields) -> tuple[float, float]:
    """Lowest and highest height that count; asperities may have felt lower separations than those asked."""
    asked = scene.separations
    if scene.lowest < min(asked):
        asked = (*asked, scene.lowest - (_MARGIN if scene.nominal else 0.0))
    low, high = extent(scene.grading, scene.heights, asked)
    if scene.nominal:  # a balance is sought in cells that begin at separations up to the highest asperity
        high = max(high, min(scene.highest + 1, scene.heights.support[1]))
    return low, high


def _resolved_law(scene: Fields) -> ContactLaw:
    """The series of a law up to the deepest penetration of the stiffest asperity."""
    low, high = _extent(scene)
    deepest = high - min(scene.lowest, low if scene.unload_from is None else scene.unload_from)
    stiffest = float(np.max(np.abs(scene.modulus(np.linspace(low, high, _LOOKED_AT)))))
    try:
        return scene.law.as_data(_BEYOND * deepest * stiffest**2)
    except ValueError as error:
        raise SceneError([f"contact.law = {type(scene.law).__name__}: {error}"]) from None


def drawn_by(scene: AnyScene, sampler: str) -> AnyScene:
    """The scene that says by which sampler it was drawn, where it left the choice to ``auto``."""
    if sampler != scene.sampler and scene.law_error and promise_of(sampler).spends:
        return scene  # its crowds follow from what may be spent
    return replace(scene, sampler=sampler)
