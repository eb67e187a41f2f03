"""The surfaces behind the figures."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from analytic import QUANTITIES, Exponential, Surface
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.regrading import regrade
from mcgw.ensemble.simulation import simulate
from mcgw.sampling.asperities import heights
from mcgw.scene.scene import Scene

__all__ = ["Samples"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Samples:
    """The surfaces behind the figures, drawn when first asked for.

    Parameters
    ----------
    surface : Surface
        Its parameters, SI.
    n_surfaces, n_asperities, seed : int
        The ensemble that is regraded.
    n_listed : int
        Surfaces whose heights are listed one by one.
    """

    surface: Surface
    n_surfaces: int
    n_asperities: int
    seed: int
    n_listed: int

    @cached_property
    def base(self) -> Ensemble:
        """The homogeneous ensemble, with its moments."""
        scene = Scene(
            surface=self.surface,
            separations=tuple(np.linspace(0, 4, 17)),
            quantities=tuple(QUANTITIES),
            n_surfaces=self.n_surfaces,
            n_asperities=self.n_asperities,
            seed=self.seed,
            keep="moments",
        )
        return simulate(scene)

    @cached_property
    def _graded(self) -> dict[float, Ensemble]:
        return {1.0: self.base}

    def graded(self, gamma: float) -> Ensemble:
        """The same surfaces with the paper's grading."""
        if gamma not in self._graded:
            self._graded[gamma] = regrade(self.base, Exponential(gamma))
        return self._graded[gamma]

    @cached_property
    def heights(self) -> tuple[Array, ...]:
        """Heights above s = -0.2 of each listed surface."""
        scene = Scene(
            surface=self.surface,
            separations=(-0.2,),
            n_surfaces=self.n_listed,
            n_asperities=self.n_asperities,
            seed=self.seed,
            sampler="tail",
        )
        return tuple(heights(scene, number) for number in range(self.n_listed))

    @property
    def caption(self) -> str:
        """In words."""
        return (
            f"Markers: Monte-Carlo means with 95 % intervals, {self.n_surfaces} surfaces of "
            f"{self.n_asperities:g} asperities, seed {self.seed}, the same for all lines. Lines: theory."
        )

    @property
    def listed_caption(self) -> str:
        """In words, where the heights are listed."""
        return self.caption.replace(f"{self.n_surfaces} surf", f"{self.n_listed} surf")
