"""Wanted accuracy of means: one number, one per quantity, or one per separation."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from analytic import quantity_of
from analytic.arrays import Array
from mcgw.scene.fields import Fields


def rel_err_mistakes(scene: Fields) -> Iterator[str]:
    """Mistakes: wishes that the scene cannot have."""
    if scene.rel_err is None:
        return
    given = scene.rel_err if isinstance(scene.rel_err, Mapping) else {"": scene.rel_err}
    if not given:
        yield "ensemble.rel_err = {}: name at least one quantity, or give one number for all"
    for name, value in given.items():
        key = f"ensemble.rel_err.{name}" if name else "ensemble.rel_err"
        if name and name not in scene.quantities:
            yield f"{key}: is not one of contact.quantities; give one of {', '.join(scene.quantities)}"
        listed = value if isinstance(value, list) else [value]
        if isinstance(value, list) and len(value) != len(scene.separations):
            yield f"{key}: has {len(value)} values; give one for each of {len(scene.separations)} separations"
        if not name or name in scene.quantities:
            least = min((x for x in listed if x < math.inf), default=math.inf)
            if least <= max(_off(scene, each) for each in ([name] if name else scene.quantities)):
                yield (
                    f"{key} = {least:g}: values and their means only have accuracy = {scene.accuracy:g}; "
                    "give a smaller accuracy, or a larger rel_err"
                )


def _off(scene: Fields, name: str) -> float:
    """Relative error of the values of a quantity, and so of their means; counts are exact."""
    return 0.0 if scene.exact or quantity_of(name).counts else scene.accuracy


def wanted(scene: Fields) -> dict[str, Array]:
    """Wanted relative error of each mean by drawing, shape (separations,), for quantities with a wish.

    The error of single values is left out: drawing more does not reduce it.
    """
    if scene.rel_err is None:
        return {}
    one = not isinstance(scene.rel_err, Mapping)
    given: Any = dict.fromkeys(scene.quantities, scene.rel_err) if one else scene.rel_err
    return {
        name: np.broadcast_to(np.array(x, dtype=np.float64) - _off(scene, name), len(scene.separations))
        for name, x in given.items()
    }


def rel_err_text(rel_err: float | Mapping[str, float | list[float]]) -> str:
    """Display the wish."""
    if not isinstance(rel_err, Mapping):
        return f"{rel_err:g}"
    shown = (f"{min(x):g} at best" if isinstance(x, list) else f"{x:g}" for x in rel_err.values())
    return ", ".join(f"{name} {text}" for name, text in zip(rel_err, shown, strict=True))
