"""Sums of Chebyshev polynomials over the uniforms of one cell, and products of matrices: the innermost loops.

Those over uniforms are written by a template. They know no physics, and have no branch, no exponential and
no logarithm. Of each number x = 2u - 1 they compute T_1 ... T_5 alone, each in a variable of its own: since
``2 T_m T_k = T_{m+k} + T_{m-k}``, the sums of the products of T_5 and T_1 ... T_5 stand for the orders
6 ... 10, those with T_10 for 11 ... 15, and so on (`unfold`). A loop over the orders would be two
to three times slower. The one for seven T_j and one f T_j::

    for i in range(n):
        t1 = w[i]
        y = t1 + t1
        t2 = y * t1 - 1.0
        t3 = y * t2 - t1
        ...
        f0 = np.sqrt(0.5 * t1 + 0.5)
        r0 += f0
        s1 += t1
        ...
        s6 += t5 * t1

A cell takes the first of the loops that has its orders. The compiler may take several terms of a sum at a
time, as many as the vector unit holds: the bits are those of one kind of processor.

A thread's workspace is one array, since each array that a function is given costs as much as ten asperities::

    from     0              1024 = PLAIN    1056 = ROOTED    1088 = WORDS
    there is x = 2u - 1     sums T_j        sums R_j         (end)
             of 1024 u      32 of them      32 of them
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from analytic.arrays import Array
from mcgw.machine.compiling import njit

BUFFER = 1024  # uniforms at a time: they stay in the innermost cache
PLAIN, ROOTED, WORDS = BUFFER, BUFFER + 32, BUFFER + 64
TOGETHER = 8  # uniforms: loops take a multiple, so that vector loops leave few over
_FAST = {"reassoc", "contract", "nsz"}
# Orders of the loops, cheapest first: nine that serve 11 to 401 separations, 1e4 to 1e8 asperities.
_ORDERS = ((9, 0), (11, 0), (14, 0), (11, 7), (12, 6), (13, 8), (13, 10), (14, 14), (21, 21))
_WEIGHTED = (6, 11, 21)


def _loop(plain: int, rooted: int, factor: str) -> list[str]:
    """Lines of a loop that adds products for T_1 ... and f T_0 ... of `n` numbers, and takes `filled` off."""
    sums = [(f"s{j}", f"PLAIN + {j}") for j in range(1, plain)]
    sums += [(f"r{j}", f"rooted_sums + {j}") for j in range(rooted)]
    most = max(plain, rooted)
    lines = [" = ".join([*(name for name, _ in sums), "0.0"]), "for i in range(n):"]
    lines += ["    t1 = w[i]", "    y = t1 + t1", "    t2 = y * t1 - 1.0"]
    lines += [f"    t{j} = y * t{j - 1} - t{j - 2}" for j in (3, 4, 5)]
    lines += ["    t10 = (t5 + t5) * t5 - 1.0"] * (most > 11)
    lines += ["    t15 = (t5 + t5) * t10 - t5"] * (most > 16)
    lines += [f"    f0 = {factor}"] * (rooted > 0) + [
        f"    f{m} = f0 * t{m}" for m in (5, 10, 15) if rooted > m + 1
    ]
    for j in range(most):
        first = (j - 1) // 5 * 5 if j else 0
        term = f"t{first} * t{j - first}" if first else f"t{j}"
        lines += [f"    s{j} += {term}"] * (0 < j < plain)
        lines += [f"    r{j} += f{first} * t{j - first}" if j else "    r0 += f0"] * (j < rooted)
    return lines + [f"w[{place}] += {name} - filled" for name, place in sums]


def _compiled(head: str, choices: list[tuple[str, list[str]]]) -> Callable[..., None]:
    """Return a function of these loops, of which the first whose condition holds is taken, or the last."""
    lines = [head]
    for condition, loop in choices[:-1]:
        lines += [f"    if {condition}:", *(f"        {line}" for line in loop), "        return"]
    lines += [f"    {line}" for line in choices[-1][1]]
    names = {"np": np, "PLAIN": PLAIN, "rooted_sums": ROOTED}
    exec("\n".join(lines), names)
    made: Callable[..., None] = njit(fastmath=_FAST)(names["add"])
    return made


add_uniforms = _compiled(
    "def add(w, n, filled, plain, rooted):",
    [(f"plain <= {p} and rooted <= {r}", _loop(p, r, "np.sqrt(0.5 * t1 + 0.5)")) for p, r in _ORDERS],
)
"""Add the sums of so many moments over the first `n` uniforms, a multiple of `TOGETHER`.

The last `filled` of them are 1, and are taken off again: every polynomial is 1 there, and the root.
"""
add_weighted = _compiled(
    "def add(w, n, filled, orders, weights, rooted_sums):",
    [(f"orders <= {r}", _loop(0, r, "w[weights + i]")) for r in _WEIGHTED],
)
add_weighted.__doc__ = (
    """Add to ``w[rooted_sums + j]`` the sums of so many f T_j; weights begin at `weights`."""
)


@njit(inline="always")
def unfold(moments: Any, row: Any, orders: Any, start: Any, stop: Any) -> None:
    """Make sums of polynomials of sums of products, `orders` rows from `row` on, for some surfaces."""
    for j in range(6, orders):
        before = row + 2 * ((j - 1) // 5 * 5) - j
        for surface in range(start, stop):
            moments[row + j, surface] = 2.0 * moments[row + j, surface] - moments[before, surface]


def chebyshev_transform(points: Array) -> Array:
    """Return the matrix from values at the Chebyshev points to coefficients of the series, shape (n, n)."""
    n = len(points)
    matrix = np.asarray(chebyshev.chebvander(points, n - 1).T * (2 / n), dtype=np.float64)
    matrix[0] /= 2
    return matrix


def product(a: Array, b: Array) -> Array:
    """Return the product of two matrices: the same bits for any number of threads and jobs.

    Libraries of linear algebra share it out to as many threads as there are; here each sum is taken in the
    order of its terms.

    Parameters
    ----------
    a, b : ndarray
        Shape (..., n) and (n, m), or (n,).

    Returns
    -------
    ndarray
        Shape (..., m), or (...).
    """
    rows = np.ascontiguousarray(a.reshape(math.prod(a.shape[:-1]), a.shape[-1]))
    columns = np.ascontiguousarray(b.reshape(len(b), math.prod(b.shape[1:])))
    result = np.empty((len(rows), columns.shape[1]))
    multiply(rows, columns, result)
    return result.reshape(a.shape[:-1] + b.shape[1:])


@njit(cache=True, fastmath={"contract"})
def multiply(a: Any, b: Any, result: Any) -> None:
    """Write `product` of two matrices, in compiled loops."""
    for i in range(a.shape[0]):
        for j in range(b.shape[1]):
            result[i, j] = 0.0
        for k in range(a.shape[1]):
            x = a[i, k]
            for j in range(b.shape[1]):
                result[i, j] += x * b[k, j]
