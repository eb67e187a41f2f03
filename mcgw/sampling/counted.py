"""Samplers that count before they draw: the numbers in the cells, their moments, and the product.

And asperities drawn one by one: those outside all cells, and all of them for the sampler ``tail``.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from analytic import quantity_of
from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.machine.process import check_memory
from mcgw.sampling.block import Layout, Sampler, Sums
from mcgw.sampling.cells import Mesh
from mcgw.sampling.counts import Counts, contacts_above, counts_of
from mcgw.sampling.direct import asperity_sums
from mcgw.sampling.moments import OneByOne
from mcgw.sampling.philox import EXTRAS, centred, made_for
from mcgw.sampling.response.response import Response
from mcgw.sampling.stretches import stretches_of
from mcgw.scene.scene import Scene

if TYPE_CHECKING:
    from mcgw.sampling.own_radii import Families, RadiusTable

_HIGH, _LOW, _RADII = 0, 1, 2  # streams, and what leads from one of heights to that of their radii
_MANY, _BYTES = 10**7, 100  # heights that are worth asking whether there is room; bytes of one


@dataclass(frozen=True)
class Counted(Sampler):
    """A sampler put together of a mesh, a response, a way to count and a way to draw."""

    response: "Response | Families"  # physics on this mesh
    drawing: OneByOne = OneByOne()  # of the moments of cells  # noqa: RUF009 - it has no state
    table: "RadiusTable | None" = None  # of radii, where summits have their own

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

    def block(self, first: int, n: int) -> Sums:
        """Results of surfaces `first` ... `first + n - 1`."""
        return self.sums(first, *self.drawn(first, n, self.response.layout))

    def drawn(self, first: int, n: int, layout: Layout) -> tuple[Array, Array, Array]:
        """Moments, numbers in the cells and heights outside of these surfaces: what `sums` takes."""
        counts = counts_of(self.scene, self.mesh, first, n)
        moments = self.drawing.moments(self.scene.seed, first, counts.cells, layout)
        extras = extra_heights(self.scene, self.mesh, first, counts, self.table)
        return moments, counts.cells.astype(np.float64), extras

    def sums(self, first: int, moments: Array, counts: Array, extras: Array) -> Sums:
        """Return quantities of surfaces `first` ... from what was drawn, SI, shape (surfaces, separations).

        Moments have shape (moments, surfaces), counts (cells, surfaces); extras are rows (surface, height,
        weight), and the ratio of the radius where summits have their own.
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


def extra_heights(
    scene: Scene, mesh: Mesh, first: int, counts: Counts, table: "RadiusTable | None" = None
) -> Array:
    """Return contacting heights outside the cells, for a block of surfaces that begins with number `first`.

    Rows (number of the surface, reduced height, weight), surface by surface, low ones first; and in a fourth
    column the radius over that of the surface, where summits have their own, out of the `table`.
    """
    law = scene.heights
    number = int(counts.high_extras.sum() + counts.low_extras.sum())
    if number > _MANY:
        check_memory(f"ensemble.sampler: to list {number:.4g} heights one by one", _BYTES * number)
    edge = float(mesh.edges[-1]) if mesh.size else scene.lowest

    def listed(stream: int, numbers: Ints, heights: Array) -> Array:
        surfaces = np.repeat(first + np.arange(len(numbers)), numbers)
        columns = [surfaces, heights, np.ones(len(heights))]
        if table:
            pairs = _centred_pairs(np.uint64(scene.seed), first, stream + _RADII, numbers)
            two = np.ascontiguousarray(pairs.reshape(-1, 2).T)
            columns.append(table.root_ratios(np.ascontiguousarray(heights), *two) ** 2)
        return np.column_stack(columns)

    heights = law.isf(_wide_uniforms(scene.seed, first, _HIGH, counts.high_extras), edge)
    rows = listed(_HIGH, counts.high_extras, heights)
    if not counts.low_extras.any():
        return rows
    bottom = float(mesh.edges[0])
    least = float(law.cdf(np.array(scene.lowest)) / law.cdf(np.array(bottom)))
    share = least + (1 - least) * _wide_uniforms(scene.seed, first, _LOW, counts.low_extras)
    low = listed(_LOW, counts.low_extras, law.ppf(share, bottom))
    rows = np.concatenate([low, rows])
    return np.asarray(rows[np.argsort(rows[:, 0], kind="stable")])


def table_of(scene: Scene, lowest: float) -> "RadiusTable | None":
    """Radii of summits above a height, where they have their own."""
    if scene.summits is None:
        return None
    from mcgw.sampling.own_radii import radius_table  # for those scenes alone

    return radius_table(scene.summits, lowest)


def _wide_uniforms(seed: int, first: int, stream: int, numbers: Ints) -> Array:
    """Uniforms of 64 bits: those of 32 would cut the tail of 1e10 asperities."""
    u = (1 + _centred_pairs(np.uint64(seed), first, stream, numbers)) / 2
    return np.asarray((u[::2] - 0.5 / 2**32) + u[1::2] / 2**32)


@njit(cache=True)
def _centred_pairs(seed: Any, first: Any, stream: Any, numbers: Any) -> Any:
    """Two for each number wanted, surface by surface."""
    total = most = at = 0
    for n in numbers:  # a reduction by NumPy's name imports half of SciPy when it is loaded
        total, most = total + n, max(most, n)
    pairs, words = np.empty(2 * total), np.empty(made_for(2 * most))
    for i in range(numbers.size):
        n = 2 * numbers[i]
        if n:
            centred(words, seed, EXTRAS, first + i, stream, 0, n)
            for k in range(n):  # in one step it takes 2 s to compile: the text of its errors
                pairs[at + k] = words[k]
            at += n
    return pairs
