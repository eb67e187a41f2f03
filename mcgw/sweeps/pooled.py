"""Means, variances and covariances over surfaces of several scenes that share these."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array, Ints
from mcgw.ensemble.summary import ROW, Summary, push, total
from mcgw.store.shards import BLOCK

Values = dict[str, Array]
Blocks = tuple[tuple[Summary, ...], ...]

_MEANS, _PRODUCTS, _OF_EACH = "_means", "_products", "summary_"


@dataclass(frozen=True)
class Pooled:
    """What is kept of some surfaces.

    Parameters
    ----------
    n : int
        How many.
    means : dict of str to ndarray
        Of each quantity, shape (scenes, separations).
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
        """Of the values of some surfaces: for each scene arrays (surfaces, separations).

        Shifted by the first surface, so that nothing cancels; of one scene the same bits as an ensemble's.
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
        """What `tables` gave."""
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

    @classmethod
    def from_shard(cls, tables: Mapping[str, NDArray[Any]]) -> "Pooled":
        """What `shard` gave."""
        return cls.from_tables({name.removeprefix(BLOCK): table[0] for name, table in tables.items()})

    def shard(self) -> dict[str, NDArray[Any]]:
        """As tables of one row for the whole block."""
        return {BLOCK + name: table[None] for name, table in self.tables().items()}

    def __add__(self, other: "Pooled") -> "Pooled":
        """Of the surfaces of both."""
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
