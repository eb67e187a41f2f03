"""The innermost loops against NumPy's Chebyshev polynomials, for every number of moments there can be."""

from itertools import product

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebvander

from mcgw.sampling.layout import Layout
from mcgw.sampling.moments import cell_moments
from mcgw.sampling.philox import CELLS, uniforms

ORDERS = np.array(list(product(range(1, 22), range(22))))


@pytest.mark.parametrize("n", [1, 8, 61, 700, 2500])
def test_moments_are_sums_of_chebyshev_polynomials(n):
    layout = Layout(ORDERS[:, 0], ORDERS[:, 1])
    moments = cell_moments(7, 0, np.full((len(ORDERS), 1), n), layout)[:, 0]
    for cell, (start, (plain, rooted)) in enumerate(zip(layout.starts[:-1], ORDERS, strict=True)):
        u = uniforms(7, CELLS, 0, cell, n)
        terms = chebvander(2 * u - 1, 20)
        exact = np.concatenate([terms[:, :plain].sum(axis=0), (np.sqrt(u) @ terms)[:rooted]])
        found = moments[start : start + plain + rooted]
        np.testing.assert_allclose(found, exact, rtol=0, atol=1e-13 * n)


def test_an_empty_cell_has_none():
    moments = cell_moments(7, 0, np.zeros((len(ORDERS), 2), np.int64), Layout(ORDERS[:, 0], ORDERS[:, 1]))
    assert not moments.any()
