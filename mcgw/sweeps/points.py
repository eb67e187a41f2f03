"""The scene of each point of a sweep, checked as a scene file is.

A sweep is checked and put into groups before anything is drawn.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any

import tomli_w

from mcgw.ensemble.forecast import without_rule
from mcgw.ensemble.pooled import Pooled, pooled_from
from mcgw.ensemble.results import Tables
from mcgw.formats.named_files import loads
from mcgw.machine.progress import steps
from mcgw.scene.cautions import cautions
from mcgw.scene.reading import with_changes
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_document, scene_of
from mcgw.scene.section import SceneError
from mcgw.sweeps.axes import Axes
from mcgw.sweeps.groups import Group, Place, groups_of, weighted
from mcgw.sweeps.sweep import Sweep

_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_MOST_TOLD = 20  # most mistakes that are shown


@dataclass(frozen=True, eq=False)
class Points(Sequence[Scene]):
    """The scenes of a sweep, each made when it is needed.

    Parameters
    ----------
    document : dict
        Tables of the base scene.
    axes : Axes
        What they differ in.
    drawn : tuple of int
        Number of surfaces of each point, once it is known.
    """

    document: dict[str, Any]
    axes: Axes
    drawn: tuple[int, ...] = ()

    @classmethod
    def of(cls, scene: Scene, axes: Axes) -> "Points":
        """From a base scene and its changes; nothing is checked yet."""
        document = scene_document(scene)
        if document["grading"]["law"] == "homogeneous":
            del document["grading"]["law"]
        return cls(document, axes)

    @classmethod
    def from_texts(cls, scene: str, axes: str) -> "Points":
        """From what `texts` gave."""
        return cls(loads(scene), Axes.from_text(axes))

    def texts(self) -> tuple[str, str]:
        """Return the scene as TOML and the axes as JSON."""
        return tomli_w.dumps(self.document), self.axes.text_of_all()

    def __len__(self) -> int:
        """Return the number of points."""
        return self.axes.size

    def __getitem__(self, i: Any) -> Any:
        """Return a scene, or several."""
        of = range(len(self))[i]
        return [self._scene(k) for k in of] if isinstance(i, slice) else self._scene(of)

    @cached_property
    def _scene(self) -> Callable[[int], Scene]:
        points = list(self.axes.points())

        @cache
        def made(i: int) -> Scene:
            scene = scene_of(with_changes(self.document, self.axes.at(points[i])))
            return scene.replace(n_surfaces=self.drawn[i], rel_err=None) if self.drawn else scene

        return made

    @cached_property
    def _grouped(self) -> tuple[list[Group], list[Place]]:
        found, problems = list[Scene](), list[str]()
        for i, point in enumerate(steps(list(self.axes.points()), "points")):
            try:
                found.append(self[i])
            except SceneError as error:
                problems += [f"{line} (at {self.axes.text(point)})" for line in error.problems]
        if len(problems) > _MOST_TOLD:
            problems = [*problems[:_MOST_TOLD], f"... and {len(problems) - _MOST_TOLD} more"]
        elif not problems and len({(one.separations, one.tables) for one in found}) > 1:
            problems = ["sweep: the points differ in separations or quantities; sweep them separately"]
        elif not problems and any(scene.max_seconds is not None for scene in found):
            problems = ["ensemble.max_seconds: a sweep must be reproducible; give n_surfaces or rel_err"]
        if problems:
            raise SceneError(problems)
        return groups_of([x if x.rel_err is None else without_rule(x) for x in found])

    @property
    def groups(self) -> list[Group]:
        """Points that share their surfaces.

        Raises
        ------
        SceneError
            With the mistakes of all points, each with its point.
        """
        return self._grouped[0]

    def answered(self, pooled: Sequence[Pooled], places: Sequence[Place] = ()) -> Sweep:
        """Return the sweep, from the data of each group, and where in them each point is."""
        places = places or self._grouped[1]
        scenes = replace(self, drawn=tuple(pooled[group].n for group, *_ in places))
        return Sweep(self.axes, scenes, tuple(places), tuple(pooled))

    def in_memory(self, tell: Callable[[float, float], object]) -> Sweep:
        """Draw all of it; `tell` is told of (done, total) surfaces, weighted by their cost.

        Raises
        ------
        StoreError
            If the memory is too small.
        """
        note, done = weighted(self.groups, tell), 0.0
        for group in self.groups:
            group.check()

        def blocks(group: Group) -> Iterator[Tables]:
            nonlocal done
            n = group.scene.n_surfaces
            for first in range(0, n, group.rows):
                stop = min(first + group.rows, n)
                yield group.tables(first, stop)
                done += (stop - first) * group.work
                note(done)

        note(0)
        return self.answered([group.held(blocks(group)) for group in self.groups])


def sweep_of(scene: str, axes: str, drawn: Tables) -> Sweep:
    """Return a finished sweep from the words and tables of its file; scenes are made when needed."""
    rows = zip(drawn["points"].tolist(), drawn["points"][:, 1:], drawn["weights"], strict=True)
    places = [(g, some[some >= 0], w[some >= 0]) for (g, *_), some, w in rows]
    return Points.from_texts(scene, axes).answered(pooled_from(drawn), places)


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
