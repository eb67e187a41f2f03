"""Samplers of scenes whose summits have radii of their own: imported for those alone."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array
from mcgw.sampling.cells import Mesh
from mcgw.sampling.counted import Counted
from mcgw.sampling.counts import Counts
from mcgw.sampling.families import Families
from mcgw.sampling.layout import Layout
from mcgw.sampling.radius_table import RadiusTable, radius_table
from mcgw.sampling.weighted_sums import weighted_moments
from mcgw.scene.scene import Scene


def with_radii(
    name: str,
    scene: Scene,
    mesh: Mesh,
    response: Families,
    counting: Callable[[Scene, Mesh, int, int], Counts],
    *,
    strata: bool,
) -> Counted:
    """A sampler on a mesh that draws a radius for each asperity."""
    assert scene.curvature is not None
    table = radius_table(scene.curvature, scene.lowest)
    return Counted(name, scene, mesh, response, counting, WithRadii(mesh, table, response, strata), table)


@dataclass(frozen=True)
class WithRadii:
    """A uniform and a radius for each asperity.

    Parameters
    ----------
    mesh : Mesh
        The cells, whose heights the radii go with.
    table : RadiusTable
        The law of the radii.
    families : Families
        Powers of the radius that are asked for.
    strata : bool, optional
        Draw the uniforms in as many equal strata of the cell.
    """

    mesh: Mesh
    table: RadiusTable
    families: Families
    strata: bool = False
    distance = 0.0

    def moments(self, seed: int, first: int, counts: Counts, layout: Layout) -> Array:
        """Sums over the uniforms of each cell, each with a power of its radius."""
        layouts = list(self.families.apart(layout))
        squares = [power == 1.0 for power in self.families.powers]
        moments = weighted_moments(
            seed, first, counts.cells, layouts, squares, self.mesh, self.table, stratified=self.strata
        )
        if self.strata:
            weights = np.tile(counts.weights[1:-1], len(layouts))
            moments *= np.repeat(weights, layout.sizes)[:, None]
        return moments

    def draws(self, asperities: float, layout: Layout) -> float:
        """A height and two words of a radius, which take about as long."""
        return 6 * asperities if layout.sizes.any() else 0.0
