"""Tests of means whose values are only as accurate as the scene asks (`Scene.accuracy`).

Every value may be off by its share, and so may the mean, in the same direction for all surfaces.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from mcgw.scene.scene import Scene

__all__ = ["allowance", "beyond", "farthest", "told_apart"]

Array = NDArray[np.float64]

_UNSEEN = 0.3  # standard errors by which a combination may be off without being seen


def allowance(scene: Scene, mean: Array, stderr: Array) -> Array:
    """How many standard errors each mean may be off by: none, where nothing but the last digit is.

    Parameters
    ----------
    scene : Scene
        What was asked.
    mean, stderr : ndarray
        Exact means and standard errors, in the same units.
    """
    if scene.exact:
        return np.zeros(np.shape(mean))
    return np.asarray(scene.accuracy * np.abs(mean) / stderr)


def beyond(z: Array, allowed: Array) -> Array:
    """What of each deviation is beyond what is allowed."""
    return np.asarray(z - np.clip(z, -allowed, allowed))


def told_apart(allowed: Array) -> float:
    """Variance of a combination of means, each of variance 1, from which on their errors are not seen."""
    return float(4 * (allowed**2).sum() / _UNSEEN**2)


def farthest(z: Array) -> float:
    """Probability that the largest of some deviations is as large by chance, whatever their correlation."""
    return min(1.0, 2 * z.size * float(ndtr(-np.abs(z).max(initial=0.0)))) if z.size else 1.0
