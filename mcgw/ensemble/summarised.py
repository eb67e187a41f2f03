"""Surfaces that are drawn for their statistics alone, in as much memory for ten as for a billion."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from time import monotonic

import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.bins import Bins
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import joined
from mcgw.ensemble.simulation import block_size, drawn_blocks, kept
from mcgw.ensemble.summary import Summary, push, size_of, total
from mcgw.machine.memory import check_memory
from mcgw.sampling.samplers import Sampler
from mcgw.scene.scene import Scene

__all__ = ["Summarised", "block_rows", "check_width", "simulated", "stored_bytes", "summary_of"]

Array = NDArray[np.float64]

_ROWS = 2**13  # surfaces whose values lie in memory at once
_BYTES = 2**26  # of these values
_DRAWS = 1e9  # numbers drawn for a block: what an interruption may cost
_MOST = 2**20  # surfaces of a block
_PACKED = 1500  # bytes of what else there is of a column, packed


@dataclass(frozen=True)
class Summarised:
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

    def rows(self) -> int:
        """Number of surfaces."""
        return sum(block.n for block in self.blocks)

    def read(self, name: str, start: int, stop: int | None) -> Array:  # noqa: ARG002 - as all results have it
        """Refuse: there are no values.

        Raises
        ------
        ValueError
            Always.
        """
        raise ValueError(
            f'{name}: single surfaces are not kept with keep = "statistics"; ask for mean, std, covariance, '
            'skewness, quantile or extremes, or draw some of them again with keep = "sums"'
        )

    @cached_property
    def whole(self) -> Summary:
        """All blocks as one."""
        return total(self.blocks)

    @cached_property
    def bins(self) -> Bins:
        """In which values are counted."""
        return Bins.of(self.scene)

    def columns(self, name: str) -> NDArray[np.int64]:
        """Where the numbers of a table stand, in the shape it has for one surface."""
        start = 0
        for other, shape in self.scene.shapes.items():
            size = int(np.prod(shape))
            if other == name:
                return np.arange(start, start + size).reshape(shape)
            start += size
        raise KeyError(name)


def block_rows(scene: Scene, sampler: Sampler) -> int:
    """Surfaces of a block: a function of the scene alone, a power of two of `_piece`."""
    rows = _piece(scene)
    while 2 * rows <= min(_MOST, _DRAWS / (sampler.draws + 1)):
        rows *= 2
    return rows


def _piece(scene: Scene) -> int:
    return max(min(_ROWS, _BYTES // (8 * scene.width)), 1)


def summary_of(scene: Scene, sampler: Sampler, bins: Bins, first: int, stop: int) -> Summary:
    """What is kept of one block, or of the beginning of one."""
    size, piece, parts = block_size(scene, sampler), _piece(scene), list[Summary]()
    for start in range(first, stop, piece):
        end = min(start + piece, stop)
        values = joined([kept(scene, block) for block in drawn_blocks(sampler, start, end, size)])
        table = [values[name].reshape(end - start, -1).astype(np.float64) for name in scene.shapes]
        push(parts, Summary.of(np.concatenate(table, axis=1), start, bins))
    return total(parts)


def simulated(
    scene: Scene, sampler: Sampler, until: float | None, tell: Callable[[float, float], object]
) -> Ensemble:
    """The ensemble of a scene in memory, of as many blocks as there is time for."""
    check_width(scene)
    blocks, drawn, rows = list[Summary](), 0, block_rows(scene, sampler)
    bins = Bins.of(scene)
    tell(0, scene.n_surfaces)
    while drawn < scene.n_surfaces and (not drawn or until is None or monotonic() < until):
        push(blocks, summary_of(scene, sampler, bins, drawn, min(drawn + rows, scene.n_surfaces)))
        drawn = sum(block.n for block in blocks)
        tell(drawn, scene.n_surfaces)
    if drawn != scene.n_surfaces:
        scene = replace(scene, n_surfaces=drawn)
    return Ensemble(scene, sampler.name, Summarised(scene, tuple(blocks)))


def stored_bytes(scene: Scene, rows: int) -> int:
    """About what a run of blocks of so many surfaces takes on the disk, until they are joined."""
    pairs = scene.width * (scene.width + 1) // 2
    return -(-scene.n_surfaces // rows) * (8 * pairs + _PACKED * scene.width)


def check_width(scene: Scene) -> None:
    """Refuse covariances that do not fit the memory.

    Raises
    ------
    StoreError
        With the numbers.
    """
    size = 4 * size_of(scene.width) + 3 * 8 * scene.width * _piece(scene)
    check_memory(f'ensemble.keep = "statistics": covariances between {scene.width} numbers', size)
