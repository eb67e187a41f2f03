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
from typing import Any, TypeVar

import numpy as np

from analytic import Exponential, Homogeneous, quantity_of
from analytic.arrays import Array, Ints
from mcgw.ensemble.drawing import GoOn, Reducer, always, block_size, drawn, drawn_blocks, kept
from mcgw.ensemble.pooled import Pooled, pooled_from, tables_of
from mcgw.ensemble.results import Held, Tables, joined
from mcgw.machine.memory import check_memory
from mcgw.machine.progress import steps
from mcgw.sampling.shared import Shared, common_edges, shared, to_be_shared
from mcgw.scene.scene import Scene

_Item = TypeVar("_Item")
_MANY = 8  # gradings; fewer are computed one by one, with the same bits as alone


@dataclass(frozen=True)
class Place:
    """Statistics of a point as a weighted mean of computed scenes.

    Parameters
    ----------
    group : int
        Number of the group.
    scenes : ndarray of int
        Computed scenes of the group.
    weights : ndarray
        Of what the modulus enters; anything else is the same for all of them.
    """

    group: int
    scenes: Ints
    weights: Array

    def of(self, quantity: str) -> tuple[Ints, Array]:
        """For one quantity."""
        if len(self.scenes) == 1 or quantity_of(quantity).modulus:
            return self.scenes, self.weights
        return self.scenes[:1], np.ones(1)


