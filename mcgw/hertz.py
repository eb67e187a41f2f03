"""Sums of Hertz contacts over given heights, by plain loops: slow, literal, trusted."""

from typing import Any

import numpy as np
from numba import njit, prange
from numpy.typing import NDArray

from analytic import QUANTITIES
from mcgw.scene import Scene

__all__ = ["hertz_sums"]

Array = NDArray[np.float64]


@njit(cache=True, inline="always")
def _power(d: float, twice: int) -> float:
    """``d**(twice/2)`` by roots and products, which every processor rounds alike."""
    power = np.sqrt(d) if twice % 2 else 1.0
    for _ in range(twice // 2):
        power *= d
    return power


@njit(parallel=True, cache=True)
def _sums(starts: Any, heights: Any, modulus: Any, separations: Any, twice: Any) -> Any:
    """For each surface and separation the sum of ``modulus (s - h)^(twice/2)`` over s > h."""
    surfaces = starts.size - 1
    result = np.zeros((surfaces, separations.size))
    for i in prange(surfaces):
        for k in range(separations.size):
            total = 0.0
            for j in range(starts[i], starts[i + 1]):
                d = heights[j] - separations[k]
                if d > 0.0:
                    total += modulus[j] * _power(d, twice)
            result[i, k] = total
    return result


def hertz_sums(scene: Scene, numbers: NDArray[np.int64], heights: Array, weights: Array) -> dict[str, Array]:
    """Load, area, ... of surfaces whose heights are given.

    Parameters
    ----------
    scene : Scene
        Its surface, grading, separations and quantities are used.
    numbers : ndarray of int
        How many of the heights belong to each surface, shape (surfaces,).
    heights : ndarray
        The reduced heights of all surfaces, one after the other.
    weights : ndarray
        For how many asperities each height stands: 1 in an ensemble.

    Returns
    -------
    dict of str to ndarray
        Each quantity in SI units, shape (surfaces, separations).
    """
    starts = np.concatenate([[0], np.cumsum(numbers)])
    separations = np.array(scene.separations)
    graded = weights
    if any(QUANTITIES[name].modulus for name in scene.quantities):
        graded = weights * scene.modulus(heights)
    sums = {}
    for name in scene.quantities:
        q = QUANTITIES[name]
        values = _sums(starts, heights, graded if q.modulus else weights, separations, round(2 * q.exponent))
        sums[name] = q.scale(scene.surface) * values
    return sums
