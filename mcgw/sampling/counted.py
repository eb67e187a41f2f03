"""Samplers that count before they draw: the numbers in the cells, their moments, and the product.

The number in contact is binomial (fixed N) or Poisson. Given that number, those of the cells are
multinomial: from the highest cell down, so that each probability is accurate however far into the tail.
All are drawn exactly, by NumPy's generator.

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
from mcgw.sampling.block import GROUP, Sampler, Sums
from mcgw.sampling.cells import Mesh
from mcgw.sampling.direct import COUNTS, asperity_sums, generator
from mcgw.sampling.moments import Layout, OneByOne
from mcgw.sampling.philox import EXTRAS, centred, made_for
from mcgw.sampling.response.response import Response
from mcgw.sampling.stretches import stretches_of
from mcgw.scene.scene import Scene

if TYPE_CHECKING:
    from mcgw.sampling.own_radii import Families, RadiusTable

_HIGH, _LOW, _RADII = 0, 1, 2  # streams, and what leads from one of heights to that of their radii
_WORDS = 12  # numbers in memory for an asperity drawn by itself
_RARE = 1e-8  # probability below which binomial and Poisson differ less than 1 - p is rounded
_MANY, _BYTES = 10**7, 100  # heights that are worth asking whether there is room; bytes of one


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
        rng = generator(scene.seed, COUNTS, group)
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


@dataclass(frozen=True)
class Counted(Sampler):
    """A sampler put together of a mesh, a response, a way to count and a way to draw."""

    response: "Response | Families"  # physics on this mesh
    drawing: OneByOne = OneByOne()  # of the moments of cells  # noqa: RUF009 - it has no state
    table: "RadiusTable | None" = None  # of radii, where summits have their own

    @property
    def words(self) -> int:
        """Return the memory for one surface, in numbers."""
        moments = int(self.response.layout.starts[-1])
        return moments + 2 * self.mesh.size + _WORDS * int(min(self.outside, 1e12))

    @property
    def outside(self) -> float:
        """Asperities that are expected to be drawn by themselves."""
        return self.scene.n_asperities * (self.mesh.low_extras + self.mesh.high_extras)

    @property
    def distance(self) -> float:
        """Distance of the laws of its values from the exact ones; nan if nobody knows."""
        return self.drawing.distance

    @property
    def draws(self) -> float:
        """Numbers that are expected to be drawn for a surface."""
        inside = self.scene.n_asperities * float(self.mesh.probability.sum())
        return self.outside + self.drawing.draws(inside, self.response.layout)

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
    sides, parts = [(_HIGH, counts.high_extras)], []
    if counts.low_extras.any():
        sides.insert(0, (_LOW, counts.low_extras))
    for stream, numbers in sides:
        u = (1 + _centred_pairs(np.uint64(scene.seed), first, stream, numbers)) / 2
        u = (u[::2] - 0.5 / 2**32) + u[1::2] / 2**32  # of 64 bits: 32 would cut the tail of 1e10 asperities
        if stream == _HIGH:
            heights = law.isf(u, float(mesh.edges[-1]) if mesh.size else scene.lowest)
        else:
            bottom = float(mesh.edges[0])
            least = float(law.cdf(np.array(scene.lowest)) / law.cdf(np.array(bottom)))
            heights = law.ppf(least + (1 - least) * u, bottom)
        columns = [np.repeat(first + np.arange(len(numbers)), numbers), heights, np.ones(len(heights))]
        if table:
            pairs = _centred_pairs(np.uint64(scene.seed), first, stream + _RADII, numbers)
            two = np.ascontiguousarray(pairs.reshape(-1, 2).T)
            columns.append(table.root_ratios(np.ascontiguousarray(heights), *two) ** 2)
        parts.append(np.column_stack(columns))
    if len(parts) == 1:
        return parts[0]
    rows = np.concatenate(parts)
    return np.asarray(rows[np.argsort(rows[:, 0], kind="stable")])


def contacts_above(counts: Array, cells: Ints) -> Array:
    """Add up numbers in cells (cells, surfaces) from some lowest ones on: (surfaces, lowest ones)."""
    above = np.zeros((len(counts) + 1, counts.shape[1]))
    np.cumsum(counts[::-1], axis=0, out=above[-2::-1])
    return np.ascontiguousarray(above[cells].T)


def table_of(scene: Scene, lowest: float) -> "RadiusTable | None":
    """Radii of summits above a height, where they have their own."""
    if scene.summits is None:
        return None
    from mcgw.sampling.own_radii import radius_table  # for those scenes alone

    return radius_table(scene.summits, lowest)


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
