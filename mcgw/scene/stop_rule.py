"""Wanted accuracy of means: one number, one per quantity, or one per separation."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.scene.fields import Fields


def rel_err_mistakes(scene: Fields) -> Iterator[str]:
    """Mistakes: wishes that the scene cannot have."""
    given = scene.rel_err if isinstance(scene.rel_err, Mapping) else {"": scene.rel_err}
    if not given:
        yield "ensemble.rel_err = {}: name at least one quantity, or give one number for all"
    for name, value in given.items():
        key = f"ensemble.rel_err.{name}" if name else "ensemble.rel_err"
        if name and name not in scene.quantities:
            yield f"{key}: is not one of contact.quantities; give one of {', '.join(scene.quantities)}"
        if isinstance(value, list) and len(value) != len(scene.separations):
            yield f"{key}: has {len(value)} values; give one for each of {len(scene.separations)} separations"


def wanted(scene: Fields) -> dict[str, Array]:
    """Wanted relative error of each mean, shape (separations,), for quantities with a wish."""
    if scene.rel_err is None:
        return {}
    one = not isinstance(scene.rel_err, Mapping)
    given: Any = dict.fromkeys(scene.quantities, scene.rel_err) if one else scene.rel_err
    return {
        name: np.broadcast_to(np.array(x, dtype=np.float64), len(scene.separations))
        for name, x in given.items()
    }


def rel_err_text(rel_err: float | Mapping[str, float | list[float]]) -> str:
    """Display the wish."""
    if not isinstance(rel_err, Mapping):
        return f"{rel_err:g}"
    shown = (f"{min(x):g} at best" if isinstance(x, list) else f"{x:g}" for x in rel_err.values())
    return ", ".join(f"{name} {text}" for name, text in zip(rel_err, shown, strict=True))
