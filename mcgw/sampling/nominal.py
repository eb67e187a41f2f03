"""Surfaces at nominal separations, where each of them finds a balance of its own.

``CellsAtNominal``   under Hertz's law and with one radius: by the moments of cells (`mcgw.sampling.balance`)
``TailAtNominal``    under any law: by the formula of each contact at each step of a search; slow, literal,
                     trusted, as `balanced_sums` of any heights are: the witness against the other
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

from analytic import quantity_of
from analytic.arrays import Array
from mcgw.sampling.balance import FAILED, POINTS, balance_surfaces, no_balance
from mcgw.sampling.block import Block, Layout, Sampler
from mcgw.sampling.cells import NODES, TO_COEFFICIENTS, mesh_of
from mcgw.sampling.counts import counts_of
from mcgw.sampling.moments import cell_moments
from mcgw.sampling.outside import extra_heights
from mcgw.sampling.rules import chebyshev_points, chebyshev_transform, product
from mcgw.scene.scene import Scene

if TYPE_CHECKING:
    from mcgw.sampling.own_radii import RadiusTable

_POINTS = chebyshev_points(POINTS)
_TRANSFORM = chebyshev_transform(_POINTS)
_FEW = 2 * POINTS  # asperities of a cell that are rather taken one by one
_WIDEST, _NARROWEST = 2.0**-2, 2.0**-12  # of a cell
_WEIGHTED = 8.0 * POINTS  # over the asperities: width of a cell squared
_NOTHING = 1e-17  # of a series
_GUESSES, _COARSE = 512, 2.0**10  # separations at which the mean surface is looked at, and their rounding
_PLACES = {"load": 1, "stiffness": 2, "load_slope": 2, "area": 3, "conductance": 4, "contacts": 5}
_CLOSE = 4e-15
_MOST_STEPS = 10_000


def on_a_grid(scene: Scene) -> Scene:
    """The scene without interaction, at separations whose cells are those of `CellsAtNominal`."""
    width = math.sqrt(_WEIGHTED / scene.n_asperities)
    width = min(max(2.0 ** round(math.log2(width)), _NARROWEST), _WIDEST)
    steps = max(math.ceil((scene.highest - scene.lowest) / width), 1)
    grid = scene.lowest + width * np.arange(steps)
    return replace(scene, interaction=None, separations=tuple(grid.tolist()))


@dataclass(frozen=True, eq=False)
class CellsAtNominal(Sampler):
    """Surfaces drawn in cells, whose width is a compromise (`mcgw.sampling.balance`).

    The narrower the cells are, the fewer asperities are near a separation, and the more cells are above it.

    The scene is at nominal separations, with one radius and Hertz's law.
    """

    @classmethod
    def of(cls, scene: Scene) -> "CellsAtNominal":
        """Prepare it."""
        return cls("cells", scene, mesh_of(on_a_grid(scene), split=False))

    @property
    def moments(self) -> int:
        """Moments of a surface, by which its cells are weighted; none is kept."""
        return POINTS * self.cells

    @property
    def words(self) -> int:
        """Numbers in memory for a surface, besides its results."""
        return 3 * self.moments + super().words

    def block(self, first: int, n: int) -> Block:
        """Results of surfaces `first` ... `first + n - 1`.

        Raises
        ------
        ValueError
            If a surface has no balance at a separation.
        """
        scene = self.scene
        counts = counts_of(scene, self.mesh, first, n)
        crowded = np.where(counts.cells > _FEW, counts.cells, 0)
        layout = Layout(np.full(self.cells, POINTS), np.zeros(self.cells, dtype=np.int64))
        moments = cell_moments(scene.seed, first, crowded, layout)
        weights = product(
            np.ascontiguousarray(moments.reshape(self.cells, POINTS, n).transpose(2, 0, 1)), _TRANSFORM
        )
        heights, moduli = self._points
        rows = extra_heights(scene, self.mesh, first, counts, None)
        own = np.ascontiguousarray(rows[:, 1])
        begins = np.searchsorted(rows[:, 0], first + np.arange(n + 1))
        found = balance_surfaces(
            np.uint64(scene.seed),
            first,
            self._series,
            (heights.ravel(), (weights * moduli).reshape(n, -1), weights.reshape(n, -1)),
            np.ascontiguousarray(counts.cells.T),
            _FEW,
            (own, scene.modulus(own), begins),
            (np.array(scene.separations), self._guess, self._compliance),
        )
        self._check(first, found)
        sums = {
            name: found[:, :, _PLACES[quantity_of(name).base]] * quantity_of(name).scale(scene.surface)
            for name in scene.quantities
        }
        return Block({**sums, "effective_separation": np.ascontiguousarray(found[:, :, 0])})

    def _check(self, first: int, found: Array) -> None:
        """Refuse surfaces without a balance, or one below what is drawn."""
        failed = (found[:, :, 5] == FAILED) | (found[:, :, 0] < self.scene.lowest)
        if failed.any():
            surface, k = (int(x[0]) for x in np.nonzero(failed))
            raise no_balance(first + surface, self.scene.separations[k])

    @property
    def _compliance(self) -> float:
        """Of the interaction, d/sigma for a reduced load of 1."""
        surface = self.scene.surface
        return self.scene.compliance / surface.sigma * quantity_of("load").scale(surface)

    @cached_property
    def _points(self) -> tuple[Array, Array]:
        """Heights and moduli at the Chebyshev points of each cell, shape (cells, POINTS)."""
        heights = self._heights(_POINTS)
        return heights, np.asarray(self.scene.modulus(heights))

    def _heights(self, x: Array) -> Array:
        """Those at x = 2u - 1 in each cell, shape (cells, x.size)."""
        steps = [self.mesh.offsets(np.arange(self.cells), np.full(self.cells, u)) for u in (1 + x) / 2]
        return np.asarray(self.mesh.edges[:-1, None] + np.stack(steps, axis=1))

    @cached_property
    def _series(self) -> tuple[Array, Array, Array]:
        """Edges, and coefficients by which asperities are drawn: no more than count."""
        moduli = product(TO_COEFFICIENTS, np.asarray(self.scene.modulus(self._heights(NODES))).T)
        return self.mesh.edges, _short(self.mesh.stretch), _short(moduli)

    @cached_property
    def _guess(self) -> Array:
        """Effective separations of the mean surface, roughly, and rounded: they begin the search alone."""
        scene, mesh, c = self.scene, self.mesh, self._compliance
        s, e = (part[:, POINTS // 2] for part in self._points)
        forces = scene.n_asperities * mesh.probability * e
        x = np.linspace(scene.lowest, scene.highest + 1, _GUESSES)
        depths = (np.maximum(s - at, 0.0) for at in x)
        load = np.array([float(product(d * np.sqrt(d), forces)) for d in depths])
        nominal = x - c * load
        falling = np.flatnonzero(np.diff(nominal) <= 0)
        usable = slice(int(falling[-1]) + 1 if falling.size else 0, None)
        guess = np.interp(scene.separations, nominal[usable], x[usable])
        return np.asarray(np.round(guess * _COARSE) / _COARSE)


def _short(coefficients: Array) -> Array:
    """Without the orders that are rounding errors in every cell."""
    size = np.abs(coefficients) / np.abs(coefficients[0])
    last = int(np.max(np.nonzero((size > _NOTHING).any(axis=1))[0], initial=0))
    return np.ascontiguousarray(coefficients[: last + 1])


def balanced_sums(scene: Scene, number: int, heights: Array, ratios: Array | None) -> dict[str, Array]:
    """Quantities of one surface at its effective separations, and these.

    Parameters
    ----------
    scene : Scene
        At nominal separations.
    number : int
        Of the surface, for messages.
    heights : ndarray
        Reduced heights of its asperities, shape (n,).
    ratios : ndarray or None
        Radius of each over that of the surface, where summits have their own.

    Returns
    -------
    dict of str to ndarray
        Each quantity in SI units, shape (1, separations).

    Raises
    ------
    ValueError
        If it has no balance at a separation.
    """
    c = scene.compliance / scene.surface.sigma
    e, ways = scene.modulus(heights), scene.ways

    def total(name: str, x: float) -> float:
        terms = ways.term(name, x, heights, e, ratios)
        return float(quantity_of(name).scale(scene.surface) * np.sum(terms))

    load = partial(total, "load")
    felt = []
    for h in scene.separations:
        x = _from_below(h, c, load) if c > 0 else _from_above(h, c, load, scene.lowest)
        if x is None:
            raise no_balance(number, h)
        felt.append(x)
    found = {name: np.array([[total(name, x) for x in felt]]) for name in scene.quantities}
    return {**found, "effective_separation": np.array([felt])}


def _from_below(h: float, c: float, load: Callable[[float], float]) -> float:
    """Balance of a surface that sinks away: between none of its loads sinking, and all of that at h."""
    most = h + c * load(h)
    if most <= h:
        return h
    if most - h <= c * load(most):  # but for rounding, which is all that it sinks less by there
        return most
    return float(brentq(lambda x: x - h - c * load(x), h, most, xtol=1e-15, rtol=_CLOSE))


def _from_above(h: float, c: float, load: Callable[[float], float], lowest: float) -> float | None:
    """The first balance from the side of no load, where loads pull the plane down; None if there is none.

    The load falls with the separation: so each step goes down, and none beyond the balance.
    """
    x = h
    for _ in range(_MOST_STEPS):
        last, x = x, h + c * load(x)
        if x < lowest:
            return None
        if abs(x - last) <= _CLOSE * max(abs(x), 1.0):
            return x
    return None


@dataclass(frozen=True)
class TailAtNominal(Sampler):
    """Every asperity that may touch drawn by itself.

    Parameters
    ----------
    name, scene, mesh
        As of any `Sampler`: at nominal separations, without cells.
    table : RadiusTable or None
        Of radii, where summits have their own.
    """

    table: "RadiusTable | None"

    def block(self, first: int, n: int) -> Block:
        """Results of surfaces `first` ... `first + n - 1`."""
        counts = counts_of(self.scene, self.mesh, first, n)
        rows = extra_heights(self.scene, self.mesh, first, counts, self.table)
        found = []
        for number in range(first, first + n):
            mine = rows[rows[:, 0] == number]
            ratios = np.ascontiguousarray(mine[:, 3]) if self.table else None
            found.append(balanced_sums(self.scene, number, np.ascontiguousarray(mine[:, 1]), ratios))
        return Block({name: np.concatenate([row[name] for row in found]) for name in found[0]})
