"""Means, variances and covariances of scenes that share their surfaces, drawn block by block."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, reduce
from operator import add
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array, Ints
from mcgw.ensemble.drawing import GoOn, Reducer, always, block_size, drawn, drawn_blocks, kept
from mcgw.ensemble.results import Tables, joined
from mcgw.ensemble.summary import ROW, Summary, push, size_of, total
from mcgw.machine.memory import check_memory
from mcgw.sampling.shared import Shared, shared
from mcgw.store.shards import BLOCK
from mcgw.sweeps.groups import Group

Values = dict[str, Array]
Blocks = tuple[tuple[Summary, ...], ...]

_MEANS, _PRODUCTS, _OF_EACH = "_means", "_products", "summary_"


@dataclass(frozen=True)
class Pooled:
    """Statistics of some surfaces.

    Parameters
    ----------
    n : int
        Number of surfaces.
    means : dict of str to ndarray
        Means of each quantity, shape (scenes, separations).
    products : dict of str to ndarray
        Sums over the surfaces of products of two scenes' deviations from their means, shape (scenes, scenes,
        separations).
    blocks : tuple of tuple of Summary
        Of each scene joined blocks as `mcgw.ensemble.summary.push` leaves them; none, unless the scenes keep
        statistics.
    """

    n: int
    means: Values
    products: Values
    blocks: Blocks = ()

    @classmethod
    def of(cls, values: Sequence[Values]) -> "Pooled":
        """From values of some surfaces: for each scene arrays (surfaces, separations).

        Shifted by the first surface against cancellation; for one scene the same bits as an ensemble.
        """
        means, products = {}, {}
        for name in values[0]:
            rows = [one[name].astype(np.float64) for one in values]
            means[name] = np.stack([(x - x[0]).sum(axis=0) / len(x) + x[0] for x in rows])
            apart = [x - mean for x, mean in zip(rows, means[name], strict=True)]
            products[name] = np.empty((len(rows), *means[name].shape))
            for i, x in enumerate(apart):
                for j in range(i + 1):
                    products[name][i, j] = products[name][j, i] = (x * apart[j]).sum(axis=0)
        return cls(len(next(iter(values[0].values()))), means, products)

    @classmethod
    def from_tables(cls, tables: Mapping[str, NDArray[Any]]) -> "Pooled":
        """From what `tables` gave."""
        means = {k.removesuffix(_MEANS): v for k, v in tables.items() if k.endswith(_MEANS)}
        products = {
            name: tables[name + _PRODUCTS].reshape(len(mean), *mean.shape) for name, mean in means.items()
        }
        rows = {ROW + k.removeprefix(_OF_EACH): v for k, v in tables.items() if k.startswith(_OF_EACH)}
        scenes = range(len(rows[ROW + "n"]) if rows else 0)
        return cls(
            int(tables["n"][0]), means, products, tuple((Summary.from_tables(rows, i),) for i in scenes)
        )

    def tables(self) -> dict[str, NDArray[Any]]:
        """As arrays: n, means (scenes, ...), products (scenes^2, ...), and the summaries of all scenes."""
        tables: dict[str, NDArray[Any]] = {"n": np.array([self.n])}
        for name, mean in self.means.items():
            tables[name + _MEANS] = mean
            tables[name + _PRODUCTS] = self.products[name].reshape(len(mean) ** 2, *mean.shape[1:])
        rows = [total(blocks).tables() for blocks in self.blocks]
        for name in rows[0] if rows else ():
            tables[_OF_EACH + name.removeprefix(ROW)] = np.concatenate([row[name] for row in rows])
        return tables

    def __add__(self, other: "Pooled") -> "Pooled":
        """Statistics of the surfaces of both."""
        n, means, products = self.n + other.n, {}, {}
        for name, mean in self.means.items():
            step = other.means[name] - mean
            means[name] = mean + step * (other.n / n)
            between = step[:, None] * step[None] * (self.n * (other.n / n))
            products[name] = self.products[name] + other.products[name] + between
        blocks = [list(before) for before in self.blocks]
        for before, new in zip(blocks, other.blocks, strict=True):
            for block in new:
                push(before, block)
        return Pooled(n, means, products, tuple(map(tuple, blocks)))

    def mean(self, name: str, scenes: Ints, weights: Array) -> Array:
        """Mean of a combination of some scenes, shape (separations,)."""
        means = self.means[name]
        return np.asarray(sum(w * means[i] for i, w in zip(scenes, weights, strict=True)))

    def variance(self, name: str, scenes: Ints, weights: Array) -> Array:
        """Variance of a combination over the surfaces (divisor n - 1); nan for one surface."""
        products = self.products[name]
        if self.n == 1:
            return np.full(products.shape[2:], np.nan)
        pairs = list(zip(scenes, weights, strict=True))
        total = sum(v * w * products[i, j] for i, v in pairs for j, w in pairs)
        return np.asarray(total / (self.n - 1))


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
        return max(min(_ROWS, _BYTES // (8 * width), int(_DRAWS / (self._touching + 1))), 1)

    @property
    def work(self) -> float:  # type: ignore[override]
        """Cost of a surface, in asperities drawn."""
        return self._touching + _ANSWER * len(self.group.computed)

    @property
    def _touching(self) -> float:
        return self.group.scenes[0].touching

    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """Statistics of a block, as `Pooled` stores them."""
        scenes, source = self.group.computed, _source_of(self)
        blocks = list(drawn_blocks(source, first, stop, block_size(scenes[0], source)))
        values = [joined([kept(scene, block[i]) for block in blocks]) for i, scene in enumerate(scenes)]
        pooled = Pooled.of(values)
        if scenes[0].keep == "statistics":
            from mcgw.ensemble.summarised import summary_of_values  # for those scenes alone

            each = zip(scenes, values, self.group.bins, strict=True)
            blocks_of_each = tuple((summary_of_values(*one[:2], first, one[2]),) for one in each)
            pooled = replace(pooled, blocks=blocks_of_each)
        go_on(stop)
        return {BLOCK + name: table[None] for name, table in pooled.tables().items()}  # rows of whole blocks

    def held(self, blocks: Iterable[Tables]) -> Pooled:
        """The sum of all blocks."""
        plain = ({name.removeprefix(BLOCK): table[0] for name, table in block.items()} for block in blocks)
        return reduce(add, map(Pooled.from_tables, plain))

    def check(self, surfaces: int | None = None) -> None:  # noqa: ARG002
        """Refuse covariances that the memory cannot hold."""
        scenes = self.group.computed
        check_memory(
            f"sweep: covariances between {len(scenes)} points at {len(scenes[0].separations)} separations",
            2 * 8 * scenes[0].width * len(scenes) ** 2,
        )
        if scenes[0].keep == "statistics":
            what = f'ensemble.keep = "statistics": {len(scenes)} points of {scenes[0].width} numbers'
            check_memory(what, 4 * len(scenes) * size_of(scenes[0].width))


@lru_cache(maxsize=1)  # blocks come in the order of groups
def _source_of(pooling: Pooling) -> Shared:
    return shared(pooling.group.computed)


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
    poolings, before, found = list(map(Pooling, groups)), 0.0, []
    for one in poolings:
        one.check()
    note = weighted(poolings, tell)
    note(0)
    for one in poolings:

        def go_on(done: int, one: Pooling = one, before: float = before) -> bool:
            note(before + done * one.work)
            return True

        found.append(drawn(one, go_on))
        before += one.n_surfaces * one.work
    return found
