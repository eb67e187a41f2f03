"""One load on one map, by Tamaas (Polonsky-Keer-Rey): E* = 1, cell of side 1."""

import time
from dataclasses import dataclass

import numpy as np
import tamaas
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from solve_list import STEP, TOLERANCE

from mcgw.elasticity.levels import rimless

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Solution:
    """What the solver found; areas are shares of the cell, lengths in its side, stiffness of E*."""

    area_raw: float
    area: float
    gap: float
    stiffness: float
    spots: int
    error: float
    seconds: float


class Solver:
    """Loads one map again and again, each time from what it found before.

    Parameters
    ----------
    heights : ndarray
        Periodic map, shape (n, n), in sides of the cell.
    tolerance : float, optional
        At which Tamaas stops, by its own measure.
    step : float, optional
        From a load to the next, for stiffness.
    """

    def __init__(self, heights: Array, tolerance: float = TOLERANCE, step: float = STEP) -> None:
        tamaas.set_log_level(tamaas.LogLevel.error)
        self.heights = np.ascontiguousarray(heights)
        self.model = tamaas.Model(tamaas.model_type.basic_2d, [1.0, 1.0], list(heights.shape))
        self.model.E, self.model.nu = 1.0, 0.0
        self.solver = tamaas.PolonskyKeerRey(self.model, self.heights, tolerance)
        self.solver.max_iter = 20000
        self.tolerance, self.step = tolerance, step

    def at(self, pressure: float) -> Solution:
        """Contact under a mean pressure over E*.

        Raises
        ------
        RuntimeError
            If the solver stops before its tolerance.
        """
        begun = time.perf_counter()
        error = self._press(pressure)
        touching, gap = self.model.traction[...] > 0, self._gap()
        self._press(self.step * pressure)
        stiffness = (self.step - 1) * pressure / (gap - self._gap())
        return Solution(
            area_raw=float(touching.mean()),
            area=rimless(touching),
            gap=gap,
            stiffness=stiffness,
            spots=spots(touching),
            error=error,
            seconds=time.perf_counter() - begun,
        )

    def _press(self, pressure: float) -> float:
        error = float(self.solver.solve(pressure))
        if not error <= self.tolerance:
            raise RuntimeError(f"p = {pressure:g}: the solver stopped at an error of {error:g}")
        return error

    def _gap(self) -> float:
        """Mean gap: height of the rigid plane over the mean plane of the map."""
        gap = self.model.displacement[...] - self.heights
        pressure = self.model.traction[...]
        return float(gap.mean() - (gap * pressure).sum() / pressure.sum())


def spots(touching: NDArray[np.bool_]) -> int:
    """Connected regions (pixels that share an edge), also across the rim of the periodic cell."""
    label, many = ndimage.label(touching)
    across = np.hstack([label[[0, -1]], label[:, [0, -1]].T])
    a, b = across[:, (across > 0).all(axis=0)] - 1
    return int(connected_components(coo_array((np.ones(a.size), (a, b)), shape=(many, many)))[0])
