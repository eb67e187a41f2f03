"""The scene of each point of a sweep, checked as a scene file is.

A sweep is checked and put into groups before anything is drawn.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from typing import Any

import tomli_w

from mcgw.ensemble.forecast import without_rule
from mcgw.ensemble.pooled import Pooled, pooled_from
from mcgw.ensemble.results import Tables
from mcgw.formats.named_files import loads
from mcgw.machine.progress import steps
from mcgw.scene.cautions import cautions
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_document, scene_of, with_changes
from mcgw.scene.section import SceneError
from mcgw.sweeps.axes import Axes
from mcgw.sweeps.groups import Group, Place, groups_of
from mcgw.sweeps.sweep import Sweep

_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_MOST_TOLD = 20  # most mistakes that are shown


def scenes_of(document: dict[str, Any], axes: Axes) -> list[Scene]:
    """Scenes of all points, from the tables of the base scene.

    Raises
    ------
    SceneError
        With the mistakes of all points, each with its point.
    """
    found, problems = [], []
    for point in steps(list(axes.points()), "points"):
        try:
            found.append(scene_of(with_changes(document, axes.at(point))))
        except SceneError as error:
            problems += [f"{line} (at {axes.text(point)})" for line in error.problems]
    if len(problems) > _MOST_TOLD:
        problems = [*problems[:_MOST_TOLD], f"... and {len(problems) - _MOST_TOLD} more"]
    if problems:
        raise SceneError(problems)
    if len({(one.separations, one.tables) for one in found}) > 1:
        raise SceneError(["sweep: the points differ in separations or quantities; sweep them separately"])
    return found


class Points(Sequence[Scene]):
    """Scenes of a finished sweep, each made once, when needed.

    Parameters
    ----------
    document : dict
        Tables of the base scene.
    axes : Axes
        What they differ in.
    drawn : sequence of int
        Number of surfaces of each point.
    """

    def __init__(self, document: dict[str, Any], axes: Axes, drawn: Sequence[int]) -> None:
        points = list(axes.points())

        @cache
        def made(i: int) -> Scene:
            scene = scene_of(with_changes(document, axes.at(points[i])))
            return scene.replace(n_surfaces=drawn[i], rel_err=None)

        self._made, self._numbers = made, range(len(points))

    def __len__(self) -> int:
        """Return the number of points."""
        return len(self._numbers)

    def __getitem__(self, i: Any) -> Any:
        """Return a scene, or several."""
        of = self._numbers[i]
        return [self._made(k) for k in of] if isinstance(i, slice) else self._made(of)


def document_of(scene: Scene) -> dict[str, Any]:
    """Tables of the scene, without defaults and derived values."""
    document = scene_document(scene)
    if document["grading"]["law"] == "homogeneous":
        del document["grading"]["law"]
    return document


@dataclass(frozen=True)
class Asked:
    """The scenes of a sweep, not yet drawn.

    Parameters
    ----------
    document : dict
        Tables of the base scene.
    axes : Axes
        What they differ in.
    """

    document: dict[str, Any]
    axes: Axes

    @classmethod
    def of(cls, scene: Scene, axes: Axes) -> "Asked":
        """From a base scene and its changes; nothing is checked yet."""
        return cls(document_of(scene), axes)

    @staticmethod
    @lru_cache(maxsize=1)
    def from_texts(scene: str, axes: str) -> "Asked":
        """From what `texts` gave; cached, since finding the groups may take long."""
        return Asked(loads(scene), Axes.from_text(axes))

    def texts(self) -> tuple[str, str]:
        """Return the scene as TOML and the axes as JSON."""
        return tomli_w.dumps(self.document), self.axes.text_of_all()

    @cached_property
    def groups(self) -> list[Group]:
        """Points that share their surfaces.

        Raises
        ------
        SceneError
            With the mistakes of all points.
        """
        scenes = scenes_of(self.document, self.axes)
        if any(scene.max_seconds is not None for scene in scenes):
            what = "ensemble.max_seconds: a sweep must be reproducible; give n_surfaces or rel_err"
            raise SceneError([what])
        return groups_of([x if x.rel_err is None else without_rule(x) for x in scenes])

    def answered(self, pooled: Sequence[Pooled], places: Sequence[Place] = ()) -> Sweep:
        """Return the sweep, from the data of each group, and where in them each point is."""
        if not places:
            found = {i: x for group in self.groups for i, x in zip(group.numbers, group.places, strict=True)}
            places = [found[i] for i in range(self.axes.size)]
        scenes = Points(self.document, self.axes, [pooled[place.group].n for place in places])
        return Sweep(self.axes, scenes, tuple(places), tuple(pooled))


def sweep_of(scene: str, axes: str, drawn: Tables) -> Sweep:
    """Return a finished sweep from the words and tables of its file; scenes are made when needed."""
    rows = zip(drawn["points"].tolist(), drawn["points"][:, 1:], drawn["weights"], strict=True)
    places = [Place(g, some[some >= 0], w[some >= 0]) for (g, *_), some, w in rows]
    return Asked(loads(scene), Axes.from_text(axes)).answered(pooled_from(drawn), places)


def sweep_cautions(sweep: Sweep) -> list[str]:
    """Cautions about all scenes, one line each, the most common first.

    Cautions that differ in their numbers alone are one, with those of the first point that has it.
    """
    points = list(sweep.axes.points())
    found: dict[str, list[tuple[int, str]]] = {}
    for i in range(len(points)):
        for line in cautions(sweep.scenes[i]):
            found.setdefault(_NUMBER.sub("#", line), []).append((i, line))
    lines = []
    for some in sorted(found.values(), key=len, reverse=True):
        first, line = some[0]
        alike = len({text for _, text in some}) == 1
        where = "" if alike else f" (numbers of {sweep.axes.text(points[first])})"
        lines.append(f"{len({i for i, _ in some})} of {len(points)} points: {line}{where}")
    return lines
