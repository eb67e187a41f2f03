"""The height axis above the lowest separation, cut into cells.

Every separation and every break of the grading is an edge. Inside a cell the heights are independent
and equally distributed: s = a + t(u), with u uniform on (0, 1) and t the cell's own inverse
distribution, smooth in u and known to full relative accuracy. No cell is wider than its distance to the
next separation below, where the laws of contact have a root (the mesh of a fast multipole method); how
much narrower it is, is a matter of price (`mcgw.sampling.spacing`).

Every break of the law of heights is an edge too, and cells shrink towards an end of its support where
its density is a broken power. Where less than one asperity in ten surfaces is expected there are no
cells: those few are the extras.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from analytic import Grading, HeightLaw, PiecewiseSeries
from analytic.arrays import Array
from analytic.quadrature import gauss_legendre
from mcgw.machine.process import kept
from mcgw.sampling.kernels import chebyshev_transform, product
from mcgw.sampling.spacing import edges_before_grading
from mcgw.sampling.stretches import SMALLEST, losses
from mcgw.scene.ensemble import EXACT
from mcgw.scene.scene import Scene

_CONVERGED = 1e-9  # a step of Newton whose square is nothing
_SHORT, _MOST_HALVINGS = 16, 60  # terms for a grading on a cell, and how often it is cut to get there
_DIGITS = 4.0  # of a height that coefficients without meaning may seem to be worth
_EVEN, _LEAST = 4.0, 1 / 16  # see `tolerances`
_NARROW = 2.0**-6  # cells that are not cut because the modulus falls
_TOGETHER = 64  # cells whose densities stay in the cache

_ORDER = 20
NODES = chebyshev.chebpts1(_ORDER)
TO_COEFFICIENTS = chebyshev_transform(NODES)
_X, _W = gauss_legendre(20)


@dataclass(frozen=True, eq=False)
class Mesh:
    """Cells of a scene."""

    edges: Array  # reduced heights, increasing, shape (cells + 1,); empty if there is no cell
    probability: Array  # of a height in each cell, shape (cells,)
    stretch: Array  # Chebyshev coefficients of t(u)/u for each cell, shape (order, cells)
    low_extras: float  # probability of a contacting height below the first cell
    high_extras: float  # and above the last

    @property
    def range(self) -> tuple[float, float]:
        """Heights between which the cells lie; none if there is no cell."""
        return (float(self.edges[0]), float(self.edges[-1])) if self.size else (0.0, 0.0)

    @property
    def size(self) -> int:
        """Number of cells."""
        return len(self.probability)

    def offsets(self, cell: int | NDArray[np.int64], u: Array) -> Array:
        """Height above the cell's lower edge at the uniform(s) `u`; `cell` alike or one for all."""
        return np.asarray(u * chebyshev.chebval(2 * u - 1, self.stretch[:, cell], tensor=False))


def mesh_of(scene: Scene, given: Sequence[float] = (), *, split: bool = True) -> Mesh:
    """Cut the contacting heights of a scene into cells: every separation and break of the grading is an edge.

    Edges `given` are those of the cells of other scenes, which are to be edges here too: then no cell is cut
    further. `split` cuts crowded cells further, so that each needs fewer moments.
    """
    edges = edges_before_grading(scene, given, split=split)
    if not edges.size:
        return no_cells(scene)
    if _steep(scene.modulus):
        edges = _resolving(scene, edges)
    return _mesh(scene.heights, float(scene.lowest), edges.tobytes())


def cut(scene: Scene, mesh: Mesh, starts: Array) -> Mesh:
    """Cut the cells that begin at these heights, finer at their start, or towards where contacts are lost."""
    cell = np.searchsorted(mesh.edges, starts)
    low, high = mesh.edges[cell], mesh.edges[cell + 1]
    parts, width = [(low + (high - low) * part) for part in (1 / 16, 0.25, 0.5, 0.75)], high - low
    for end in np.flatnonzero(np.isin(high, losses(scene, *mesh.range)) & (width > 2 * SMALLEST)):
        nearer = width[end] * 2.0 ** -np.arange(1, math.floor(math.log2(width[end] / SMALLEST)) + 1)
        parts.append(high[end] - nearer)
    edges = np.unique(np.concatenate([mesh.edges, *parts]))
    return _mesh(scene.heights, float(scene.lowest), edges.tobytes())


