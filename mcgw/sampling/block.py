"""What a sampler is, seen from outside, and what it gives."""

from dataclasses import dataclass
from typing import Protocol, TypeVar

from analytic.arrays import Array

Drawn = TypeVar("Drawn", covariant=True)


@dataclass(frozen=True)
class Block:
    """Results of some consecutive surfaces.

    Parameters
    ----------
    sums : dict of str to ndarray
        Each quantity in SI units, shape (surfaces, separations).
    moments : ndarray or None
        Of all cells, shape (surfaces, moments), where the sampler has cells.
    counts : ndarray or None
        Asperities in each cell, shape (surfaces, cells).
    extras : ndarray or None
        Rows (surface, height, weight) of the asperities outside the cells.
    """

    sums: dict[str, Array]
    moments: Array | None = None
    counts: Array | None = None
    extras: Array | None = None


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


class Sampler(Source[Block], Protocol):
    """Draws the surfaces of a scene."""

    @property
    def name(self) -> str:
        """One of `mcgw.scene.samplers.SAMPLERS`, never "auto"."""
        ...

    @property
    def cells(self) -> int:
        """Number of its cells; 0 if it has none."""
        ...

    @property
    def moments(self) -> int:
        """Numbers that it keeps of a surface besides those of the asperities in each cell."""
        ...

    @property
    def seconds_per_draw(self) -> float:
        """Very roughly."""
        ...

    def with_seed(self, seed: int) -> "Sampler":
        """The same cells and physics with other draws."""
        ...
