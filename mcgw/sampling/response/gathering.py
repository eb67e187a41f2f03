"""From rows of a matrix, each a few runs of neighbouring columns, to tiles in the order of one sweep."""

from typing import Any, NamedTuple

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit

FOUR = 4  # rows and columns of a tile


def in_fours(rows: Any) -> Any:
    """Rounded up."""
    return (rows + FOUR - 1) // FOUR * FOUR


class Lines(NamedTuple):
    """Pieces of rows, one an array element; a row may have several.

    Attributes
    ----------
    row : ndarray of int
        Whose they are.
    start, length : ndarray of int
        First column, a multiple of four, and number of columns.
    at : ndarray of int
        Where their values begin.
    values : ndarray
        Of the columns of all lines.
    """

    row: Ints
    start: Ints
    length: Ints
    at: Ints
    values: Array


def gathered(first: Lines, second: Lines, given: int, computed: int) -> tuple[Any, ...]:
    """Gather lines into tiles.

    Parameters
    ----------
    first, second : Lines
        Of rows that are computed, of given rows and rows of earlier groups; the first ones go before.
    given, computed : int
        How many groups of rows are given, and how many are computed after them.

    Returns
    -------
    tuple of ndarray
        Which computed group each step computes; the given groups that are fetched; then `fetch_ends` to
        `computed` of `mcgw.sampling.response.product.Tiles`. Groups are computed in one sweep from the
        highest given ones that they need down, so that each has a place in the table for a short time; tiles
        of a group in the order of their columns.
    """
    row, start, length, at = (np.concatenate(both) for both in zip(first[:4], second[:4], strict=True))
    values = first.values, second.values
    lines = row, start, length, at, len(first.row), values
    needed = _needed(lines, given, computed)
    tiles = np.zeros((len(needed[-1]), FOUR, FOUR))  # here: NumPy asks for large pages, compiled loops do not
    return tuple(_gather(lines, needed, given, computed, tiles))


