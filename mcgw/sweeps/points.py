"""The scene of each point of a sweep, checked as a scene file is."""

from typing import Any

from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_document, scene_of
from mcgw.scene.section import SceneError
from mcgw.sweeps.axes import Axes

__all__ = ["scenes_of"]

_MOST_TOLD = 20  # mistakes: more say nothing new


def scenes_of(scene: Scene, axes: Axes) -> list[Scene]:
    """The scenes of all points.

    Raises
    ------
    SceneError
        With the mistakes of all points, each with the point it is of.
    """
    document, found, problems = _document(scene), [], []
    for point in axes.points():
        try:
            found.append(scene_of(_with(document, axes.at(point))))
        except SceneError as error:
            problems += [f"{line} (at {axes.text(point)})" for line in error.problems]
    if len(problems) > _MOST_TOLD:
        problems = [*problems[:_MOST_TOLD], f"... and {len(problems) - _MOST_TOLD} more"]
    if problems:
        raise SceneError(problems)
    if len({(one.separations, tuple(one.shapes)) for one in found}) > 1:
        raise SceneError(["sweep: the points have other separations or quantities; sweep them apart"])
    return found


def _document(scene: Scene) -> dict[str, Any]:
    """The tables of the scene; what follows from others, or goes without saying, is left out."""
    document = scene_document(scene, left_out=False)
    if "n_asperities" in scene.left_out:
        del document["ensemble"]["n_asperities"]
    if document["grading"]["law"] == "homogeneous":
        del document["grading"]["law"]
    document["ensemble"]["keep"] = "sums"
    return document


def _with(document: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """The tables with other values; a whole table takes the place of one."""
    changed = dict(document)
    for key, value in changes.items():
        section, _, name = key.partition(".")
        if not name:
            changed[section] = value
            continue
        table = changed.get(section, {})
        changed[section] = {**table, name: value} if isinstance(table, dict) else table
    return changed
