"""Surfaces whose summits have places in a periodic cell, their own or uniform at random: their sums."""

import math

import numpy as np
from scipy import fft

from analytic import MeasuredRadii
from analytic.arrays import Array, Ints
from mcgw.errors import RunError
from mcgw.sampling.counts import generator
from mcgw.sampling.located.balance import BalanceError, Located
from mcgw.sampling.located.spots import Grid, LawSpots, sized_grid
from mcgw.scene.scene import Scene

_PURPOSE = 2  # of NumPy's generator: places
_FINE, _FEWEST = 8, 64  # points of the grid a summit and a side
_FINER, _MOST = 16, 4096  # the same for places of their own, and the most that tell near ones apart
_ROUNDED = 1e-9  # points that are not added for a last digit


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
    spots = LawSpots(scene, scene.surface.sigma * heights, ratios)
    return Located(spots, *(_own(scene) if scene.own_places else _random(scene, number, heights.size)))


def _random(scene: Scene, number: int, n: int) -> tuple[Ints, Grid]:
    """Rows and columns of so many summits of a surface, and of what."""
    side = math.sqrt(scene.surface.nominal_area)
    points = fft.next_fast_len(max(math.ceil(_FINE * math.sqrt(scene.n_asperities)), _FEWEST), real=True)
    cells = generator(scene.seed, _PURPOSE, number).choice(points**2, n, replace=False)
    places = np.array(np.divmod(cells, points))
    return places, sized_grid((points, points), (side, side), True)


def _own(scene: Scene) -> tuple[Ints, Grid]:
    """The same of measured summits: the points nearest to them, of a grid that has one for each."""
    listed = scene.curvature
    assert isinstance(listed, MeasuredRadii)
    assert listed.places is not None
    (x, y), (width, height) = np.array(listed.places), listed.sides(scene.surface.nominal_area)
    apart, n = min(math.sqrt(width * height / x.size) / _FINER, min(width, height) / _FEWEST), 0
    while n <= _MOST:
        points = (math.ceil(s / apart - _ROUNDED) for s in (height, width))
        rows, columns = (fft.next_fast_len(number, real=True) for number in points)
        places = np.array(
            [np.rint(p / s * m).astype(np.int64) % m for p, s, m in ((y, height, rows), (x, width, columns))]
        )
        if np.unique(places, axis=1).shape[1] == x.size:
            return places, sized_grid((rows, columns), (width, height), True)
        apart, n = apart / 2, 2 * max(rows, columns)
    raise RunError(f"summits: two of them lie within {2 * apart:.2g} m; leave one of them out of the list")
