"""Samplers that count before they draw: the numbers in the cells, their moments, and the product."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from analytic import quantity_of
from analytic.arrays import Array, Ints
from mcgw.sampling.block import Block, Layout, Sampler
from mcgw.sampling.counts import contacts_above, counts_of
from mcgw.sampling.direct import asperity_sums
from mcgw.sampling.drawn_moments import OneByOne
from mcgw.sampling.outside import extra_heights
from mcgw.sampling.response.response import Response
from mcgw.sampling.stretches import stretches_of

if TYPE_CHECKING:
    from mcgw.sampling.own_radii import Families, RadiusTable


@dataclass(frozen=True)
class Counted(Sampler):
    """A sampler put together of a mesh, a response, a way to count and a way to draw.

    Parameters
    ----------
    name, scene, mesh
        As of any `Sampler`.
    response : Response or Families
        Physics on this mesh.
    drawing : OneByOne, optional
        How the moments of the cells are drawn.
    table : RadiusTable, optional
        Of radii, where summits have their own.
    """

    response: "Response | Families"
    drawing: OneByOne = OneByOne()  # noqa: RUF009 - it has no state
    table: "RadiusTable | None" = None

    @property
    def moments(self) -> int:
        """Moments of a surface."""
        return int(self.response.layout.starts[-1])

    @property
    def distance(self) -> float:
        """Distance of the laws of its values from the exact ones; nan if nobody knows."""
        return self.drawing.distance

    @property
    def draws(self) -> float:
        """Numbers that are expected to be drawn for a surface."""
        return self.outside + self.drawing.draws(self.inside, self.response.layout)

    def block(self, first: int, n: int) -> Block:
        """Results of surfaces `first` ... `first + n - 1`."""
        return Block(self.sums(first, *self.drawn(first, n, self.response.layout)))

    def drawn(self, first: int, n: int, layout: Layout) -> tuple[Array, Array, Array]:
        """Moments, numbers in the cells and heights outside of these surfaces: what `sums` takes."""
        counts = counts_of(self.scene, self.mesh, first, n)
        moments = self.drawing.moments(self.scene.seed, first, counts, layout)
        extras = extra_heights(self.scene, self.mesh, first, counts, self.table)
        return moments, counts.cells.astype(np.float64), extras

    def sums(self, first: int, moments: Array, counts: Array, extras: Array) -> dict[str, Array]:
        """Quantities of surfaces `first` ... from what was drawn.

        Parameters
        ----------
        first : int
            Number of the first surface.
        moments, counts : ndarray
            Shape (moments, surfaces) and (cells, surfaces).
        extras : ndarray
            Rows (surface, height, weight), and the ratio of the radius where summits have their own.

        Returns
        -------
        dict of str to ndarray
            Each quantity in SI units, shape (surfaces, separations).
        """
        scene = self.scene
        once = np.array(scene.all_separations)
        given = np.searchsorted(once, scene.separations)
        columns = slice(None) if np.array_equal(once, scene.separations) else given
        answers = iter(self.response @ moments)
        sums = {}
        for name in scene.quantities:
            if name == "contacts" or (scene.hertzian and quantity_of(name).counts):
                lowest = np.searchsorted(self.mesh.edges[:-1], scene.separations)
                sums[name] = contacts_above(counts, lowest)
            elif quantity_of(name).counts:
                sums[name] = self._numbers(name, counts)
            else:
                sums[name] = next(answers)[:, columns]
        if not len(extras):
            return sums
        where, numbers = np.unique(extras[:, 0].astype(np.int64) - first, return_counts=True)
        heights, weights, *ratios = np.ascontiguousarray(extras[:, 1:].T)
        with np.errstate(over="ignore"):  # as in the product: what is too large is infinite
            for name, values in asperity_sums(scene, numbers, heights, weights, *ratios).items():
                sums[name][where] += values
        return sums

    def _numbers(self, name: str, counts: Array) -> Array:
        """Asperities in cells that count for a quantity under another law, shape (surfaces, separations)."""
        separation, first, last = self._counted[name]
        numbers = contacts_above(counts, first) - contacts_above(counts, last)
        once = np.array(self.scene.all_separations)
        result = np.zeros((counts.shape[1], len(once)))
        np.add.at(result.T, separation, numbers.T)
        return result[:, np.searchsorted(once, self.scene.separations)]

    @cached_property
    def _counted(self) -> dict[str, tuple[Ints, Ints, Ints]]:
        """For each quantity that counts asperities: separations, and ranges of cells."""
        ranges = {}
        for name in self.scene.quantities:
            q = quantity_of(name)
            if q.counts:
                found = stretches_of(self.scene, self.scene.ways.of(name), *self.mesh.range)
                here = (found.piece > 0) if q.base == "yielded" else np.ones(len(found.piece), dtype=bool)
                first, last = (
                    np.minimum(np.searchsorted(self.mesh.edges, x[here]), self.mesh.size)
                    for x in (found.low, found.high)
                )
                ranges[name] = found.separation[here], first, last
        return ranges
