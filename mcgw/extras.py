"""Asperities drawn one by one: those outside all cells, and all of them for the sampler ``tail``."""

import numpy as np
from numpy.typing import NDArray

from mcgw.cells import Mesh
from mcgw.philox import EXTRAS, uniforms
from mcgw.scene import Scene

__all__ = ["extra_heights"]

Array = NDArray[np.float64]

_HIGH, _LOW = 0, 1  # streams


def extra_heights(scene: Scene, mesh: Mesh, surface: int, low: int, high: int) -> Array:
    """Contacting heights of one surface outside the cells.

    Parameters
    ----------
    scene : Scene
        Its height law, seed and lowest separation are used.
    mesh : Mesh
        The scene's.
    surface : int
        Its number.
    low, high : int
        How many lie below and above the cells.

    Returns
    -------
    ndarray
        Reduced heights, shape (low + high,).
    """
    law = scene.heights
    edge = float(mesh.edges[-1]) if mesh.size else scene.lowest
    above = law.from_above(_wide_uniforms(scene.seed, surface, _HIGH, high), edge)
    if not low:
        return above
    bottom = float(mesh.edges[0])
    least = float(law.below(np.array(scene.lowest)) / law.below(np.array(bottom)))
    share = least + (1 - least) * _wide_uniforms(scene.seed, surface, _LOW, low)
    return np.concatenate([law.from_below(share, bottom), above])


def _wide_uniforms(seed: int, surface: int, stream: int, n: int) -> Array:
    """Uniforms of 64 bits: those of 32 would cut the tail of 1e10 asperities."""
    u = uniforms(seed, EXTRAS, surface, stream, 2 * n)
    return (u[::2] - 0.5 / 2**32) + u[1::2] / 2**32
