"""The scenes of a sweep, checked as a scene file is and put into groups that share their surfaces.

Exponential gradings as combinations of two: under Hertz's law every sum is linear in the modulus.

``E*(s)/E* = gamma - (gamma - 1) exp(-s)`` is linear in gamma (a homogeneous surface has gamma = 1). So every
grading lies between the softest and the stiffest of a sweep: its load on a surface is the same weighted mean
of their loads there, and over the surfaces its mean and variance follow from their means, variances and
covariance. A thousand more gradings cost no product with the surfaces. Weights from 0 to 1 and moduli that
are not negative let nothing cancel: the last digits are those of the two.
"""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, lru_cache, reduce
from operator import add
from time import perf_counter
from typing import Any

import numpy as np
import tomli_w

from analytic import Exponential, Homogeneous
from analytic.arrays import Array, Ints
from mcgw.ensemble.drawing import GoOn, Values, block_size, drawn_blocks, kept, seconds_per_surface
from mcgw.ensemble.forecast import in_words, without_rule
from mcgw.ensemble.pooled import Pooled, pooled_from, tables_of
from mcgw.ensemble.results import Tables, joined
from mcgw.formats.named_files import loads
from mcgw.machine.process import check_memory, steps
from mcgw.machine.terminal import listed, one_line
from mcgw.sampling.shared import Shared, common_edges, shared, to_be_shared
from mcgw.scene.cautions import cautions
from mcgw.scene.reading import with_changes
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_document, scene_of
from mcgw.scene.section import SceneError
from mcgw.sweeps.axes import Axes
from mcgw.sweeps.sweep import Place, Sweep

_MANY = 8  # gradings; fewer are computed one by one, with the same bits as alone
_ROWS = 8192  # surfaces whose values are pooled at once, as an ensemble does
_BYTES = 2**28  # bytes of those values
_DRAWS = 1e10  # asperities per block: the cost of an interruption
_ANSWER = 3000  # cost of one scene per surface, in asperities drawn
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_MOST_TOLD = 20  # most mistakes that are shown


