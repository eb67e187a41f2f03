"""How many asperities fall into each cell: drawn exactly.

The number in contact is binomial (fixed N) or Poisson, by NumPy's generator. It is distributed among the
cells by halving: given the number in a node of a binary tree, that in its left child is binomial with the
child's share. So the cells are multinomial, or independent Poisson, and every probability is a ratio of sums
of positive terms: accurate however far into the tail.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numba import uint64
from numpy.typing import NDArray

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.sampling.binomial import SURFACES, TRIALS, WORDS, binomials
from mcgw.sampling.cells import Mesh
from mcgw.scene.scene import Scene

GROUP = 64  # surfaces whose total numbers come from one generator of NumPy, which takes longer to make
_RARE = 1e-8  # below, binomial and Poisson differ less than 1 - p is rounded
_BITS = 2.0**46  # of a probability: of a law of scipy.stats the last ones differ between kinds of CPU


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
    numbers, seed = _touching(scene, halvings.touching, first, n), np.uint64(scene.seed)
    drawn = _share_out(seed, first, numbers, halvings.shares, halvings.turned, halvings.sizes)
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
    asperities, drawn = scene.n_asperities, []
    for group in groups:
        rng = generator(scene.seed, 0, group)
        if scene.count == "poisson":
            drawn.append(rng.poisson(asperities * p, GROUP))
        elif p >= _RARE:
            drawn.append(rng.binomial(asperities, p, GROUP))
        else:
            drawn.append(np.minimum(rng.poisson(asperities * p, GROUP), asperities))
    skip = first - groups[0] * GROUP
    return np.concatenate(drawn).astype(np.float64)[skip : skip + n]


@dataclass(frozen=True)
class Halvings:
    """How numbers are distributed, level by level from the root.

    Parameters
    ----------
    touching : float
        Probability of all.
    shares : ndarray
        Of the rarer child in its parent, for all parents of all levels.
    turned : ndarray of bool
        Where the right child is the rarer one, alike.
    sizes : ndarray of int
        Number of nodes on each level below the root.
    """

    touching: float
    shares: NDArray[np.float64]
    turned: NDArray[np.bool_]
    sizes: Ints


@lru_cache(maxsize=8)
def halvings_of(mesh: Mesh) -> Halvings:
    """Prepare to share out the contacts of a mesh.

    Parameters
    ----------
    mesh : Mesh
        The scene's.

    Returns
    -------
    Halvings
        Its categories are the low extras, each cell, and the high extras.
    """
    probability = np.concatenate([[mesh.low_extras], mesh.probability, [mesh.high_extras]])
    shares, turned, sizes = [np.empty(0)], [np.empty(0, dtype=bool)], []
    while len(probability) > 1:
        sizes.append(len(probability))
        pairs = np.concatenate([probability, np.zeros(len(probability) % 2)])
        left, right = pairs[::2], pairs[1::2]
        probability = left + right
        total = np.where(probability > 0, probability, 1.0)
        shares.append(_rounded(np.minimum(left, right) / total))
        turned.append(_rounded(left / total) > 0.5)
    touching = float(_rounded(np.minimum(probability[0], 1.0)))
    levels = np.array(sizes[::-1], dtype=np.int64)
    return Halvings(touching, np.concatenate(shares[::-1]), np.concatenate(turned[::-1]), levels)


def _rounded(p: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round to 46 bits: a half must be a half, where the rarer one and the other change places."""
    mantissa, exponent = np.frexp(p)
    return np.asarray(np.ldexp(np.rint(mantissa * _BITS) / _BITS, exponent))


@njit(cache=True)
def _share_out(seed: Any, first: Any, numbers: Any, shares: Any, turned: Any, sizes: Any) -> Any:
    """Share out numbers of contacts.

    Parameters
    ----------
    seed : uint64
        The scene's.
    first : int
        Number of the first surface.
    numbers : ndarray
        Of each surface, whole, at most 2^53; shape (surfaces,).
    shares, turned, sizes : ndarray
        Of the `Halvings` of the scene's mesh.

    Returns
    -------
    ndarray of int
        Shape (categories, surfaces): a pure function of the seed, the surface and its number.
    """
    result = np.empty((sizes[-1], numbers.size), dtype=np.int64)
    for start in range(0, numbers.size, SURFACES):
        stop = min(start + SURFACES, numbers.size)
        node = np.empty((sizes[-1] + 1, stop - start))
        for i in range(start, stop):  # in one step it takes 2 s to compile: the text of its errors
            node[0, i - start] = numbers[i]
        _halve(node, uint64(first + start), seed, shares, turned, sizes)
        for category in range(sizes[-1]):
            for i in range(start, stop):
                result[category, i] = node[category, i - start]
    return result


@njit()
def _halve(node: Any, first: Any, seed: Any, shares: Any, turned: Any, sizes: Any) -> None:
    """Write children in place of their parents, from the last one on: none is lost."""
    surfaces = node.shape[1]
    work, parents = np.empty(WORDS), 0
    for size in sizes:
        for parent in range((size - 1) // 2, -1, -1):
            which = parents + parent
            for i in range(surfaces):
                work[TRIALS + i] = node[parent, i]
            binomials(work, surfaces, shares[which], seed, first, uint64(which))
            rarer = 2 * parent + turned[which]
            other = 4 * parent + 1 - rarer
            for i in range(surfaces):
                node[rarer, i] = work[i]
                node[other, i] = work[TRIALS + i] - work[i]
        parents += (size + 1) // 2
