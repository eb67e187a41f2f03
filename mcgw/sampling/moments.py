"""Moments of the uniforms that fall into a cell: all that a surface keeps of its asperities.

Of the n uniforms u of a cell, with x = 2u - 1, the sums over the asperities

    T_j = sum T_j(x),  j < plain        R_j = sum sqrt(u) T_j(x),  j < rooted

of Chebyshev polynomials determine every smooth law of the height, and every smooth law times the
root of the distance from the cell's start (`mcgw.sampling.response.response`).
"""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numba import get_num_threads
from numpy.typing import NDArray

from mcgw.machine.aligned import aligned
from mcgw.machine.compiling import njit
from mcgw.machine.in_threads import in_threads
from mcgw.sampling.layout import Layout
from mcgw.sampling.spacing import price
from mcgw.sampling.uniform_sums import PLAIN, ROOTED, WORDS, sum_uniforms, unfold

__all__ = ["add_compensated", "cell_moments", "in_runs_of_cells"]

_START = 80.0  # asperities that take as long to draw as a cell takes to begin
_ALONE = 1e6  # asperities' work that a thread does before another one has begun
_PIECE = 512 * 512  # a plain sum of so many terms is good to 1e-14; beyond, it is compensated


@njit(nogil=True, cache=True)
def add_compensated(total: Any, carry: Any, sums: Any) -> None:
    """Neumaier's sum: what rounding drops from `total` is kept in `carry`."""
    for j in range(total.size):
        new = total[j] + sums[j]
        if abs(total[j]) >= abs(sums[j]):
            carry[j] += (total[j] - new) + sums[j]
        else:
            carry[j] += (sums[j] - new) + total[j]
        total[j] = new


@njit(nogil=True, cache=True)
def _sum_pieces(w: Any, seed: Any, surface: Any, cell: Any, n: Any, strata: Any, orders: Any) -> None:
    """Sum all `n` uniforms of a cell that has very many, in pieces; else as `sum_uniforms`."""
    sums = w[PLAIN:WORDS]
    total, carry = np.zeros(sums.size), np.zeros(sums.size)
    for start in range(0, n, _PIECE):
        sum_uniforms(w, seed, surface, cell, start, min(start + _PIECE, n), strata, orders)
        add_compensated(total, carry, sums)
    for j in range(sums.size):
        sums[j] = total[j] + carry[j]


@njit(nogil=True, cache=True)
def _sum_cell(
    w: Any,
    seed: Any,
    first: Any,
    cell: Any,
    counts: Any,
    start: Any,
    orders: Any,
    stratified: Any,
    moments: Any,
) -> None:
    """Sum a cell of some consecutive surfaces, each to its own column, from row `start` on."""
    plain, rooted = orders
    drawn = 0
    for n in counts:  # a reduction by NumPy's name imports half of SciPy when it is loaded
        drawn += n
    if drawn == 0:
        moments[start : start + np.uint64(plain + rooted)] = 0.0
        return
    for surface in range(counts.size):
        n = counts[surface]
        strata = n if stratified else 0
        if n <= _PIECE:
            sum_uniforms(w, seed, first + surface, cell, 0, n, strata, orders)
        else:
            _sum_pieces(w, seed, first + surface, cell, n, strata, orders)
        for j in range(plain):
            moments[start + np.uint64(j), np.uint64(surface)] = w[np.uint64(PLAIN + j)]
        for j in range(rooted):
            moments[start + np.uint64(plain + j), np.uint64(surface)] = w[np.uint64(ROOTED + j)]
    unfold(moments, start, plain)
    unfold(moments, start + plain, rooted)


@njit(nogil=True, cache=True)
def _sum_cells(
    seed: Any, first: Any, counts: Any, starts: Any, orders: Any, bounds: Any, stratified: Any, moments: Any
) -> None:
    """Sum a run of cells, all surfaces of one after the other."""
    w = np.ones(WORDS)
    surfaces = counts.shape[1]
    at, end = bounds
    while at < end:
        cell, surface = at // surfaces, at % surfaces
        stop = min(surfaces, surface + end - at)
        some = slice(surface, stop)
        needed = (orders[cell, 0], orders[cell, 1])
        _sum_cell(
            w,
            seed,
            first + surface,
            cell,
            counts[cell, some],
            np.uint64(starts[cell]),
            needed,
            stratified,
            moments[:, some],
        )
        at += stop - surface


def cell_moments(
    seed: int, first: int, counts: NDArray[np.int64], layout: Layout, *, stratified: bool = False
) -> NDArray[np.float64]:
    """Moments of all cells of a block of surfaces.

    Parameters
    ----------
    seed : int
        The key.
    first : int
        Number of the block's first surface.
    counts : ndarray of int
        Asperities to draw in each cell, shape (cells, surfaces).
    layout : Layout
        Moments of each cell.
    stratified : bool, optional
        Jitter the uniforms of a cell over as many equal strata.

    Returns
    -------
    ndarray
        Shape (moments, surfaces): the same bits for any number of threads and in any block.
    """

    def sum_run(*cells: Any) -> None:
        counts, starts, orders, bounds, moments = cells
        _sum_cells(np.uint64(seed), first, counts, starts, orders, bounds, stratified, moments)

    return in_runs_of_cells(counts, layout, sum_run)


def in_runs_of_cells(
    counts: NDArray[np.int64], layout: Layout, sum_run: Callable[..., None]
) -> NDArray[np.float64]:
    """Moments of all cells, of which every thread has a run: no number of threads changes a sum's order.

    ``sum_run(counts, starts, orders, bounds, moments)`` writes those of the cells and surfaces within bounds.
    """
    counts = np.where(layout.sizes[:, None] > 0, counts, 0)  # what nobody asks for is not drawn
    starts, orders = layout.starts, np.column_stack([layout.plain, layout.rooted])
    moments = aligned(int(starts[-1]), counts.shape[1])
    bounds = list(pairwise(_shares(counts, layout).tolist()))
    in_threads(lambda some: sum_run(counts, starts, orders, some, moments), bounds)
    return moments


def _shares(counts: NDArray[np.int64], layout: Layout) -> NDArray[np.int64]:
    """Where the work of each thread begins and ends, counted through the surfaces of each cell in turn."""
    each = price(layout.plain, layout.rooted)
    work = np.concatenate([[0.0], np.cumsum(_START * counts.shape[1] + counts.sum(axis=1) * each)])
    threads = get_num_threads() if work[-1] > _ALONE else 1
    ends = np.linspace(0, work[-1], threads + 1)
    return np.asarray(np.interp(ends, work, counts.shape[1] * np.arange(len(work))), dtype=np.int64)
