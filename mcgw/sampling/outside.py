"""Asperities drawn one by one: those outside all cells, and all of them for the sampler ``tail``."""

from typing import TYPE_CHECKING, Any

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.machine.memory import check_memory
from mcgw.sampling.cells import Mesh
from mcgw.sampling.counts import Counts
from mcgw.sampling.philox import EXTRAS, centred, made_for
from mcgw.scene.scene import Scene

if TYPE_CHECKING:
    from mcgw.sampling.own_radii import RadiusTable

_HIGH, _LOW, _RADII = 0, 1, 2  # streams, and what leads from one of heights to that of their radii
_MANY, _BYTES = 10**7, 100  # heights that are worth asking whether there is room; bytes of one


def extra_heights(
    scene: Scene, mesh: Mesh, first: int, counts: Counts, table: "RadiusTable | None" = None
) -> Array:
    """Contacting heights outside the cells, for a block of surfaces.

    Parameters
    ----------
    scene : Scene
        Its height law, seed and lowest separation are used.
    mesh : Mesh
        The scene's.
    first : int
        Number of the block's first surface.
    counts : Counts
        How many lie below and above the cells.
    table : RadiusTable, optional
        Of radii, where summits have their own.

    Returns
    -------
    ndarray
        Rows (number of the surface, reduced height, weight), surface by surface, low ones first; and in a
        fourth column the radius over that of the surface, where summits have their own.
    """
    law = scene.heights
    number = int(counts.high_extras.sum() + counts.low_extras.sum())
    if number > _MANY:
        check_memory(f"ensemble.sampler: to list {number:.4g} heights one by one", _BYTES * number)
    edge = float(mesh.edges[-1]) if mesh.size else scene.lowest

    def listed(stream: int, numbers: Ints, heights: Array) -> Array:
        surfaces = np.repeat(first + np.arange(len(numbers)), numbers)
        columns = [surfaces, heights, np.ones(len(heights))]
        if table:
            pairs = _centred_pairs(np.uint64(scene.seed), first, stream + _RADII, numbers)
            two = np.ascontiguousarray(pairs.reshape(-1, 2).T)
            columns.append(table.root_ratios(np.ascontiguousarray(heights), *two) ** 2)
        return np.column_stack(columns)

    heights = law.isf(_wide_uniforms(scene.seed, first, _HIGH, counts.high_extras), edge)
    rows = listed(_HIGH, counts.high_extras, heights)
    if not counts.low_extras.any():
        return rows
    bottom = float(mesh.edges[0])
    least = float(law.cdf(np.array(scene.lowest)) / law.cdf(np.array(bottom)))
    share = least + (1 - least) * _wide_uniforms(scene.seed, first, _LOW, counts.low_extras)
    low = listed(_LOW, counts.low_extras, law.ppf(share, bottom))
    rows = np.concatenate([low, rows])
    return np.asarray(rows[np.argsort(rows[:, 0], kind="stable")])


def table_of(scene: Scene, lowest: float) -> "RadiusTable | None":
    """Radii of summits above a height, where they have their own."""
    if scene.summits is None:
        return None
    from mcgw.sampling.own_radii import radius_table  # for those scenes alone

    return radius_table(scene.summits, lowest)


def _wide_uniforms(seed: int, first: int, stream: int, numbers: Ints) -> Array:
    """Uniforms of 64 bits: those of 32 would cut the tail of 1e10 asperities."""
    u = (1 + _centred_pairs(np.uint64(seed), first, stream, numbers)) / 2
    return np.asarray((u[::2] - 0.5 / 2**32) + u[1::2] / 2**32)


@njit(cache=True)
def _centred_pairs(seed: Any, first: Any, stream: Any, numbers: Any) -> Any:
    """Two for each number wanted, surface by surface."""
    total = most = at = 0
    for n in numbers:  # a reduction by NumPy's name imports half of SciPy when it is loaded
        total, most = total + n, max(most, n)
    pairs, words = np.empty(2 * total), np.empty(made_for(2 * most))
    for i in range(numbers.size):
        n = 2 * numbers[i]
        if n:
            centred(words, seed, EXTRAS, first + i, stream, 0, n)
            for k in range(n):  # in one step it takes 2 s to compile: the text of its errors
                pairs[at + k] = words[k]
            at += n
    return pairs
