"""Moments of the uniforms that fall into a cell: all that a surface keeps of its asperities.

Of the n uniforms u of a cell, with x = 2u - 1, the sums over the asperities

    T_j = sum T_j(x),  j < plain        R_j = sum sqrt(u) T_j(x),  j < rooted

of Chebyshev polynomials determine every smooth law of the height, and every smooth law times the
root of the distance from the cell's start (`mcgw.sampling.response.response`).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.machine.threads import THREADS, in_threads
from mcgw.sampling.kernels import BUFFER, PLAIN, ROOTED, TOGETHER, WORDS, add_uniforms, unfold
from mcgw.sampling.philox import CELLS, centred
from mcgw.sampling.spacing import price

_START = 80.0  # asperities that take as long to draw as a cell takes to begin
_ALONE = 1e6  # asperities' work that a thread does before another one has begun
_PIECE = 512 * 512  # a plain sum of so many terms is good to 1e-14; beyond, it is compensated


@dataclass(frozen=True)
class Layout:
    """Which moments a surface keeps."""

    plain: Ints  # how many T_j each cell has
    rooted: Ints  # how many R_j

    @property
    def sizes(self) -> Ints:
        """Moments of each cell."""
        return self.plain + self.rooted

    @property
    def starts(self) -> Ints:
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

    def rows_of(self, part: "Layout") -> Ints:
        """Where the rows of a layout lie in this one, which covers it."""
        first = np.stack([self.starts[:-1], self.starts[:-1] + self.plain], axis=1).ravel()
        size = np.stack([part.plain, part.rooted], axis=1).ravel()
        return np.repeat(first - np.cumsum(size) + size, size) + np.arange(size.sum())


@njit(inline="always")
def add_compensated(totals: Any, w: Any, first: Any, size: Any) -> None:
    """Neumaier's sums: `size` totals, then what rounding dropped from each. Numbers of `w` move there."""
    for j in range(size):
        total, term = totals[j], w[first + j]
        new = total + term
        totals[size + j] += (total - new) + term if abs(total) >= abs(term) else (term - new) + total
        totals[j] = new
        w[first + j] = 0.0


@njit(inline="always")
def _sum_cell(
    w: Any, carries: Any, seed: Any, surface: Any, cell: Any, n: Any, plain: Any, rooted: Any
) -> None:
    """Leave the sums of products over the `n` uniforms of a cell in the workspace; very many in pieces."""
    for k in range(PLAIN, WORDS):
        w[k] = 0.0
    for k in range(carries.size if n > _PIECE else 0):
        carries[k] = 0.0
    for first in range(0, n, BUFFER):
        some = min(BUFFER, n - first)
        centred(w, seed, CELLS, surface, cell, first, some)
        filled = -some % TOGETHER
        for i in range(some, some + filled):
            w[i] = 1.0
        add_uniforms(w, some + filled, filled, plain, rooted)
        if n > _PIECE and ((first + BUFFER) % _PIECE == 0 or first + some == n):
            add_compensated(carries, w, PLAIN, WORDS - PLAIN)
    for k in range(WORDS - PLAIN if n > _PIECE else 0):
        w[PLAIN + k] = carries[k] + carries[WORDS - PLAIN + k]
    w[PLAIN] = n


@njit(cache=True)
def _sum_cells(
    seed: Any, first: Any, starts: Any, orders: Any, counts: Any, bounds: Any, moments: Any
) -> None:
    """Sum a run of cells, all surfaces of one after the other."""
    w, carries = np.empty(WORDS), np.empty(2 * (WORDS - PLAIN))
    for k in range(WORDS):
        w[k] = 1.0
    surfaces = counts.shape[1]
    at, end = bounds
    while at < end:
        cell, start = at // surfaces, at % surfaces
        stop = min(surfaces, start + end - at)
        row, plain, rooted = starts[cell], orders[cell, 0], orders[cell, 1]
        for surface in range(start, stop):
            n = counts[cell, surface]
            if n:
                _sum_cell(w, carries, seed, first + surface, cell, n, plain, rooted)
            for j in range(plain):
                moments[row + j, surface] = w[PLAIN + j] if n else 0.0
            for j in range(rooted):
                moments[row + plain + j, surface] = w[ROOTED + j] if n else 0.0
        unfold(moments, row, plain, start, stop)
        unfold(moments, row + plain, rooted, start, stop)
        at += stop - start


def in_runs_of_cells(counts: Ints, orders: Ints, each: Array | float, sum_run: Callable[..., None]) -> Array:
    """Moments of all cells, of which every thread has a run: no number of threads changes a sum's order.

    Cells have as many of them as `orders` say, shape (cells, kinds); an asperity costs `each`.
    ``sum_run(counts, bounds, moments)`` writes those of the cells and surfaces within bounds.
    """
    counts = np.where(orders.any(axis=1, keepdims=True), counts, 0)  # what nobody asks for is not drawn
    moments = np.empty((int(orders.sum()), counts.shape[1]))
    work = np.concatenate([[0.0], np.cumsum(_START * counts.shape[1] + counts.sum(axis=1) * each)])
    threads = THREADS.get() if work[-1] > _ALONE else 1
    ends = np.linspace(0, work[-1], threads + 1)  # counted through the surfaces of each cell in turn
    places = np.interp(ends, work, counts.shape[1] * np.arange(len(work))).astype(np.int64)
    in_threads(lambda some: sum_run(counts, some, moments), list(pairwise(places.tolist())))
    return moments


@dataclass(frozen=True)
class OneByOne:
    """A uniform for each asperity; other ways to draw the moments of the cells derive from it."""

    distance = 0.0  # of the laws of values from the exact ones; nan if nobody knows

    def moments(self, seed: int, first: int, counts: Ints, layout: Layout) -> Array:
        """Draw sums over the uniforms of each cell: shape (moments, surfaces).

        Of surfaces from number `first` on, with `counts` asperities in each cell, shape (cells, surfaces).
        The same bits for any number of threads and in any block.
        """
        orders = np.column_stack([layout.plain, layout.rooted])
        sum_run = partial(_sum_cells, np.uint64(seed), first, layout.starts, orders)
        return in_runs_of_cells(counts, orders, price(layout.plain, layout.rooted), sum_run)

    def draws(self, asperities: float, layout: Layout) -> float:
        """Return the numbers drawn for so many asperities in the cells of a surface."""
        return asperities if layout.plain.any() or layout.rooted.any() else 0.0
