"""Sums of Hertz contacts over given heights, by plain loops: slow, literal, trusted."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from analytic.arrays import Array
from mcgw.machine.compiling import njit
from mcgw.scene.scene import Scene


@njit(cache=True, inline="always")
def _power(d: float, twice: int) -> float:
    """``d**(twice/2)`` by roots and products, which every processor rounds alike."""
    power = np.sqrt(d) if twice % 2 else 1.0
    for _ in range(twice // 2):
        power *= d
    return power


@njit(nogil=True, cache=True)
def _sums(starts: Any, heights: Any, factors: Any, separations: Any, twice: Any) -> Any:
    """For each quantity, surface and separation the sum of ``factor (s - h)^(twice/2)`` over s > h."""
    surfaces = starts.size - 1
    result = np.zeros((twice.size, surfaces, separations.size))
    for i in range(surfaces):
        if starts[i] == starts[i + 1]:
            continue
        for q in range(twice.size):
            exponent = twice[q]
            for k in range(separations.size):
                total = 0.0
                for j in range(starts[i], starts[i + 1]):
                    d = heights[j] - separations[k]
                    if d > 0.0:
                        total += factors[q, j] * _power(d, exponent)
                result[q, i, k] = total
    return result


def hertz_sums(
    scene: Scene,
    numbers: NDArray[np.int64],
    heights: Array,
    weights: Array,
    ratios: Array | None = None,
) -> dict[str, Array]:
    """As `mcgw.sampling.law_sums.asperity_sums`, of Hertz contacts."""
    asked = [quantity_of(name) for name in scene.quantities]
    graded = weights
    if any(q.modulus for q in asked):
        graded = weights * scene.modulus(heights)
    factors = np.stack([graded if q.modulus else weights for q in asked])
    if ratios is not None:
        of_radius = {0.0: np.ones_like(ratios), 0.5: np.sqrt(ratios), 1.0: ratios}
        factors *= np.stack([of_radius[q.radius] for q in asked])
    sums = _sums(
        np.concatenate([[0], np.cumsum(numbers)]),
        heights,
        factors,
        np.array(scene.separations),
        np.array([round(2 * q.exponent) for q in asked]),
    )
    for q, values in zip(asked, sums, strict=True):
        values *= q.scale(scene.surface)
    return dict(zip(scene.quantities, sums, strict=True))
