"""What every sampler has, and what it gives; and which moments of each cell a surface keeps."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array
from mcgw.sampling.cells import Mesh
from mcgw.scene.scene import Scene


@dataclass(frozen=True)
class Layout:
    """Which moments a surface keeps."""

    plain: NDArray[np.int64]  # how many T_j each cell has
    rooted: NDArray[np.int64]  # how many R_j

    @property
    def sizes(self) -> NDArray[np.int64]:
        """Moments of each cell."""
        return self.plain + self.rooted

    @property
    def starts(self) -> NDArray[np.int64]:
        """First row of each cell, and the number of all rows."""
        return np.concatenate([[0], np.cumsum(self.plain + self.rooted)])

    def at_most(self, other: "Layout") -> "Layout":
        """No more than another one has."""
        return Layout(np.minimum(self.plain, other.plain), np.minimum(self.rooted, other.rooted))

    @classmethod
    def covering(cls, layouts: Sequence["Layout"]) -> "Layout":
        """Return the moments that any of some layouts of the same cells has."""
        return cls(
            np.max([layout.plain for layout in layouts], axis=0),
            np.max([layout.rooted for layout in layouts], axis=0),
        )

    def rows_of(self, part: "Layout") -> NDArray[np.int64]:
        """Where the rows of a layout lie in this one, which covers it."""
        first = np.stack([self.starts[:-1], self.starts[:-1] + self.plain], axis=1).ravel()
        size = np.stack([part.plain, part.rooted], axis=1).ravel()
        return np.repeat(first - np.cumsum(size) + size, size) + np.arange(size.sum())


Sums = dict[str, Array]  # of some consecutive surfaces each quantity, SI, shape (surfaces, separations)
Drawn = TypeVar("Drawn", covariant=True)

_WORDS = 12  # numbers in memory for an asperity drawn by itself


class Source(Protocol[Drawn]):
    """Whatever draws surfaces by their numbers."""

    @property
    def words(self) -> int:
        """Numbers in memory for a surface while it is drawn, besides the results of one scene."""
        ...

    @property
    def draws(self) -> float:
        """Numbers that are expected to be drawn for a surface."""
        ...

    def block(self, first: int, n: int) -> Drawn:
        """Results of surfaces `first` ... `first + n - 1`: the same in any block."""
        ...


@dataclass(frozen=True)
class Sampler:
    """Draws surfaces of a scene: in cells, and one by one beside them, unless a sampler says otherwise."""

    name: str  # one of `mcgw.scene.ensemble.SAMPLERS`, never "auto"
    scene: Scene  # what to simulate
    mesh: Mesh  # its cells; with none, every asperity is drawn by itself

    @property
    def distance(self) -> float:
        """Distance of the laws of its values from the exact ones; nan if nobody knows."""
        return 0.0

    @property
    def cells(self) -> int:
        """Number of its cells."""
        return self.mesh.size

    @property
    def moments(self) -> int:
        """Numbers that it keeps of a surface besides those of the asperities in each cell."""
        return 0

    @property
    def words(self) -> int:
        """Return the memory for one surface, in numbers."""
        return self.moments + 2 * self.mesh.size + _WORDS * int(min(self.outside, 1e12))

    @property
    def draws(self) -> float:
        """Return the random numbers that a surface takes."""
        return self.outside + self.inside

    @property
    def inside(self) -> float:
        """Asperities of a surface that are expected in its cells."""
        return self.scene.n_asperities * float(self.mesh.probability.sum())

    @property
    def outside(self) -> float:
        """Asperities that are expected to be drawn by themselves."""
        return self.scene.n_asperities * (self.mesh.low_extras + self.mesh.high_extras)

    def block(self, first: int, n: int) -> Sums:
        """Results of surfaces `first` ... `first + n - 1`."""
        raise NotImplementedError
