"""What every sampler has, and what it gives."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, TypeVar

from analytic.arrays import Array
from mcgw.scene.scene import Scene

if TYPE_CHECKING:
    from mcgw.sampling.cells import Mesh

Sums = dict[str, Array]  # of some consecutive surfaces each quantity, SI, shape (surfaces, separations)
Drawn = TypeVar("Drawn", covariant=True)

GROUP = 64  # surfaces whose numbers in cells come from one generator of NumPy, which takes longer to make


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
class Sampler(Source[Sums]):
    """Draws surfaces of a scene, exactly unless a sampler says otherwise."""

    name: str  # one of `mcgw.scene.ensemble.SAMPLERS`, never "auto"
    scene: Scene  # what to simulate
    mesh: "Mesh"  # its cells; with none, every asperity is drawn by itself

    @property
    def distance(self) -> float:
        """Distance of the laws of its values from the exact ones; nan if nobody knows."""
        return 0.0

    @property
    def cells(self) -> int:
        """Number of its cells."""
        return self.mesh.size
