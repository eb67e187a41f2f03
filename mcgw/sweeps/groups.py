"""Groups of points that share their surfaces, the points whose sums are computed, and how these are drawn.

Exponential gradings as combinations of two: under Hertz's law every sum is linear in the modulus.

``E*(s)/E* = gamma - (gamma - 1) exp(-s)`` is linear in gamma (a homogeneous surface has gamma = 1). So every
grading lies between the softest and the stiffest of a sweep: its load on a surface is the same weighted mean
of their loads there, and over the surfaces its mean and variance follow from their means, variances and
covariance. A thousand more gradings cost no product with the surfaces. Weights from 0 to 1 and moduli that
are not negative let nothing cancel: the last digits are those of the two.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields
from functools import lru_cache, reduce
from operator import add
from typing import Any

import numpy as np

from analytic import Exponential, Homogeneous, quantity_of
from analytic.arrays import Array, Ints
from mcgw.ensemble.drawing import GoOn, Values, always, block_size, drawn_blocks, kept
from mcgw.ensemble.pooled import Pooled, pooled_from, tables_of
from mcgw.ensemble.results import Held, Tables, joined
from mcgw.machine.memory import check_memory
from mcgw.machine.progress import steps
from mcgw.sampling.shared import Shared, common_edges, shared, to_be_shared
from mcgw.scene.scene import Scene

_MANY = 8  # gradings; fewer are computed one by one, with the same bits as alone


Place = tuple[int, Ints, Array]  # of a point: number of its group, which computed scenes of it, their weights


@dataclass(frozen=True)
class PointResults(Held):
    """Mean and deviation of a point, a weighted mean of computed scenes.

    Parameters
    ----------
    pooled : Pooled
        Statistics of its group.
    scenes : ndarray of int
        Computed scenes of the group.
    weights : ndarray
        Of what the modulus enters; anything else is the same for all of them.
    """

    pooled: Pooled
    scenes: Ints
    weights: Array

    no_more = (
        "a sweep only keeps mean and standard deviation of a point; simulate(sweep.scene(point)) draws "
        "surfaces of that scene"
    )

    def rows(self) -> int:
        """Return the number of surfaces."""
        return self.pooled.n

    def at(self, which: Ints) -> "PointResults":
        """Return the same at some of the separations, by their numbers."""
        return PointResults(self.pooled.at(which), self.scenes, self.weights)

    def of(self, quantity: str) -> tuple[Ints, Array]:
        """Scenes and weights for one quantity."""
        if len(self.scenes) == 1 or quantity_of(quantity).modulus:
            return self.scenes, self.weights
        return self.scenes[:1], np.ones(1)

    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Mean and standard deviation (divisor M - 1)."""
        some = self.of(name)
        return self.pooled.mean(name, *some), np.sqrt(self.pooled.variance(name, *some))


_ROWS = 8192  # surfaces whose values are pooled at once, as an ensemble does
_BYTES = 2**28  # bytes of those values
_DRAWS = 1e10  # asperities per block: the cost of an interruption
_ANSWER = 3000  # cost of one scene per surface, in asperities drawn


class Group(Values):
    """Points that share their surfaces: their means, variances and covariances.

    Parameters
    ----------
    computed : tuple of Scene
        Those whose sums are computed for every surface.
    edges : tuple of float
        Common edges of cells, where the cells of the scenes would differ (`common_edges`).
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

    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """Return the statistics of a block."""
        source = _source_of(self)
        blocks = list(drawn_blocks(source, first, stop, block_size(self.scene, source)))
        values = [joined([kept(x, block[i]) for block in blocks]) for i, x in enumerate(self.computed)]
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

    Returns
    -------
    (sequence of int, list of (ndarray, ndarray))
        Those of which all are means: two; or all, if they are few, a grading is no exponential one, or sums
        are not linear in it. For each scene which of them it is made of, and their weights.
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
