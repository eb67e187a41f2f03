"""Series of rows on nodes, one after the other; and the rules of the walk, one row on one node at a time.

The rules say where a row holds, and where its series is cut.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.sampling.cells import NODES, TO_COEFFICIENTS
from mcgw.sampling.rules import multiply

MOST, MOST_IN_CELL = 12, 19  # moments: what is not resolved by so many is left to the children, or refused
APART, _PARTLY, WHOLE = 0, 1, 2
U = (1 + NODES) / 2
_NODES = 32  # that add to one sum, with errors of their own


def _times_u(order: int) -> Any:
    """Multiplies coefficients, from their right, by u = (1 + x)/2, and leaves zeros where they are."""
    matrix = np.eye(order) / 2 + np.eye(order, k=1) / 4 + np.eye(order, k=-1) / 4
    matrix[0, 1] = 0.5
    return matrix


TABLES = np.ascontiguousarray(TO_COEFFICIENTS.T), _times_u(len(NODES)), U


class Entries(NamedTuple):
    """Series of rows on nodes, one an array element."""

    node: Ints  # of which node
    row: Ints  # of which row
    rooted: NDArray[np.bool_]  # whether they multiply the R_j of a cell, or the T_j of a node
    length: Ints  # how many coefficients each has; further ones are zero
    coefficients: Array  # of all of them, one after the other


@njit()
def meeting(low: Any, high: Any, rooted: Any, split: Any, start: Any, end: Any) -> Any:
    """Return how a row that holds from `low` to `high` meets a node: not, as one smooth function, or partly.

    The row may begin with a root, and a modulus that it depends on may have a break inside the node: `split`.
    """
    if not (low < end and high > start):
        return APART
    begun = low < start or (low == start and not rooted)
    return WHOLE if begun and end <= high and not split else _PARTLY


@njit(inline="always")
def series_of(
    values: Any, node: Any, row: Any, limits: Any, rough: Any, of_many: Any, transform: Any, c: Any
) -> Any:
    """Chebyshev series of a row on a node.

    Parameters
    ----------
    values : ndarray
        At the points of the node, shape (1, points); overwritten.
    node, row : int
        Whose they are.
    limits : tuple
        `Nodes.limits`.
    rough : float
        Share of the values that the last digit of a height makes, besides that of the modulus.
    of_many : bool
        Keep what counts in a sum over many nodes, whose errors add up: it is used if others need the moments.
    transform : ndarray
        Of values to coefficients, from their right.
    c : ndarray
        Where the coefficients are written, shape (1, order): zero beyond those kept.

    Returns
    -------
    int
        How many leading coefficients count: so many moments the node must have.
    """
    even, noise, crowd, graded, total, accuracy = limits
    of_largest = even[node] if graded[row] else 1.0
    multiply(values, transform, c)
    tail = 0.0
    for i in range(c.shape[1] - 1, -1, -1):
        tail += abs(c[0, i])
        values[0, i] = tail
    enough = max(of_largest * tail, total[row] / crowd[node])
    least = max(noise[node] if graded[row] else 0.0, rough) * tail
    alone, kept = max(accuracy * enough, least), max(accuracy / (_NODES if of_many else 1) * enough, least)
    count = c.shape[1]
    while count > 0 and not values[0, count - 1] > alone:
        count -= 1
        if not values[0, count] > kept:
            c[0, count] = 0.0
    return count


@njit()
def raised(c: Any, power: Any, times_u: Any) -> None:
    """Put a whole power of u into a series that was cut without it: accurate to the row down to u = 0.

    Here and elsewhere numbers are copied one by one: what Numba compiles for a slice set to an array, with
    the text of an error message in it, takes 4 s.
    """
    before = np.empty(c.shape)
    for _ in range(power):
        for k in range(c.shape[1]):
            before[0, k] = c[0, k]
        multiply(before, times_u, c)


@njit()
def length_of(c: Any) -> Any:
    """How many coefficients there are up to the last that is not zero."""
    n = c.shape[1]
    while n > 0 and c[0, n - 1] == 0.0:
        n -= 1
    return n
