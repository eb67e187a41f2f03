"""Statistics over the surfaces of a scene that keeps no surface, and what draws these.

They take as much memory for ten surfaces as for a billion.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from analytic.arrays import Array, Ints
from mcgw.ensemble.drawing import GoOn, OfScene, always, block_size, drawn_blocks, kept
from mcgw.ensemble.results import Held, Tables, joined
from mcgw.ensemble.summary import Bins, Summary, push, size_of, total
from mcgw.machine.memory import check_memory
from mcgw.scene.scene import Scene


@dataclass(frozen=True)
class Summarised(Held):
    """The numbers of an ensemble of which no values are kept.

    Parameters
    ----------
    scene : Scene
        Whose columns these are.
    blocks : tuple of Summary
        Joined blocks as `push` leaves them.
    """

    scene: Scene
    blocks: tuple[Summary, ...]

    no_more = (
        'single surfaces are not kept with keep = "statistics"; use mean, std, covariance, skewness, '
        'quantile or extremes, or simulate with keep = "sums"'
    )

    @classmethod
    def of(cls, scene: Scene, blocks: Iterable[Summary]) -> "Summarised":
        """Of blocks that follow each other."""
        found: list[Summary] = []
        for block in blocks:
            push(found, block)
        return cls(scene, tuple(found))

    def rows(self) -> int:
        """Number of surfaces."""
        return sum(block.n for block in self.blocks)

    @cached_property
    def whole(self) -> Summary:
        """All blocks as one."""
        return total(self.blocks)

    @cached_property
    def _bins(self) -> Bins:
        """In which values are counted."""
        return Bins.of(self.scene)

    def _columns(self, name: str) -> Ints:
        """Where the numbers of a table stand, in the shape it has for one surface."""
        start = 0
        for other, shape in self.scene.shapes.items():
            size = int(np.prod(shape))
            if other == name:
                return np.arange(start, start + size).reshape(shape)
            start += size
        raise KeyError(name)

    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Mean and standard deviation (divisor M - 1)."""
        columns, m = self._columns(name), self.rows()
        mean, squares = self.whole.mean[columns], self.whole.squares[columns]
        return mean, np.sqrt(squares / (m - 1)) if m > 1 else np.full(mean.shape, np.nan)

    def total_number(self, name: str) -> Array:
        """The mean times the number of surfaces, as a whole number."""
        return np.rint(self.whole.mean[self._columns(name)] * self.whole.n)

    def covariance(self, name: str, other: str) -> Array:
        """From the products of deviations of every two columns."""
        a, b = self._columns(name), self._columns(other)
        if self.rows() == 1:
            return np.full(a.shape + b.shape, np.nan)
        i, j = np.meshgrid(a.ravel(), b.ravel(), indexing="ij")
        i, j = np.maximum(i, j), np.minimum(i, j)
        found = self.whole.products[i * (i + 1) // 2 + j] / (self.rows() - 1)
        return np.asarray(found).reshape(a.shape + b.shape)

    def skewness(self, name: str) -> Array:
        """From the sums of the cubes of deviations."""
        squares, cubes = (x[self._columns(name)] for x in (self.whole.squares, self.whole.cubes))
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(cubes * np.sqrt(self.rows()) / squares**1.5)

    def extremes(self, name: str) -> tuple[Array, Array, Ints, Ints]:
        """Least and greatest value, and the first surfaces that have them."""
        columns = self._columns(name)
        (low, high), (at_low, at_high) = self.whole.extremes, self.whole.at
        return low[columns], high[columns], at_low[columns], at_high[columns]

    def quantile(self, name: str, share: float) -> tuple[Array, Array, Array]:
        """By even spacing in the bins that hold the two values next to it."""
        columns = self._columns(name)
        place = share * (self.whole.n - 1)
        ranks = (int(k) for k in (np.floor(place), np.ceil(place)))
        below, above = (self._in_order(name, columns.ravel(), k) for k in ranks)
        part = place - np.floor(place)
        found = ((1 - part) * x + part * y for x, y in zip(below, above, strict=True))
        value, low, high = (x.reshape(columns.shape) for x in found)
        return value, low, high

    def _in_order(self, name: str, columns: Ints, k: int) -> tuple[Array, Array, Array]:
        """The value with `k` others below it, by even spacing in its bin, and the ends of that."""
        whole, whole_numbers = self.whole, quantity_of(name).counts
        upto = np.cumsum(whole.counts[columns], axis=1)
        bins = (upto <= k).sum(axis=1)
        row = np.arange(len(columns))
        inside = whole.counts[columns][row, bins]
        before = upto[row, bins] - inside
        ends = self._bins.ends(columns, bins, whole=whole_numbers)
        least, most = whole.extremes[:, columns]
        low, high = np.maximum(ends[0], least), np.minimum(ends[1], most)
        value = low + (high - low) * ((k - before + 0.5) / inside)
        value = np.rint(value) if whole_numbers else value
        for end, at in ((least, 0), (most, whole.n - 1)):
            if k == at:  # it is known
                value, low, high = end, end, end
        return value, low, high


_ROWS = 2**13  # surfaces whose values lie in memory at once
_BYTES = 2**26  # of these values
_DRAWS = 1e9  # numbers drawn for a block: what an interruption may cost
_MOST = 2**20  # surfaces of a block
_PACKED = 1500  # bytes of what else there is of a column, packed


class Statistics(OfScene):
    """What `mcgw.ensemble.summary` keeps of the surfaces of a scene."""

    @cached_property
    def rows(self) -> int:
        """Surfaces of a block: a power of two of pieces."""
        rows = self._piece
        while 2 * rows <= min(_MOST, _DRAWS / (self.sampler.draws + 1)):
            rows *= 2
        return rows

    @property
    def _piece(self) -> int:
        most = _DRAWS / (self.sampler.draws + 1)
        return max(int(min(_ROWS, _BYTES // (8 * self.scene.width), most)), 1)

    @cached_property
    def _bins(self) -> Bins:
        return Bins.of(self.scene)

    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """The summary of a block, as tables of one row."""
        size, piece, parts = block_size(self.scene, self.sampler), self._piece, list[Summary]()
        for start in range(first, stop, piece):
            end = min(start + piece, stop)
            blocks = drawn_blocks(self.sampler, start, end, size)
            values = joined([kept(self.scene, block) for block in blocks])
            push(parts, summary_of_values(self.scene, values, start, self._bins))
            if not go_on(end):
                break
        return total(parts).tables()

    def held(self, blocks: Iterable[Tables]) -> Summarised:
        """All of them, joined."""
        return Summarised.of(self.scene, map(Summary.from_tables, blocks))

    def check(self, surfaces: int | None = None) -> None:  # noqa: ARG002
        """Refuse covariances that do not fit the memory."""
        width = self.scene.width
        size = 4 * size_of(width) + 3 * _BYTES
        check_memory(f'ensemble.keep = "statistics": covariances between {width} numbers', size)

    @property
    def disk(self) -> int:  # type: ignore[override]
        """About what blocks take, until they are joined."""
        return -(-self.n_surfaces // self.rows) * self._block_bytes

    def joined_bytes(self, surfaces: int) -> int:
        """About what the file of so many surfaces takes: joined blocks, and the covariance once more."""
        blocks, rest = divmod(surfaces, self.rows)
        return (blocks.bit_count() + (rest > 0)) * self._block_bytes + 8 * self.scene.width**2

    @property
    def _block_bytes(self) -> int:
        width = self.scene.width
        return 8 * (width * (width + 1) // 2) + _PACKED * width


def summary_of_values(scene: Scene, values: Mapping[str, NDArray[Any]], first: int, bins: Bins) -> Summary:
    """What is kept of the tables of surfaces from number `first` on."""
    table = [values[name].reshape(len(values[name]), -1).astype(np.float64) for name in scene.shapes]
    return Summary.of(np.concatenate(table, axis=1), first, bins)
