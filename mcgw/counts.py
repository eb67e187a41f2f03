"""How many asperities fall into each cell: drawn exactly, by halving.

The number in contact is binomial (fixed N) or Poisson; given that of a node, the number in its left
child is binomial with the child's share. So the cells are multinomial, or independent Poisson, with
every probability a ratio of sums of positive terms: accurate however far into the tail.
"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np
from numba import get_num_threads
from numpy.typing import NDArray

from mcgw.cells import Mesh
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
    with ThreadPoolExecutor(get_num_threads()) as pool:  # NumPy draws without Python's lock
        drawn = np.concatenate(list(pool.map(partial(_group, scene, halvings), groups)), axis=1)
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
    shares : tuple of ndarray
        Of the rarer child in its parent, for each level, shape (parents, 1).
    turned : tuple of ndarray of bool
        Where the right child is the rarer one, alike.
    sizes : tuple of int
        Number of children on each level: one less than twice the parents' where the last has one only.
    """

    touching: float
    shares: tuple[NDArray[np.float64], ...]
    turned: tuple[NDArray[np.bool_], ...]
    sizes: tuple[int, ...]


def _halvings(probability: NDArray[np.float64]) -> _Halvings:
    shares, turned, sizes = [], [], []
    while len(probability) > 1:
        sizes.append(len(probability))
        pairs = np.concatenate([probability, np.zeros(len(probability) % 2)])
        left, right = pairs[::2, None], pairs[1::2, None]
        probability = (left + right)[:, 0]
        total = np.where(left + right > 0, left + right, 1.0)
        shares.append(_rounded(np.minimum(left, right) / total))
        turned.append(_rounded(left / total) > 0.5)
    touching = float(_rounded(np.minimum(probability[0], 1.0)))
    return _Halvings(touching, tuple(shares[::-1]), tuple(turned[::-1]), tuple(sizes[::-1]))


def _group(scene: Scene, halvings: _Halvings, group: int) -> Ints:
    """Numbers of a group of surfaces: shape (categories, GROUP)."""
    rng = generator(scene.seed, 0, group)
    if scene.count == "poisson":
        numbers = rng.poisson(scene.n_asperities * halvings.touching, (1, GROUP))
    else:
        numbers = _binomial(rng, np.full((1, GROUP), scene.n_asperities), np.array([[halvings.touching]]))
    for share, turned, size in zip(halvings.shares, halvings.turned, halvings.sizes, strict=True):
        rarer = _binomial(rng, numbers, share)
        other = numbers - rarer
        children = np.empty((2 * len(numbers), GROUP), dtype=np.int64)
        children[::2] = np.where(turned, other, rarer)
        children[1::2] = np.where(turned, rarer, other)
        numbers = children[:size]
    return numbers


def _rounded(p: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round to 46 bits: a half must be a half, where rarer and other, or NumPy's methods, change places."""
    mantissa, exponent = np.frexp(p)
    return np.asarray(np.ldexp(np.rint(mantissa * _BITS) / _BITS, exponent))


def _binomial(rng: np.random.Generator, n: Ints, p: NDArray[np.float64]) -> Ints:
    """Binomial numbers; Poisson ones where p is so small that NumPy's 1 - p would lose it."""
    rare = p < _RARE
    usual = rng.binomial(n, np.where(rare, 0.0, p))
    if not np.any(rare & (p > 0)):
        return usual
    return np.where(rare, np.minimum(rng.poisson(n * np.where(rare, p, 0.0)), n), usual)