@kept  # another grading asks for the same, and so does the number in each cell
def _mesh(law: HeightLaw, lowest: float, asked: bytes) -> Mesh:
    """Return the mesh on these edges."""
    edges = np.frombuffer(asked)
    mass = _mass(law, edges[:-1], np.diff(edges)[:, None])[:, 0]
    probability = law.pdf(edges[:-1]) * mass
    stretch = _stretch(law, edges[:-1], np.diff(edges), mass)
    below = float(law.cdf(np.array(edges[0])) - law.cdf(np.array(lowest))) if edges[0] > lowest else 0.0
    return Mesh(edges, probability, stretch, below, float(law.sf(np.array(edges[-1]))))


def no_cells(scene: Scene) -> Mesh:
    """Leave every contacting asperity to be drawn by itself."""
    return Mesh(
        np.empty(0), np.empty(0), np.empty((_ORDER, 0)), 0.0, float(scene.heights.sf(np.array(scene.lowest)))
    )


def _resolving(scene: Scene, edges: Array) -> Array:
    """Halve cells until a short series describes the grading: the law of contact has a root besides.

    And until errors are held against its least values.
    """
    grading, law = scene.modulus, scene.heights
    for _ in range(_MOST_HALVINGS):
        a, width = edges[:-1], np.diff(edges)
        stretch = _stretch(law, a, width, _mass(law, a, width[:, None])[:, 0])
        t = (1 + NODES) / 2 * chebyshev.chebval(NODES, stretch)
        e = grading(a[:, None] + t)
        tail = np.abs(product(TO_COEFFICIENTS, e.T))[_SHORT:].sum(axis=0)
        share, noise = tolerances(grading, a, t, e)
        rough = tail > EXACT * share * np.abs(e).max(axis=1) + noise
        least, changing = _least(e)  # next to a zero it falls as deep on every cell
        rough |= (share > _EVEN * least) & ~changing & (width > _NARROW)
        if not rough.any():
            break
        edges = np.unique(np.concatenate([edges, (a + width / 2)[rough]]))
    return edges


def _steep(grading: Grading) -> bool:
    """Whether it may be, between its breaks or, if it is made of series, its kinks."""
    return not grading.smooth or isinstance(getattr(grading, "grading", grading), PiecewiseSeries)


def tolerances(grading: Grading, a: Array | float, t: Array, e: Array) -> tuple[Array, Array]:
    """Share of the largest modulus on a cell that errors are held against; and noise of the modulus.

    Of moduli `e` at heights ``a + t``, over the last axis. A single contact may sit where the modulus is
    least, and is to be as accurate as all others. The share is 1 up to a ratio of four, for gradings without
    steep places, and where the modulus changes its sign. The noise is what a steep grading makes of the last
    digit of a height.
    """
    widest, share = t.max(axis=-1), np.ones(e.shape[:-1])
    noise = _DIGITS * np.spacing(np.abs(a) + widest) * np.ptp(e, axis=-1) / widest
    if _steep(grading):
        least, changing = _least(e)
        share = np.where(changing, 1.0, np.clip(_EVEN * least, _LEAST, 1.0))
    return share, noise


def _least(e: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Least modulus `e` on a cell over the largest, over the last axis; and whether it changes its sign."""
    low, high = e.min(axis=-1), e.max(axis=-1)
    small, large = np.minimum(np.abs(low), np.abs(high)), np.maximum(np.abs(low), np.abs(high))
    return small / np.maximum(large, np.finfo(float).tiny), (low <= 0) & (high >= 0)


def _mass(law: HeightLaw, a: Array, t: Array) -> Array:
    """Probability between a and a + t, relative to the density at a: `t` has shape (cells, points)."""
    sums = np.empty(t.shape)
    for first in range(0, len(a), _TOGETHER):
        some = slice(first, first + _TOGETHER)
        logs = law.log_ratio(a[some, None, None], t[some, :, None] * _X)
        sums[some] = product(np.exp(logs), _W)
    return t * sums


def _stretch(law: HeightLaw, a: Array, width: Array, mass: Array) -> Array:
    """Coefficients of t(u)/u, where ``mass(t(u)) = u mass``: by Newton at the Chebyshev points."""
    u = (1 + NODES) / 2
    t = width[:, None] * u
    for _ in range(8):  # the mass is nearly linear in t: quadratic convergence from the first step
        step = (_mass(law, a, t) - u * mass[:, None]) / np.exp(law.log_ratio(a[:, None], t))
        t = t - step
        if np.all(np.abs(step) < _CONVERGED * t):
            break
    return product(TO_COEFFICIENTS, (t / u).T)
