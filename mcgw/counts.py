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
    probability = np.concatenate([[mesh.low_extras], mesh.probability, [mesh.high_extras]])
    groups = range(first // GROUP, -(-(first + n) // GROUP))
    with ThreadPoolExecutor(get_num_threads()) as pool:  # NumPy draws without Python's lock
        drawn = np.concatenate(list(pool.map(partial(_group, scene, probability), groups)), axis=1)
    skip = first - groups[0] * GROUP
    chosen = drawn[:, skip : skip + n]
    return Counts(np.ascontiguousarray(chosen[1:-1]), chosen[0], chosen[-1], np.ones(len(probability)))


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


def _group(scene: Scene, probability: NDArray[np.float64], group: int) -> Ints:
    """Numbers of a group of surfaces: shape (categories, GROUP)."""
    rng = generator(scene.seed, 0, group)
    sums = [probability]
    while len(sums[-1]) > 1:
        p = np.concatenate([sums[-1], np.zeros(len(sums[-1]) % 2)])
        sums.append(p[::2] + p[1::2])
    touching = float(_rounded(np.minimum(sums[-1][0], 1.0)))
    numbers = np.full((1, GROUP), scene.n_asperities)
    if scene.count == "poisson":
        numbers = rng.poisson(scene.n_asperities * touching, (1, GROUP))
    else:
        numbers = _binomial(rng, numbers, np.array([[touching]]))
    for p in reversed(sums[:-1]):
        pairs = np.concatenate([p, np.zeros(len(p) % 2)])
        numbers = _halve(rng, numbers, pairs[::2], pairs[1::2])[: len(p)]
    return numbers


def _halve(
    rng: np.random.Generator, numbers: Ints, left: NDArray[np.float64], right: NDArray[np.float64]
) -> Ints:
    """Share numbers among left and right children; the rarer side is drawn."""
    total = np.where(left + right > 0, left + right, 1.0)
    rarer = _binomial(rng, numbers, _rounded(np.minimum(left, right) / total)[:, None])
    other = numbers - rarer
    left_is_rarer = (_rounded(left / total) <= 0.5)[:, None]
    both = np.empty((2 * len(numbers), numbers.shape[1]), dtype=np.int64)
    both[::2] = np.where(left_is_rarer, rarer, other)
    both[1::2] = np.where(left_is_rarer, other, rarer)
    return both


def _rounded(p: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round to 46 bits: a half must be a half, where rarer and other, or NumPy's methods, change places."""
    mantissa, exponent = np.frexp(p)
    return np.asarray(np.ldexp(np.rint(mantissa * _BITS) / _BITS, exponent))


def _binomial(rng: np.random.Generator, n: Ints, p: NDArray[np.float64]) -> Ints:
    """Binomial numbers; Poisson ones where p is so small that NumPy's 1 - p would lose it."""
    p = np.broadcast_to(p, n.shape)
    usual = rng.binomial(n, np.where(p < _RARE, 0.0, p))
    if not np.any((p < _RARE) & (p > 0)):
        return usual
    return np.where(p < _RARE, np.minimum(rng.poisson(n * np.where(p < _RARE, p, 0.0)), n), usual)
