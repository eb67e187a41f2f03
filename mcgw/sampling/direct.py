"""All heights, by NumPy's generator, and plain loops: the witness against the other samplers."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array
from mcgw.sampling.block import Block, Sampler
from mcgw.sampling.cells import no_cells
from mcgw.sampling.counts import generator
from mcgw.sampling.law_sums import asperity_sums
from mcgw.scene.scene import Scene

_PURPOSE = 1  # of NumPy's generator; the counts have 0
_PIECE = 2**20  # heights at a time


@dataclass(frozen=True)
class Direct(Sampler):
    """Draws every asperity of every surface."""

    @classmethod
    def of(cls, scene: Scene) -> "Direct":
        """Prepare it."""
        return cls("direct", scene, no_cells(scene))

    @property
    def words(self) -> int:
        """One surface at a time."""
        return 0

    @property
    def draws(self) -> float:
        """Numbers drawn for a surface."""
        return float(self.scene.n_asperities)

    def block(self, first: int, n: int) -> Block:
        """Results of surfaces `first` ... `first + n - 1`."""
        rows = [self._surface(number) for number in range(first, first + n)]
        return Block({name: np.concatenate([row[name] for row in rows]) for name in rows[0]})

    def asperities(self, number: int) -> Iterator[tuple[Array, Array | None]]:
        """Heights of all asperities of a surface, and ratios of their radii, some at a time."""
        scene = self.scene
        rng = generator(scene.seed, _PURPOSE, number)
        left = scene.n_asperities if scene.count == "fixed" else int(rng.poisson(scene.n_asperities))
        most = left if scene.nominal or scene.as_measured else _PIECE
        while left:
            now = min(left, most)
            left -= now
            yield self._summits(rng, now)

    def _surface(self, number: int) -> dict[str, Array]:
        scene = self.scene
        if scene.nominal:
            return self._balanced(number, *next(self.asperities(number), (np.empty(0), None)))
        total = asperity_sums(scene, np.array([0]), np.empty(0), np.empty(0))
        for s, ratios in self.asperities(number):
            sums = asperity_sums(scene, np.array([s.size]), s, np.ones(s.size), ratios)
            for name, value in sums.items():
                total[name] += value
        return total

    def _summits(self, rng: np.random.Generator, n: int) -> tuple[Array, Array | None]:
        """Heights of so many summits, and ratios of their radii where they have their own."""
        if self.scene.curvature:
            return self.scene.curvature.summits(rng, n)
        return self.scene.heights.rvs(n, rng), None

    def _balanced(self, number: int, heights: Array, ratios: Array | None) -> dict[str, Array]:
        """The surface at the separations that its asperities feel."""
        from mcgw.sampling.nominal import balanced_sums  # for those scenes alone

        touching = heights > self.scene.lowest
        ratios = None if ratios is None else ratios[touching]
        return balanced_sums(self.scene, number, heights[touching], ratios)
