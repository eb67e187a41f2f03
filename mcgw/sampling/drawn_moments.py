"""From the numbers of asperities in the cells to their moments.

``OneByOne``   a uniform for each asperity, anywhere in the cell
``Crowds``     for cells with few asperities as `OneByOne`, else one Gaussian number a moment

Where summits have radii of their own there is a third way, `mcgw.sampling.weighted_sums`.

The moments of a cell with n asperities are sums of n independent vectors ``b(u)``, so for large n
they are Gaussian with mean ``n E b`` and covariance ``n Cov b``, both known exactly. Cells are narrow:
what is approximated is only the small part of the fluctuations that arises inside a cell. In 1e5 surfaces
the first four cumulants of load, area and stiffness cannot be told from the exact ones for N from 10 to
1e9, even if single asperities count as a crowd. What gives the
approximation away is the shape: with a threshold of 1, 1 % of the surfaces at light contact have a negative
load, with 4 one in 1e5, with 16 or more none.

Half of the moments are there for the last digits of the means. Where only sums are kept, those that would
add less than a millionth of the variance stay at their means.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from scipy.special import ndtri

from analytic.arrays import Array, Ints
from analytic.quadrature import gauss_legendre
from mcgw.machine.compiling import njit
from mcgw.sampling.block import Layout
from mcgw.sampling.moments import OneByOne
from mcgw.sampling.philox import MOMENTS, centred, made_for
from mcgw.sampling.rules import product

CROWDED = 256  # asperities in a cell, from which its moments count as Gaussian
VARYING = 1e-6  # accuracy of the laws up to which moments vary, if only sums are kept


@dataclass(frozen=True)
class Crowds(OneByOne):
    """Crowded cells by the Gaussian limit of their moments (`mcgw.sampling.drawn_moments`).

    Parameters
    ----------
    varying : Layout
        Moments that vary; the others stay at their means.
    threshold : int
        Asperities in a cell, from which its moments count as Gaussian.
    distance : float, optional
        What is known of the distance from the exact laws: largest difference of distribution functions.
    """

    varying: Layout
    threshold: int
    distance: float = np.nan

    def moments(self, seed: int, first: int, counts: Ints, layout: Layout) -> Array:
        """Of crowded cells as Gaussian numbers, of the others asperity by asperity."""
        many = np.where(counts >= self.threshold, counts, 0)
        moments = super().moments(seed, first, counts - many, layout)
        crowded = np.flatnonzero(many.any(axis=1) & (layout.sizes > 0))
        if not crowded.size:
            return moments
        varying = self.varying
        orders = np.stack([layout.plain, layout.rooted, varying.plain, varying.rooted], axis=1)[crowded]
        laws = [_partly(*cell) for cell in orders.tolist()]
        widths = np.array([root.shape for _, root in laws])
        starts = np.concatenate([[[0, 0]], np.cumsum(widths, axis=0)])
        roots = np.zeros((starts[-1, 0], widths[:, 1].max()))
        for (_, root), (start, _) in zip(laws, starts, strict=False):
            roots[start : start + root.shape[0], : root.shape[1]] = root
        words = np.repeat(varying.starts[crowded] - starts[:-1, 1], widths[:, 1]) + np.arange(starts[-1, 1])
        z = _words(np.uint64(seed), first, words, many.shape[1])
        z = ndtri((1 + z) / 2)
        means = np.concatenate([mean for mean, _ in laws])
        _mix(moments, many[crowded], layout.starts[crowded], starts, means, roots, z)
        return moments

    def draws(self, asperities: float, layout: Layout) -> float:
        """Return the random numbers of a surface: one an asperity or one a moment, whichever are fewer."""
        return min(asperities, float(layout.sizes.sum()))


@cache
def _law_of_moments(plain: int, rooted: int) -> tuple[Array, Array]:
    """Mean of b = (T_0 .., sqrt(u) T_0 ..) for a uniform u, and a root of its covariance.

    The root is the triangle of a QR decomposition, never of the covariance itself, whose least
    eigenvalues are lost to rounding. The rooted ones are nearly dependent: with the highest first
    no later one has a larger part along a direction than the one that gave it.
    """
    v, w = gauss_legendre(48)
    w = 2 * v * w  # u = v^2: the integrands are polynomials in v
    x = 2 * v * v - 1
    b = np.concatenate(
        [
            chebyshev.chebvander(x, max(plain, 1) - 1)[:, :plain],
            v[:, None] * chebyshev.chebvander(x, max(rooted, 1) - 1)[:, :rooted],
        ],
        axis=1,
    )
    mean = product(w, b)
    if plain:
        mean[0] = 1.0  # T_0 counts the asperities
    varying = [*range(min(plain, 1), plain), *range(plain + rooted - 1, plain - 1, -1)]
    order = np.array(varying, dtype=np.int64)
    root = np.zeros((plain + rooted, len(order)))
    triangle = np.linalg.qr((b - mean)[:, order] * np.sqrt(w)[:, None], mode="r")
    root[order] = (triangle * np.sign(np.diag(triangle))[:, None]).T
    return mean, root


@cache
def _partly(plain: int, rooted: int, plain_varying: int, rooted_varying: int) -> tuple[Array, Array]:
    """Return the same with only the first ones varying."""
    mean, _ = _law_of_moments(plain, rooted)
    _, varying = _law_of_moments(plain_varying, rooted_varying)
    root = np.zeros((plain + rooted, varying.shape[1]))
    root[:plain_varying] = varying[:plain_varying]
    root[plain : plain + rooted_varying] = varying[plain_varying:]
    return mean, root


@njit(cache=True)
def _words(seed: Any, first_surface: Any, words: Any, surfaces: Any) -> Any:
    """Return some centred uniforms of each surface, by their numbers: shape (words, surfaces)."""
    result = np.empty((words.size, surfaces))
    last = words[-1] + 1 if words.size else 0
    for first in range(0, surfaces, 8):  # as many as share a line of the cache
        n = min(8, surfaces - first)
        x = np.empty((n, made_for(last)))
        for i in range(n):
            centred(x[i], seed, MOMENTS, first_surface + first + i, 0, 0, last)
        for j in range(words.size):
            for i in range(n):
                result[j, first + i] = x[i, words[j]]
    return result


@njit(cache=True)
def _mix(moments: Any, counts: Any, rows: Any, starts: Any, means: Any, roots: Any, z: Any) -> None:
    """Write ``n mean + sqrt(n) root z`` where n > 0, in one order of summation.

    Of each cell: its first row, and the first row of its means and root and of its numbers z.
    """
    cells, surfaces = counts.shape
    for c in range(cells):
        n, law, normal = np.sqrt(counts[c].astype(np.float64)), starts[c, 0], starts[c, 1]
        total = np.empty(surfaces)
        for j in range(starts[c + 1, 0] - law):
            total[:] = 0.0
            for k in range(starts[c + 1, 1] - normal):
                factor = roots[law + j, k]
                if factor != 0.0:  # a triangle
                    for i in range(surfaces):
                        total[i] += factor * z[normal + k, i]
            for i in range(surfaces):
                if n[i] > 0:
                    moments[rows[c] + j, i] = counts[c, i] * means[law + j] + n[i] * total[i]
