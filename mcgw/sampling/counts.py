"""How many asperities fall into each cell: drawn exactly, by halving.

The number in contact is binomial (fixed N) or Poisson; given that of a node, the number in its left
child is binomial with the child's share. So the cells are multinomial, or independent Poisson, with
every probability a ratio of sums of positive terms: accurate however far into the tail.
"""

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mcgw.sampling.cells import Mesh
from mcgw.sampling.in_threads import in_threads
from mcgw.scene import Scene

__all__ = ["Counts", "counts_of", "generator", "strata_of"]

Ints = NDArray[np.int64]

GROUP = 64  # surfaces that share a NumPy generator, which takes longer to make than to use
_BITS = 2.0**46  # of a probability: the last ones differ between kinds of CPU
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
    halvings = _halvings(np.concatenate([[mesh.low_extras], mesh.probability, [mesh.high_extras]]))
    groups = range(first // GROUP, -(-(first + n) // GROUP))
    drawn = np.concatenate(in_threads(partial(_group, scene, halvings), groups), axis=1)
    skip = first - groups[0] * GROUP
    chosen = drawn[:, skip : skip + n]
    weights = np.ones(mesh.size + 2)
    return Counts(np.ascontiguousarray(chosen[1:-1]), chosen[0], chosen[-1], weights)


def strata_of(scene: Scene, mesh: Mesh, n: int) -> Counts:
    """Number of strata in each cell: the expected number of asperities, and enough in the tail.

    The last of N equal strata has no upper end, and its asperity alone makes an error of order 1/N.
    So every cell gets at least half of an equal share, with weights that keep the means exact.

    Parameters
    ----------
    scene : Scene
        Its number of asperities is used.
    mesh : Mesh
        The scene's.
    n : int
        Number of surfaces, all alike.

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


def generator(seed: int, purpose: int, number: int) -> np.random.Generator:
    """NumPy's generator for one purpose and number, a pure function of these and the seed."""
    return np.random.Generator(np.random.Philox(key=seed, counter=[0, 0, number, purpose]))


@dataclass(frozen=True)
class _Halvings:
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


def _halvings(probability: NDArray[np.float64]) -> _Halvings:
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
    return _Halvings(touching, np.concatenate(shares[::-1]), np.concatenate(turned[::-1]), levels)


def _rounded(p: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round to 46 bits: a half must be a half, where rarer and other, or NumPy's methods, change places."""
    mantissa, exponent = np.frexp(p)
    return np.asarray(np.ldexp(np.rint(mantissa * _BITS) / _BITS, exponent))


def _group(scene: Scene, halvings: _Halvings, group: int) -> Ints:
    """Numbers of a group of surfaces: shape (categories, GROUP)."""
    rng = generator(scene.seed, 0, group)
    n, p = scene.n_asperities, halvings.touching
    numbers = rng.poisson(n * p, GROUP) if scene.count == "poisson" else _all_touching(rng, n, p)
    return np.asarray(_share_out(rng, numbers, halvings.shares, halvings.turned, halvings.sizes))


@njit(nogil=True, cache=True)
def _all_touching(rng: Any, n: Any, p: Any) -> Any:
    numbers = np.empty(GROUP, dtype=np.int64)
    for i in range(GROUP):
        numbers[i] = _binomial(rng, n, p)
    return numbers


@njit(nogil=True, cache=True)
def _share_out(rng: Any, numbers: Any, shares: Any, turned: Any, sizes: Any) -> Any:
    """Halve the numbers, level by level."""
    parents = numbers.copy().reshape(1, numbers.size)
    parent = 0
    for size in sizes:
        children = np.empty((size, numbers.size), dtype=np.int64)
        for left in range(0, size, 2):
            for i in range(numbers.size):
                n = parents[left // 2, i]
                rarer = _binomial(rng, n, shares[parent])
                first = n - rarer if turned[parent] else rarer
                children[left, i] = first
                if left + 1 < size:
                    children[left + 1, i] = n - first
            parent += 1
        parents = children
    return parents


@njit(nogil=True, cache=True)
def _binomial(rng: Any, n: Any, p: Any) -> Any:
    """Binomial number; a Poisson one where p is so small that NumPy's 1 - p would lose it."""
    if n == 0 or p == 0.0:
        return 0
    return rng.binomial(n, p) if p >= _RARE else min(rng.poisson(n * p), n)
