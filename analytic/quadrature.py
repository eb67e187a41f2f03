"""Gauss rules on pieces of the heights, and integrals over them for many separations.

With s = h + v^2 the integrand is ``2 v^(2n+1)`` times a smooth function of v. For half-integer n the whole of
it is smooth and Gauss-Legendre converges exponentially. For other n it is so on pieces that are no wider than
some times their distance from the separation.
"""

from functools import cache
from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import leggauss

from analytic.arrays import Array

NEAREST = 2.0**-30  # below, a power >= 0 is 1e-9 of the whole, and integrated to 1e-7
_GROWTH = 8.0  # of a piece to its distance from the separation below
NODES = 64  # of a piece
SPANS = 6.0  # of a law in it: a density that changes by a factor of 50 over a piece needs some 30 nodes
WIDEST = 4.0  # piece, on which they resolve the normal density as far down as s = -40
REACH = 13.0  # no lower or rarer normal height counts: 2e-37 of the density, times a modulus up to exp(3|s|)


@cache
def gauss_legendre(nodes: int) -> tuple[Array, Array]:
    """Points and weights, read-only."""
    x, w = leggauss(nodes)
    x, w = (1 + x) / 2, w / 2
    x.flags.writeable = w.flags.writeable = False
    return x, w


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


def rooted(left: Array, right: Array, separations: Array, nodes: int) -> tuple[Array, Array]:
    """Points and weights in the root of the approach to the next separation below, piece by piece.

    Pieces go from `left` to `right`, shape (k,); no separation divides one, and the first of them, which
    increase, is below all pieces. Of shape (k nodes,); every point lies inside its piece.
    """
    x, w = gauss_legendre(nodes)
    anchor = separations[np.searchsorted(separations, left, side="right") - 1]
    v0, v1 = np.sqrt(left - anchor)[:, None], np.sqrt(right - anchor)[:, None]
    v = v0 + (v1 - v0) * x
    s = np.clip(anchor[:, None] + v * v, left[:, None], np.nextafter(right, left)[:, None])
    return s.ravel(), (2 * v * (v1 - v0) * w).ravel()


def towards(separation: float, nearest: float) -> list[float]:
    """Heights from as near as `nearest`, each 8 times as far from the separation, up to a distance of 1."""
    edges, distance = [], nearest
    while distance < 1:
        edges.append(float(separation + distance))
        distance *= _GROWTH
    return edges


def above_neighbours(separations: Array) -> list[float]:
    """Return the same above close separations, as near to the upper one as the lower one is.

    The root of the approach to the lower one almost has its kink inside the next piece.
    """
    return [edge for lower, upper in pairwise(separations) for edge in towards(upper, upper - lower)]
