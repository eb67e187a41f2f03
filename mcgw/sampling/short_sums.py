"""Moments of cells where less than the last digit is asked: shorter sums, of uniforms of fewer bits.

The sums are those of `mcgw.sampling.moments`. Few orders have loops of their own: T_1 ... T_4 as they are,
then T_5 ... T_7 from the products T_3 T_2, T_3 T_3 and T_4 T_3. The shortest loop takes T_3 and T_4 from the
products T_2 T_1 and T_2 T_2 as well, and eight uniforms at a time, for a sum is slower than its terms. More
orders are summed by the loops of `mcgw.sampling.uniform_sums`.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mcgw.machine.compiling import njit
from mcgw.sampling.few_bits import spread
from mcgw.sampling.lanes import LANES, alike, fused, load, roots, total
from mcgw.sampling.layout import Layout
from mcgw.sampling.moments import add_compensated, in_runs_of_cells
from mcgw.sampling.uniform_sums import BUFFER, PLAIN, ROOTED, WORDS, add_uniforms

__all__ = ["short_moments"]

Ints = NDArray[np.int64]


def _adder(plain: int, rooted: int) -> Any:
    """Loop that adds so many sums, as `mcgw.sampling.uniform_sums` does, products not yet unfolded."""

    @njit(nogil=True, cache=True, version=f"short_{plain}_{rooted}")
    def add(w: Any, n: Any, filled: Any) -> None:
        a = b = c = d = e = f = g = r0 = r1 = r2 = r3 = alike(0.0)
        half, minus = alike(0.5), alike(-1.0)
        for i in range(0, n, LANES):
            x = load(w, i)
            twice = x + x
            t2 = fused(twice, x, minus)
            t3 = fused(twice, t2, minus * x)
            t4 = fused(t2 + t2, t2, minus)
            a += x
            b += t2
            c += t3
            d += t4
            if plain > 5:
                e = fused(t3, t2, e)
                f = fused(t3, t3, f)
                g = fused(t4, t3, g)
            if rooted:
                r = roots(fused(half, x, half))
                r0 += r
                r1 = fused(r, x, r1)
                r2 = fused(r, t2, r2)
                r3 = fused(r, t3, r3)
        for k, lanes in enumerate((a, b, c, d)):
            w[PLAIN + 1 + k] += total(lanes) - filled
        if plain > 5:
            for k, lanes in enumerate((e, f, g)):
                w[PLAIN + 5 + k] += total(lanes) - filled
        if rooted:
            for k, lanes in enumerate((r0, r1, r2, r3)):
                w[ROOTED + k] += total(lanes) - filled

    return add


_5_4, _8_0, _8_4 = _adder(5, 4), _adder(8, 0), _adder(8, 4)


@njit(nogil=True, cache=True)
def _5_0(w: Any, n: Any, filled: Any) -> None:
    """Add the sums of T_1, T_2, T_2 T_1, T_2 T_2 over a multiple of eight uniforms."""
    a = b = c = d = e = f = g = h = alike(0.0)
    minus = alike(-1.0)
    for i in range(0, n, 2 * LANES):
        x, y = load(w, i), load(w, i + LANES)
        p, q = fused(x + x, x, minus), fused(y + y, y, minus)
        a += x
        e += y
        b += p
        f += q
        c = fused(p, x, c)
        g = fused(q, y, g)
        d = fused(p, p, d)
        h = fused(q, q, h)
    for k, lanes in enumerate((a + e, b + f, c + g, d + h)):
        w[PLAIN + 1 + k] += total(lanes) - filled


@njit(nogil=True, cache=True)
def _add(w: Any, count: Any, plain: Any, rooted: Any) -> None:
    """Add the sums over `count` uniforms by the shortest loop that will do."""
    if plain > 8 or rooted > 4:
        add_uniforms(w, count, plain, rooted)
        return
    n = (count + 2 * LANES - 1) // (2 * LANES) * (2 * LANES)
    for i in range(count, n):
        w[i] = 1.0
    if plain <= 5:
        if rooted == 0:
            _5_0(w, n, n - count)
        else:
            _5_4(w, n, n - count)
    elif rooted == 0:
        _8_0(w, n, n - count)
    else:
        _8_4(w, n, n - count)


@njit(nogil=True, cache=True)
def _unfold(w: Any, n: Any, plain: Any, rooted: Any) -> None:
    """Make sums of polynomials of the sums of products."""
    w[PLAIN] = n
    if plain <= 5 and rooted == 0:
        w[PLAIN + 3] = 2.0 * w[PLAIN + 3] - w[PLAIN + 1]
        w[PLAIN + 4] = 2.0 * w[PLAIN + 4] - n
        return
    if plain <= 8 and rooted <= 4:
        w[PLAIN + 5] = 2.0 * w[PLAIN + 5] - w[PLAIN + 1]
        w[PLAIN + 6] = 2.0 * w[PLAIN + 6] - n
        w[PLAIN + 7] = 2.0 * w[PLAIN + 7] - w[PLAIN + 1]
        return
    for first, orders in ((PLAIN, plain), (ROOTED, rooted)):
        for j in range(6, orders):
            w[first + j] = 2.0 * w[first + j] - w[first + 2 * ((j - 1) // 5 * 5) - j]


@njit(nogil=True, cache=True)
def _sum_cell(
    w: Any, kept: Any, seed: Any, surface: Any, cell: Any, n: Any, plain: Any, rooted: Any, bits: Any
) -> None:
    """Leave the sums over the uniforms of a cell in the workspace."""
    sums = w[PLAIN:WORDS]
    sums[:] = 0.0
    if n > BUFFER:
        kept[:] = 0.0
    for first in range(0, n, BUFFER):
        m = min(BUFFER, n - first)
        spread(w, seed, surface, cell, first, m, bits)
        _add(w, m, plain, rooted)
        if n > BUFFER:
            add_compensated(kept[0], kept[1], sums)
            sums[:] = 0.0
    if n > BUFFER:
        for j in range(sums.size):
            sums[j] = kept[0, j] + kept[1, j]
    _unfold(w, n, plain, rooted)


@njit(nogil=True, cache=True)
def _sum_cells(
    seed: Any, first: Any, counts: Any, starts: Any, orders: Any, bits: Any, bounds: Any, moments: Any
) -> None:
    """Sum a run of cells, all surfaces of one after the other."""
    w, kept = np.ones(WORDS), np.zeros((2, WORDS - PLAIN))
    surfaces = counts.shape[1]
    for at in range(bounds[0], bounds[1]):
        cell, surface = at // surfaces, at % surfaces
        plain, rooted = orders[cell, 0], orders[cell, 1]
        n, row = counts[cell, surface], starts[cell]
        if n == 0:
            moments[row : row + plain + rooted, surface] = 0.0
            continue
        _sum_cell(w, kept, seed, first + surface, cell, n, plain, rooted, bits[cell])
        for j in range(plain):
            moments[row + j, surface] = w[PLAIN + j]
        for j in range(rooted):
            moments[row + plain + j, surface] = w[ROOTED + j]


def short_moments(seed: int, first: int, counts: Ints, layout: Layout, bits: Ints) -> NDArray[np.float64]:
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
    bits : ndarray of int
        Of the uniforms of each cell.

    Returns
    -------
    ndarray
        Shape (moments, surfaces): the same bits for any number of threads and in any block.
    """

    def sum_run(*cells: Any) -> None:
        counts, starts, orders, bounds, moments = cells
        _sum_cells(np.uint64(seed), first, counts, starts, orders, bits, bounds, moments)

    return in_runs_of_cells(counts, layout, sum_run)
