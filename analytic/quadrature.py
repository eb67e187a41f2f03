"""Gauss rules on pieces of the heights.

Contacts begin and end with powers of the distance, whole or broken, and next to a height where others began.
So places on a piece go as the fourth power of the variable at both ends, in which Gauss-Legendre converges.
"""

from functools import cache

import numpy as np
from numpy.polynomial.legendre import leggauss

from analytic.arrays import Array

NODES = 64  # of a piece
SPANS = 6.0  # of a law in it: a density that changes by a factor of 50 over a piece needs some 30 nodes
WIDEST = 4.0  # piece, on which they resolve the normal density as far down as s = -40
REACH = 13.0  # no lower or rarer normal height counts: 2e-37 of the density, times a modulus up to exp(3|s|)


@cache
def gauss_legendre(nodes: int) -> tuple[Array, Array]:
    """Points and weights, read-only."""
    x, w = leggauss(nodes)
    x, w = (1 + x) / 2, w / w.sum()
    x.flags.writeable = w.flags.writeable = False
    return x, w


@cache
def towards_both_ends(nodes: int) -> tuple[Array, Array]:
    """Places and weights from 0 to 1, of a function that may have broken powers of the distance from both."""
    x, w = gauss_legendre(nodes)
    return x**4 * (35 - 84 * x + 70 * x**2 - 20 * x**3), 140 * w * (x * (1 - x)) ** 3


def panelled(edges: Array) -> tuple[Array, Array]:
    """Points and weights of Gauss-Legendre rules between neighbouring edges, each of shape (64 m, n).

    Edges increase along the first axis, shape (k, n), some of them equal. There are m <= k - 1 pieces: those
    that have no width in any column are left out.
    """
    x, w = gauss_legendre(NODES)
    width = np.diff(edges, axis=0)
    some = width.any(axis=1)
    width = width[some][:, None]
    points = edges[:-1][some][:, None] + width * x[:, None]
    return points.reshape(-1, edges.shape[1]), (width * w[:, None]).reshape(-1, edges.shape[1])


def in_pieces(left: Array, right: Array, nodes: int = NODES) -> tuple[Array, Array]:
    """Points and weights piece by piece, whatever power of the distance a function begins or ends with.

    Pieces go from `left` to `right`, shape (k,); every point lies inside its piece. Of shape (k nodes,).
    """
    place, weight = towards_both_ends(nodes)
    left, width = left[:, None], (right - left)[:, None]
    last = np.nextafter(left + width, left)
    near_left = np.minimum(left + width * place, last)
    near_right = np.maximum(np.minimum(right[:, None] - width * place[::-1], last), left)
    return np.where(place < 0.5, near_left, near_right).ravel(), (width * weight).ravel()
