"""Surfaces at nominal separations under any law: by the formula of each contact at each step of a search.

Slow, literal, trusted: the witness against `mcgw.sampling.nominal`, and the way in for other laws than
Hertz's and for summits with radii of their own.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

from analytic import quantity_of
from analytic.arrays import Array
from analytic.laws import term_of
from mcgw.sampling.balance import no_balance
from mcgw.sampling.block import Block, Sampler
from mcgw.sampling.counts import counts_of
from mcgw.sampling.outside import extra_heights
from mcgw.scene.scene import Scene

if TYPE_CHECKING:
    from mcgw.sampling.radius_table import RadiusTable

_CLOSE = 4e-15
_MOST_STEPS = 10_000


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
    e = scene.modulus(heights)

    def total(name: str, x: float) -> float:
        q = quantity_of(name)
        if ratios is None:
            terms = term_of(q.base, scene.branch_of(name), x, heights, e)
        else:
            terms = scene.ways.term(name, x, heights, e, ratios)
        return float(q.scale(scene.surface) * np.sum(terms))

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

    @property
    def seconds_per_draw(self) -> float:
        """With all steps of the searches."""
        return 1e-6

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
