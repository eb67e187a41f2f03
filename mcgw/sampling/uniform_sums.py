"""Sums of Chebyshev polynomials over the uniforms of one cell: the innermost loops.

Only five polynomials are ever computed. Since ``2 T_m T_k = T_{m+k} + T_{m-k}``, the sums of the
products of T_5 and T_1 ... T_5 stand for the orders 6 ... 10; those with T_10, for 11 ... 15; and so on.
The loops know no physics; they have no branch, no exponential and no logarithm, and go over four uniforms
at a time (`mcgw.sampling.lanes`).

To begin a cell must cost little. A thread's workspace is one array, since each array that a function is given
costs as much as ten asperities, and what is called once a cell is compiled into its caller::

    from     0              1024 = _ROOT     2048 = _ONE     3072 = PLAIN    3104 = ROOTED    3136 = WORDS
    there is x = 2u - 1     sqrt(u)          1               sums T_j        sums R_j         (end)
             of the same 1024 uniforms, in turn              32 of them      32 of them

Which of its loops a cell takes depends on how many sums it needs; each stands for all smaller numbers:

    ================  ========================================================
    plain T_j         rooted R_j for which there is a loop
    ================  ========================================================
    10                0, 4, 6, 11
    12                0, 6, 11
    16                0, 6, 11
    beyond            the loop of 16, and five more T_j or R_j a pass
    ================  ========================================================
"""

from typing import Any

from mcgw.machine.compiling import njit
from mcgw.sampling.lanes import LANES, alike, fused, load, roots, store, total
from mcgw.sampling.philox import CELLS, centred

__all__ = [
    "BUFFER",
    "PLAIN",
    "ROOTED",
    "WORDS",
    "add_uniforms",
    "five",
    "five_more",
    "stratify",
    "sum_uniforms",
    "unfold",
]

BUFFER = 1024  # uniforms at a time: they stay in the innermost cache
_ROOT, _ONE, PLAIN, ROOTED, WORDS = 1024, 2048, 3072, 3104, 3136  # see above


@njit(inline="always")
def five(x: Any) -> Any:
    """T_1 ... T_5 at x."""
    twice, minus = x + x, alike(-1.0)
    t2 = fused(twice, x, minus)
    t3 = fused(twice, t2, minus * x)
    t4 = fused(twice, t3, minus * t2)
    return x, t2, t3, t4, fused(twice, t4, minus * t3)


def _adder(plain: int, rooted: int) -> Any:
    """Loop that adds the sums of T_1 ... T_5, T_5 T_1 ... T_5 T_4, past ten T_5 T_5, T_10 T_1 ... T_10 T_5.

    Of the plain ones it adds ten, twelve or sixteen; of the rooted ones none, four (sqrt(u) T_0 ... T_3), six
    or eleven (and sqrt(u) T_5 T_1 ... T_5 T_5), then with the roots left behind. What is not asked for is not
    in the machine code. `n` is a multiple of LANES, and of the last terms so many as `filled` are at x = 1,
    where each polynomial is 1: they are taken off again.
    """

    @njit(nogil=True, cache=True, version=f"{plain}_{rooted}")
    def add(w: Any, n: Any, filled: Any) -> None:
        a = b = c = d = e = f = g = h = p = q = alike(0.0)
        v1 = v2 = v3 = v4 = v5 = alike(0.0)
        r0 = r1 = r2 = r3 = r4 = r5 = s1 = s2 = s3 = s4 = s5 = alike(0.0)
        half, minus = alike(0.5), alike(-1.0)
        for i in range(0, n, LANES):
            t1, t2, t3, t4, t5 = five(load(w, i))
            a += t1
            b += t2
            c += t3
            d += t4
            e += t5
            f = fused(t5, t1, f)
            g = fused(t5, t2, g)
            h = fused(t5, t3, h)
            p = fused(t5, t4, p)
            if plain > 10:
                q = fused(t5, t5, q)
                t10 = fused(t5 + t5, t5, minus)
                v1 = fused(t10, t1, v1)
            if plain > 12:
                v2 = fused(t10, t2, v2)
                v3 = fused(t10, t3, v3)
                v4 = fused(t10, t4, v4)
                v5 = fused(t10, t5, v5)
            if rooted:
                r = roots(fused(half, t1, half))
                r0 += r
                r1 = fused(r, t1, r1)
                r2 = fused(r, t2, r2)
                r3 = fused(r, t3, r3)
            if rooted > 4:
                r4 = fused(r, t4, r4)
                r5 = fused(r, t5, r5)
            if rooted > 6:
                store(w, _ROOT + i, r)
                s = r * t5
                s1 = fused(s, t1, s1)
                s2 = fused(s, t2, s2)
                s3 = fused(s, t3, s3)
                s4 = fused(s, t4, s4)
                s5 = fused(s, t5, s5)
        for k, lanes in enumerate((a, b, c, d, e, f, g, h, p)):
            w[PLAIN + 1 + k] += total(lanes) - filled
        if plain > 10:
            for k, lanes in enumerate((q, v1)):
                w[PLAIN + 10 + k] += total(lanes) - filled
        if plain > 12:
            for k, lanes in enumerate((v2, v3, v4, v5)):
                w[PLAIN + 12 + k] += total(lanes) - filled
        if rooted:
            for k, lanes in enumerate((r0, r1, r2, r3)):
                w[ROOTED + k] += total(lanes) - filled
        if rooted > 4:
            for k, lanes in enumerate((r4, r5)):
                w[ROOTED + 4 + k] += total(lanes) - filled
        if rooted > 6:
            for k, lanes in enumerate((s1, s2, s3, s4, s5)):
                w[ROOTED + 6 + k] += total(lanes) - filled

    return add


