"""Moments of the uniforms that fall into a cell: all that a surface keeps of its asperities.

Of the n uniforms u of a cell, with x = 2u - 1, the sums over the asperities

    T_j = sum T_j(x),  j < plain        R_j = sum sqrt(u) T_j(x),  j < rooted

of Chebyshev polynomials determine every smooth law of the height, and every smooth law times the
root of the distance from the cell's start (`mcgw.response`). The loop knows no physics; it has no
branch, no exponential and no logarithm, and runs at the width of the vector unit.

Only five polynomials are ever computed. Since ``2 T_m T_k = T_{m+k} + T_{m-k}``, the sums of the
products of T_5 and T_1 ... T_5 stand for the orders 6 ... 10; those with T_10, for 11 ... 15; and so on.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import get_num_threads, njit, prange
from numpy.typing import NDArray

from mcgw.philox import CELLS, centred

__all__ = ["Layout", "cell_moments"]

_BUFFER = 1024  # uniforms at a time: they stay in the innermost cache
_START = 200  # asperities that take as long to draw as a cell takes to begin
_ROOM = 32  # for the moments of a cell, of either kind
_PIECE = 512 * 512  # a plain sum of so many terms is good to 1e-14; beyond, it is compensated

# A vectorised sum needs to reorder its terms, and nothing else: no NaN and no infinity is assumed away.
_VECTOR = {"reassoc", "nsz", "contract"}


@njit(inline="always")
def _five(x: Any) -> Any:
    """T_1 ... T_5 at x."""
    t2 = 2 * x * x - 1.0
    t3 = 2 * x * t2 - x
    t4 = 2 * x * t3 - t2
    return x, t2, t3, t4, 2 * x * t4 - t3


@njit(nogil=True, cache=True, fastmath=_VECTOR)
def _to_ten(x: Any, n: Any, plain: Any) -> None:
    """Add sums of T_1 ... T_5 to `plain`, and of T_5 T_1 ... T_5 T_5."""
    a = b = c = d = e = f = g = h = p = q = 0.0
    for i in range(n):
        t1, t2, t3, t4, t5 = _five(x[i])
        a += t1
        b += t2
        c += t3
        d += t4
        e += t5
        f += t5 * t1
        g += t5 * t2
        h += t5 * t3
        p += t5 * t4
        q += t5 * t5
    for k, total in enumerate((a, b, c, d, e, f, g, h, p, q)):
        plain[1 + k] += total


@njit(nogil=True, cache=True, fastmath=_VECTOR)
def _to_ten_and_root(x: Any, n: Any, root: Any, plain: Any, rooted: Any) -> None:
    """Do the same, leave sqrt(u) in `root`, and add sums of sqrt(u) T_0 ... sqrt(u) T_5 to `rooted`."""
    a = b = c = d = e = f = g = h = p = q = 0.0
    r0 = r1 = r2 = r3 = r4 = r5 = 0.0
    for i in range(n):
        t1, t2, t3, t4, t5 = _five(x[i])
        r = np.sqrt(0.5 * t1 + 0.5)
        root[i] = r
        a += t1
        b += t2
        c += t3
        d += t4
        e += t5
        f += t5 * t1
        g += t5 * t2
        h += t5 * t3
        p += t5 * t4
        q += t5 * t5
        r0 += r
        r1 += r * t1
        r2 += r * t2
        r3 += r * t3
        r4 += r * t4
        r5 += r * t5
    for k, total in enumerate((a, b, c, d, e, f, g, h, p, q)):
        plain[1 + k] += total
    for k, total in enumerate((r0, r1, r2, r3, r4, r5)):
        rooted[k] += total


@njit(nogil=True, cache=True, fastmath=_VECTOR)
def _five_more(x: Any, n: Any, m: Any, factor: Any, sums: Any) -> None:
    """Add sums of T_5m T_1 ... T_5m T_5, m = 1, 2 or 3, times a factor: T_5m is T_m of T_5."""
    c0, c1, c2, c3 = (
        (0.0, 1.0, 0.0, 0.0) if m == 1 else (-1.0, 0.0, 2.0, 0.0) if m == 2 else (0.0, -3.0, 0.0, 4.0)
    )
    a = b = c = d = e = 0.0
    for i in range(n):
        t1, t2, t3, t4, t5 = _five(x[i])
        f = (((c3 * t5 + c2) * t5 + c1) * t5 + c0) * factor[i]
        a += f * t1
        b += f * t2
        c += f * t3
        d += f * t4
        e += f * t5
    for k, total in enumerate((a, b, c, d, e)):
        sums[5 * m + 1 + k] += total


@njit(nogil=True, cache=True)
def _unfold(sums: Any, orders: Any) -> None:
    """Make sums of polynomials of the sums of products, from the lowest order on."""
    for j in range(6, orders):
        m = (j - 1) // 5 * 5
        sums[j] = 2.0 * sums[j] - sums[2 * m - j]


@njit(nogil=True, cache=True, fastmath=_VECTOR)
def _stratified(x: Any, n: Any, first: Any, strata: Any) -> None:
    """Move the uniform of asperity ``first + i`` into its own one of `strata` equal strata."""
    for i in range(n):
        x[i] = (2.0 * (first + i) + 1.0 + x[i]) / strata - 1.0


@njit(nogil=True, cache=True)
def _add_compensated(total: Any, carry: Any, sums: Any, n: Any) -> None:
    """Neumaier's sum: what rounding drops from `total` is kept in `carry`."""
    for j in range(n):
        new = total[j] + sums[j]
        if abs(total[j]) >= abs(sums[j]):
            carry[j] += (total[j] - new) + sums[j]
        else:
            carry[j] += (sums[j] - new) + total[j]
        total[j] = new


