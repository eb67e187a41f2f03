"""Scenes of the same surfaces: each surface is drawn once and answers all of them.

Where a height lies in its cell is drawn without a look at gradings or contact laws. So scenes whose heights
have the same law, number, seed and cells have the same surfaces, and each has the bits that it has alone.
Where their own cells differ, all take the edges of all.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from analytic import Exponential, Homogeneous, MeasuredRadii, quantity_of
from mcgw.sampling.block import Sampler, Sums
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.counted import Counted
from mcgw.sampling.expected import name_of
from mcgw.sampling.moments import Layout
from mcgw.sampling.response.walk import UnresolvedError
from mcgw.sampling.samplers import cells_of, sampler_of, tail_of
from mcgw.scene.scene import Scene


@dataclass(frozen=True)
class Shared:
    """Scenes of the same surfaces on the same cells."""

    scenes: tuple[Sampler, ...]  # each alone: a `Counted` one, but where there is no other

    @property
    def _counted(self) -> tuple[Counted, ...]:
        return cast(tuple[Counted, ...], self.scenes)

    @cached_property
    def layout(self) -> Layout:
        """Moments that one of them needs."""
        return Layout.covering([one.response.layout for one in self._counted])

    @cached_property
    def _answering(self) -> tuple[Counted, ...]:
        """All of them, out of the moments of all."""
        return tuple(replace(one, response=one.response.out_of(self.layout)) for one in self._counted)

    @property
    def words(self) -> int:
        """Numbers in memory for a surface, besides the results of one scene."""
        more = sum(one.scene.width for one in self.scenes[1:])
        return max(one.words for one in self.scenes) + more

    @property
    def draws(self) -> float:
        """Numbers that are expected to be drawn for a surface."""
        return self.scenes[0].draws

    def block(self, first: int, n: int) -> tuple[Sums, ...]:
        """Return what surfaces `first` ... `first + n - 1` answer to each scene."""
        if len(self.scenes) == 1:
            return (self.scenes[0].block(first, n),)
        drawn = self._counted[0].drawn(first, n, self.layout)
        return tuple(one.sums(first, *drawn) for one in self._answering)


def to_be_shared(scene: Scene) -> tuple[Any, ...] | None:
    """Return what other scenes must agree in to have the same surfaces; None if it shares them with none.

    Crowds depend on what is asked.
    """
    name = name_of(scene)
    perhaps_crowded = scene.accuracy > 0 and scene.sampler == "auto"
    listed = isinstance(scene.summits, MeasuredRadii)
    if name not in ("cells", "tail") or listed or perhaps_crowded:
        return None
    drawn = scene.n_asperities, scene.seed, scene.count, scene.n_surfaces
    powers = {quantity_of(name).radius for name in scene.quantities} if scene.summits else None
    return *drawn, name, scene.lowest, scene.heights, scene.summits, powers


def common_edges(scenes: Sequence[Scene]) -> tuple[float, ...] | None:
    """Return edges that give scenes which share their surfaces the same cells.

    Returns
    -------
    tuple of float or None
        Nothing where their own cells are the same; None where no cells resolve one of them, and each asperity
        is to be drawn by itself.
    """
    if name_of(scenes[0]) != "cells":
        return ()
    common: tuple[float, ...] = ()
    while True:
        try:
            edges = [_edges(scene, common) for scene in scenes]
        except UnresolvedError:
            return None
        if all(np.array_equal(each, edges[0]) for each in edges):
            return common
        common = tuple(np.unique(np.concatenate(edges)).tolist())


def _edges(scene: Scene, given: Sequence[float]) -> NDArray[np.float64]:
    """Of its cells; the response may need more of them than the mesh has, but for plain gradings."""
    plain = scene.hertzian and isinstance(scene.modulus, Homogeneous | Exponential)
    return (mesh_of(scene, given) if plain else cells_of(scene, given).mesh).edges


def shared(scenes: Sequence[Scene], edges: Sequence[float] = ()) -> Shared:
    """Prepare to draw scenes on cells with these common edges; one alone may be any."""
    if len(scenes) == 1 and not edges:
        return Shared((sampler_of(scenes[0]),))
    if name_of(scenes[0]) == "cells":
        return Shared(tuple(cells_of(scene, edges) for scene in scenes))
    return Shared(tuple(map(tail_of, scenes)))