@dataclass(frozen=True)
class PointResults(Held):
    """Mean and deviation of a point, a weighted mean of what is pooled.

    Parameters
    ----------
    pooled : Pooled
        Statistics of its group.
    place : Place
        Its place in the group.
    """

    pooled: Pooled
    place: Place

    no_more = (
        "a sweep only keeps mean and standard deviation of a point; simulate(sweep.scene(point)) draws "
        "surfaces of that scene"
    )

    def rows(self) -> int:
        """Return the number of surfaces."""
        return self.pooled.n

    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Mean and standard deviation (divisor M - 1)."""
        some = self.place.of(name)
        return self.pooled.mean(name, *some), np.sqrt(self.pooled.variance(name, *some))


@dataclass(frozen=True)
class Group:
    """Points that share their surfaces.

    Parameters
    ----------
    numbers : tuple of int
        Which points of the sweep.
    scenes : tuple of Scene
        Their scenes.
    computed : tuple of Scene
        Those whose sums are computed for every surface.
    places : tuple of Place
        Places of all points.
    edges : tuple of float
        Common edges of cells, where the cells of the scenes would differ (`common_edges`).
    """

    numbers: tuple[int, ...]
    scenes: tuple[Scene, ...]
    computed: tuple[Scene, ...]
    places: tuple[Place, ...]
    edges: tuple[float, ...]

    @property
    def n_surfaces(self) -> int:
        """Number of shared surfaces."""
        return self.scenes[0].n_surfaces


def groups_of(scenes: Sequence[Scene]) -> list[Group]:
    """Group the scenes of a sweep."""
    keys = [to_be_shared(scene) for scene in steps(scenes, "points")]
    together = _alike(range(len(scenes)), lambda i: (i,) if keys[i] is None else keys[i])
    return [_group(g, members, [scenes[i] for i in members]) for g, members in enumerate(together)]


def _group(group: int, numbers: list[int], scenes: list[Scene]) -> Group:
    edges = common_edges(scenes) if len(scenes) > 1 else ()
    if edges is None:
        scenes, edges = [scene.replace(sampler="tail") for scene in scenes], ()
    computed: list[int] = []
    places: dict[int, Place] = {}
    for members in _alike(
        range(len(scenes)),
        lambda i: [
            getattr(scenes[i], f.name) for f in fields(scenes[i]) if f.name not in ("grading", "title")
        ],
    ):
        first, one = len(computed), np.ones(1)
        if (found := between_two([scenes[i] for i in members])) is None:
            computed += members
            places |= {i: Place(group, np.array([first + k]), one) for k, i in enumerate(members)}
            continue
        two, weights = found
        computed += [members[k] for k in two]
        for i, pair in zip(members, weights, strict=True):
            some = np.flatnonzero(pair)  # drop those with zero weight
            places[i] = Place(group, first + some, pair[some])
    in_order = tuple(places[i] for i in range(len(scenes)))
    return Group(tuple(numbers), tuple(scenes), tuple(scenes[i] for i in computed), in_order, edges)


def _alike(items: Sequence[_Item], key: Callable[[_Item], Any]) -> list[list[_Item]]:
    """Group items with equal keys, which need not be hashable."""
    keys: list[Any] = []
    found: list[list[_Item]] = []
    for item in items:
        this = key(item)
        at = next((i for i in range(len(keys) - 1, -1, -1) if keys[i] == this), None)
        if at is None:
            keys.append(this)
            found.append([item])
        else:
            found[at].append(item)
    return found


def between_two(scenes: Sequence[Scene]) -> tuple[tuple[int, int], Array] | None:
    """Scenes that differ in their gradings alone, as weighted means of two of them.

    Returns
    -------
    ((int, int), ndarray) or None
        The two, and the weights of each scene on them, shape (scenes, 2). None if there are few scenes, a
        grading is no exponential one, or sums are not linear in it.
    """
    one = scenes[0]
    # All that is kept must be linear in a modulus that is not negative.
    linear = one.hertzian and one.interaction is None and one.negative == "error"
    gammas = [
        x.grading.gamma if isinstance(x.grading, Exponential) else 1.0 if x.grading == Homogeneous() else None
        for x in scenes
    ]
    if len(set(gammas)) < _MANY or None in gammas or not linear:
        return None
    x = np.array(gammas, dtype=np.float64)
    low, high = int(np.argmin(x)), int(np.argmax(x))
    share = (x - x[low]) / (x[high] - x[low])
    return (low, high), np.column_stack([1 - share, share])


_ROWS = 8192  # surfaces whose values are pooled at once, as an ensemble does
_BYTES = 2**28  # bytes of those values
_DRAWS = 1e10  # asperities per block: the cost of an interruption
_ANSWER = 3000  # cost of one scene per surface, in asperities drawn


@dataclass(frozen=True, eq=False)
class Pooling(Reducer):
    """Means, variances and covariances of the points of a sweep that share their surfaces."""

    group: Group

    @property
    def n_surfaces(self) -> int:
        """Number of shared surfaces."""
        return self.group.n_surfaces

    @property
    def rows(self) -> int:
        """Surfaces per block."""
        width = sum(scene.width for scene in self.group.computed)
        return max(min(_ROWS, _BYTES // (8 * width), int(_DRAWS / (self.group.scenes[0].touching + 1))), 1)

    @property
    def work(self) -> float:  # type: ignore[override]
        """Cost of a surface, in asperities drawn."""
        return self.group.scenes[0].touching + _ANSWER * len(self.group.computed)

    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """Return the statistics of a block."""
        scenes, source = self.group.computed, _source_of(self)
        blocks = list(drawn_blocks(source, first, stop, block_size(scenes[0], source)))
        values = [joined([kept(scene, block[i]) for block in blocks]) for i, scene in enumerate(scenes)]
        go_on(stop)
        return tables_of([Pooled.of(values)])

    def held(self, blocks: Iterable[Tables]) -> Pooled:
        """Return the sum of all blocks."""
        return reduce(add, (pooled_from(block)[0] for block in blocks))

    def check(self, surfaces: int | None = None) -> None:  # noqa: ARG002
        """Refuse covariances that the memory cannot hold."""
        scenes = self.group.computed
        check_memory(
            f"sweep: covariances between {len(scenes)} points at {len(scenes[0].separations)} separations",
            2 * 8 * scenes[0].width * len(scenes) ** 2,
        )


@lru_cache(maxsize=1)  # blocks come in the order of groups
def _source_of(pooling: Pooling) -> Shared:
    return shared(pooling.group.computed, pooling.group.edges)


def weighted(
    reducers: Iterable[Reducer], tell: Callable[[float, float], object]
) -> Callable[[float], object]:
    """Convert work done to (done, total) surfaces, weighted by their cost."""
    each = [(one.n_surfaces, one.n_surfaces * one.work) for one in reducers]
    surfaces, work = map(sum, zip(*each, strict=True))
    return lambda done: tell(round(surfaces * done / work), surfaces)


def draw(groups: Iterable[Group], tell: Callable[[float, float], object]) -> list[Pooled]:
    """Draw all groups in memory and return their statistics.

    Raises
    ------
    StoreError
        If the memory is too small.
    """
    poolings = list(map(Pooling, groups))
    for one in poolings:
        one.check()
    note = weighted(poolings, tell)

    def go_on(done: float) -> bool:
        note(done)
        return True

    go_on(0)
    return drawn(poolings, go_on)
