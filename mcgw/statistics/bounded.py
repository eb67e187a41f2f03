"""Theory to hold an ensemble to: with a bound on radii that hardly any ensemble meets.

Where each summit has a radius of its own, the fourth moment of the area is infinite, by the logarithm of the
flattest summit. Whether a mean is Gaussian cannot be told from the kurtosis of all summits then, but from
that of those an ensemble has. Left out are summits flatter than a bound, of which there is one in ten
thousand ensembles: means and variances change by less than a thousandth of their errors.

Tests of means whose values are only as accurate as the scene asks (`Scene.accuracy`).

Every value may be off by its share, and so may the mean, in the same direction for all surfaces.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from analytic import Model, RandomCurvature
from analytic.curvature import MEAN_CURVATURE
from mcgw.scene.scene import Scene

__all__ = ["allowance", "beyond", "bounded_theory", "farthest", "told_apart"]

_SELDOM = 1e-4  # summits flatter than the bound, in an ensemble
_FLAT = 1e-3  # curvature down to which the share of flatter summits goes as its fourth power
Array = NDArray[np.float64]
_UNSEEN = 0.3  # standard errors by which a combination may be off without being seen


def bounded_theory(scene: Scene, surfaces: int) -> Model:
    """The scene's own model, with a bound on the radii where there is none."""
    theory, law = scene.theory, scene.curvature
    if not isinstance(law, RandomCurvature) or np.isfinite(law.largest):
        return theory
    flatter = float(law.cdf(_FLAT, max(scene.lowest, scene.least))) * max(scene.touching, 1.0) * surfaces
    flattest = _FLAT * min((_SELDOM / flatter) ** 0.25, 1.0)
    return replace(theory, curvature=RandomCurvature(law.alpha, MEAN_CURVATURE / flattest))


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
