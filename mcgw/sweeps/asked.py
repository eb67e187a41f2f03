"""What a sweep asks, checked and put into groups: before anything is drawn."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import tomli_w

from mcgw.ensemble.forecast import without_rule
from mcgw.formats.untrusted import loads
from mcgw.machine.memory import keep_freed_memory
from mcgw.scene.scene import Scene
from mcgw.scene.section import SceneError
from mcgw.sweeps.axes import Axes
from mcgw.sweeps.groups import Group, Place, groups_of
from mcgw.sweeps.points import document_of, scenes_of
from mcgw.sweeps.pooled import Pooled
from mcgw.sweeps.sweep import Sweep

__all__ = ["Asked"]


@dataclass(frozen=True)
class Asked:
    """The question.

    Parameters
    ----------
    document : dict
        The tables of the scene that the points come from.
    axes : Axes
        What they differ in.
    """

    document: dict[str, Any]
    axes: Axes

    @classmethod
    def of(cls, scene: Scene, axes: Axes) -> "Asked":
        """A scene and what is changed of it; nothing is checked yet."""
        return cls(document_of(scene), axes)

    @classmethod
    def from_texts(cls, scene: str, axes: str) -> "Asked":
        """What `texts` gave; the same object for the same texts, for its groups may take long to find."""
        return _from_texts(scene, axes)

    def texts(self) -> tuple[str, str]:
        """The scene as TOML and the axes as JSON."""
        return tomli_w.dumps(self.document), self.axes.text_of_all()

    @cached_property
    def groups(self) -> list[Group]:
        """Points that share their surfaces.

        Raises
        ------
        SceneError
            With the mistakes of all points.
        """
        keep_freed_memory()
        return groups_of([_with_a_number(scene) for scene in scenes_of(self.document, self.axes)])

    def answered(self, pooled: Sequence[Pooled], statistics: tuple[str, ...]) -> Sweep:
        """The answer, from what is kept of each group."""
        scenes: dict[int, Scene] = {}
        places: dict[int, Place] = {}
        for group in self.groups:
            scenes |= dict(zip(group.numbers, group.scenes, strict=True))
            places |= dict(zip(group.numbers, group.places, strict=True))
        return Sweep(
            axes=self.axes,
            scenes=tuple(scenes[i] for i in range(self.axes.size)),
            places=tuple(places[i] for i in range(self.axes.size)),
            groups=tuple(pooled),
            edges=tuple(group.scenes[0].edges for group in self.groups),
            statistics=statistics,
        )


@lru_cache(maxsize=1)
def _from_texts(scene: str, axes: str) -> Asked:
    return Asked(loads(scene), Axes.from_text(axes))


def _with_a_number(scene: Scene) -> Scene:
    """With a number of surfaces in the place of a rule."""
    if scene.max_seconds is not None:
        raise SceneError(["ensemble.max_seconds: a sweep draws the same again; give n_surfaces or rel_err"])
    return scene if scene.rel_err is None else without_rule(scene)
