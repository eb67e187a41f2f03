"""How many asperities fall into each cell: drawn exactly.

The number in contact is binomial (fixed N) or Poisson, by NumPy's generator. It is shared out by
halving (`mcgw.sampling.halving`), so the cells are multinomial, or independent Poisson.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array, Ints
from mcgw.sampling.cells import Mesh
from mcgw.sampling.halving import halvings_of, share_out
from mcgw.scene.scene import Scene

GROUP = 64  # surfaces whose total numbers come from one generator of NumPy, which takes longer to make
_RARE = 1e-8  # below, binomial and Poisson differ less than 1 - p is rounded


@dataclass(frozen=True)
class Counts:
    """Numbers of asperities of a block of surfaces.

    Parameters
    ----------
    cells : ndarray of int
        In each cell, shape (cells, surfaces).
    low_extras, high_extras : ndarray of int
        In contact, below and above all cells, shape (surfaces,).
    weights : ndarray
        For how many asperities one drawn in the low extras, each cell, the high extras stands.
    """

    cells: Ints
    low_extras: Ints
    high_extras: Ints
    weights: NDArray[np.float64]


def counts_of(scene: Scene, mesh: Mesh, first: int, n: int) -> Counts:
    """Draw the numbers of surfaces `first` ... `first + n - 1`.

    Parameters
    ----------
    scene : Scene
        Its seed, number of asperities and law of that number are used.
    mesh : Mesh
        The scene's.
    first, n : int
        Which surfaces.

    Returns
    -------
    Counts
        A pure function of the seed and the number of the surface.
    """
    halvings = halvings_of(mesh)
    drawn = share_out(scene.seed, first, _touching(scene, halvings.touching, first, n), halvings)
    weights = np.ones(mesh.size + 2)
    return Counts(np.ascontiguousarray(drawn[1:-1]), drawn[0], drawn[-1], weights)


def strata_of(scene: Scene, mesh: Mesh, first: int, n: int) -> Counts:  # noqa: ARG001 - all are alike
    """Number of strata in each cell: the expected number of asperities, and enough in the tail.

    The last of N equal strata has no upper end, and its asperity alone makes an error of order 1/N.
    So every cell gets at least half of an equal share, with weights that keep the means exact.

    Parameters
    ----------
    scene : Scene
        Its number of asperities is used.
    mesh : Mesh
        The scene's.
    first, n : int
        Which surfaces; all are alike.

    Returns
    -------
    Counts
        The same for every surface.
    """
    probability = np.concatenate([[mesh.low_extras], mesh.probability, [mesh.high_extras]])
    expected = scene.n_asperities * probability
    numbers = np.ceil(np.maximum(expected, expected.sum() / (2 * len(expected)))).astype(np.int64)
    weights = expected / np.maximum(numbers, 1)
    alike = np.repeat(numbers[:, None], n, axis=1)
    return Counts(np.ascontiguousarray(alike[1:-1]), alike[0], alike[-1], weights)


def contacts_above(counts: Array, cells: Ints) -> Array:
    """Number of asperities in some cells and all those above.

    Parameters
    ----------
    counts : ndarray
        In each cell, shape (cells, surfaces).
    cells : ndarray of int
        Lowest ones.

    Returns
    -------
    ndarray
        Shape (surfaces, lowest ones).
    """
    above = np.zeros((len(counts) + 1, counts.shape[1]))
    np.cumsum(counts[::-1], axis=0, out=above[-2::-1])
    return np.ascontiguousarray(above[cells].T)


def generator(seed: int, purpose: int, number: int) -> np.random.Generator:
    """NumPy's generator for one purpose and number, a pure function of these and the seed."""
    return np.random.Generator(np.random.Philox(key=seed, counter=[0, 0, number, purpose]))


def _touching(scene: Scene, p: float, first: int, n: int) -> Array:
    """Numbers in contact of surfaces `first` ... `first + n - 1`, by NumPy's generator."""
    groups = range(first // GROUP, -(-(first + n) // GROUP))
    drawn = [_group(scene, p, generator(scene.seed, 0, group)) for group in groups]
    skip = first - groups[0] * GROUP
    return np.concatenate(drawn).astype(np.float64)[skip : skip + n]


def _group(scene: Scene, p: float, rng: np.random.Generator) -> Ints:
    n = scene.n_asperities
    if scene.count == "poisson":
        return rng.poisson(n * p, GROUP)
    return rng.binomial(n, p, GROUP) if p >= _RARE else np.minimum(rng.poisson(n * p, GROUP), n)
