"""Stretches of heights on which one formula of a contact law holds, at each separation of a scene."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic import Grading
from analytic.arrays import Array, Ints
from analytic.laws import Branch
from mcgw.machine.process import kept
from mcgw.scene.scene import Scene

_NOTHING = 1e-12  # penetration
SMALLEST = 2.0**-30  # cell next to the beginning, or the loss, of a power that no series resolves


@dataclass(frozen=True)
class Stretches:
    """Stretches of the separations of a scene, each separation once, in increasing order."""

    separation: Ints  # which of the separations
    low: Array  # reduced heights; infinite where the stretch goes on beyond the range
    high: Array
    piece: Ints  # which formula
    # whether contact begins at `low` from nothing, rather than with a jump or from another piece
    begins: NDArray[np.bool_]
    # about where it would begin from nothing, next to which formulas are singular: at `low` or below
    root: Array
    # whether contact dwindles to nothing towards `high`, as on unloading where asperities soften
    lost: NDArray[np.bool_]


def stretches_of(scene: Scene, branch: Branch, low: float, high: float) -> Stretches:
    """Stretches between two heights."""
    return _stretches(branch, scene.modulus, np.array(scene.all_separations).tobytes(), low, high)


@kept  # the cells and the rows on them ask for the same
def _stretches(branch: Branch, grading: Grading, separations: bytes, low: float, high: float) -> Stretches:
    h = np.frombuffer(separations)
    found = branch.regimes(grading, h, low, high)
    inside = (found.low > low) | (h[found.separation] >= low)
    at = h[found.separation]
    left = branch.left(at, found.low - at, grading(found.low))
    nothing, begin = np.abs(left) <= _NOTHING, found.low - left  # on a separation, but for rounding
    last = np.nextafter(found.high, -np.inf)
    dwindling = np.abs(branch.left(at, last - at, grading(last))) <= _NOTHING
    follows = (found.low[1:] <= found.high[:-1]) & (np.diff(found.separation) == 0)
    return Stretches(
        separation=found.separation,
        low=np.where(inside, found.low, -np.inf),
        high=np.where(found.high < high, found.high, np.inf),
        piece=found.piece,
        begins=inside & nothing & ~np.append(False, follows)[: at.size],
        root=np.where(nothing, found.low, np.where(np.abs(begin - at) <= _NOTHING, at, begin)),
        lost=dwindling & (found.high < high) & (found.low < last),
    )


def begins_and_breaks(scene: Scene, low: float, high: float) -> tuple[Array, Array]:
    """Heights where contacts begin, and those that must be edges of cells besides.

    Parameters
    ----------
    scene : Scene
        With any contact law.
    low, high : float
        Range of reduced heights.

    Returns
    -------
    (ndarray, ndarray)
        Increasing; formulas are singular next to the first ones. Hertz's law has only those at separations.
    """
    begins, breaks = [np.array(scene.all_separations)], []
    for branch in scene.ways.among(scene.quantities):
        found = stretches_of(scene, branch, low, high)
        starts, pieces = found.low[found.begins], found.piece[found.begins]
        begins.append(found.root)
        breaks += [found.low, found.high]
        rough = (pieces > 0) | (not branch.law.root)
        breaks.append(starts[rough] + SMALLEST)
    edges = np.unique(np.concatenate([np.empty(0), *breaks]))
    return np.unique(np.concatenate(begins)), edges[np.isfinite(edges)]


def losses(scene: Scene, low: float, high: float) -> Array:
    """Heights towards which contacts dwindle to nothing, increasing."""
    if scene.hertzian:
        return np.empty(0)
    found = [stretches_of(scene, branch, low, high) for branch in scene.ways.among(scene.quantities)]
    return np.unique(np.concatenate([np.empty(0), *(each.high[each.lost] for each in found)]))
