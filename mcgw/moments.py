"""Moments of the uniforms that fall into a cell: all that a surface keeps of its asperities.

Of the n uniforms u of a cell, with x = 2u - 1, the sums over the asperities

    T_j = sum T_j(x),  j < plain        R_j = sum sqrt(u) T_j(x),  j < rooted

of Chebyshev polynomials determine every smooth law of the height, and every smooth law times the
root of the distance from the cell's start (`mcgw.response`). The loop knows no physics; it has no
branch, no exponential and no logarithm, and runs at the width of the vector unit.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import get_num_threads, njit, prange
from numpy.typing import NDArray

from mcgw.philox import CELLS, centred

__all__ = ["Layout", "cell_moments"]

_BUFFER = 1024  # uniforms at a time: four buffers stay in the innermost cache
_ROOM = 32  # for the moments of a cell, of either kind
_PIECE = 512 * 512  # a plain sum of so many terms is good to 1e-14; beyond, it is compensated

# A vectorised sum needs to reorder its terms, and nothing else: no NaN and no infinity is assumed away.
_VECTOR = {"reassoc", "nsz", "contract"}


@njit(nogil=True, cache=True, fastmath=_VECTOR)
def _first_ten(x: Any, rooted: Any, before: Any, last: Any, n: Any, sums: Any) -> None:
    """Add the sums of the first ten terms to `sums`; leave the last two terms in `before` and `last`.

    The terms are ``T_j(x)``, or ``sqrt(u) T_j(x)`` if `rooted`: t_0, then ``t_{j+1} = 2 x t_j - t_{j-1}``.
    """
    a = b = c = d = e = f = g = h = p = q = 0.0
    for i in range(n):
        v = x[i]
        w = 2 * v
        ta = np.sqrt(0.5 * v + 0.5) if rooted else 1.0
        tb = v * ta
        tc = w * tb - ta
        td = w * tc - tb
        te = w * td - tc
        tf = w * te - td
        tg = w * tf - te
        th = w * tg - tf
        tp = w * th - tg
        tq = w * tp - th
        a += ta
        b += tb
        c += tc
        d += td
        e += te
        f += tf
        g += tg
        h += th
        p += tp
        q += tq
        before[i] = tp
        last[i] = tq
    for j, total in enumerate((a, b, c, d, e, f, g, h, p, q)):
        sums[j] += total


@njit(nogil=True, cache=True, fastmath=_VECTOR)
def _first_five_rooted(x: Any, n: Any, sums: Any) -> None:
    """Add the sums of the first five ``sqrt(u) T_j(x)``: a narrow cell needs no more."""
    a = b = c = d = e = 0.0
    for i in range(n):
        v = x[i]
        w = 2 * v
        ta = np.sqrt(0.5 * v + 0.5)
        tb = v * ta
        tc = w * tb - ta
        td = w * tc - tb
        te = w * td - tc
        a += ta
        b += tb
        c += tc
        d += td
        e += te
    for j, total in enumerate((a, b, c, d, e)):
        sums[j] += total


@njit(nogil=True, cache=True, fastmath=_VECTOR)
def _next_eight(x: Any, before: Any, last: Any, n: Any, sums: Any) -> None:
    """Add the sums of the next eight terms to `sums`.

    Fewer terms a pass would be bound by what it stores, more by the number of registers.
    """
    a = b = c = d = e = f = g = h = 0.0
    for i in range(n):
        w = 2 * x[i]
        ta = w * last[i] - before[i]
        tb = w * ta - last[i]
        tc = w * tb - ta
        td = w * tc - tb
        te = w * td - tc
        tf = w * te - td
        tg = w * tf - te
        th = w * tg - tf
        a += ta
        b += tb
        c += tc
        d += td
        e += te
        f += tf
        g += tg
        h += th
        before[i] = tg
        last[i] = th
    for j, total in enumerate((a, b, c, d, e, f, g, h)):
        sums[j] += total


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
def _sum_cell(key: Any, n: Any, orders: Any, stratified: Any, work: Any, sums: Any, total: Any) -> None:
    """Leave the moments of one cell of one surface in `total`: a row of T_j, a row of R_j."""
    seed, surface, cell = key
    x, before, last = work[0], work[1], work[2]
    total[:] = 0.0
    carry = total[2:]
    for piece in range(0, n, _PIECE):
        sums[:] = 0.0
        for first in range(piece, min(piece + _PIECE, n), _BUFFER):
            m = min(_BUFFER, n - first)
            centred(x, seed, CELLS, surface, cell, first, m)
            if stratified:
                _stratified(x, m, first, n)
            for k in range(2):
                if orders[k] > 5 or (orders[k] and not k):
                    _first_ten(x, k == 1, before, last, m, sums[k])
                    for j in range(10, orders[k], 8):
                        _next_eight(x, before, last, m, sums[k, j:])
                elif orders[k]:
                    _first_five_rooted(x, m, sums[k])
        for k in range(2):
            _add_compensated(total[k], carry[k], sums[k], orders[k])
    total[:2] += carry


@njit(parallel=True, cache=True)
def _all_cells(
    seed: Any, first: Any, counts: Any, starts: Any, orders: Any, pairs: Any, bounds: Any, stratified: Any
) -> Any:
    """Each pair (cell, surface) is summed by one thread and written to its own place."""
    surfaces = counts.shape[1]
    moments = np.zeros((starts[-1], surfaces))
    for thread in prange(bounds.size - 1):
        work = np.empty((3, _BUFFER))
        sums, total = np.empty((2, _ROOM)), np.empty((4, _ROOM))
        for k in range(bounds[thread], bounds[thread + 1]):
            cell, surface = pairs[k] // surfaces, pairs[k] % surfaces
            key = (seed, first + surface, cell)
            _sum_cell(key, counts[cell, surface], orders[cell], stratified, work, sums, total)
            for j in range(orders[cell, 0]):
                moments[starts[cell] + j, surface] = total[0, j]
            for j in range(orders[cell, 1]):
                moments[starts[cell] + orders[cell, 0] + j, surface] = total[1, j]
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
    filled = np.flatnonzero((counts > 0) & (layout.sizes[:, None] > 0))
    threads = get_num_threads()
    shares = [filled[k::threads] for k in range(threads)]  # neighbours have about the same number
    pairs, bounds = np.concatenate(shares), np.cumsum([0, *map(len, shares)])
    orders = np.column_stack([layout.plain, layout.rooted])
    return np.asarray(
        _all_cells(np.uint64(seed), first, counts, layout.starts, orders, pairs, bounds, stratified)
    )
