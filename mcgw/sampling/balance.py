"""The separation that the asperities of one surface feel at a nominal one, and its sums there: inner loops.

Asperities that press each other down feel ``x = h + c P(x)``, P being the load of this very surface. Newton's
steps on that need P and its slope at any x. Cells well above x need none of their asperities for that: the
sums of Chebyshev polynomials over their uniforms are turned into weights of a few heights, the Chebyshev
points of the cell, at which any function that is smooth on the cell gives the sum over all its asperities.
Only the cell in which x lies and the next one are drawn asperity by asperity, and those with hardly any.

Arrays are copied number by number, and cells found by a loop: what Numba compiles for a slice set to an
array, with the text of an error message in it, takes 4 s, and its search 1 s.
"""

from typing import Any

import numpy as np

from mcgw.machine.compiling import njit
from mcgw.sampling.lanes import LANES, alike, fused, load, roots, total
from mcgw.sampling.philox import CELLS, centred, made_for

POINTS = 16  # of a cell; the error falls as 5.8 to their number
SUMS = 5  # load, slope of the load, area, conductance (all reduced) and contacts
FAILED = -1.0  # in place of the contacts: the surface has no balance

_CLOSE = 4e-15  # of a separation
_ROUGHLY, _ROUGH_STEPS = 1e-3, 3  # a step after which cells are drawn, and how many without them
_MOST_STEPS = 100


def no_balance(surface: int, h: float) -> ValueError:
    """The error of a surface without a balance at a nominal separation, to be raised."""
    return ValueError(
        f"interaction: surface {surface} has no equilibrium at d/sigma = {h:g} from the mean plane; give "
        "larger separations"
    )


@njit(cache=True)
def _add_weighted(s: Any, graded: Any, weight: Any, first: Any, stop: Any, x: Any, sums: Any) -> None:
    """Add the sums over weighted heights, all above x; their number is a multiple of LANES."""
    forces = slopes = areas = widths = alike(0.0)
    plane = alike(x)
    for i in range(first, stop, LANES):
        d = load(s, i) - plane
        r, e, w = roots(d), load(graded, i), load(weight, i)
        pressed = e * r
        slopes += pressed
        forces = fused(pressed, d, forces)
        areas = fused(w, d, areas)
        widths = fused(w, r, widths)
    sums[0] += total(forces)
    sums[1] += total(slopes)
    sums[2] += total(areas)
    sums[3] += total(widths)


@njit(inline="always")
def _padded(n: Any) -> Any:
    """How many numbers fill whole registers."""
    return (n + LANES - 1) // LANES * LANES


@njit(cache=True)
def _add_single(s: Any, modulus: Any, first: Any, stop: Any, x: Any, room: Any, sums: Any) -> None:
    """Add the sums over single asperities, those above x."""
    n = stop - first
    contacts = 0
    for i in range(n):
        d = s[first + i] - x
        contacts += d > 0.0
        room[i] = max(d, 0.0)
    filled = _padded(n)
    for i in range(n, filled):
        room[i] = 0.0
    forces = slopes = areas = widths = alike(0.0)
    for i in range(0, filled, LANES):
        d = load(room, i)
        r = roots(d)
        pressed = load(modulus, first + i) * r
        slopes += pressed
        forces = fused(pressed, d, forces)
        areas += d
        widths += r
    sums[0] += total(forces)
    sums[1] += total(slopes)
    sums[2] += total(areas)
    sums[3] += total(widths)
    sums[4] += contacts


@njit(cache=True)
def _series(coefficients: Any, cell: Any, x: Any, n: Any, value: Any, last: Any) -> None:
    """Chebyshev series of a cell at the points x, by Clenshaw's recurrence, into `value`."""
    order = coefficients.shape[0]
    for i in range(n):
        value[i] = 0.0
        last[i] = 0.0
    for j in range(order - 1, 0, -1):
        c = coefficients[j, cell]
        for i in range(n):
            now = fused(x[i] + x[i], value[i], c - last[i])
            last[i] = value[i]
            value[i] = now
    c = coefficients[0, cell]
    for i in range(n):
        value[i] = fused(x[i], value[i], c - last[i])


@njit(cache=True)
def _draw(
    seed: Any, surface: Any, cell: Any, n: Any, mesh: Any, s: Any, modulus: Any, at: Any, room: Any
) -> None:
    """Heights and moduli of the asperities of a cell into `s` and `modulus`, from `at` on."""
    edges, stretch, moduli = mesh
    x, value, last = room[0], room[1], room[2]
    centred(x, seed, CELLS, surface, cell, 0, n)
    _series(stretch, cell, x, n, value, last)
    for i in range(n):
        s[at + i] = edges[cell] + (1.0 + x[i]) / 2.0 * value[i]
    _series(moduli, cell, x, n, value, last)
    for i in range(n):
        modulus[at + i] = value[i]
    for i in range(n, _padded(n)):
        s[at + i] = edges[cell]
        modulus[at + i] = 0.0


@njit(cache=True)
def _cell_of(edges: Any, x: Any) -> Any:
    """The cell that x lies in; the first below all, the number of cells above all."""
    low, high = 0, edges.size
    while low < high:
        middle = (low + high) // 2
        if edges[middle] <= x:
            low = middle + 1
        else:
            high = middle
    return max(low - 1, 0)


@njit(cache=True)
def _copy(given: Any, first: Any, stop: Any, to: Any) -> None:
    """Numbers `first` to `stop` of an array to the beginning of another."""
    for i in range(first, stop):
        to[i - first] = given[i]


