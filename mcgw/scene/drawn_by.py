"""A scene whose sampler is told, where it left the choice open."""

from dataclasses import replace

from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene

__all__ = ["drawn_by"]


def drawn_by(scene: Scene, sampler: str) -> Scene:
    """The scene that says by which sampler it was drawn, where it left the choice to ``auto``."""
    if sampler != scene.sampler and scene.law_error and promise_of(sampler).spends:
        return scene  # its crowds follow from what may be spent
    return replace(scene, sampler=sampler)
