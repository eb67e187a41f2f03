"""Summits at their places that press each other down: the balance of all of them."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from analytic.arrays import Array, Ints, Marks
from mcgw.elasticity.newton import Equations, State
from mcgw.elasticity.spots import Grid, Spots
from mcgw.errors import RunError

_REACH = 4.0  # contact radii of spots that feel no other one: beyond, a spot is a point load
_BELOW = 0.4  # of the deepest penetration: how far below the plane summits are looked at first
_MOST_MERGED = 0.05  # of the spots


class BalanceError(RunError):
    """A load at which no balance was found."""


@dataclass(frozen=True)
class Balance:
    """Spots in balance under a rigid plane; sums over all of them.

    Parameters
    ----------
    separation : float
        Of the plane from the mean plane of the deformed surface (periodic) or from the undeformed one, m.
    load, area, stiffness : float
        N, m^2, N/m; stiffness is -dP/dd of the whole, in which the spots give way to each other.
    penetrations : ndarray
        Of each summit, in the order of the spots, m; not positive where it does not touch.
    merged : int
        Summits left out, since a higher one's contact holds their place and the two have no balance.
    residual : float
        What is left over, of the deepest penetration.
    start : float
        Separation of the spots that do not feel each other, m, by whose contacts near ones were told.
    """

    separation: float
    load: float
    area: float
    stiffness: float
    penetrations: Array
    merged: int
    residual: float
    start: float

    @property
    def contacts(self) -> int:
        """How many spots carry load."""
        return int(np.count_nonzero(self.penetrations > 0))


@dataclass(frozen=True)
class Located:
    """Summits at points of a grid, each of which feels the load of every other one.

    The spot i sinks by what the loads of all others press the half-space down at its place ::

        delta_i = z_i - d - sum_j G_ij P_j(delta_j),

    with the exact potential of point loads, and within some contact radii that of Hertz's pressure.

    Parameters
    ----------
    spots : Spots
        What each does alone, shape (n,).
    places : ndarray of int
        Rows and columns, shape (2, n), no two alike.
    grid : Grid
        Where they lie.

    Examples
    --------
    >>> from mcgw.elasticity.spots import HertzSpots
    >>> spots = HertzSpots(np.array([0.0, 0.0]), np.array([1e-5, 1e-5]), 1e9)
    >>> pair = Located(spots, np.array([[0, 0], [0, 50]]), Grid((100, 100), (1e-3, 1e-3), periodic=False))
    >>> bool(pair.at_separation(-1e-7).load < spots.load(np.array([1e-7, 1e-7])).sum())
    True
    """

    spots: Spots
    places: Ints
    grid: Grid

    def at_load(self, load: float) -> Balance:
        """Find the balance under a load, N.

        Raises
        ------
        BalanceError
            If Newton's steps do not converge; it says what is left over.
        """
        return self._balance(self.alone_at(load), load)

    def at_separation(self, separation: float) -> Balance:
        """Find the balance at a separation, m, below the highest summit: see `at_load`."""
        return self._balance(separation, None)

    def alone_at(self, load: float) -> float:
        """Separation at which the spots carry a load if none feels another one, m."""
        z = self.spots.heights
        depth = float(np.ptp(z)) or 1e-9

        def missing(d: float) -> float:
            return float(self.spots.load(z - d).sum()) - load

        while missing(float(z.max()) - depth) < 0:
            depth *= 2
        return float(brentq(missing, z.max() - depth, z.max(), xtol=1e-14 * depth, rtol=1e-14))

    def _balance(self, separation: float, load: float | None) -> Balance:
        """Of the summits that come near the plane, and of more of them if others turn out to touch."""
        z, top = self.spots.heights, float(self.spots.heights.max())
        alone = self.spots.squared_radius(z - separation)
        reach = _REACH**2 * np.maximum(alone, alone.mean(where=alone > 0))
        near, merged = z > separation - _BELOW * (top - separation), np.zeros(z.size, dtype=bool)
        while True:
            equations = Equations(self.spots.only(near), self.places[:, near], self.grid, reach[near])
            state = equations.solved(separation, load)
            if not state.converged:
                merged[np.flatnonzero(near)[equations.doubtful(state)]] = True
                near &= ~merged
                if merged.sum() > max(_MOST_MERGED * np.count_nonzero(state.penetrations > 0), 1):
                    raise BalanceError(
                        f"no equilibrium of {near.sum()} summits found (residual {state.residual:.1e} of the "
                        "deepest penetration); give a lower load or a larger separation"
                    )
                continue
            missed = self._missed(equations, state) & ~near & ~merged
            if not missed.any():
                return self._summed(equations, state, near, merged, separation)
            near |= missed

    def _missed(self, equations: Equations, state: State) -> Marks:
        """Summits that would touch."""
        loads = equations.spots.load(state.penetrations)
        pressed = self.grid.pressed(equations.places, loads, self.places) / (math.pi * self.spots.E_star)
        return np.asarray(self.spots.heights - state.separation > pressed)

    def _summed(
        self, equations: Equations, state: State, near: Marks, merged: Marks, start: float
    ) -> Balance:
        delta = state.penetrations
        everywhere = np.full(near.shape, -np.inf)
        everywhere[near] = delta
        return Balance(
            state.separation,
            float(equations.spots.load(delta).sum()),
            math.pi * float(equations.spots.squared_radius(delta).sum()),
            equations.stiffness(state),
            everywhere,
            int(merged.sum()),
            state.residual,
            start,
        )
