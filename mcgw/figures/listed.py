"""Sums over the listed heights under any contact law, and the theory of the same surfaces."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import Exponential, Homogeneous, Model
from analytic.laws import ContactLaw
from mcgw.figures.data import Points
from mcgw.figures.samples import Samples
from mcgw.sampling.law_sums import asperity_sums
from mcgw.scene.scene import Scene

__all__ = ["PRESSURE", "area_of", "mean_points", "model_of", "sums_of"]

Array = NDArray[np.float64]

PRESSURE = "pressure $P/A_n$ (MPa)"


def area_of(samples: Samples) -> float:
    """Nominal area of a surface of so many asperities, m^2."""
    return samples.n_asperities / samples.surface.eta


def model_of(samples: Samples, law: ContactLaw, gamma: float = 1.0, **further: Any) -> Model:
    """Theory of the listed surfaces under a law."""
    surface = replace(samples.surface, nominal_area=area_of(samples))
    grading = Homogeneous() if gamma == 1 else Exponential(gamma)
    return Model(surface, grading=grading, law=law, n_asperities=float(samples.n_asperities), **further)


def sums_of(samples: Samples, law: ContactLaw, h: Array, **further: Any) -> dict[str, Array]:
    """Sums of each listed surface under a law, at separations above -0.2."""
    asked = {"quantities": ("load", "area"), "n_asperities": samples.n_asperities, "seed": samples.seed}
    scene = Scene(samples.surface, separations=h, law=law, **{**asked, **further})
    heights = np.concatenate(samples.heights)
    return asperity_sums(scene, np.array([len(s) for s in samples.heights]), heights, np.ones(len(heights)))


def mean_points(x: Array, values: Array, exact: Array) -> Points:
    """Means over the listed surfaces."""
    return Points(x, values.mean(axis=0), values.std(axis=0, ddof=1) / np.sqrt(len(values)), exact)