@njit(cache=True)
def _grown(s: Any, modulus: Any, needed: Any) -> Any:
    """The arrays, or larger ones that begin alike."""
    if needed <= s.size:
        return s, modulus
    more_s, more_modulus = np.empty(2 * needed), np.empty(2 * needed)
    _copy(s, 0, s.size, more_s)
    _copy(modulus, 0, s.size, more_modulus)
    return more_s, more_modulus


@njit(cache=True)
def _singles(who: Any, mesh: Any, counts: Any, few: Any, own: Any, first: Any, stop: Any, room: Any) -> Any:
    """Heights and moduli of the asperities that are always taken one by one, and how many with padding.

    Those outside of the cells, `first` to `stop` of what is the surface's own, and of cells with few.
    """
    n = stop - first
    for cell in range(counts.size):
        if counts[cell] <= few:
            n += _padded(counts[cell])
    s, modulus = np.full(n + LANES, -np.inf), np.zeros(n + LANES)
    _copy(own[0], first, stop, s)
    _copy(own[1], first, stop, modulus)
    at = _padded(stop - first)
    for cell in range(counts.size):
        if 0 < counts[cell] <= few:
            _draw(who[0], who[1], cell, counts[cell], mesh, s, modulus, at, room)
            for i in range(at + counts[cell], at + _padded(counts[cell])):
                s[i] = -np.inf  # it fills a register, and is nobody
            at += _padded(counts[cell])
    return s, modulus, at


@njit(cache=True)
def _balance(
    who: Any, mesh: Any, nodes: Any, counts: Any, few: Any, singles: Any, asked: Any, room: Any, result: Any
) -> None:
    """Effective separations of one surface, and its sums there: a row of `result` for each."""
    edges, cells = mesh[0], counts.size
    heights, graded, weight = nodes
    above = np.zeros(cells + 1)  # asperities in the crowded cells from here on
    for cell in range(cells - 1, -1, -1):
        above[cell] = above[cell + 1] + (counts[cell] if counts[cell] > few else 0)
    s, modulus = np.empty(4096), np.empty(4096)
    starts, filled = np.full(cells, -1), 0
    sums = np.empty(SUMS)
    nominal, guess, c = asked
    for k in range(nominal.size):
        h, x, exact, tries = nominal[k], guess[k], False, 0
        while True:
            cell = _cell_of(edges, x)
            far = min(cell + 2, cells)
            sums[:] = 0.0
            _add_single(singles[0], singles[1], 0, singles[2], x, room[0], sums)
            for near in range(cell, far if exact else cell):
                n = counts[near]
                if n <= few:
                    continue
                if starts[near] < 0:
                    starts[near] = filled
                    s, modulus = _grown(s, modulus, filled + _padded(n))
                    _draw(who[0], who[1], near, n, mesh, s, modulus, starts[near], room)
                    filled += _padded(n)
                _add_single(s, modulus, starts[near], starts[near] + n, x, room[0], sums)
            _add_weighted(heights, graded, weight, far * POINTS, cells * POINTS, x, sums)
            sums[4] += above[far]
            rate = 1.0 + 1.5 * c * sums[1]
            tries += 1
            if tries > _MOST_STEPS or (rate <= 0.0 and x == h):
                sums[4] = FAILED
                break
            if rate <= 0.0:  # too far from the side of no load
                x = h
                continue
            step = (h - x + c * sums[0]) / rate
            if exact and abs(step) <= _CLOSE * max(abs(x), 1.0):
                break
            exact = exact or abs(step) <= _ROUGHLY or tries == _ROUGH_STEPS
            x += step
        result[k, 0] = x
        for j in range(SUMS):
            result[k, 1 + j] = sums[j]


@njit(cache=True)
def balance_surfaces(
    seed: Any, first: Any, mesh: Any, nodes: Any, counts: Any, few: Any, own: Any, asked: Any
) -> Any:
    """Effective separations of some surfaces, and their sums there.

    Parameters
    ----------
    seed, first : int
        The key, and number of the first surface.
    mesh : tuple of ndarray
        Edges (cells + 1,), and Chebyshev coefficients of the stretch and of the modulus, (order, cells).
    nodes : tuple of ndarray
        Heights (cells * POINTS,), and for each surface the weights times the modulus, and the weights,
        (surfaces, cells * POINTS).
    counts : ndarray of int
        Asperities of each surface in each cell, (surfaces, cells).
    few : int
        Cells with so many at most have no weights; their asperities are taken one by one.
    own : tuple of ndarray
        Heights and moduli of those outside of the cells, (n,) each, and where each surface begins among
        them, (surfaces + 1,).
    asked : tuple
        Nominal separations (k,), what the search starts from (k,), c for a reduced load.

    Returns
    -------
    ndarray
        For each separation the effective one and the sums, (surfaces, k, 1 + SUMS).
    """
    surfaces = counts.shape[0]
    result = np.empty((surfaces, asked[0].size, 1 + SUMS))
    for i in range(surfaces):
        who, begin, end = (seed, first + i), own[2][i], own[2][i + 1]
        outside = end - begin + 2 * LANES
        most = made_for(max(counts[i].max(), outside)) if counts.shape[1] else made_for(outside)
        room = np.empty((3, most + LANES))
        singles = _singles(who, mesh, counts[i], few, own, begin, end, room)
        if singles[2] > room.shape[1]:
            room = np.empty((3, singles[2] + LANES))
        weights = (nodes[0], nodes[1][i], nodes[2][i])
        _balance(who, mesh, weights, counts[i], few, singles, asked, room, result[i])
    return result
