"""Which runs may be one: those whose surfaces are the same, whatever their number."""

import hashlib
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from mcgw.formats.untrusted import loads
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_from, scene_text
from mcgw.store.arithmetic import KIND, drawn_with

__all__ = ["Question", "difference", "identity_of"]

Question = tuple[str, str, str]  # text of a scene, axes of a sweep or none, versions that draw


def _frozen_text(scene: Scene) -> str:
    """What of a scene must stay the same while its ensemble grows: the values, whoever gave them."""
    return scene_text(replace(scene, n_surfaces=1), left_out=False)


def identity_of(scene: Scene, sampler: str) -> str:
    """SHA-256 of all that the numbers of a surface depend on: frozen scene, sampler, what draws."""
    parts = (_frozen_text(scene), sampler, drawn_with(scene, sampler))
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


def difference(there: Question, here: Question) -> str:
    """What keeps two runs, or two sweeps, from being one, in words: scene, axes and what draws, of each."""
    before, now = _said(*there[:2]), _said(*here[:2])
    for key, value in now.items():
        if before.get(key) != value:
            return f"{key} is {_short(before.get(key))} there and {_short(value)} here"
    for key, value in before.items():
        if key not in now:
            return f"{key} is {_short(value)} there and not given here"
    made_with, this = there[2], here[2]
    if made_with.partition(KIND)[0] == this.partition(KIND)[0] and made_with != this:
        return "it was drawn on another kind of processor, which rounds exponentials and logarithms otherwise"
    return f"it was drawn with {made_with}, this is {this}"


def _said(scene: str, axes: str) -> dict[str, Any]:
    """Keys and values that decide the numbers: of a scene alone but for the number of surfaces."""
    if not axes:
        return dict(_flat(loads(_frozen_text(scene_from(scene)))))
    return {**dict(_flat(loads(scene))), "sweep": axes}


def _flat(table: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


def _short(value: Any) -> str:
    shown = repr(value)
    return shown if len(shown) <= 60 else shown[:57] + "..."
