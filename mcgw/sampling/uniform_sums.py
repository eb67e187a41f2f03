"""Sums of Chebyshev polynomials over the uniforms of one cell: the innermost loops.

Only five polynomials are ever computed. Since ``2 T_m T_k = T_{m+k} + T_{m-k}``, the sums of the
products of T_5 and T_1 ... T_5 stand for the orders 6 ... 10; those with T_10, for 11 ... 15; and so on.
The loops know no physics; they have no branch, no exponential and no logarithm, and run at the width of
the vector unit.

To begin a cell must cost little. A thread's workspace is one array, since each array that a function is given
costs as much as ten asperities, and what is called once a cell is compiled into its caller. The workspace
holds some uniforms x = 2u - 1 at a time, their roots, ones, and the sums.
"""

from typing import Any

import numpy as np
from numba import njit

from mcgw.sampling.philox import CELLS, centred

__all__ = ["PLAIN", "ROOTED", "WORDS", "sum_uniforms", "unfold"]

_BUFFER = 1024  # uniforms at a time: they stay in the innermost cache
_ROOT, _ONE, PLAIN, ROOTED, WORDS = 1024, 2048, 3072, 3104, 3136  # where the rest begins, and its end

# A vectorised sum needs to reorder its terms, and nothing else: no NaN and no infinity is assumed away.
_VECTOR = {"reassoc", "nsz", "contract"}


@njit(inline="always")
def _five(x: Any) -> Any:
    """T_1 ... T_5 at x."""
    t2 = 2 * x * x - 1.0
    t3 = 2 * x * t2 - x
    t4 = 2 * x * t3 - t2
    return x, t2, t3, t4, 2 * x * t4 - t3


def _adder(plain: int, rooted: int) -> Any:
    """Loop that adds the sums of T_1 ... T_5, T_5 T_1 ... T_5 T_4, past ten T_5 T_5, T_10 T_1 ... T_10 T_5.

    Of the plain ones it adds ten, twelve or sixteen; of the rooted ones none, four (sqrt(u) T_0 ... T_3), six
    or eleven (and sqrt(u) T_5 T_1 ... T_5 T_5), then with the roots left behind. What is not asked for is not
    in the machine code.
    """

    @njit(nogil=True, cache=True, fastmath=_VECTOR)
    def add(w: Any, n: Any) -> None:
        a = b = c = d = e = f = g = h = p = q = 0.0
        v1 = v2 = v3 = v4 = v5 = 0.0
        r0 = r1 = r2 = r3 = r4 = r5 = s1 = s2 = s3 = s4 = s5 = 0.0
        for i in range(n):
            t1, t2, t3, t4, t5 = _five(w[i])
            a += t1
            b += t2
            c += t3
            d += t4
            e += t5
            f += t5 * t1
            g += t5 * t2
            h += t5 * t3
            p += t5 * t4
            if plain > 10:
                q += t5 * t5
                t10 = 2 * t5 * t5 - 1.0
                v1 += t10 * t1
            if plain > 12:
                v2 += t10 * t2
                v3 += t10 * t3
                v4 += t10 * t4
                v5 += t10 * t5
            if rooted:
                r = np.sqrt(0.5 * t1 + 0.5)
                r0 += r
                r1 += r * t1
                r2 += r * t2
                r3 += r * t3
            if rooted > 4:
                r4 += r * t4
                r5 += r * t5
            if rooted > 6:
                w[_ROOT + i] = r
                s = r * t5
                s1 += s * t1
                s2 += s * t2
                s3 += s * t3
                s4 += s * t4
                s5 += s * t5
        for k, total in enumerate((a, b, c, d, e, f, g, h, p)):
            w[PLAIN + 1 + k] += total
        if plain > 10:
            for k, total in enumerate((q, v1)):
                w[PLAIN + 10 + k] += total
        if plain > 12:
            for k, total in enumerate((v2, v3, v4, v5)):
                w[PLAIN + 12 + k] += total
        if rooted:
            for k, total in enumerate((r0, r1, r2, r3)):
                w[ROOTED + k] += total
        if rooted > 4:
            for k, total in enumerate((r4, r5)):
                w[ROOTED + 4 + k] += total
        if rooted > 6:
            for k, total in enumerate((s1, s2, s3, s4, s5)):
                w[ROOTED + 6 + k] += total

    return add