class Group(Values):
    """Points that share their surfaces: means, variances and covariances of those scenes that are computed.

    `edges` are common to all cells, where the cells of the scenes would differ (`common_edges`).
    """

    disk = 0  # statistics take hardly any

    def __init__(self, computed: tuple[Scene, ...], edges: tuple[float, ...]) -> None:
        super().__init__(computed[0])
        self.computed, self.edges = computed, edges
        self.work = self.scene.touching + _ANSWER * len(computed)

    @property
    def rows(self) -> int:
        """Surfaces per block."""
        width = sum(scene.width for scene in self.computed)
        return max(min(_ROWS, _BYTES // (8 * width), int(_DRAWS / (self.scene.touching + 1))), 1)

    def tables(self, first: int, stop: int, go_on: GoOn | None = None) -> Tables:
        """Return the statistics of a block."""
        source = _source_of(self)
        blocks = list(drawn_blocks(source, first, stop, block_size(self.scene, source)))
        values = [joined([kept(x, block[i]) for block in blocks]) for i, x in enumerate(self.computed)]
        if go_on:
            go_on(stop)
        return tables_of([Pooled.of(values)])

    def held(self, blocks: Iterable[Tables]) -> Pooled:
        """Return the sum of all blocks."""
        return reduce(add, (pooled_from(block)[0] for block in blocks))

    def check(self, surfaces: int | None = None) -> None:  # noqa: ARG002
        """Refuse covariances that the memory cannot hold."""
        n, h = len(self.computed), len(self.scene.separations)
        what = f"sweep: covariances between {n} points at {h} separations"
        check_memory(what, 2 * 8 * self.scene.width * n**2)


@lru_cache(maxsize=1)  # blocks come in the order of groups
def _source_of(group: Group) -> Shared:
    return shared(group.computed, group.edges)


def groups_of(scenes: Sequence[Scene]) -> tuple[list[Group], list[Place]]:
    """Group the scenes of a sweep; return also where in the groups each scene is."""
    groups, places = list[Group](), dict[int, Place]()
    keys = [to_be_shared(scene) for scene in steps(scenes, "points")]
    for members in _alike([(i,) if key is None else key for i, key in enumerate(keys)]):
        some, computed = [scenes[i] for i in members], list[Scene]()
        edges = common_edges(some) if len(some) > 1 else ()
        if edges is None:
            some, edges = [scene.replace(sampler="tail") for scene in some], ()
        others = [each.name for each in fields(Scene) if each.name not in ("grading", "title")]
        for alike in _alike([[getattr(scene, name) for name in others] for scene in some]):
            wanted, combinations = combined([some[k] for k in alike])
            for k, (which, weights) in zip(alike, combinations, strict=True):
                places[members[k]] = len(groups), len(computed) + which, weights
            computed += [some[alike[k]] for k in wanted]
        groups.append(Group(tuple(computed), edges))
    return groups, [places[i] for i in range(len(scenes))]


def _alike(keys: Sequence[Any]) -> list[list[int]]:
    """Group the numbers of equal keys, which need not be hashable."""
    found: list[tuple[Any, list[int]]] = []
    for i, key in enumerate(keys):
        members = next((some for other, some in reversed(found) if other == key), None)
        if members is None:
            found.append((key, members := []))
        members.append(i)
    return [members for _, members in found]


def combined(scenes: Sequence[Scene]) -> tuple[Sequence[int], list[tuple[Ints, Array]]]:
    """Scenes that differ in their gradings alone, as weighted means of some of them.

    These are two; or all, if they are few, a grading is no exponential one, or sums are not linear in it. Of
    each scene follow which of them it is made of, and their weights.
    """
    one = scenes[0]
    # All that is kept must be linear in a modulus that is not negative.
    linear = one.hertzian and one.interaction is None and one.negative == "error"
    gammas = [
        x.grading.gamma if isinstance(x.grading, Exponential) else 1.0 if x.grading == Homogeneous() else None
        for x in scenes
    ]
    if len(set(gammas)) < _MANY or None in gammas or not linear:
        return range(len(scenes)), [(np.array([i]), np.ones(1)) for i in range(len(scenes))]
    x = np.array(gammas, dtype=np.float64)
    low, high = int(np.argmin(x)), int(np.argmax(x))
    pairs = [np.array([1 - share, share]) for share in (x - x[low]) / (x[high] - x[low])]
    return (low, high), [(np.flatnonzero(pair), pair[pair != 0]) for pair in pairs]


def weighted(reducers: Iterable[Values], tell: Callable[[float, float], object]) -> GoOn:
    """Convert work done to (done, total) surfaces, weighted by their cost."""
    each = [(one.scene.n_surfaces, one.scene.n_surfaces * one.work) for one in reducers]
    surfaces, work = map(sum, zip(*each, strict=True))

    def note(done: float) -> bool:
        tell(round(surfaces * done / work), surfaces)
        return True

    return note


@dataclass(frozen=True, eq=False)
class Points(Sequence[Scene]):
    """The scenes of a sweep, each made when it is needed."""

    document: dict[str, Any]  # tables of the base scene
    axes: Axes  # what they differ in
    drawn: tuple[int, ...] = ()  # number of surfaces of each point, once it is known
    _made: dict[int, Scene] = field(default_factory=dict, init=False)

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
        if isinstance(i, slice):
            return [self[k] for k in range(len(self))[i]]
        k = range(len(self))[i]
        if k not in self._made:
            scene = scene_of(with_changes(self.document, self.axes.at(k)))
            self._made[k] = scene.replace(n_surfaces=self.drawn[k], rel_err=None) if self.drawn else scene
        return self._made[k]

    @cached_property
    def _grouped(self) -> tuple[list[Group], list[Place]]:
        found, problems = list[Scene](), list[str]()
        for i in steps(range(len(self)), "points"):
            try:
                found.append(self[i])
            except SceneError as error:
                problems += [f"{line} (at {self.axes.text(i)})" for line in error.problems]
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
        """Points that share their surfaces; an error tells the mistakes of all points, and where each is."""
        return self._grouped[0]

    def answered(self, pooled: Sequence[Pooled], places: Sequence[Place] = ()) -> Sweep:
        """Return the sweep, from the data of each group, and where in them each point is."""
        places = places or self._grouped[1]
        scenes = replace(self, drawn=tuple(pooled[group].n for group, *_ in places))
        return Sweep(self.axes, scenes, tuple(places), tuple(pooled))

    def in_memory(self, tell: Callable[[float, float], object]) -> Sweep:
        """Draw all of it; `tell` is told of (done, total) surfaces, weighted by their cost."""
        note, done, pooled = weighted(self.groups, tell), 0.0, list[Pooled]()
        for group in self.groups:
            group.check()
        note(0)
        for group in self.groups:
            n, rows = group.scene.n_surfaces, group.rows

            def go_on(stop: float, before: float = done, work: float = group.work) -> bool:
                return note(before + stop * work)

            blocks = (group.tables(first, min(first + rows, n), go_on) for first in range(0, n, rows))
            pooled.append(group.held(blocks))
            done += n * group.work
        return self.answered(pooled)


def sweep_of(scene: str, axes: str, drawn: Tables) -> Sweep:
    """Return a finished sweep from the words and tables of its file; scenes are made when needed."""
    rows = zip(drawn["points"].tolist(), drawn["points"][:, 1:], drawn["weights"], strict=True)
    places = [(g, some[some >= 0], w[some >= 0]) for (g, *_), some, w in rows]
    return Points.from_texts(scene, axes).answered(pooled_from(drawn), places)


def sweep_plan_text(asked: Points) -> str:
    """Return the plan in words; the group that takes the longest is tried out, of which nothing is kept."""
    groups = asked.groups
    scenes = sum(len(group.computed) for group in groups)
    touching = sum(group.scene.n_surfaces * group.scene.touching for group in groups)
    work = [group.scene.n_surfaces * group.work for group in groups]
    longest = groups[work.index(max(work))]
    started = perf_counter()
    source = shared(longest.computed)
    preparing = (perf_counter() - started) * scenes / len(longest.computed)
    surfaces = longest.scene.n_surfaces * sum(work) / max(work)
    drawing = seconds_per_surface(longest.scene, source) * surfaces
    facts = [
        *((key, asked.axes.summary(key)) for key in asked.axes.keys),
        ("groups", f"{len(groups)} that share their surfaces"),
        (
            "surfaces",
            f"{sum(x.scene.n_surfaces for x in groups)}, with {touching:.4g} asperities that touch",
        ),
        ("computed", f"{scenes} scenes; the others are weighted means of them"),
        ("time", f"about {in_words(preparing + drawing)} on this machine"),
    ]
    title = one_line(str(asked.document["title"])) or "sweep"
    return "\n".join([f"{title}: {asked.axes.size} scenes", *listed(facts)])


def sweep_cautions(sweep: Sweep) -> list[str]:
    """Cautions about all scenes, one line each, the most common first.

    Cautions that differ in their numbers alone are one, with those of the first point that has it.
    """
    found: dict[str, list[tuple[int, str]]] = {}
    for i in range(sweep.axes.size):
        for line in cautions(sweep.scenes[i]):
            found.setdefault(_NUMBER.sub("#", line), []).append((i, line))
    lines = []
    for some in sorted(found.values(), key=len, reverse=True):
        first, line = some[0]
        alike = len({text for _, text in some}) == 1
        where = "" if alike else f" (numbers of {sweep.axes.text(first)})"
        lines.append(f"{len({i for i, _ in some})} of {sweep.axes.size} points: {line}{where}")
    return lines
