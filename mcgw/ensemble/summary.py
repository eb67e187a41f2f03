"""What `keep = "statistics"` keeps of some surfaces in place of their values, and how two are joined.

Mean, products and cubes of deviations are joined by the formulas of Chan, Golub and LeVeque (1979) and Pebay
(2008) [mem]. Rounding depends on what is joined with what, and that is fixed: blocks of a size that the scene
decides are joined in pairs along a binary tree over their numbers (`push`), what is left of it from the last
to the first (`total`). So the bits do not depend on who drew what, and when.

Bins in which values are counted, so that quantiles need no values: around the exact mean they are as wide as
1/128 of a scale, the largest power of two below the exact standard deviation, and wider in proportion to the
distance beyond that. Both ends of a bin are exact binary numbers, so that a value falls into the same bin on
every processor.

Sums of products of every two columns: the compiled loop behind covariances.

A library's matrix product adds in an order that depends on how many threads it has; this one does not.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from analytic.arrays import Array, Ints
from mcgw.ensemble.intervals import moments
from mcgw.machine.compiling import njit
from mcgw.machine.in_threads import in_threads
from mcgw.scene.scene import Scene

_BITS = 7  # of a distance that tell its bin: 128 bins for each doubling
_DOUBLINGS = 14  # of the distance; what lies beyond is in the last bin, and the extremes are known
_HALF = _DOUBLINGS << _BITS
NUMBER = 2 * _HALF
_FIRST = 1023 << _BITS  # these bits of the number 1
_OFF_TIES = 0.3  # no mean that people ask for lies half way between two centres


@dataclass(frozen=True)
class Bins:
    """Of each number that a surface has, in the order of `Scene.shapes`.

    Parameters
    ----------
    centre, scale : ndarray
        Where its bins are narrowest, and the power of two they are measured in; shape (columns,).
    """

    centre: Array
    scale: Array

    @classmethod
    def of(cls, scene: Scene) -> "Bins":
        """Those of a scene, from the exact mean and standard deviation of a surface."""
        known_already = _of_independent(scene)
        found = [known_already.get(name) or _mean_and_std(scene, name) for name in scene.shapes]
        mean, std = (np.concatenate([np.ravel(pair[i]) for pair in found]) for i in (0, 1))
        known = np.isfinite(std) & (std > 0) & np.isfinite(mean)
        scale = np.exp2(np.floor(np.log2(np.where(known, std, 1.0))))
        centre = np.floor(np.where(known, mean, 0.0) / scale + _OFF_TIES) * scale
        return cls(centre, scale)

    def counts(self, column: int, values: Array) -> Ints:
        """How many of some values of a column are in each of its bins."""
        z = (values - self.centre[column]) / self.scale[column]
        place = ((np.abs(z) + 1).view(np.int64) >> (52 - _BITS)) - _FIRST
        np.minimum(place, _HALF - 1, out=place)
        return np.bincount(np.where(z < 0, _HALF - 1 - place, _HALF + place), minlength=NUMBER)

    def ends(self, columns: Ints, bins: Ints, *, whole: bool) -> tuple[Array, Array]:
        """Between which values lies what is in some bins, one of each column; the outermost have no end.

        Parameters
        ----------
        columns, bins : ndarray
            Of the same shape.
        whole : bool
            Whether values are whole numbers: then both ends are such values.
        """
        above = bins >= _HALF
        place = np.where(above, bins - _HALF, _HALF - 1 - bins)
        near, far = _distance(place), np.where(place == _HALF - 1, np.inf, _distance(place + 1))
        low, high = np.where(above, near, -far), np.where(above, far, -near)
        low, high = (self.centre[columns] + self.scale[columns] * end for end in (low, high))
        if whole:  # an end of a bin belongs to it on the side of the centre
            low = np.where(above, np.ceil(low), np.floor(low) + 1)
            high = np.where(above, np.ceil(high) - 1, np.floor(high))
        return low, high


def _distance(place: Ints) -> Array:
    """Distance from the centre, in scales, at which a bin begins."""
    return np.asarray(np.ldexp(1 + (place & (1 << _BITS) - 1) / (1 << _BITS), place >> _BITS) - 1)


def _of_independent(scene: Scene) -> dict[str, tuple[Array, Array]]:
    """Exact mean and standard deviation of all quantities at once, of asperities that are independent."""
    if scene.interaction is not None:
        return {}
    names = scene.quantities
    mean, variance = moments(scene, names, (2,)) * scene.n_asperities
    scale = [quantity_of(name).scale(scene.surface) for name in names]
    pairs = zip(mean, np.sqrt(np.maximum(variance, 0.0)), scale, strict=True)
    return {name: (m * unit, std * unit) for name, (m, std, unit) in zip(names, pairs, strict=True)}


def _mean_and_std(scene: Scene, name: str) -> tuple[Array, Array]:
    """Exact, of what one surface has of a table."""
    h, theory = np.array(scene.separations), scene.theory
    return theory.mean(name, h), theory.std(name, h)


ROW = "block_"  # before the names of tables with one row for a whole block of surfaces
_ROWS = 256  # of a column at a time: those of all columns stay near
_BANDS = 16  # that threads share


@dataclass(frozen=True)
class Summary:
    """Of some surfaces, each with so many columns of numbers.

    Parameters
    ----------
    n : int
        How many surfaces.
    mean, cubes : ndarray
        Mean, and sum of the cubes of deviations from it, shape (columns,).
    products : ndarray
        Sums of the products of deviations of every two columns, a packed lower triangle.
    extremes : ndarray
        Least and greatest value, shape (2, columns).
    at : ndarray of int64
        The first surfaces that have them, shape (2, columns).
    counts : ndarray of int64
        Values in each bin, shape (columns, bins).
    """

    n: int
    mean: Array
    cubes: Array
    products: Array
    extremes: Array
    at: Ints
    counts: Ints

    @classmethod
    def of(cls, values: Array, first: int, bins: Bins) -> "Summary":
        """Of values, shape (surfaces, columns), of the surfaces from number `first` on."""
        n, width = values.shape
        apart = np.empty((width, n))

        def column(i: int) -> tuple[float, float, tuple[float, float], tuple[int, int], Ints]:
            x = np.ascontiguousarray(values[:, i])
            mean = (x - x[0]).sum() / n + x[0]
            d = np.subtract(x, mean, out=apart[i])
            least, most = int(x.argmin()), int(x.argmax())
            at = first + least, first + most
            return mean, float((d * d * d).sum()), (x[least], x[most]), at, bins.counts(i, x)

        found = in_threads(column, range(width))
        mean, cubes, extremes, at, counts = (np.array(each) for each in zip(*found, strict=True))
        return cls(n, mean, cubes, products(apart), extremes.T.copy(), at.T.astype(np.int64), counts)

    @classmethod
    def from_tables(cls, tables: dict[str, NDArray[Any]], row: int = 0) -> "Summary":
        """What `tables` gave, of one row."""
        each = {name.removeprefix(ROW): table[row] for name, table in tables.items() if name.startswith(ROW)}
        return cls(int(each.pop("n")), **each)

    def tables(self) -> dict[str, NDArray[Any]]:
        """As tables of one row."""
        each = {name: np.asarray(value)[None] for name, value in vars(self).items()}
        return {ROW + name: value for name, value in each.items()}

    @property
    def squares(self) -> Array:
        """Sums of the squares of deviations, shape (columns,)."""
        i = np.arange(len(self.mean))
        return np.asarray(self.products[i * (i + 3) // 2])

    def __add__(self, other: "Summary") -> "Summary":
        """Of the surfaces of both, the other's numbers being higher."""
        n, step = self.n + other.n, other.mean - self.mean
        both = self.n * (other.n / n)
        lean = 3 * step * (self.n / n * other.squares - other.n / n * self.squares)
        better = np.stack([other.extremes[0] < self.extremes[0], other.extremes[1] > self.extremes[1]])
        return Summary(
            n=n,
            mean=self.mean + step * (other.n / n),
            cubes=self.cubes + other.cubes + step**3 * (both * ((self.n - other.n) / n)) + lean,
            products=self.products + other.products + packed(step, step) * both,
            extremes=np.where(better, other.extremes, self.extremes),
            at=np.where(better, other.at, self.at),
            counts=self.counts + other.counts,
        )


