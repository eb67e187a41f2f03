"""Count, means and covariances over surfaces: what is kept of them where no values are.

Two are joined by the formulas of Chan, Golub and LeVeque (1979) [mem]. Rounding depends on what is joined
with what, and that is fixed: blocks of a size that the scene decides are added up in their order. So the
bits do not depend on who drew what, and when.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import pairwise
from operator import add
from typing import Any

import numpy as np

from analytic import quantity_of
from analytic.arrays import Array, Ints
from mcgw.ensemble.results import Held, Tables
from mcgw.machine.compiling import njit
from mcgw.machine.threads import in_threads

Values = dict[str, Array]

_MEANS, _PRODUCTS = "_means", "_products"
_RUN = 256  # of a column at a time: those of all columns stay near
_BANDS = 16  # that threads share
NUMBERS = "numbers"  # what all numbers of a surface are called together


@dataclass(frozen=True)
class Pooled:
    """Statistics of some surfaces, of each of which there are several values of each quantity.

    Of a sweep these are the values of its scenes, with covariances between scenes at each separation. Of one
    scene that keeps statistics all its numbers are the values of one quantity, at one place.
    """

    n: int  # number of surfaces
    means: Values  # by quantity, shape (values, separations)
    products: Values  # sums of products of two values' deviations, shape (values, values, separations)

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
    def of_columns(cls, name: str, table: Array) -> "Pooled":
        """From a table (surfaces, columns): its columns are the values of one quantity."""
        first = table[0].astype(np.float64)
        apart = np.ascontiguousarray((table - first).T)
        shift = apart.mean(axis=1, keepdims=True)
        apart -= shift
        return cls(len(table), {name: first[:, None] + shift}, {name: products_of(apart)[..., None]})

    def __add__(self, other: "Pooled") -> "Pooled":
        """Statistics of the surfaces of both."""
        n, means, products = self.n + other.n, {}, {}
        for name, mean in self.means.items():
            step = other.means[name] - mean
            means[name] = mean + step * (other.n / n)
            between = step[:, None] * step[None] * (self.n * (other.n / n))
            products[name] = self.products[name] + other.products[name] + between
        return Pooled(n, means, products)

    def at(self, which: Ints) -> "Pooled":
        """Return the same at some of the separations."""
        means = {name: mean[..., which] for name, mean in self.means.items()}
        return Pooled(self.n, means, {name: x[..., which] for name, x in self.products.items()})

    def mean(self, name: str, which: Ints, weights: Array) -> Array:
        """Mean of a combination of some values, shape (separations,)."""
        means = self.means[name]
        return np.asarray(sum(w * means[i] for i, w in zip(which, weights, strict=True)))

    def variance(self, name: str, which: Ints, weights: Array) -> Array:
        """Variance of a combination over the surfaces (divisor n - 1); nan for one surface."""
        products = self.products[name]
        if self.n == 1:
            return np.full(products.shape[2:], np.nan)
        pairs = list(zip(which, weights, strict=True))
        total = sum(v * w * products[i, j] for i, v in pairs for j, w in pairs)
        return np.asarray(total / (self.n - 1))


def tables_of(parts: Sequence[Pooled]) -> Tables:
    """As tables: n and the number of values of each, then all means and all products, one below the other."""
    sizes = [(one.n, len(next(iter(one.means.values())))) for one in parts]
    tables: Tables = {"n": np.array(sizes, dtype=np.int64)}
    for name in parts[0].means:
        products = [one.products[name] for one in parts]
        tables[name + _MEANS] = np.concatenate([one.means[name] for one in parts])
        tables[name + _PRODUCTS] = np.concatenate([x.reshape(-1, x.shape[-1]) for x in products])
    return tables


def pooled_from(tables: Tables) -> tuple[Pooled, ...]:
    """From what `tables_of` gave."""
    sizes = tables["n"][:, 1]
    names = [name.removesuffix(_MEANS) for name in tables if name.endswith(_MEANS)]
    means = {name: np.split(tables[name + _MEANS], np.cumsum(sizes)[:-1]) for name in names}
    products = {name: np.split(tables[name + _PRODUCTS], np.cumsum(sizes**2)[:-1]) for name in names}
    return tuple(
        Pooled(n, {x: means[x][i] for x in names}, {x: products[x][i].reshape(k, k, -1) for x in names})
        for i, (n, k) in enumerate(tables["n"].tolist())
    )


@njit(cache=True, fastmath={"reassoc", "contract"})
def _sum_products(columns: Any, first: int, stop: int, out: Any) -> None:  # pragma: no cover - compiled
    """Add the products of columns `first` ... `stop - 1` with all up to themselves."""
    rows = columns.shape[1]
    for start in range(0, rows, _RUN):
        end = min(start + _RUN, rows)
        for i in range(first, stop):
            x = columns[i, start:end]
            for j in range(i + 1):
                y, total = columns[j, start:end], 0.0
                for k in range(end - start):
                    total += x[k] * y[k]
                out[i, j] += total


def products_of(columns: Array) -> Array:
    """Return the sums over the rows of products of every two columns, each contiguous.

    A library's matrix product adds in an order that depends on how many threads it has; this one does not.
    """
    width = len(columns)
    out = np.zeros((width, width))
    ends = np.unique((width * np.sqrt(np.linspace(0, 1, _BANDS + 1))).round().astype(int)).tolist()
    bands = list(pairwise(ends))  # every second one: halves of about the same work
    in_threads(lambda band: _sum_products(columns, *band, out), bands[::2] + bands[1::2])
    return out + np.tril(out, -1).T


@dataclass(frozen=True)
class PointResults(Held):
    """Mean and deviation of a point, a weighted mean of computed scenes."""

    pooled: Pooled  # statistics of its group
    scenes: Ints  # computed ones of the group
    weights: Array  # of what the modulus enters; anything else is the same for all of them

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


@dataclass(frozen=True)
class Summarised(Held):
    """Mean, deviation and covariance of all numbers of a surface."""

    names: tuple[str, ...]  # of tables of as many numbers each, one after the other
    parts: tuple[Pooled, ...]  # all whole blocks together, which more may follow, and a last one that is not

    no_more = (
        'single surfaces are not kept with keep = "statistics"; scene.theory.distribution has exact '
        'quantiles, or simulate with keep = "sums"'
    )

    @cached_property
    def whole(self) -> Pooled:
        """All surfaces as one."""
        return reduce(add, self.parts)

    def rows(self) -> int:
        """Return the number of surfaces."""
        return sum(part.n for part in self.parts)

    def at(self, which: Ints) -> "Summarised":
        """Return the same at some of the separations, by their numbers."""
        columns = np.concatenate([self._columns(name)[which] for name in self.names])
        both = np.ix_(columns, columns)
        some = (
            Pooled(one.n, {NUMBERS: one.means[NUMBERS][columns]}, {NUMBERS: one.products[NUMBERS][both]})
            for one in self.parts
        )
        return Summarised(self.names, tuple(some))

    def _columns(self, name: str) -> Ints:
        """Which of the numbers those of a table are, one at each separation."""
        numbers = np.arange(len(self.whole.means[NUMBERS])).reshape(len(self.names), -1)
        return np.asarray(numbers[self.names.index(name)])

    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Mean and standard deviation (divisor M - 1)."""
        mean = self.whole.means[NUMBERS][self._columns(name), 0]
        return mean, np.sqrt(np.diagonal(self.covariance(name, name)))

    def covariance(self, name: str, other: str) -> Array:
        """Between all numbers of two tables (divisor M - 1)."""
        a, b, m = self._columns(name), self._columns(other), self.rows()
        return np.asarray(self.whole.products[NUMBERS][np.ix_(a, b)][..., 0] / (m - 1 if m > 1 else np.nan))
