"""How many asperities make a crowd: the fewest whose Gaussian moments keep the laws of all values.

Given the numbers in the cells, what a crowded cell of n asperities adds to a value has the third and fourth
cumulants n k3 and n k4, and its Gaussian limit has none. Edgeworth's expansion of the distribution function
of the value, whose standard deviation is sigma, then misses

    (x^2 - 1) phi(x) K3/6 + (x^3 - 3x) phi(x) K4/24 + (x^5 - 10x^3 + 15x) phi(x) K3^2/72

with K3 and K4 the sums over the crowded cells, over sigma^3 and sigma^4 (Petrov, "Sums of Independent
Random Variables", 1975, VI.1): what the theorem of Berry and Esseen bounds. The largest of each term,
doubled, is held against what may be spent. The distance itself is half of it
(`tests/oracles/law_of_crowds.py`).
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import pdtr, pdtrc

from analytic import quantity_of
from analytic.arrays import Array
from analytic.quadrature import gauss_legendre
from mcgw.sampling.cells import Mesh
from mcgw.sampling.direct import asperity_sums
from mcgw.sampling.drawn_moments import CROWDED
from mcgw.sampling.rules import product
from mcgw.scene.scene import Scene

_MOST = 2**24  # of a crowd; fewer than CROWDED are as quickly drawn one by one
_TOGETHER = 16  # cells whose laws are in memory
_THIRD, _FOURTH, _SQUARED = 0.3990 / 6, 0.5506 / 24, 2.3071 / 72  # the largest of the three terms
_SAFELY = 2.0
_U, _W = gauss_legendre(24)


@dataclass(frozen=True)
class Crowding:
    """A threshold, and what it costs.

    Parameters
    ----------
    threshold : int
        Asperities in a cell, from which its moments count as Gaussian.
    distance : float
        From the exact law of any value: largest difference of distribution functions.
    alone : float
        Asperities of a surface that are expected in cells with fewer.
    """

    threshold: int
    distance: float
    alone: float


def crowding(scene: Scene, mesh: Mesh) -> Crowding | None:
    """Return the smallest crowd that keeps the laws of all values to `scene.accuracy`.

    Parameters
    ----------
    scene : Scene
        What to simulate.
    mesh : Mesh
        Its cells.

    Returns
    -------
    Crowding or None
        None if no crowd is large enough, or there is no cell.
    """
    if not mesh.size:
        return None
    variance, third, fourth = _cumulants(scene, mesh)
    expected = scene.n_asperities * mesh.probability
    threshold = CROWDED
    while threshold <= _MOST:
        crowded = expected * pdtrc(threshold - 2, expected)  # n P(n - 1 crowd at least) = E[n; n a crowd]
        found = _distance(variance, product(crowded, third), product(crowded, fourth))
        if found <= scene.accuracy:
            return Crowding(threshold, found, float((expected * pdtr(threshold - 2, expected)).sum()))
        threshold *= 2
    return None


def _cumulants(scene: Scene, mesh: Mesh) -> tuple[Array, Array, Array]:
    """Variance of each value of a surface; third and fourth cumulants of one asperity in each cell.

    Shapes (values,) and (cells, values), without values that are counted.
    """
    first = second = np.zeros(1)
    thirds: list[Array] = []
    fourths: list[Array] = []
    for start in range(0, mesh.size, _TOGETHER):
        cells = np.arange(start, min(start + _TOGETHER, mesh.size))
        heights = mesh.edges[cells] + np.stack([mesh.offsets(cells, np.full(len(cells), v)) for v in _U])
        values = _values(scene, heights.T.ravel()).reshape(len(cells), len(_U), -1)
        mean = np.einsum("u,cuv->cv", _W, values)
        apart = values - mean[:, None]
        square, cube, biquadrate = (np.einsum("u,cuv->cv", _W, apart**power) for power in (2, 3, 4))
        thirds.append(cube)
        fourths.append(biquadrate - 3 * square**2)
        share = mesh.probability[cells]
        first = first + product(share, mean)
        second = second + product(share, square + mean**2)
    fixed = first**2 if scene.count == "fixed" else np.zeros(1)
    return scene.n_asperities * (second - fixed), np.concatenate(thirds), np.concatenate(fourths)


def _values(scene: Scene, heights: Array) -> Array:
    """Return what single asperities add to every value that is not counted, reduced: (heights, values)."""
    one = np.ones(len(heights))
    sums = asperity_sums(scene, one.astype(np.int64), heights, one)
    parts = [
        part / quantity_of(name).scale(scene.surface)  # its fourth power is a number
        for name, part in sums.items()
        if not quantity_of(name).counts
    ]
    return np.concatenate([np.empty((len(heights), 0)), *parts], axis=1)


def _distance(variance: Array, third: Array, fourth: Array) -> float:
    """Bound of the three terms, of the value that is farthest off."""
    some = variance > 0
    k3, k4 = np.abs(third[some]) / variance[some] ** 1.5, np.abs(fourth[some]) / variance[some] ** 2
    return float(_SAFELY * (_THIRD * k3 + _FOURTH * k4 + _SQUARED * k3**2).max(initial=0.0))
