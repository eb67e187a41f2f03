"""Numbers shared out among the cells by halving.

Given the number in a node of a binary tree, that in its left child is binomial with the child's share. So
every probability is a ratio of sums of positive terms: accurate however far into the tail.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numba import uint64
from numpy.typing import NDArray

from analytic.arrays import Ints
from mcgw.machine.compiling import njit
from mcgw.sampling.binomial import SURFACES, TRIALS, WORDS, binomials
from mcgw.sampling.cells import Mesh

_BITS = 2.0**46  # of a probability: of a law of scipy.stats the last ones differ between kinds of CPU


@dataclass(frozen=True)
class Halvings:
    """How numbers are shared out, level by level from the root.

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


def share_out(seed: int, first: int, numbers: NDArray[np.float64], halvings: Halvings) -> Ints:
    """Share out numbers of contacts.

    Parameters
    ----------
    seed : int
        The scene's.
    first : int
        Number of the first surface.
    numbers : ndarray
        Of each surface, whole, at most 2^53; shape (surfaces,).
    halvings : Halvings
        Of the scene's mesh.

    Returns
    -------
    ndarray of int
        Shape (categories, surfaces): a pure function of the seed, the surface and its number.
    """
    tree = halvings.shares, halvings.turned, halvings.sizes
    return np.asarray(_share_out(np.uint64(seed), first, numbers, *tree))


@njit(nogil=True, cache=True)
def _share_out(seed: Any, first: Any, numbers: Any, shares: Any, turned: Any, sizes: Any) -> Any:
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
    """Write children in the place of their parents, from the last one on: none is lost."""
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
