"""All heights, by NumPy's generator, and plain loops: the witness against the other samplers.

Sums over given heights, by the formula of each contact: slow, literal, trusted.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from analytic.arrays import Array
from mcgw.machine.compiling import njit
from mcgw.sampling.block import Sampler, Sums
from mcgw.scene.scene import Scene

COUNTS, _HEIGHTS = 0, 1  # purposes of NumPy's generator
_PIECE = 2**20  # heights at a time


def generator(seed: int, purpose: int, number: int) -> np.random.Generator:
    """NumPy's generator for one purpose and number, a pure function of these and the seed."""
    return np.random.Generator(np.random.Philox(key=seed, counter=[0, 0, number, purpose]))


@dataclass(frozen=True)
class Direct(Sampler):
    """Draws every asperity of every surface."""

    @property
    def words(self) -> int:
        """One surface at a time."""
        return 0

    @property
    def draws(self) -> float:
        """Numbers drawn for a surface."""
        return float(self.scene.n_asperities)

    def block(self, first: int, n: int) -> Sums:
        """Results of surfaces `first` ... `first + n - 1`."""
        rows = [self._surface(number) for number in range(first, first + n)]
        return {name: np.concatenate([row[name] for row in rows]) for name in rows[0]}

    def asperities(self, number: int) -> Iterator[tuple[Array, Array | None]]:
        """Heights of all asperities of a surface, and ratios of their radii, some at a time."""
        scene = self.scene
        rng = generator(scene.seed, _HEIGHTS, number)
        left = scene.n_asperities if scene.count == "fixed" else int(rng.poisson(scene.n_asperities))
        most = left if scene.as_measured else _PIECE
        while left:
            now = min(left, most)
            left -= now
            yield self._summits(rng, now)

    def _surface(self, number: int) -> dict[str, Array]:
        scene = self.scene
        total = asperity_sums(scene, np.array([0]), np.empty(0), np.empty(0))
        for s, ratios in self.asperities(number):
            sums = asperity_sums(scene, np.array([s.size]), s, np.ones(s.size), ratios)
            for name, value in sums.items():
                total[name] += value
        return total

    def _summits(self, rng: np.random.Generator, n: int) -> tuple[Array, Array | None]:
        """Heights of so many summits, and ratios of their radii where they have their own."""
        if self.scene.summits:
            return self.scene.summits.summits(rng, n)
        return self.scene.heights.rvs(n, rng), None


def asperity_sums(
    scene: Scene, numbers: NDArray[np.int64], heights: Array, weights: Array, ratios: Array | None = None
) -> dict[str, Array]:
    """Load, area, ... of surfaces whose heights are given.

    Parameters
    ----------
    scene : Scene
        Its surface, grading, contact law, separations and quantities are used.
    numbers : ndarray of int
        How many of the heights belong to each surface, shape (surfaces,).
    heights : ndarray
        The reduced heights of all surfaces, one after the other.
    weights : ndarray
        For how many asperities each height stands: 1 in an ensemble.
    ratios : ndarray, optional
        The radius of each over that of the surface, where summits have their own.

    Returns
    -------
    dict of str to ndarray
        Each quantity in SI units, shape (surfaces, separations).
    """
    if scene.hertzian:
        return _hertz_sums(scene, numbers, heights, weights, ratios)
    surface = np.repeat(np.arange(len(numbers)), numbers)
    touching = heights > scene.lowest
    surface, s, weight = surface[touching], heights[touching], weights[touching]
    e, own = scene.modulus(s), None if ratios is None else ratios[touching]
    sums = {}
    for name in scene.quantities:
        branch = scene.ways.of(name).with_radii(own)
        terms = (branch.terms([name], h, s, e)[0] for h in scene.separations)
        rows = np.stack([np.bincount(surface, weight * one, len(numbers)) for one in terms], axis=1)
        sums[name] = np.asarray(quantity_of(name).scale(scene.surface) * rows, dtype=np.float64)
    return sums


@njit(cache=True, inline="always")
def _power(d: float, twice: int) -> float:
    """``d**(twice/2)`` by roots and products, which every processor rounds alike."""
    power = np.sqrt(d) if twice % 2 else 1.0
    for _ in range(twice // 2):
        power *= d
    return power


@njit(cache=True)
def _sums(starts: Any, heights: Any, factors: Any, separations: Any, twice: Any) -> Any:
    """For each quantity, surface and separation the sum of ``factor (s - h)^(twice/2)`` over s > h."""
    surfaces = starts.size - 1
    result = np.zeros((twice.size, surfaces, separations.size))
    for i in range(surfaces):
        if starts[i] == starts[i + 1]:
            continue
        for q in range(twice.size):
            exponent = twice[q]
            for k in range(separations.size):
                total = 0.0
                for j in range(starts[i], starts[i + 1]):
                    d = heights[j] - separations[k]
                    if d > 0.0:
                        total += factors[q, j] * _power(d, exponent)
                result[q, i, k] = total
    return result


def _hertz_sums(
    scene: Scene, numbers: NDArray[np.int64], heights: Array, weights: Array, ratios: Array | None = None
) -> dict[str, Array]:
    """As `asperity_sums`, of Hertz contacts, by plain loops."""
    asked = [quantity_of(name) for name in scene.quantities]
    graded = weights
    if any(q.modulus for q in asked):
        graded = weights * scene.modulus(heights)
    factors = np.stack([graded if q.modulus else weights for q in asked])
    if ratios is not None:
        of_radius = {0.0: np.ones_like(ratios), 0.5: np.sqrt(ratios), 1.0: ratios}
        factors *= np.stack([of_radius[q.radius] for q in asked])
    sums = _sums(
        np.concatenate([[0], np.cumsum(numbers)]),
        heights,
        factors,
        np.array(scene.separations),
        np.array([round(2 * q.exponent) for q in asked]),
    )
    for q, values in zip(asked, sums, strict=True):
        values *= q.scale(scene.surface)
    return dict(zip(scene.quantities, sums, strict=True))
