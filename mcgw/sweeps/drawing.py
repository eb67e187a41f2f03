"""The surfaces of a group of points: drawn once, and what is kept of what they answer."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.results import joined
from mcgw.ensemble.simulation import block_size, drawn_blocks, kept
from mcgw.machine.memory import check_memory
from mcgw.sampling.shared import shared
from mcgw.scene.scene import Scene
from mcgw.sweeps.groups import Group, Mixture
from mcgw.sweeps.pooled import Pooled

__all__ = ["Drawn", "drawn"]

Array = NDArray[np.float64]

_ROWS = 8192  # surfaces whose values are pooled at once, as an ensemble does
_BYTES = 2**28  # of those values


@dataclass(frozen=True)
class Drawn:
    """What is kept of a group.

    Parameters
    ----------
    pooled : Pooled
        Of the points that are computed.
    mixtures : tuple of Mixture
        All points of the group.
    """

    pooled: Pooled
    mixtures: tuple[Mixture, ...]

    def mean(self, point: int, quantity: str) -> Array:
        """Mean over the surfaces, shape (separations,)."""
        return self.pooled.mean(quantity, *self.mixtures[point].of(quantity))

    def variance(self, point: int, quantity: str) -> Array:
        """Variance over the surfaces; nan for a single surface."""
        return self.pooled.variance(quantity, *self.mixtures[point].of(quantity))

    def variance_of_difference(
        self, points: tuple[int, int], quantity: str, areas: tuple[float, float]
    ) -> Array:
        """Variance of one point less another, each per an area: of one combination, so nothing cancels."""
        (one, v), (other, w) = (self.mixtures[i].of(quantity) for i in points)
        weights = np.zeros(int(max(one.max(), other.max())) + 1)
        weights[one] += v / areas[0]
        weights[other] -= w / areas[1]
        scenes = np.unique(np.concatenate([one, other]))
        return np.maximum(self.pooled.variance(quantity, scenes, weights[scenes]), 0.0)  # but for rounding


def drawn(group: Group, tell: Callable[[int], None]) -> Drawn:
    """Draw the surfaces of a group.

    Parameters
    ----------
    group : Group
        Points that share them.
    tell : callable
        Told how many surfaces have been drawn.

    Raises
    ------
    StoreError
        If the memory is too small.
    """
    scenes = [group.scenes[i] for i in group.computed]
    _check_memory(scenes)
    source = shared(scenes)
    total, size = scenes[0].n_surfaces, block_size(scenes[0], source)
    rows = max(min(_ROWS, _BYTES // (8 * sum(scene.width for scene in scenes))), 1)
    pooled = None
    for first in range(0, total, rows):
        blocks = list(drawn_blocks(source, first, min(first + rows, total), size))
        values = [joined([kept(scene, block[i]) for block in blocks]) for i, scene in enumerate(scenes)]
        some = Pooled.of(values)
        pooled = some if pooled is None else pooled + some
        tell(pooled.n)
    assert pooled is not None
    return Drawn(pooled, group.mixtures)


def _check_memory(scenes: list[Scene]) -> None:
    check_memory(
        f"sweep: covariances between {len(scenes)} points at {len(scenes[0].separations)} separations",
        8 * scenes[0].width * len(scenes) ** 2,
    )
