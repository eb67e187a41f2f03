"""How many asperities fall into each cell: drawn exactly, by NumPy's generator.

The number in contact is binomial (fixed N) or Poisson. Given that number, those of the cells are
multinomial: from the highest cell down, so that each probability is accurate however far into the tail.
"""

from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.sampling.cells import Mesh
from mcgw.scene.scene import Scene

GROUP = 64  # surfaces whose numbers come from one generator of NumPy, which takes longer to make
_RARE = 1e-8  # below, binomial and Poisson differ less than 1 - p is rounded


@dataclass(frozen=True)
class Counts:
    """Numbers of asperities of a block of surfaces."""

    cells: Ints  # in each cell, shape (cells, surfaces)
    low_extras: Ints  # in contact, below all cells, shape (surfaces,)
    high_extras: Ints  # and above them


def counts_of(scene: Scene, mesh: Mesh, first: int, n: int) -> Counts:
    """Draw how many asperities of each cell the surfaces `first` ... `first + n - 1` have.

    A pure function of the seed of the scene and the number of the surface.
    """
    probability = np.concatenate([[mesh.low_extras], mesh.probability, [mesh.high_extras]])
    n_asperities, touching = scene.n_asperities, float(probability.sum())
    p = min(touching, 1.0)
    mantissa, exponent = np.frexp(probability[::-1] / (touching or 1.0))
    # To 44 bits: NumPy draws from the smaller side, and of two like cells a last digit would decide which.
    falling = np.ldexp(np.round(mantissa * 2.0**44) / 2.0**44, exponent)
    groups = range(first // GROUP, -(-(first + n) // GROUP))
    drawn = []
    for group in groups:
        rng = generator(scene.seed, 0, group)
        if scene.count == "fixed" and p >= _RARE:
            contacts = rng.binomial(n_asperities, p, GROUP)
        else:
            contacts = rng.poisson(n_asperities * p, GROUP)
            if scene.count == "fixed":
                contacts = np.minimum(contacts, n_asperities)
        drawn.append(rng.multinomial(contacts, falling))
    skip = first - groups[0] * GROUP
    numbers = np.ascontiguousarray(np.concatenate(drawn)[skip : skip + n, ::-1].T)
    return Counts(numbers[1:-1], numbers[0], numbers[-1])


def contacts_above(counts: Array, cells: Ints) -> Array:
    """Add up numbers in cells (cells, surfaces) from some lowest ones on: (surfaces, lowest ones)."""
    above = np.zeros((len(counts) + 1, counts.shape[1]))
    np.cumsum(counts[::-1], axis=0, out=above[-2::-1])
    return np.ascontiguousarray(above[cells].T)


def generator(seed: int, purpose: int, number: int) -> np.random.Generator:
    """NumPy's generator for one purpose and number, a pure function of these and the seed."""
    return np.random.Generator(np.random.Philox(key=seed, counter=[0, 0, number, purpose]))
