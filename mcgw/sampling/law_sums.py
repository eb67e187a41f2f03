"""Sums over given heights under any contact law, by the formula of each contact: slow, literal, trusted."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from analytic.arrays import Array
from analytic.laws import term_of
from mcgw.sampling.hertz import hertz_sums
from mcgw.sampling.sideways import tangential_loads
from mcgw.scene.scene import Scene


def asperity_sums(
    scene: Scene,
    numbers: NDArray[np.int64],
    heights: Array,
    weights: Array,
    ratios: Array | None = None,
) -> dict[str, Array]:
    """Load, area, ... of surfaces whose heights are given.

    Parameters
    ----------
    scene : Scene
        Its surface, grading, contact law, separations and quantities are used.
    numbers : ndarray of int
        How many of the heights belong to each surface, shape (surfaces,).
    heights : ndarray
        The reduced heights of all surfaces, one after the other.
    weights : ndarray
        For how many asperities each height stands: 1 in an ensemble.
    ratios : ndarray, optional
        The radius of each over that of the surface, where summits have their own.

    Returns
    -------
    dict of str to ndarray
        Each quantity in SI units, shape (surfaces, separations).
    """
    if scene.tangential:
        plain = replace(scene, tangential=None)
        loads = replace(plain, separations=scene.all_separations, quantities=("load",))
        everywhere = asperity_sums(loads, numbers, heights, weights, ratios)["load"]
        sums = asperity_sums(plain, numbers, heights, weights, ratios)
        return {**sums, "tangential_load": tangential_loads(scene, everywhere)}
    if scene.hertzian:
        return hertz_sums(scene, numbers, heights, weights, ratios)
    surface = np.repeat(np.arange(len(numbers)), numbers)
    touching = heights > scene.lowest
    surface, s, weight = surface[touching], heights[touching], weights[touching]
    e = scene.modulus(s)
    c = None if ratios is None else ratios[touching]
    sums = {}
    for name in scene.quantities:
        q, branch = quantity_of(name), scene.branch_of(name)
        rows = []
        for h in scene.separations:
            one = term_of(q.base, branch, h, s, e) if c is None else scene.ways.term(name, h, s, e, c)
            rows.append(np.bincount(surface, weight * one, len(numbers)))
        sums[name] = np.asarray(q.scale(scene.surface) * np.stack(rows, axis=1), dtype=np.float64)
    return sums