@njit(nogil=True, cache=True)
def _sum_piece(key: Any, start: Any, stop: Any, strata: Any, orders: Any, work: Any, sums: Any) -> None:
    """Leave the moments of asperities `start` ... `stop - 1` of a cell in `sums`: plain ones, rooted ones."""
    seed, surface, cell = key
    (x, root, one), (plain, rooted) = work, sums
    plain[:] = 0.0
    rooted[:] = 0.0
    for first in range(start, stop, _BUFFER):
        n = min(_BUFFER, stop - first)
        centred(x, seed, CELLS, surface, cell, first, n)
        if strata:
            _stratified(x, n, first, strata)
        if orders[1]:
            _to_ten_and_root(x, n, root, plain, rooted)
        else:
            _to_ten(x, n, plain)
        for m in range(2, (orders[0] + 3) // 5):
            _five_more(x, n, m, one, plain)
        for m in range(1, (orders[1] + 3) // 5):
            _five_more(x, n, m, root, rooted)
    plain[0] = stop - start
    _unfold(plain, orders[0])
    _unfold(rooted, orders[1])


@njit(nogil=True, cache=True)
def _sum_pieces(key: Any, n: Any, strata: Any, orders: Any, work: Any, sums: Any) -> None:
    """Do the same for all `n` asperities of a cell that has very many."""
    plain, rooted = sums
    total, carry = np.zeros((2, _ROOM)), np.zeros((2, _ROOM))
    for start in range(0, n, _PIECE):
        _sum_piece(key, start, min(start + _PIECE, n), strata, orders, work, sums)
        _add_compensated(total[0], carry[0], plain, orders[0])
        _add_compensated(total[1], carry[1], rooted, orders[1])
    plain[:] = total[0] + carry[0]
    rooted[:] = total[1] + carry[1]


@njit(parallel=True, cache=True)
def _all_cells(
    seed: Any, first: Any, counts: Any, starts: Any, orders: Any, bounds: Any, stratified: Any
) -> Any:
    """Each cell of each surface is summed by one thread, which has a run of them, to its own place."""
    surfaces = counts.shape[1]
    moments = np.zeros((starts[-1], surfaces))
    for thread in prange(bounds.size - 1):
        work = np.empty(_BUFFER), np.empty(_BUFFER), np.ones(_BUFFER)
        plain, rooted = sums = np.empty(_ROOM), np.empty(_ROOM)
        cell, surface = bounds[thread] // surfaces, bounds[thread] % surfaces
        for _ in range(bounds[thread], bounds[thread + 1]):
            n, start = counts[cell, surface], starts[cell]
            if n > 0:
                key, order = (seed, first + surface, cell), (orders[cell, 0], orders[cell, 1])
                strata = n if stratified else 0
                if n <= _PIECE:
                    _sum_piece(key, 0, n, strata, order, work, sums)
                else:
                    _sum_pieces(key, n, strata, order, work, sums)
                for j in range(orders[cell, 0]):
                    moments[start + j, surface] = plain[j]
                for j in range(orders[cell, 1]):
                    moments[start + orders[cell, 0] + j, surface] = rooted[j]
            surface += 1
            if surface == surfaces:
                cell, surface = cell + 1, 0
    return moments


@dataclass(frozen=True)
class Layout:
    """Which moments a surface keeps.

    Parameters
    ----------
    plain, rooted : ndarray of int
        How many T_j and R_j each cell has.
    """

    plain: NDArray[np.int64]
    rooted: NDArray[np.int64]

    @property
    def sizes(self) -> NDArray[np.int64]:
        """Moments of each cell."""
        return self.plain + self.rooted

    @property
    def starts(self) -> NDArray[np.int64]:
        """First row of each cell, and the number of all rows."""
        return np.concatenate([[0], np.cumsum(self.sizes)])


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
    counts = np.where(layout.sizes[:, None] > 0, counts, 0)  # what nobody asks for is not drawn
    work = np.cumsum(np.where(counts > 0, counts + _START, 0))
    threads = get_num_threads()
    shares = np.searchsorted(work, np.arange(1, threads) * (work[-1:].sum() / threads))
    bounds = np.array([0, *shares, counts.size])
    orders = np.column_stack([layout.plain, layout.rooted])
    return np.asarray(_all_cells(np.uint64(seed), first, counts, layout.starts, orders, bounds, stratified))
