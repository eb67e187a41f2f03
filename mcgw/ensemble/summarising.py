"""Surfaces that are drawn for their statistics alone, in as much memory for ten as for a billion."""

from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.bins import Bins
from mcgw.ensemble.drawing import GoOn, OfScene, always, block_size, drawn_blocks, kept
from mcgw.ensemble.results import Tables, joined
from mcgw.ensemble.summarised import Summarised
from mcgw.ensemble.summary import Summary, push, size_of, total
from mcgw.machine.memory import check_memory
from mcgw.scene.scene import Scene

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
