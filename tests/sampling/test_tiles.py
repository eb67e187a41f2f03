"""The sparse product against a dense one, row by row."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import SURFACE

import analytic
import mcgw
from mcgw.machine.memory import aligned
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.response.product import FOUR, Lines, Tiles
from mcgw.sampling.response.rows import hertz_rows
from mcgw.sampling.response.tree import Nodes, tree_over
from mcgw.sampling.response.walk import walk
from mcgw.scene.promises import EXACT


def random_blocks(rng, given, computed):
    """Groups of four rows; each row needs a few given groups, and some of earlier ones."""
    blocks = []
    for group in range(given, given + computed):
        for row in FOUR * group + np.arange(FOUR):
            own = rng.integers(0, given, 2)
            earlier = rng.integers(given, group, 2) if group > given else []
            columns = FOUR * np.unique(np.concatenate([own, earlier]).astype(np.int64))
            blocks.append((np.full(len(columns), row), columns, rng.normal(0, 0.3, (len(columns), FOUR))))
    return blocks


def lines(blocks):
    """A block a line, in two halves."""
    if not blocks:
        return NONE, NONE
    row, start, values = (np.concatenate(part) for part in zip(*blocks, strict=True))
    at, length, half = FOUR * np.arange(len(row)), np.full(len(row), FOUR), len(row) // 2
    cut = slice(half), slice(half, None)
    return [Lines(row[x], start[x], length[x], at[x], values.ravel()) for x in cut]


NONE = Lines(*np.empty((4, 0), dtype=np.int64), np.empty(0))


def gaps(rng, groups):
    """Given rows in order, with rows of zeros in between; and how many there are."""
    kept = rng.random(FOUR * groups) < 0.8
    return np.where(kept, np.cumsum(kept) - 1, -1).reshape(-1, FOUR), int(kept.sum())


def dense(blocks, given, computed, moments):
    """The same by plain loops."""
    table = np.zeros((FOUR * computed + given.size, moments.shape[1]))
    table[: given.size] = np.where(given.reshape(-1, 1) < 0, 0.0, moments[given.ravel()])
    for rows, columns, values in blocks:
        for row, column, four in zip(rows, columns, values, strict=True):
            table[row] += four @ table[column : column + FOUR]
    return table[given.size :]


@pytest.mark.parametrize(("groups", "computed"), [(1, 1), (2, 3), (10, 25), (75, 60)])
@pytest.mark.parametrize("surfaces", [1, 63, 64, 130])
def test_every_row_is_that_of_a_dense_product(groups, computed, surfaces):
    """In random order of the answers, some rows being none."""
    rng = np.random.default_rng(groups + surfaces)
    blocks = random_blocks(rng, groups, computed)
    given, rows = gaps(rng, groups)
    moments = rng.normal(size=(rows, surfaces))
    answers = rng.permutation(
        np.where(np.arange(FOUR * computed) < 2 * computed, np.arange(FOUR * computed), -1)
    )
    exact = np.empty((2 * computed, surfaces))
    exact[answers[answers >= 0]] = dense(blocks, given, computed, moments)[answers >= 0]
    tiles = Tiles.of(lines(blocks), given, answers.reshape(-1, FOUR))
    found = tiles.apply(moments, (2, computed))
    scale = np.abs(exact).max(axis=1, keepdims=True) + 1
    assert np.abs((found.transpose(0, 2, 1).reshape(-1, surfaces) - exact) / scale).max() < 1e-13
    np.testing.assert_array_equal(tiles.apply(moments[:, :1].copy(), (2, computed)), found[:, :1])


def test_nothing_asked():
    none = np.empty((0, FOUR), dtype=np.int64)
    tiles = Tiles.of((NONE, NONE), np.array([[0, 1, 2, 3], [4, -1, -1, -1]]), none)
    assert tiles.apply(np.ones((5, 3)), (0, 4)).shape == (0, 3, 4)
    silent = Tiles.of((NONE, NONE), none, np.arange(8).reshape(-1, FOUR))  # a separation above all cells
    np.testing.assert_array_equal(silent.apply(np.ones((5, 3)), (2, 4)), np.zeros((2, 3, 4)))


def test_arrays_begin_with_a_line_of_the_cache():
    several = [aligned(3, n) for n in range(20)]
    assert [x.shape for x in several] == [(3, n) for n in range(20)]
    assert all(x.ctypes.data % 64 == 0 and x.flags.c_contiguous for x in several[1:])


QUANTITIES = ("load", "area", "stiffness", "conductance")


def asked(grading, number):
    h = tuple(np.linspace(0, 4, number))
    scene = mcgw.Scene(
        SURFACE,
        separations=h,
        grading=grading,
        contact=mcgw.Contact(quantities=QUANTITIES),
        ensemble=mcgw.Sampling(n_asperities=10**5),
        n_surfaces=1,
        seed=1,
    )
    mesh = mesh_of(scene)
    tree = tree_over(mesh)
    return (
        mesh, tree, hertz_rows(scene, QUANTITIES),
        Nodes.of(mesh, tree, grading, 10**5, EXACT),
    )  # fmt: skip


def test_what_is_not_resolved_is_refused():
    """A grading too steep for the cells, and a row that begins inside one."""
    mesh, tree, rows, nodes = asked(analytic.Homogeneous(), 7)
    steep = replace(nodes, moduli=1 + 0.5 * np.sign(np.sin(40 * (nodes.start[:, None] + nodes.above))))
    with pytest.raises(ValueError, match="not resolved near s = "):
        walk(mesh, tree, rows, steep)
    inside = rows.h + 1e-3
    with pytest.raises(ValueError, match=r"at s = 0.001 is not an edge"):
        walk(mesh, tree, replace(rows, h=inside, low=inside), nodes)


def test_a_row_of_very_many_groups_in_falling_order():
    """Put in order in time that grows as their number: one by one it takes minutes."""
    n = 200_000
    start, at = FOUR * np.arange(n)[::-1].copy(), np.arange(n)
    first = Lines(np.full(n, FOUR * n), start, np.ones(n, dtype=np.int64), at, 1.0 + at)
    given = np.arange(FOUR * n).reshape(-1, FOUR)
    tiles = Tiles.of((first, NONE), given, np.array([[0, -1, -1, -1]]))
    np.testing.assert_array_equal(tiles.columns, np.arange(n))
    np.testing.assert_array_equal(tiles.values[:, 0, 0], n - at)
