"""Sums of Chebyshev polynomials over the uniforms of one cell: the innermost loops, and what writes them.

Only five polynomials are ever computed. Since ``2 T_m T_k = T_{m+k} + T_{m-k}``, the sums of the
products of T_5 and T_1 ... T_5 stand for the orders 6 ... 10; those with T_10, for 11 ... 15; and so on.
The loops know no physics; they have no branch, no exponential and no logarithm, and go over four uniforms
at a time (`mcgw.sampling.lanes`).

A thread's workspace is one array, since each array that a function is given costs as much as ten asperities::

    from     0              1024 = _ROOT     2048 = PLAIN    2080 = ROOTED    2112 = WORDS
    there is x = 2u - 1     sqrt(u)          sums T_j        sums R_j         (end)
             of the same 1024 uniforms       32 of them      32 of them

Which of its loops a cell takes depends on how many sums it needs; each stands for all smaller numbers:

    ================  ========================================================
    plain T_j         rooted R_j for which there is a loop
    ================  ========================================================
    6                 4
    9                 0
    10                0, 6, 11
    12                0, 6, 11
    16                0, 6, 11
    beyond            the loop of 16, and five more T_j or R_j a pass
    ================  ========================================================
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils

from mcgw.machine.compiling import njit
from mcgw.sampling.lanes import LANES, called, intrinsic_of, place, same, sum_of

BUFFER = 1024  # uniforms at a time: they stay in the innermost cache
_variable: Any = cgutils.alloca_once_value
_ROOT, PLAIN, ROOTED, WORDS = 1024, 2048, 2080, 2112  # see above


def _adder(plain: range, weighted: range = range(0), *, roots: bool = False) -> Any:
    """Write a loop that adds the sums of the products that stand for some T_j, and for some f T_j.

    It is made of instructions: Numba takes half a second for a loop of Python's, and more for what calls it.

    Parameters
    ----------
    plain, weighted : range
        Which T_j, and which f T_j.
    roots : bool, optional
        Whether the weights f are those of the workspace, or the roots of the uniforms: then they are left
        there, if more than six orders are asked for.

    Returns
    -------
    function
        ``add(w, n, filled, weights, sums)`` for compiled loops: over the first `n` numbers x of a workspace,
        a multiple of LANES. Weights begin at ``w[weights]``; the sums are added to ``w[PLAIN + j]`` and
        ``w[sums + j]``. Of the last numbers so many as `filled` are 1, with the weight 1: each polynomial is
        1 there, and they are taken off again.
    """

    def add(_typing: Any, w: Any, _n: Any, _filled: Any, _weights: Any, _sums: Any) -> Any:
        def code(context: Any, b: Any, sig: Any, args: Any) -> Any:
            array, n, filled, weights, sums = args
            at = place(context, b, sig.args[0], array)
            kept = [(j, _variable(b, same(0.0))) for j in (*plain, *weighted)]
            with cgutils.for_range_slice(b, n.type(0), n, n.type(LANES), n.type) as (i, _):
                t, f = _polynomials(b, b.load(at(i), align=8), max(*plain, *weighted)), None
                for k, (j, lanes) in enumerate(kept):
                    if k == len(plain) and roots:
                        half = same(0.5)
                        f = called(b, "llvm.sqrt", called(b, "llvm.fma", half, t[1], half))
                        if weighted.stop > 6:
                            b.store(f, at(b.add(weights, i)), align=8)
                    elif k == len(plain):
                        f = b.load(at(b.add(weights, i)), align=8)
                    b.store(_with_product(b, b.load(lanes), t, j, f), lanes)
            off = b.sitofp(filled, ir.DoubleType())
            for k, (j, lanes) in enumerate(kept):
                where = at(b.add(n.type(PLAIN) if k < len(plain) else sums, n.type(j)), one=True)
                b.store(b.fadd(b.load(where), b.fsub(sum_of(b, b.load(lanes)), off)), where)
            return context.get_dummy_value()

        return types.void(w, *[types.intp] * 4), code

    return intrinsic_of(add)


def _polynomials(b: Any, x: Any, most: int) -> dict[int, Any]:
    """T_1 ... T_5 at x, and T_10 and T_15 if there are so many orders."""
    minus, twice = same(-1.0), b.fadd(x, x)
    t = {1: x, 2: called(b, "llvm.fma", twice, x, minus)}
    for j in (3, 4, 5):
        t[j] = called(b, "llvm.fma", twice, t[j - 1], b.fmul(minus, t[j - 2]))
    twice = b.fadd(t[5], t[5])
    if most > 10:
        t[10] = called(b, "llvm.fma", twice, t[5], minus)
    if most > 15:
        t[15] = called(b, "llvm.fma", twice, t[10], b.fmul(minus, t[5]))
    return t


def _with_product(b: Any, total: Any, t: dict[int, Any], j: int, f: Any) -> Any:
    """A sum and the next product that stands for T_j, or f T_j."""
    factors = [x for x in (f, t.get((j - 1) // 5 * 5)) if x is not None]
    if j:
        factors.append(t[(j - 1) % 5 + 1])
    while len(factors) > 2:
        factors[:2] = [b.fmul(*factors[:2])]
    return b.fadd(total, *factors) if len(factors) == 1 else called(b, "llvm.fma", *factors, total)


def _rooted(plain: int, rooted: int) -> Any:
    return _adder(range(1, plain), range(rooted), roots=True)


_6_4, _9_0 = _rooted(6, 4), _rooted(9, 0)
_10_0, _10_6, _10_11 = (_rooted(10, n) for n in (0, 6, 11))
_12_0, _12_6, _12_11 = (_rooted(12, n) for n in (0, 6, 11))
_16_0, _16_6, _16_11 = (_rooted(16, n) for n in (0, 6, 11))
_plain_more = _adder(range(16, 21))
_11_weighted, _16_weighted, _21_weighted = (
    _adder(range(0), r) for r in (range(11), range(11, 16), range(16, 21))
)


@njit(inline="always")
def add_uniforms(w: Any, count: Any, plain: Any, rooted: Any) -> None:
    """Add the sums of so many moments over `count` uniforms, by the shortest loop that will do."""
    n = (count + LANES - 1) // LANES * LANES
    filled = n - count
    for i in range(count, n):
        w[i] = 1.0
    if plain <= 10:
        if rooted == 0 and plain <= 9:
            _9_0(w, n, filled, _ROOT, ROOTED)
        elif rooted == 0:
            _10_0(w, n, filled, _ROOT, ROOTED)
        elif rooted <= 4 and plain <= 6:
            _6_4(w, n, filled, _ROOT, ROOTED)
        elif rooted <= 6:
            _10_6(w, n, filled, _ROOT, ROOTED)
        else:
            _10_11(w, n, filled, _ROOT, ROOTED)
    elif plain <= 12:
        if rooted == 0:
            _12_0(w, n, filled, _ROOT, ROOTED)
        elif rooted <= 6:
            _12_6(w, n, filled, _ROOT, ROOTED)
        else:
            _12_11(w, n, filled, _ROOT, ROOTED)
    elif rooted == 0:
        _16_0(w, n, filled, _ROOT, ROOTED)
    elif rooted <= 6:
        _16_6(w, n, filled, _ROOT, ROOTED)
    else:
        _16_11(w, n, filled, _ROOT, ROOTED)
    if plain > 16:
        _plain_more(w, n, filled, _ROOT, ROOTED)
    if rooted > 11:
        _16_weighted(w, n, filled, _ROOT, ROOTED)
    if rooted > 16:
        _21_weighted(w, n, filled, _ROOT, ROOTED)


@njit(inline="always")
def add_weighted(w: Any, n: Any, orders: Any, weights: Any, sums: Any) -> None:
    """Add the sums of so many f T_j over `n` uniforms, a multiple of LANES; weights begin at `weights`."""
    _11_weighted(w, n, 0, weights, sums)
    if orders > 11:
        _16_weighted(w, n, 0, weights, sums)
    if orders > 16:
        _21_weighted(w, n, 0, weights, sums)


@njit(inline="always")
def stratify(w: Any, n: Any, first: Any, strata: Any) -> None:
    """Move the uniform of asperity ``first + i`` into its own one of `strata` equal strata."""
    for i in range(n):
        w[i] = (2.0 * (first + i) + 1.0 + w[i]) / strata - 1.0


@njit(inline="always")
def unfold(sums: Any, first: Any, orders: Any, start: Any, stop: Any) -> None:
    """Make sums of polynomials of the sums of products.

    Parameters
    ----------
    sums : ndarray
        Rows, one an order.
    first : int
        Row of order 0.
    orders : int
        How many there are.
    start, stop : int
        Columns.
    """
    for j in range(6, orders):
        m = (j - 1) // 5 * 5
        for i in range(start, stop):
            sums[first + j, i] = 2.0 * sums[first + j, i] - sums[first + 2 * m - j, i]
