"""Two points of a sweep over the same surfaces: difference of means, and slopes along a key."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.paired import Pair
from mcgw.ensemble.pooled import Pooled
from mcgw.formats.sheet import Sheet, Shown
from mcgw.formats.table import Column, Table
from mcgw.machine.terminal import plotted
from mcgw.sweeps.groups import Place


@dataclass(frozen=True)
class Difference:
    """Difference of two means over the same surfaces; arrays over the separations.

    Parameters
    ----------
    value, stderr : ndarray
        In SI units, and its standard error; nan for a single surface.
    gain : ndarray
        Variance of the difference of two independent ensembles of this size, divided by that of the pair.
    """

    value: Array
    stderr: Array
    gain: Array

    @classmethod
    def of(
        cls, pooled: Pooled, points: tuple[Place, Place], quantity: str, areas: tuple[float, float]
    ) -> "Difference":
        """First point minus second, each per area."""
        one, other = (point.of(quantity) for point in points)
        pair = Pair.of(pooled, quantity, one, other, 1 / areas[0], 1 / areas[1])
        value = pair.one / areas[0] - pair.other / areas[1]
        with np.errstate(divide="ignore", invalid="ignore"):
            return cls(value, np.sqrt(pair.together / pooled.n), pair.apart / pair.together)


@dataclass(frozen=True, repr=False)
class Slopes(Shown):
    """Change of a mean with a key, between neighbouring points of a sweep.

    Parameters
    ----------
    quantity, key : str
        What changes, and the key with which it changes.
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
        """Draw the slopes at one separation, given by its index; returns the axes."""
        return plotted(self, ax, k=k)

    def sheet(self) -> Sheet:
        """Display slopes at the first separation, for some values of the key."""
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
