"""Theory to hold an ensemble to: with a bound on radii that hardly any ensemble meets.

Where each summit has a radius of its own, the fourth moment of the area is infinite, by the logarithm of the
flattest summit. Whether a mean is Gaussian cannot be told from the kurtosis of all summits then, but from
that of those an ensemble has. Left out are summits flatter than a bound, of which there is one in ten
thousand ensembles: means and variances change by less than a thousandth of their errors.
"""

from dataclasses import replace

import numpy as np

from analytic import Model, RandomCurvature
from analytic.curvature import MEAN_CURVATURE
from mcgw.scene.scene import Scene

__all__ = ["bounded_theory"]

_SELDOM = 1e-4  # summits flatter than the bound, in an ensemble
_FLAT = 1e-3  # curvature down to which the share of flatter summits goes as its fourth power


def bounded_theory(scene: Scene, surfaces: int) -> Model:
    """The scene's own model, with a bound on the radii where there is none."""
    theory, law = scene.theory, scene.curvature
    if not isinstance(law, RandomCurvature) or np.isfinite(law.largest):
        return theory
    flatter = float(law.cdf(_FLAT, max(scene.lowest, scene.least))) * max(scene.touching, 1.0) * surfaces
    flattest = _FLAT * min((_SELDOM / flatter) ** 0.25, 1.0)
    return replace(theory, curvature=RandomCurvature(law.alpha, MEAN_CURVATURE / flattest))
