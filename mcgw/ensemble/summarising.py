"""Surfaces that are drawn for their statistics alone, in as much memory for ten as for a billion."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from time import monotonic
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.bins import Bins
from mcgw.ensemble.drawing import block_size, drawn_blocks, kept
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import joined
from mcgw.ensemble.summarised import Summarised
from mcgw.ensemble.summary import Summary, push, size_of, total
from mcgw.machine.memory import check_memory
from mcgw.sampling.samplers import Sampler
from mcgw.scene.scene import Scene

__all__ = [
    "block_rows",
    "check_width",
    "joined_bytes",
    "simulated",
    "stored_bytes",
    "summary_of",
    "summary_of_values",
]

_ROWS = 2**13  # surfaces whose values lie in memory at once
_BYTES = 2**26  # of these values
_DRAWS = 1e9  # numbers drawn for a block: what an interruption may cost
_MOST = 2**20  # surfaces of a block
_PACKED = 1500  # bytes of what else there is of a column, packed


def block_rows(scene: Scene, sampler: Sampler) -> int:
    """Surfaces of a block: a function of the scene alone, a power of two of `_piece`."""
    rows = _piece(scene, sampler)
    while 2 * rows <= min(_MOST, _DRAWS / (sampler.draws + 1)):
        rows *= 2
    return rows


def _piece(scene: Scene, sampler: Sampler) -> int:
    return max(int(min(_ROWS, _BYTES // (8 * scene.width), _DRAWS / (sampler.draws + 1))), 1)


def summary_of(
    scene: Scene,
    sampler: Sampler,
    bins: Bins,
    first: int,
    stop: int,
    go_on: Callable[[int], bool] = lambda _: True,
) -> Summary:
    """What is kept of one block, or of the beginning of one.

    `go_on` is told the surface after each piece, and says whether to draw the next.
    """
    size, piece, parts = block_size(scene, sampler), _piece(scene, sampler), list[Summary]()
    for start in range(first, stop, piece):
        end = min(start + piece, stop)
        values = joined([kept(scene, block) for block in drawn_blocks(sampler, start, end, size)])
        push(parts, summary_of_values(scene, values, start, bins))
        if not go_on(end):
            break
    return total(parts)


def summary_of_values(scene: Scene, values: Mapping[str, NDArray[Any]], first: int, bins: Bins) -> Summary:
    """What is kept of the tables of surfaces from number `first` on."""
    table = [values[name].reshape(len(values[name]), -1).astype(np.float64) for name in scene.shapes]
    return Summary.of(np.concatenate(table, axis=1), first, bins)


def simulated(
    scene: Scene, sampler: Sampler, until: float | None, tell: Callable[[float, float], object]
) -> Ensemble:
    """The ensemble of a scene in memory, of as many blocks as there is time for."""
    check_width(scene)
    blocks, drawn, rows = list[Summary](), 0, block_rows(scene, sampler)
    bins = Bins.of(scene)

    def go_on(done: int) -> bool:
        tell(done, scene.n_surfaces)
        return until is None or monotonic() < until

    tell(0, scene.n_surfaces)
    while not drawn or (drawn % rows == 0 and drawn < scene.n_surfaces and go_on(drawn)):
        push(blocks, summary_of(scene, sampler, bins, drawn, min(drawn + rows, scene.n_surfaces), go_on))
        drawn = sum(block.n for block in blocks)
    if drawn != scene.n_surfaces:
        scene = replace(scene, n_surfaces=drawn)
    return Ensemble(scene, sampler.name, Summarised(scene, tuple(blocks)))


def stored_bytes(scene: Scene, rows: int) -> int:
    """About what a run of blocks of so many surfaces takes on the disk, until they are joined."""
    return -(-scene.n_surfaces // rows) * _block_bytes(scene)


def joined_bytes(scene: Scene, surfaces: int, rows: int) -> int:
    """About what the file of so many surfaces takes: joined blocks, and the covariance once more."""
    blocks, rest = divmod(surfaces, rows)
    return (blocks.bit_count() + (rest > 0)) * _block_bytes(scene) + 8 * scene.width**2


def _block_bytes(scene: Scene) -> int:
    return 8 * (scene.width * (scene.width + 1) // 2) + _PACKED * scene.width


def check_width(scene: Scene) -> None:
    """Refuse covariances that do not fit the memory.

    Raises
    ------
    StoreError
        With the numbers.
    """
    size = 4 * size_of(scene.width) + 3 * _BYTES
    check_memory(f'ensemble.keep = "statistics": covariances between {scene.width} numbers', size)
