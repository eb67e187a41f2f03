"""Differences between points of a sweep over the same surfaces, and how they change with a key."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.formats.sheet import Sheet, Shown
from mcgw.formats.table import Column, Table
from mcgw.machine.terminal import plotted
from mcgw.sweeps.groups import Place
from mcgw.sweeps.pooled import Pooled


@dataclass(frozen=True)
class Difference:
    """Difference of two means over the same surfaces; arrays over the separations.

    Parameters
    ----------
    value, stderr : ndarray
        In SI units, and its standard error; nan for a single surface.
    gain : ndarray
        Variance of the difference of two independent ensembles of this size over that of the pair.
    """

    value: Array
    stderr: Array
    gain: Array

    @classmethod
    def of(
        cls, pooled: Pooled, points: tuple[Place, Place], quantity: str, areas: tuple[float, float]
    ) -> "Difference":
        """First point less second one, each per an area.

        The variance is that of one combination of scenes, so that nothing cancels.
        """
        (one, v), (other, w) = (point.of(quantity) for point in points)
        a, b = areas
        value = pooled.mean(quantity, one, v) / a - pooled.mean(quantity, other, w) / b
        apart = pooled.variance(quantity, one, v) / a**2 + pooled.variance(quantity, other, w) / b**2
        scenes = np.union1d(one, other)
        weights = np.zeros(len(scenes))
        weights[np.searchsorted(scenes, one)] += v / a
        weights[np.searchsorted(scenes, other)] -= w / b
        paired = np.maximum(pooled.variance(quantity, scenes, weights), 0.0)  # but for rounding
        with np.errstate(divide="ignore", invalid="ignore"):
            return cls(value, np.sqrt(paired / pooled.n), apart / paired)


@dataclass(frozen=True, repr=False)
class Slopes(Shown):
    """Change of a mean with a key, between neighbouring points of a sweep.

    Parameters
    ----------
    quantity, key : str
        Of what, with what.
    axis : int
        Dimension of the arrays along which the key changes.
    at : ndarray
        Middle between two values of the key, shape (pairs,).
    value, stderr : ndarray
        Difference of the means over that of the key in SI units, and its standard error over the surfaces:
        shape of the sweep and separations, one less along the key.
    theory : ndarray
        The same difference of the exact means.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1], n_surfaces=200, seed=1)
    >>> sweep = mcgw.sweep(scene, {"grading.gamma": [1.0, 1.5, 2.0]})
    >>> slopes = sweep.slopes("load", "grading.gamma")
    >>> slopes.at
    array([1.25, 1.75])
    >>> bool((abs(slopes.value - slopes.theory) < 5 * slopes.stderr).all())
    True
    """

    quantity: str
    key: str
    axis: int
    at: Array
    value: Array
    stderr: Array
    theory: Array

    def plot(self, ax: Any = None, *, k: int = 0) -> Any:
        """Draw the slopes at one separation, by number; returns the axes."""
        return plotted(self, ax, k=k)

    def sheet(self) -> Sheet:
        """Slopes at the first separation, at some values of the key and the first ones of all others."""
        flat = [
            np.moveaxis(x, self.axis, 0).reshape(len(self.at), -1)[:, 0]
            for x in (self.value, self.stderr, self.theory)
        ]
        columns = (
            Column("at", self.at, self.key, form="g"),
            Column("slope", flat[0], unit="1"),
            Column("stderr", flat[1], unit="1", form=".1g"),
            Column("theory", flat[2], unit="1"),
        )
        title = f"Change of the mean {self.quantity} with {self.key}"
        return Sheet(title, table=Table(columns).rows())
