"""Crowds: moments of cells with many asperities, drawn as Gaussian numbers; and how many make a crowd.

The moments of a cell with n asperities are sums of n independent vectors ``b(u)``, so for large n
they are Gaussian with mean ``n E b`` and covariance ``n Cov b``, both known exactly. Cells are narrow:
what is approximated is only the small part of the fluctuations that arises inside a cell. In 1e5 surfaces
the first four cumulants of load, area and stiffness cannot be told from the exact ones for N from 10 to
1e9, even if single asperities count as a crowd. What gives the
approximation away is the shape: with a threshold of 1, 1 % of the surfaces at light contact have a negative
load, with 4 one in 1e5, with 16 or more none.

Half of the moments are there for the last digits of the means. Where only sums are kept, those that would
add less than a millionth of the variance stay at their means.

What a crowded cell of n asperities adds to a value, given the numbers in the cells, has the third and fourth
cumulants n k3 and n k4, and its Gaussian limit has none. Edgeworth's expansion of the distribution function
of the value, whose standard deviation is sigma, then misses

    (x^2 - 1) phi(x) K3/6 + (x^3 - 3x) phi(x) K4/24 + (x^5 - 10x^3 + 15x) phi(x) K3^2/72

with K3 and K4 the sums over the crowded cells, over sigma^3 and sigma^4 (Petrov, "Sums of Independent
Random Variables", 1975, VI.1): what the theorem of Berry and Esseen bounds. The largest of each term,
doubled, is held against what may be spent. The distance itself is half of it
(`tests/oracles/law_of_crowds.py`).
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from scipy.special import ndtri, pdtr, pdtrc

from analytic import quantity_of
from analytic.arrays import Array, Ints
from analytic.quadrature import gauss_legendre
from mcgw.machine.compiling import njit
from mcgw.sampling.cells import Mesh
from mcgw.sampling.direct import asperity_sums
from mcgw.sampling.kernels import product
from mcgw.sampling.moments import Layout, OneByOne
from mcgw.sampling.philox import MOMENTS, centred, made_for
from mcgw.scene.scene import Scene

CROWDED = 256  # asperities in a cell, from which its moments count as Gaussian
VARYING = 1e-6  # accuracy of the laws up to which moments vary, if only sums are kept
_MOST = 2**24  # of a crowd; fewer than CROWDED are as quickly drawn one by one
_TOGETHER = 16  # cells whose laws are in memory
_THIRD, _FOURTH, _SQUARED = 0.3990 / 6, 0.5506 / 24, 2.3071 / 72  # the largest of the three terms
_SAFELY = 2.0
_U, _W = gauss_legendre(24)


@dataclass(frozen=True)
class Crowds(OneByOne):
    """Crowded cells by the Gaussian limit of their moments (`mcgw.sampling.crowds`)."""

    varying: Layout  # moments that vary; the others stay at their means
    threshold: int  # asperities in a cell, from which its moments count as Gaussian
    # what is known of the distance from the exact laws: largest difference of distribution functions
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
            chebyshev.chebvander(x, plain)[:, :plain],
            v[:, None] * chebyshev.chebvander(x, rooted)[:, :rooted],
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


@dataclass(frozen=True)
class Crowding:
    """A threshold, and what it costs."""

    threshold: int  # asperities in a cell, from which its moments count as Gaussian
    distance: float  # from the exact law of any value: largest difference of distribution functions
    alone: float  # asperities of a surface that are expected in cells with fewer


def crowding(scene: Scene, mesh: Mesh) -> Crowding | None:
    """Return the smallest crowd that keeps the laws of all values to `scene.accuracy`.

    None if no crowd is large enough, or there is no cell.
    """
    if not mesh.size:
        return None
    variance, third, fourth = _cumulants(scene, mesh)
    expected = scene.n_asperities * mesh.probability
    threshold = CROWDED
    while threshold <= _MOST:
        crowded = expected * pdtrc(threshold - 2, expected)  # n P(n - 1 crowd at least) = E[n; n a crowd]
        found = _distance(variance, product(crowded, third), product(crowded, fourth))
        if found <= scene.accuracy:
            return Crowding(threshold, found, float((expected * pdtr(threshold - 2, expected)).sum()))
        threshold *= 2
    return None


def _cumulants(scene: Scene, mesh: Mesh) -> tuple[Array, Array, Array]:
    """Variance of each value of a surface; third and fourth cumulants of one asperity in each cell.

    Shapes (values,) and (cells, values), without values that are counted.
    """
    first = second = np.zeros(1)
    thirds: list[Array] = []
    fourths: list[Array] = []
    for start in range(0, mesh.size, _TOGETHER):
        cells = np.arange(start, min(start + _TOGETHER, mesh.size))
        heights = mesh.edges[cells] + np.stack([mesh.offsets(cells, np.full(len(cells), v)) for v in _U])
        values = _values(scene, heights.T.ravel()).reshape(len(cells), len(_U), -1)
        mean = np.einsum("u,cuv->cv", _W, values)
        apart = values - mean[:, None]
        square, cube, biquadrate = (np.einsum("u,cuv->cv", _W, apart**power) for power in (2, 3, 4))
        thirds.append(cube)
        fourths.append(biquadrate - 3 * square**2)
        share = mesh.probability[cells]
        first = first + product(share, mean)
        second = second + product(share, square + mean**2)
    fixed = first**2 if scene.count == "fixed" else np.zeros(1)
    return scene.n_asperities * (second - fixed), np.concatenate(thirds), np.concatenate(fourths)


def _values(scene: Scene, heights: Array) -> Array:
    """Return what single asperities add to every value that is not counted, reduced: (heights, values)."""
    one = np.ones(len(heights))
    sums = asperity_sums(scene, one.astype(np.int64), heights, one)
    parts = [
        part / quantity_of(name).scale(scene.surface)  # its fourth power is a number
        for name, part in sums.items()
        if not quantity_of(name).counts
    ]
    return np.concatenate([np.empty((len(heights), 0)), *parts], axis=1)


def _distance(variance: Array, third: Array, fourth: Array) -> float:
    """Bound of the three terms, of the value that is farthest off."""
    some = variance > 0
    k3, k4 = np.abs(third[some]) / variance[some] ** 1.5, np.abs(fourth[some]) / variance[some] ** 2
    return float(_SAFELY * (_THIRD * k3 + _FOURTH * k4 + _SQUARED * k3**2).max(initial=0.0))
