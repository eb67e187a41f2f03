"""Exponential gradings as combinations of two: under Hertz's law every sum is linear in the modulus.

``E*(s)/E* = gamma - (gamma - 1) exp(-s)`` is linear in gamma (a homogeneous surface has gamma = 1). So every
grading lies between the softest and the stiffest of a sweep: its load on a surface is the same weighted mean
of their loads there, and over the surfaces its mean and variance follow from their means, variances and
covariance. A thousand more gradings cost no product with the surfaces. Weights from 0 to 1 and moduli that
are not negative let nothing cancel: the last digits are those of the two.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from analytic import Exponential, Grading, Homogeneous
from mcgw.scene.scene import Scene

__all__ = ["between_two"]

_MANY = 8  # gradings: fewer are computed each by itself, with the bits that it has alone


def between_two(scenes: Sequence[Scene]) -> tuple[tuple[int, int], NDArray[np.float64]] | None:
    """Scenes that differ in their gradings alone, as weighted means of two of them.

    Returns
    -------
    ((int, int), ndarray) or None
        The two, and the weights of each scene on them, shape (scenes, 2). None if there are few scenes, a
        grading is no exponential one, or sums are not linear in it.
    """
    gammas = [_gamma(scene.grading) for scene in scenes]
    if len(set(gammas)) < _MANY or None in gammas or not _linear(scenes[0]):
        return None
    x = np.array(gammas, dtype=np.float64)
    low, high = int(np.argmin(x)), int(np.argmax(x))
    share = (x - x[low]) / (x[high] - x[low])
    return (low, high), np.column_stack([1 - share, share])


def _gamma(grading: Grading) -> float | None:
    if isinstance(grading, Homogeneous):
        return 1.0
    return grading.gamma if isinstance(grading, Exponential) else None


def _linear(scene: Scene) -> bool:
    """Whether all that is kept follows from sums linear in a modulus that is not negative."""
    plain = scene.hertzian and scene.tangential is None and scene.interaction is None
    return plain and scene.negative == "error" and scene.keep != "statistics"
