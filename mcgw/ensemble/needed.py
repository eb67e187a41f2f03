"""Numbers of surfaces that answers need for a relative error, by exact theory, before any is drawn.

An error is a 95 % bound: 1.96 standard errors of a mean, a standard deviation or a quantile over the answer,
and for a whole distribution the largest difference of a probability, which Kolmogorov's law bounds.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, inf

import numpy as np
from scipy.special import ndtri

from mcgw.ensemble.forecast import MOST_SURFACES, forecast, surfaces_at_load
from mcgw.ensemble.intervals import CONFIDENCE, moments
from mcgw.scene.scene import Scene
from mcgw.scene.values import EXACT

PROBABILITY = 0.99  # of the quantile
_BOUND = float(ndtri((1 + CONFIDENCE) / 2))
_KOLMOGOROV = 1.3581  # sqrt(n) times the largest difference of probabilities, in 95 of 100 samples
_FEWEST = {"std": 30, "quantile": 2000, "distribution": 1}  # 20 of 2000 lie beyond the quantile


@dataclass(frozen=True)
class Needs:
    """How many surfaces answers need, by exact theory.

    Parameters
    ----------
    scene : Scene
        Of one separation and one quantity.
    """

    scene: Scene

    def surfaces(self, want: str, target: float) -> float:
        """Surfaces for which 1.96 standard errors are at most the target; infinite if none are enough."""
        if not target > 0:
            return inf
        if want == "values":
            return float(self.scene.n_surfaces)
        if want == "mean":
            asked = replace(self.scene, accuracy=EXACT, rel_err=target, n_surfaces=MOST_SURFACES)
            found = forecast(asked)
            return inf if found.out_of_reach else float(found.surfaces)
        if want == "conductance":
            return surfaces_at_load(self.scene, self.separation, {"conductance": target})
        return float(max(ceil((self.of_one(want) / target) ** 2), _FEWEST[want]))

    def of_one(self, want: str) -> float:
        """Bound of the error from a single surface, which falls with the root of their number."""
        return {"std": self._std, "quantile": self._quantile, "distribution": _KOLMOGOROV}[want]

    @cached_property
    def at_load(self) -> float:
        """Bound of the error of the conductance of a single surface at the load of this separation."""
        alone = float(self.scene.theory.asperities_for("conductance", self.separation, 1.0, given="load"))
        return _BOUND * float(np.sqrt(alone / self.scene.n_asperities))

    @property
    def separation(self) -> float:
        """The scene's."""
        return self.scene.separations[0]

    @cached_property
    def _std(self) -> float:
        """By the fourth moment of the sum over asperities."""
        _, second, fourth = moments(self.scene, [self.scene.quantities[0]], (2, 4))[:, 0, 0]
        alone = 0.0 if self.scene.count == "poisson" else 3.0  # moments are about 0, or about the mean
        excess = (fourth / second**2 - alone) / self.scene.n_asperities
        return _BOUND * float(np.sqrt(max(2 + excess, 0.0) / 4))

    @cached_property
    def _quantile(self) -> float:
        """By the density there (order statistics); infinite where there is none."""
        law = self.scene.theory.distribution(self.scene.quantities[0], self.separation)
        value = float(law.ppf(PROBABILITY))
        density = value * float(law.pdf(value))
        return _BOUND * float(np.sqrt(PROBABILITY * (1 - PROBABILITY))) / density if density > 0 else inf
