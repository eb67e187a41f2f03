"""Statistics over the surfaces of a scene that keeps no surface, and what draws these.

They take as much memory for ten surfaces as for a billion.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property, reduce
from operator import add

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.ensemble.drawing import GoOn, Values, always
from mcgw.ensemble.pooled import Pooled, pooled_from, tables_of
from mcgw.ensemble.results import Held, Tables
from mcgw.machine.memory import check_memory
from mcgw.scene.scene import Scene

NUMBERS = "numbers"  # what all numbers of a surface are called together


@dataclass(frozen=True)
class Summarised(Held):
    """Mean, deviation and covariance of all numbers of a surface.

    Parameters
    ----------
    scene : Scene
        Whose numbers these are: its tables one after the other.
    parts : tuple of Pooled
        Of all whole blocks together, which more may follow, and of a last one that is not whole.
    """

    scene: Scene
    parts: tuple[Pooled, ...]

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

    def _columns(self, name: str) -> Ints:
        """Which of the numbers those of a table are, one at each separation."""
        k = len(self.scene.separations)
        first = k * self.scene.tables.index(name)
        return np.arange(first, first + k)

    def drawn(self) -> Tables:
        """Return the tables of its parts."""
        return tables_of(self.parts)

    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Mean and standard deviation (divisor M - 1)."""
        mean = self.whole.means[NUMBERS][self._columns(name), 0]
        return mean, np.sqrt(np.diagonal(self.covariance(name, name)))

    def covariance(self, name: str, other: str) -> Array:
        """Between all numbers of two tables (divisor M - 1)."""
        a, b, m = self._columns(name), self._columns(other), self.rows()
        return np.asarray(self.whole.products[NUMBERS][np.ix_(a, b)][..., 0] / (m - 1 if m > 1 else np.nan))


_ROWS = 2**13  # surfaces whose values lie in memory at once
_BYTES = 2**26  # of these values
_DRAWS = 1e9  # numbers drawn for a block: what an interruption may cost
_MOST = 2**20  # surfaces of a block


class Statistics(Values):
    """Count, means and covariances of the numbers of a scene's surfaces."""

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

    def tables(self, first: int, stop: int, go_on: GoOn = always) -> Tables:
        """Return the statistics of a block."""
        parts = list[Pooled]()
        for start in range(first, stop, self._piece):
            end = min(start + self._piece, stop)
            values = super().tables(start, end)
            table = np.concatenate([values[name] for name in self.scene.tables], axis=1)
            parts.append(Pooled.of_columns(NUMBERS, table))
            if not go_on(end):
                break
        return tables_of([reduce(add, parts)])

    def held(self, blocks: Iterable[Tables]) -> Summarised:
        """All of them: whole blocks added up in their order, and the rest."""
        whole, rest = list[Pooled](), list[Pooled]()
        for (block,) in map(pooled_from, blocks):
            if block.n % self.rows:
                rest = [block]
            else:
                whole = [reduce(add, [*whole, block])]
        return Summarised(self.scene, (*whole, *rest))

    def check(self, surfaces: int | None = None) -> None:  # noqa: ARG002
        """Refuse covariances that do not fit the memory."""
        width = self.scene.width
        size = 4 * 8 * width * (width + 1) + 3 * _BYTES
        check_memory(f'ensemble.keep = "statistics": covariances between {width} numbers', size)

    @property
    def disk(self) -> int:  # type: ignore[override]
        """What blocks take, until they are added up, and then their file."""
        return -(-self.n_surfaces // self.rows) * self._block_bytes + self.joined_bytes(self.n_surfaces)

    def joined_bytes(self, surfaces: int) -> int:
        """Return what the file of so many surfaces takes: whole blocks, the rest, and the covariance."""
        parts = (surfaces >= self.rows) + (surfaces % self.rows > 0)
        return parts * self._block_bytes + 8 * self.scene.width**2

    @property
    def _block_bytes(self) -> int:
        width = self.scene.width
        return 8 * width * (width + 1)