_10_0, _10_4, _10_6, _10_11 = _adder(10, 0), _adder(10, 4), _adder(10, 6), _adder(10, 11)
_12_0, _12_6, _12_11 = _adder(12, 0), _adder(12, 6), _adder(12, 11)
_16_0, _16_6, _16_11 = _adder(16, 0), _adder(16, 6), _adder(16, 11)


@njit(inline="always")
def _add(w: Any, n: Any, plain: Any, rooted: Any) -> None:
    """Add the sums of so many moments, by the shortest loop that will do."""
    if plain <= 10:
        if rooted == 0:
            _10_0(w, n)
        elif rooted <= 4:
            _10_4(w, n)
        elif rooted <= 6:
            _10_6(w, n)
        else:
            _10_11(w, n)
    elif plain <= 12:
        if rooted == 0:
            _12_0(w, n)
        elif rooted <= 6:
            _12_6(w, n)
        else:
            _12_11(w, n)
    elif rooted == 0:
        _16_0(w, n)
    elif rooted <= 6:
        _16_6(w, n)
    else:
        _16_11(w, n)
    if plain > 16:
        _five_more(w, n, 3, _ONE, PLAIN)
    if rooted > 11:
        _five_more(w, n, 2, _ROOT, ROOTED)
    if rooted > 16:
        _five_more(w, n, 3, _ROOT, ROOTED)


@njit(nogil=True, cache=True, fastmath=_VECTOR)
def _five_more(w: Any, n: Any, m: Any, factor: Any, sums: Any) -> None:
    """Add sums of T_5m T_1 ... T_5m T_5, m = 2 or 3, times a factor: T_5m is T_m of T_5."""
    c0, c1, c2, c3 = (-1.0, 0.0, 2.0, 0.0) if m == 2 else (0.0, -3.0, 0.0, 4.0)
    a = b = c = d = e = 0.0
    for i in range(n):
        t1, t2, t3, t4, t5 = _five(w[i])
        f = (((c3 * t5 + c2) * t5 + c1) * t5 + c0) * w[factor + i]
        a += f * t1
        b += f * t2
        c += f * t3
        d += f * t4
        e += f * t5
    for k, total in enumerate((a, b, c, d, e)):
        w[sums + 5 * m + 1 + k] += total


@njit(nogil=True, cache=True, fastmath=_VECTOR)
def _stratified(w: Any, n: Any, first: Any, strata: Any) -> None:
    """Move the uniform of asperity ``first + i`` into its own one of `strata` equal strata."""
    for i in range(n):
        w[i] = (2.0 * (first + i) + 1.0 + w[i]) / strata - 1.0


@njit(inline="always")
def sum_uniforms(
    w: Any, seed: Any, surface: Any, cell: Any, start: Any, stop: Any, strata: Any, orders: Any
) -> None:
    """Leave the sums over some uniforms of a cell in a workspace.

    Parameters
    ----------
    w : ndarray
        WORDS words; all ones when first used. Leaves T_j at ``PLAIN + j`` and R_j at ``ROOTED + j``, folded.
    seed, surface, cell : int
        Whose uniforms.
    start, stop : int
        Which ones, `start` a multiple of 64.
    strata : int
        How many equal strata to spread them over, one in each; 0 for none.
    orders : (int, int)
        How many T_j and R_j are wanted; there may be more.
    """
    plain, rooted = orders
    for k in range(PLAIN, WORDS):
        w[k] = 0.0
    for first in range(start, stop, _BUFFER):
        n = min(_BUFFER, stop - first)
        centred(w, seed, CELLS, surface, cell, first, n)
        if strata:
            _stratified(w, n, first, strata)
        _add(w, n, plain, rooted)
    w[PLAIN] = stop - start


@njit(nogil=True, cache=True)
def unfold(sums: Any, first: Any, orders: Any) -> None:
    """Make sums of polynomials of the sums of products.

    Parameters
    ----------
    sums : ndarray
        Rows, one an order, as `sum_uniforms` leaves them.
    first : int
        Row of order 0.
    orders : int
        How many there are.
    """
    for j in range(6, orders):
        m = (j - 1) // 5 * 5
        for i in range(sums.shape[1]):
            sums[first + j, i] = 2.0 * sums[first + j, i] - sums[first + 2 * m - j, i]
