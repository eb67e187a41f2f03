"""The sparse product against a dense one, row by row."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import SURFACE

import analytic
import mcgw
from mcgw.machine.memory import aligned
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.response.gathering import FOUR, Lines, gathered, in_fours
from mcgw.sampling.response.product import Tiles
from mcgw.sampling.response.rows import hertz_rows
from mcgw.sampling.response.tree import LAST_DIGITS, Nodes, Precision, tree_over
from mcgw.sampling.response.walk import walk


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


def swept(first, second, given, answers):
    """Tiles of lines, the order of the sweep being found."""
    step, fetches, *others, values, at = gathered(first, second, len(given), len(answers))
    return Tiles(given[fetches], *others, values, at, answers[step])


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
    tiles = swept(*lines(blocks), given, answers.reshape(-1, FOUR))
    found = tiles.apply(moments, (2, computed))
    scale = np.abs(exact).max(axis=1, keepdims=True) + 1
    assert np.abs((found.transpose(0, 2, 1).reshape(-1, surfaces) - exact) / scale).max() < 1e-13
    np.testing.assert_array_equal(tiles.apply(moments[:, :1].copy(), (2, computed)), found[:, :1])


def test_the_table_holds_what_is_needed_and_no_more():
    """A chain of sums from the highest given group down: two groups and the next are there at a time."""
    n = 100
    blocks = []
    for k in range(n):  # row k is given group n - 1 - k plus row k - 1
        for source in (n - 1 - k, n + k - 1)[: 1 + (k > 0)]:
            blocks.append(
                (FOUR * (n + np.full(FOUR, k)) + np.arange(FOUR), np.full(FOUR, FOUR * source), np.eye(FOUR))
            )
    answers = np.where(np.arange(n)[:, None] == n - 1, np.arange(FOUR), -1)
    tiles = swept(*lines(blocks), np.arange(FOUR * n).reshape(-1, FOUR), answers)
    assert max(tiles.fetched.max(), tiles.computed.max()) == 2 * FOUR
    assert tiles.fetches[:, 0].tolist() == [FOUR * (n - 1 - k) for k in range(n)]
    moments = np.random.default_rng(3).integers(0, 1000, (FOUR * n, 5)).astype(float)
    np.testing.assert_array_equal(
        tiles.apply(moments, (1, FOUR))[0], moments.reshape(n, FOUR, 5).sum(axis=0).T
    )


def test_nothing_asked():
    none = np.empty((0, FOUR), dtype=np.int64)
    tiles = swept(NONE, NONE, np.array([[0, 1, 2, 3], [4, -1, -1, -1]]), none)
    assert tiles.apply(np.ones((5, 3)), (0, 4)).shape == (0, 3, 4)
    assert [int(in_fours(n)) for n in (0, 1, 4, 5)] == [0, 4, 4, 8]
    silent = swept(NONE, NONE, none, np.arange(8).reshape(-1, FOUR))  # a separation above all cells
    np.testing.assert_array_equal(silent.apply(np.ones((5, 3)), (2, 4)), np.zeros((2, 3, 4)))


def test_arrays_begin_with_a_line_of_the_cache():
    several = [aligned(3, n) for n in range(20)]
    assert [x.shape for x in several] == [(3, n) for n in range(20)]
    assert all(x.ctypes.data % 64 == 0 and x.flags.c_contiguous for x in several[1:])


QUANTITIES = ("load", "area", "stiffness", "conductance")
GRADINGS = {
    "homogeneous": analytic.Homogeneous(),
    "gamma 2": analytic.Exponential(2.0),
    "kinks": analytic.Table((-4.0, 0.0, 1.0, 4.0), (0.5, 1.0, 2.0, 1.5)),
}


class InNumpy:
    """``scale e^m (s - h)^n`` as it is written."""

    def __init__(self, rows):
        self.exponent, self.scale, self.graded = rows.formulas.exponent, rows.formulas.scale, rows.graded

    def values(self, rows, above, e):
        whole, half = np.divmod(self.exponent[rows], 1)
        power = np.where(half > 0, np.sqrt(above), 1.0)
        for times in range(3):
            power = np.where(whole > times, power * above, power)
        return self.scale[rows] * np.where(self.graded[rows], e, 1.0) * power

    def at_start(self, rows, above, e, u):
        values, (whole, half) = self.values(rows, above / u[:, None], e), np.divmod(self.exponent[rows], 1)
        return [
            (root, np.flatnonzero(here), values[:, here], whole[here])
            for root, here in ((False, half == 0), (True, half > 0))
        ]


def asked(grading, number, precision=LAST_DIGITS):
    h = tuple(np.linspace(0, 4, number))
    scene = mcgw.Scene(
        SURFACE, separations=h, grading=grading, quantities=QUANTITIES, n_asperities=10**5, n_surfaces=1,
        seed=1,
    )  # fmt: skip
    mesh = mesh_of(scene)
    tree = tree_over(mesh)
    return (
        mesh, tree, hertz_rows(scene, QUANTITIES, lasting=False),
        Nodes.of(mesh, tree, grading, 10**5, precision),
    )  # fmt: skip


def found(mesh, tree, rows, nodes):
    """Every series by its row and node, and the moments that it takes."""
    entries, plain, rooted = walk(mesh, tree, rows, nodes)
    ends = entries.start + entries.length
    places = zip(entries.row.tolist(), entries.node.tolist(), entries.rooted.tolist(), strict=True)
    pieces = [entries.coefficients[a:b].tobytes() for a, b in zip(entries.start, ends, strict=True)]
    return dict(zip(places, pieces, strict=True)), plain.tolist(), rooted.tolist()


@pytest.mark.parametrize("grading", GRADINGS.values(), ids=GRADINGS)
@pytest.mark.parametrize("number", [1, 7, 301])
@pytest.mark.parametrize("precision", [LAST_DIGITS, Precision(1e-4, of_least=True)])
def test_both_walks_find_the_same(grading, number, precision):
    """The same nodes for every row, and the same bits of every coefficient."""
    mesh, tree, rows, nodes = asked(grading, number, precision)
    assert found(mesh, tree, rows, nodes) == found(mesh, tree, replace(rows, formulas=InNumpy(rows)), nodes)


@pytest.mark.parametrize("formulas", [lambda rows: rows.formulas, InNumpy])
def test_what_is_not_resolved_is_refused(formulas):
    """A grading too steep for the cells, and a row that begins inside one."""
    mesh, tree, rows, nodes = asked(analytic.Homogeneous(), 7)
    steep = replace(nodes, moduli=1 + 0.5 * np.sign(np.sin(40 * (nodes.start[:, None] + nodes.above))))
    with pytest.raises(ValueError, match="not resolved near s = "):
        walk(mesh, tree, replace(rows, formulas=formulas(rows)), steep)
    inside = rows.h + 1e-3
    with pytest.raises(ValueError, match=r"at s = 0.001 is not an edge"):
        walk(mesh, tree, replace(rows, h=inside, low=inside, formulas=formulas(rows)), nodes)


def test_a_row_of_very_many_groups_in_falling_order():
    """Put in order in time that grows as their number: one by one it takes minutes."""
    n = 200_000
    start, at = FOUR * np.arange(n)[::-1].copy(), np.arange(n)
    first = Lines(np.full(n, FOUR * n), start, np.ones(n, dtype=np.int64), at, 1.0 + at)
    given = np.arange(FOUR * n).reshape(-1, FOUR)
    tiles = swept(first, NONE, given, np.array([[0, -1, -1, -1]]))
    np.testing.assert_array_equal(tiles.fetches, given)
    np.testing.assert_array_equal(tiles.values[:, 0, 0], n - at)
