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

_BUFFER = 512  # uniforms at a time: four buffers stay in the innermost cache
_PIECE = 512 * 512  # a plain sum of so many terms is good to 1e-14; beyond, it is compensated

# A vectorised sum needs to reorder its terms, and nothing else: no NaN and no infinity is assumed away.
_VECTOR = {"reassoc", "nsz", "contract"}


@njit(nogil=True, cache=True, fastmath=_VECTOR)
def _first_sums(x: Any, rooted: Any, before: Any, last: Any, n: Any, sums: Any) -> None:
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
def _next_sums(x: Any, before: Any, last: Any, n: Any, sums: Any) -> None:
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
def _sum_cell(seed: Any, surface: Any, cell: Any, n: Any, plain: Any, rooted: Any, stratified: Any) -> Any:
    """Moments of one cell of one surface: `plain` sums T_j, then `rooted` sums R_j."""
    x, before, last = np.empty(_BUFFER), np.empty(_BUFFER), np.empty(_BUFFER)
    orders = (plain, rooted)
    sums = np.zeros((2, max(plain, rooted) + 10))
    total, carry = np.zeros(sums.shape), np.zeros(sums.shape)
    for piece in range(0, n, _PIECE):
        sums[:] = 0.0
        for first in range(piece, min(piece + _PIECE, n), _BUFFER):
            m = min(_BUFFER, n - first)
            centred(x, seed, CELLS, surface, cell, first, m)
            if stratified:
                _stratified(x, m, first, n)
            for k in range(2):
                if orders[k]:
                    _first_sums(x, k == 1, before, last, m, sums[k])
                    for j in range(10, orders[k], 8):
                        _next_sums(x, before, last, m, sums[k, j:])
        for k in range(2):
            _add_compensated(total[k], carry[k], sums[k], orders[k])
    return np.concatenate((total[0, :plain] + carry[0, :plain], total[1, :rooted] + carry[1, :rooted]))


@njit(parallel=True, cache=True)
def _all_cells(
    seed: Any, first: Any, counts: Any, starts: Any, plain: Any, rooted: Any, order: Any, stratified: Any
) -> Any:
    """Each pair (cell, surface) of `order` is summed by one thread and written to its own place."""
    surfaces = counts.shape[1]
    moments = np.zeros((starts[-1], surfaces))
    for k in prange(order.size):
        cell, surface = order[k] // surfaces, order[k] % surfaces
        n = counts[cell, surface]
        found = _sum_cell(seed, first + surface, cell, n, plain[cell], rooted[cell], stratified)
        for j in range(found.size):
            moments[starts[cell] + j, surface] = found[j]
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
    worth = np.where(layout.sizes[:, None] > 0, counts, 0).ravel()
    largest = np.argsort(-worth, kind="stable")[: np.count_nonzero(worth)]
    threads = get_num_threads()
    dealt = np.concatenate([largest[k::threads] for k in range(threads)])  # an equal share for each
    return np.asarray(
        _all_cells(
            np.uint64(seed), first, counts, layout.starts, layout.plain, layout.rooted, dealt, stratified
        )
    )