@njit()
def _find_filled(length: Any, at: Any, values: Any, filled: Any) -> None:
    """Which fours of the values of each line are not all zeros, as bits."""
    for line in range(length.size):
        bits = np.uint32(0)
        for column in range(length[line]):
            if values[at[line] + column] != 0.0:
                bits |= np.uint32(1) << np.uint32(column // FOUR)
        filled[line] = bits


@njit()
def _sorted_by(keys: Any, kinds: Any) -> Any:
    """Where each kind of key begins, and all places in order of their keys; alike ones in their own order."""
    starts = np.zeros(kinds + 1, dtype=np.int64)
    for i in range(keys.size):
        starts[keys[i] + 1] += 1
    for kind in range(kinds):
        starts[kind + 1] += starts[kind]
    at, order = starts.copy(), np.empty(keys.size, dtype=np.int64)
    for i in range(keys.size):
        order[at[keys[i]]] = i
        at[keys[i]] += 1
    return starts, order


@njit()
def _sources(group: Any, start: Any, filled: Any, given: Any, computed: Any) -> Any:
    """Groups that each computed group needs, increasing; and its lines, so too."""
    along = _sorted_by(start // FOUR, given + computed)[1]  # then each source is put near the last one
    firsts, order = _sorted_by(group[along], computed)
    lines, most = along[order], 0
    for bits in filled:
        while bits:
            most += bits & np.uint32(1)
            bits >>= np.uint32(1)
    seen = np.full(given + computed, -1)
    ends, sources, n = np.empty(computed, dtype=np.int64), np.empty(most, dtype=np.int64), 0
    for g in range(computed):
        first = n
        for line in lines[firsts[g] : firsts[g + 1]]:
            source, bits = start[line] // FOUR, filled[line]
            while bits:
                if bits & np.uint32(1) and seen[source] != g:
                    seen[source] = g
                    i = n
                    while i > first and sources[i - 1] > source:
                        sources[i] = sources[i - 1]
                        i -= 1
                    sources[i] = source
                    n += 1
                bits >>= np.uint32(1)
                source += 1
        ends[g] = n
    return firsts, lines, ends, sources[:n]


@njit()
def _sweep_down(ends: Any, sources: Any, given: Any) -> Any:
    """Computed groups in the order of the lowest given group that each needs, by way of the others too."""
    lowest, highest, first = np.full(ends.size, given), np.empty(ends.size, dtype=np.int64), 0
    for g in range(ends.size):
        for source in sources[first : ends[g]]:
            lowest[g] = min(lowest[g], source if source < given else lowest[source - given])
        highest[g], first = given - lowest[g], ends[g]
    return _sorted_by(highest, given + 1)[1]


@njit()
def _last_steps(order: Any, ends: Any, sources: Any, given: Any) -> Any:
    """The step at which each group is needed for the last time, or computed."""
    last = np.full(given + order.size, -1)
    for step in range(order.size):
        g = order[step]
        last[given + g] = max(last[given + g], step)
        for source in sources[(ends[g - 1] if g else 0) : ends[g]]:
            last[source] = max(last[source], step)
    return last


@njit()
def _fill(tiles: Any, tile_of: Any, source: Any, row: Any, values: Any, at: Any, n: Any, filled: Any) -> None:
    """Write the `n` values of a line, from `at` on, into the tiles of its groups, from `source` on."""
    for first in range(0, n, FOUR):
        if filled & np.uint32(1):
            tile = tile_of[source]
            for column in range(min(FOUR, n - first)):
                tiles[tile, row, column] = values[at + first + column]
        filled >>= np.uint32(1)
        source += 1


@njit(cache=True)
def _needed(all_lines: Any, given: Any, computed: Any) -> Any:
    """What is not zero in each line, then as `_sources`."""
    row, start, length, at, n_first, (first, second) = all_lines
    filled = np.empty(row.size, dtype=np.uint32)
    _find_filled(length[:n_first], at[:n_first], first, filled[:n_first])
    _find_filled(length[n_first:], at[n_first:], second, filled[n_first:])
    firsts, lines, ends, sources = _sources(row // FOUR - given, start, filled, given, computed)
    return filled, firsts, lines, ends, sources


@njit(cache=True)
def _gather(all_lines: Any, needed: Any, given: Any, computed: Any, tiles: Any) -> Any:
    row, start, length, at, n_first, (first, second) = all_lines
    filled, firsts, lines, ends, sources = needed
    order = _sweep_down(ends, sources, given)
    last = _last_steps(order, ends, sources, given)
    place, tile_of = np.full(given + computed, -1), np.empty(given + computed, dtype=np.int64)
    leaving, after = np.full(computed, -1), np.empty(given + computed, dtype=np.int64)  # lists of groups
    free, n_free, places = np.empty(given + computed, dtype=np.int64), 0, 0
    fetches, n_fetches, n_tiles = np.empty(given, dtype=np.int64), 0, 0
    fetch_ends, tile_ends = np.empty(computed, dtype=np.int64), np.empty(computed, dtype=np.int64)
    used = np.empty(sources.size, dtype=np.uint64)
    for step in range(computed):
        group = leaving[step - 1] if step else -1
        while group >= 0:
            free[n_free] = place[group]
            n_free += 1
            group = after[group]
        g = order[step]
        for i in range(ends[g - 1] if g else 0, ends[g] + 1):  # what it needs, then the group itself
            group = sources[i] if i < ends[g] else given + g
            if place[group] < 0:
                if group < given:
                    fetches[n_fetches] = group
                    n_fetches += 1
                if n_free:
                    n_free -= 1
                    place[group] = free[n_free]
                else:
                    place[group] = places
                    places += 1
                after[group], leaving[last[group]] = leaving[last[group]], group
            if i < ends[g]:
                tile_of[group] = n_tiles
                used[n_tiles] = FOUR * place[group]
                n_tiles += 1
        for line in lines[firsts[g] : firsts[g + 1]]:
            where, own = start[line] // FOUR, row[line] % FOUR
            if line < n_first:
                _fill(tiles, tile_of, where, own, first, at[line], length[line], filled[line])
            else:
                _fill(tiles, tile_of, where, own, second, at[line], length[line], filled[line])
        fetch_ends[step], tile_ends[step] = n_fetches, n_tiles
    fetches = fetches[:n_fetches]
    return (
        order,
        fetches,
        fetch_ends,
        FOUR * place[fetches],
        tile_ends,
        used,
        tiles,
        FOUR * place[given + order],
    )