_10_0, _10_4, _10_6, _10_11 = _adder(10, 0), _adder(10, 4), _adder(10, 6), _adder(10, 11)
_12_0, _12_6, _12_11 = _adder(12, 0), _adder(12, 6), _adder(12, 11)
_16_0, _16_6, _16_11 = _adder(16, 0), _adder(16, 6), _adder(16, 11)


@njit(inline="always")
def add_uniforms(w: Any, count: Any, plain: Any, rooted: Any) -> None:
    """Add the sums of so many moments over `count` uniforms, by the shortest loop that will do."""
    n = (count + LANES - 1) // LANES * LANES
    filled = n - count
    for i in range(count, n):
        w[i] = 1.0
    if plain <= 10:
        if rooted == 0:
            _10_0(w, n, filled)
        elif rooted <= 4:
            _10_4(w, n, filled)
        elif rooted <= 6:
            _10_6(w, n, filled)
        else:
            _10_11(w, n, filled)
    elif plain <= 12:
        if rooted == 0:
            _12_0(w, n, filled)
        elif rooted <= 6:
            _12_6(w, n, filled)
        else:
            _12_11(w, n, filled)
    elif rooted == 0:
        _16_0(w, n, filled)
    elif rooted <= 6:
        _16_6(w, n, filled)
    else:
        _16_11(w, n, filled)
    if plain > 16:
        five_more(w, n, filled, 3, _ONE, PLAIN)
    if rooted > 11:
        five_more(w, n, filled, 2, _ROOT, ROOTED)
    if rooted > 16:
        five_more(w, n, filled, 3, _ROOT, ROOTED)


@njit(nogil=True, cache=True)
def five_more(w: Any, n: Any, filled: Any, m: Any, factor: Any, sums: Any) -> None:
    """Add sums of T_5m T_1 ... T_5m T_5, m = 2 or 3, times a factor: T_5m is T_m of T_5."""
    a = b = c = d = e = alike(0.0)
    for i in range(0, n, LANES):
        t1, t2, t3, t4, t5 = five(load(w, i))
        f = fused(t5 + t5, t5, alike(-1.0))
        if m == 3:
            f = fused(t5 + t5, f, alike(-1.0) * t5)
        f *= load(w, factor + i)
        a = fused(f, t1, a)
        b = fused(f, t2, b)
        c = fused(f, t3, c)
        d = fused(f, t4, d)
        e = fused(f, t5, e)
    for k, lanes in enumerate((a, b, c, d, e)):
        w[sums + 5 * m + 1 + k] += total(lanes) - filled


@njit(nogil=True, cache=True)
def stratify(w: Any, n: Any, first: Any, strata: Any) -> None:
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
        Which ones, `start` a multiple of `philox.AT_ONCE`.
    strata : int
        How many equal strata to spread them over, one in each; 0 for none.
    orders : (int, int)
        How many T_j and R_j are wanted; there may be more.
    """
    plain, rooted = orders
    for k in range(PLAIN, WORDS):
        w[k] = 0.0
    for first in range(start, stop, BUFFER):
        n = min(BUFFER, stop - first)
        centred(w, seed, CELLS, surface, cell, first, n)
        if strata:
            stratify(w, n, first, strata)
        add_uniforms(w, n, plain, rooted)
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
