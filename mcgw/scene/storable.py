"""A scene made of numbers alone, whatever Python gave: what is simulated, and what a file keeps."""

from dataclasses import replace

from analytic import extent, is_data, resolved
from mcgw.scene.scene import Scene
from mcgw.scene.section import SceneError

__all__ = ["storable"]


def storable(scene: Scene) -> Scene:
    """The scene with its grading resolved, unless it is one that a file holds as it is.

    All samplers draw with this one, so that in memory, in a file, and gone on with from there, a scene has
    the same bits. A Python function becomes an `analytic.PiecewiseSeries` over all heights that count.

    Raises
    ------
    SceneError
        If the grading cannot be resolved, as one that is noisy.
    """
    if is_data(scene.grading):
        return scene
    try:
        low, high = extent(scene.grading, scene.heights, scene.separations)
        return replace(scene, grading=resolved(scene.grading, low, high))
    except SceneError:
        raise
    except ValueError as error:
        raise SceneError([str(error)]) from None
