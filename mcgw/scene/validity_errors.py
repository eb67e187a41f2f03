"""Expected errors of a model against elasticity, at some separations."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array
from mcgw.scene.validity_table import COLUMNS

Mask = NDArray[np.bool_]


@dataclass(frozen=True, repr=False)
class ModelErrors:
    """Expected errors of a model against elasticity: periodic cells of a homogeneous half-space.

    The errors of "area", "stiffness" and "separation" are those at the load that the model has at each
    separation; that of "load" is the one at the same separation, taken for the mean gap of a periodic cell.

    Parameters
    ----------
    separations : ndarray
        Reduced separations d/sigma, rising.
    loads : ndarray
        Pressure over E* g of Gaussian surfaces, g being the rms slope, or over E* sqrt(sigma/R) of separate
        caps: of Hertz's law without a grading at each separation; nan where the model was not measured.
    error : dict of str to ndarray
        How far off 95 % of surfaces are at most, over the right value, or over sigma for "separation":
        ``|bias|`` and 2.1 standard deviations, of surfaces with so many contacts as one of the scene has,
        and so many long waves except for areas, and of the bias itself. nan where nothing was measured.
    bias : dict of str to ndarray
        Mean over maps of model/elasticity - 1, or of the difference over sigma.
    graded : bool
        Whether the scene has a grading, of which these errors say nothing: they are the geometry's share.
    axis : str
        What the loads are, as "p/(E* g)".
    where : str
        Where it was measured, in words.
    unknown : str
        Why there is no number at some separation or at all; empty if there is one at each.
    """

    separations: Array
    loads: Array
    error: dict[str, Array]
    bias: dict[str, Array]
    graded: bool = False
    axis: str = ""
    where: str = ""
    unknown: str = ""

    @property
    def measured(self) -> Mask:
        """At which separations something was measured."""
        return self.known(*COLUMNS)

    def known(self, *names: str) -> Mask:
        """At which separations one of some columns was measured."""
        known = np.zeros(len(self.separations), dtype=np.bool_)
        for name in names:
            known |= np.isfinite(self.error[name])
        return known

    def worst(self, *names: str) -> float:
        """Largest expected error of some columns over the separations; nan if none was measured."""
        values = np.concatenate([self.error[name] for name in names])
        return float(np.nanmax(values)) if np.isfinite(values).any() else np.nan
