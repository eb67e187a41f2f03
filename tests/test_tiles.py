"""The sparse product against a dense one, row by row."""

import numpy as np
import pytest

from mcgw.sampling.tiles import FOUR, Tiles, in_fours


def random_blocks(rng, given, groups):
    """Rows of four in a row; each needs a few given rows, and some of earlier groups."""
    blocks = []
    for group in range(groups):
        for row in given + FOUR + FOUR * group + np.arange(FOUR):
            own = rng.integers(0, given, 2)
            earlier = given + FOUR + FOUR * rng.integers(0, group, 2) if group else []
            columns = np.unique(np.concatenate([own, earlier]).astype(np.int64))
            values = rng.normal(0, 0.3, (len(columns), FOUR))
            blocks.append((np.full(len(columns), row), columns, values))
    return blocks


def dense(blocks, given, groups, moments):
    """The same by plain loops."""
    table = np.zeros((given + FOUR + FOUR * (groups + 1), moments.shape[1]))
    table[:given] = moments
    for rows, columns, values in blocks:
        for row, column, four in zip(rows, columns, values, strict=True):
            table[row] += four @ table[column : column + FOUR]
    return table[given + FOUR : given + FOUR + FOUR * groups]


@pytest.mark.parametrize(("given", "groups"), [(1, 1), (7, 3), (40, 25), (300, 60)])
@pytest.mark.parametrize("surfaces", [1, 63, 64, 130])
def test_every_row_is_that_of_a_dense_product(given, groups, surfaces):
    rng = np.random.default_rng(given + surfaces)
    blocks = random_blocks(rng, given, groups)
    moments = rng.normal(size=(given, surfaces))
    exact = dense(blocks, given, groups, moments)
    tiles = Tiles.of(blocks, given, FOUR * groups)
    found = tiles.apply(moments, (FOUR * groups, 1))[:, :, 0]
    scale = np.abs(exact).max(axis=1, keepdims=True) + 1
    assert np.abs((found - exact) / scale).max() < 1e-13
    np.testing.assert_array_equal(tiles.apply(moments[:, :1].copy(), (FOUR * groups, 1))[:, 0], found[:, :1])


def test_given_rows_come_in_when_they_are_first_needed():
    """The sweep goes down, and no row is computed before those it needs."""
    rng = np.random.default_rng(3)
    blocks = random_blocks(rng, 40, 25)
    tiles = Tiles.of(blocks, 40, 100)
    assert (np.diff(tiles.lowest) <= 0).all()
    done = {int(row): place for place, row in enumerate(tiles.rows)}
    for place in range(len(tiles.rows)):
        for column in tiles.columns[int(tiles.pointers[place]) : int(tiles.pointers[place + 1])].astype(int):
            assert column >= tiles.lowest[place]
            assert column <= 40 or done[44 + (column - 44) // FOUR * FOUR] < place


def test_nothing_asked():
    tiles = Tiles.of([], 5, 0)
    assert tiles.apply(np.ones((5, 3)), (0, 4)).shape == (0, 3, 4)
    assert [int(in_fours(n)) for n in (0, 1, 4, 5)] == [0, 4, 4, 8]
    silent = Tiles.of([], 5, 8)  # a separation above all cells
    np.testing.assert_array_equal(silent.apply(np.ones((5, 3)), (2, 4)), np.zeros((2, 3, 4)))
