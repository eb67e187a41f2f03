"""From a scene to an ensemble, block by block of surfaces."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numba
import numpy as np

from mcgw.counts import GROUP
from mcgw.ensemble import Arrays, Ensemble
from mcgw.samplers import Block, Cells, Sampler, sampler_of
from mcgw.scene import Scene

__all__ = ["block_size", "blocks", "kept", "simulate", "use_threads"]

_WORDS = 4_000_000  # numbers a block may hold
_DRAWS = 1e8  # asperities a block may draw, so that a bar moves every second


def simulate(scene: Scene, *, threads: int | None = None) -> Ensemble:
    """Draw the ensemble of a scene in memory.

    Parameters
    ----------
    scene : Scene
        What is asked.
    threads : int, optional
        Left out: all there are. The result is the same, bit by bit, for any number.

    Returns
    -------
    Ensemble
        With arrays of shape (surfaces, separations).

    Raises
    ------
    ValueError
        If `threads` is not positive.
    """
    sampler = sampler_of(scene)
    with use_threads(threads):
        parts = [kept(scene, block) for _, block in blocks(scene, sampler)]
    arrays = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    return Ensemble(scene, sampler.name, Arrays(arrays))


def blocks(scene: Scene, sampler: Sampler) -> Iterator[tuple[int, Block]]:
    """First surface and results of each block, in order."""
    size = block_size(scene, sampler)
    for first in range(0, scene.n_surfaces, size):
        yield first, sampler.block(first, min(size, scene.n_surfaces - first))


def kept(scene: Scene, block: Block) -> dict[str, Any]:
    """What of a block is kept: its sums, and its moments if the scene says so."""
    arrays: dict[str, Any] = dict(block.sums)
    if "contacts" in arrays and scene.sampler != "stratified":
        arrays["contacts"] = np.rint(arrays["contacts"]).astype(np.int64)
    if scene.keep == "moments":
        arrays |= {"moments": block.moments, "cells": block.counts, "extras": block.extras}
    return arrays


def block_size(scene: Scene, sampler: Sampler) -> int:
    """Surfaces a block: bounded by memory and time, a multiple of a group of counts where it can be."""
    touching = scene.n_asperities * float(scene.heights.above(np.array(scene.lowest)))
    words = len(scene.separations) * len(scene.quantities)
    if isinstance(sampler, Cells):
        words += 3 * int(sampler.response.layout.starts[-1]) + 4 * sampler.mesh.size
    draws = {"direct": float(scene.n_asperities), "aggregate": 1e4}.get(sampler.name, touching)
    if sampler.name == "tail":
        words += 4 * int(min(touching, 1e12))
    size = int(min(_WORDS / words, _DRAWS / (draws + 1), 16 * GROUP))
    return max(size - size % GROUP, min(max(size, 1), GROUP))


@contextmanager
def use_threads(threads: int | None) -> Iterator[None]:
    """Let the loops use so many threads, at most as many as there are."""
    if threads is not None and threads < 1:
        raise ValueError(f"threads = {threads}: give a whole number >= 1")
    before = numba.get_num_threads()
    numba.set_num_threads(min(threads or before, before))
    try:
        yield
    finally:
        numba.set_num_threads(before)