def push(blocks: list[Summary], new: Summary) -> None:
    """Join the next block to those before it: of equal size in pairs, along a binary tree."""
    blocks.append(new)
    while len(blocks) > 1 and blocks[-2].n == blocks[-1].n:
        last = blocks.pop()
        blocks[-1] = blocks[-1] + last


def total(blocks: Sequence[Summary]) -> Summary:
    """All of them as one."""
    whole = blocks[-1]
    for block in reversed(blocks[:-1]):
        whole = block + whole
    return whole


def size_of(width: int) -> int:
    """Bytes of a summary of so many columns."""
    return 8 * (width * (width + 1) // 2 + width * (NUMBER + 6) + 1)


@njit(cache=True, fastmath={"reassoc", "contract"})
def _sum_products(columns: Any, first: int, stop: int, out: Any) -> None:  # pragma: no cover - compiled
    """Add the products of columns `first` ... `stop - 1` with all up to themselves."""
    rows = columns.shape[1]
    for start in range(0, rows, _ROWS):
        end = min(start + _ROWS, rows)
        for i in range(first, stop):
            x, place = columns[i, start:end], i * (i + 1) // 2
            for j in range(i + 1):
                y, total = columns[j, start:end], 0.0
                for k in range(end - start):
                    total += x[k] * y[k]
                out[place + j] += total


def products(columns: Array) -> Array:
    """Sums over the rows of products of every two columns.

    Parameters
    ----------
    columns : ndarray
        Shape (columns, rows), contiguous.

    Returns
    -------
    ndarray
        The lower triangle, row after row, shape (columns (columns + 1)/2,): the same bits for any number of
        threads.
    """
    width = len(columns)
    out = np.zeros(width * (width + 1) // 2)
    ends = np.unique((width * np.sqrt(np.linspace(0, 1, _BANDS + 1))).round().astype(int)).tolist()
    bands = list(pairwise(ends))
    turns = [
        bands[k] for start in (0, 1) for k in range(start, len(bands), 2)
    ]  # halves of about the same work
    in_threads(lambda band: _sum_products(columns, *band, out), turns)
    return out


def packed(x: Array, y: Array) -> Array:
    """The lower triangle of the products of two vectors' elements, packed."""
    row, column = np.tril_indices(len(x))
    return np.asarray(x[row] * y[column])
