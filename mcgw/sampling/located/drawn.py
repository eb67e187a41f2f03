"""Drawn surfaces whose summits have places, uniform at random in a periodic cell: their sums."""

import math
from functools import lru_cache

import numpy as np
from scipy import fft

from analytic.arrays import Array
from mcgw.errors import RunError
from mcgw.sampling.counts import generator
from mcgw.sampling.located.balance import BalanceError, Located
from mcgw.sampling.located.spots import Grid, LawSpots
from mcgw.scene.scene import Scene

_PURPOSE = 2  # of NumPy's generator: places
_FINE, _FEWEST = 8, 64  # points of the grid a summit and a side
_sized_grid = lru_cache(maxsize=2)(Grid)  # their potential takes as long as a balance


def located_sums(scene: Scene, number: int, heights: Array, ratios: Array | None) -> dict[str, Array]:
    """Quantities of one surface at nominal separations from the mean deformed plane.

    Parameters
    ----------
    scene : Scene
        With located summits.
    number : int
        Of the surface.
    heights : ndarray
        Reduced heights of all its summits, shape (n,).
    ratios : ndarray or None
        Radius of each over that of the surface, where summits have their own.

    Returns
    -------
    dict of str to ndarray
        Each quantity in SI units, shape (1, separations).

    Raises
    ------
    RunError
        If no balance is found at a separation.
    """
    sigma = scene.surface.sigma
    found: dict[str, list[float]] = {name: [] for name in scene.quantities}
    surface = _located(scene, number, heights, ratios)
    for h in scene.separations:
        values = {"load": 0.0, "area": 0.0, "stiffness": 0.0, "contacts": 0.0}
        if heights.size and h < heights.max():
            try:
                balance = surface.at_separation(h * sigma)
            except BalanceError as error:
                raise RunError(f"surface {number} at d/sigma = {h:g}: {error}") from None
            values = {name: float(getattr(balance, name)) for name in values}
        values["conductance"] = 2 * values["stiffness"] / scene.surface.E_star  # Barber 2003
        for name, row in found.items():
            row.append(values[name])
    return {name: np.array([row]) for name, row in found.items()}


def _located(scene: Scene, number: int, heights: Array, ratios: Array | None) -> Located:
    side = math.sqrt(scene.surface.nominal_area)
    points = fft.next_fast_len(max(math.ceil(_FINE * math.sqrt(scene.n_asperities)), _FEWEST), real=True)
    cells = generator(scene.seed, _PURPOSE, number).choice(points**2, heights.size, replace=False)
    places = np.array(np.divmod(cells, points))
    spots = LawSpots(scene, scene.surface.sigma * heights, ratios)
    return Located(spots, places, _sized_grid((points, points), (side, side), True))
