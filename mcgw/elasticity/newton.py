"""Newton's steps to the balance of spots that press each other down.

Their derivative is whole, with the growth of each contact in the fields of its neighbours: four to ten steps
do then, where a derivative that leaves it out takes dozens or fails.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse.linalg import LinearOperator, gmres
from scipy.spatial import cKDTree

from analytic.arrays import Array, Ints
from mcgw.elasticity.spots import Grid, Spots, field_beyond_point

_BALANCED = 1e-11  # what may be left over, of the deepest penetration and of the load
_STEPS, _SHORTEST, _MEMORY = 60, 2**-7, 4  # a step may leave more over than the last, not than the last four
_KRYLOV_CLOSE, _KRYLOV, _RESTARTS = 1e-10, 100, 5
_DENSE = 2500  # spots, beyond which Fourier series sum faster than a matrix
_STEP = 2.0**-20  # of a penetration, for the derivative of a contact's squared radius


@dataclass(frozen=True)
class State:
    """Where Newton's steps are, and what is left over there.

    Parameters
    ----------
    separation : float
        m.
    penetrations, misfit : ndarray
        Of each summit, m.
    short : float
        Load that is missing, of the load that is wanted.
    field, by_radii : ndarray
        Of each pair: see `mcgw.elasticity.spots.field_beyond_point`.
    """

    separation: float
    penetrations: Array
    misfit: Array
    short: float
    field: Array
    by_radii: Array

    @property
    def residual(self) -> float:
        """Largest misfit of the deepest penetration, or of the load."""
        return max(float(np.abs(self.misfit).max() / self.penetrations.max()), abs(self.short))

    @property
    def converged(self) -> bool:
        """Whether nothing that counts is left over, of the deepest penetration and of the load."""
        return self.residual < _BALANCED

    @property
    def size(self) -> float:
        """All misfits as one number."""
        return math.hypot(float(np.linalg.norm(self.misfit)) / self.penetrations.max(), self.short)


@dataclass(frozen=True)
class Equations:
    """The balance of each of some summits, and of their load.

    Parameters
    ----------
    spots : Spots
        What each does alone, shape (n,).
    places : ndarray of int
        Rows and columns, shape (2, n).
    grid : Grid
        Where they lie.
    squared_reach : ndarray
        Of each spot, m^2: two whose squared distance is below the sum of theirs are more than point loads.
    """

    spots: Spots
    places: Ints
    grid: Grid
    squared_reach: Array

    @cached_property
    def _pairs(self) -> tuple[Ints, Ints, Array]:
        """Summits within each other's reach, and squared distances, m^2."""
        at = self.places[::-1].T * np.array(self.grid.pixel)
        size = np.array(self.grid.size)
        farthest = math.sqrt(2 * float(self.squared_reach.max()))
        tree = cKDTree(at, boxsize=size if self.grid.periodic else None)
        i, j = tree.query_pairs(min(farthest, size.min() / 2), output_type="ndarray").T
        apart = np.abs(at[i] - at[j])
        if self.grid.periodic:
            apart = np.minimum(apart, size - apart)
        squared = (apart**2).sum(axis=1)
        kept = squared < self.squared_reach[i] + self.squared_reach[j]
        return i[kept], j[kept], squared[kept]

    @cached_property
    def _matrix(self) -> Array | None:
        return self.grid.between(self.places) if self.places.shape[1] <= _DENSE else None

    def _pushed(self, loads: Array, field: Array) -> Array:
        """How far loads press down each summit, m."""
        if self._matrix is None:
            total = self.grid.pressed(self.places, loads, self.places)
        else:
            total = self._matrix @ loads
        return np.asarray((total + self._over_pairs(field, loads)) / (math.pi * self.spots.E_star))

    def _over_pairs(self, weights: Array, values: Array) -> Array:
        """Sum at each summit of the values at those within reach."""
        i, j, _ = self._pairs
        n = self.places.shape[1]
        return np.asarray(
            np.bincount(i, weights * values[j], n) + np.bincount(j, weights * values[i], n), dtype=np.float64
        )

    def _at(self, separation: float, penetrations: Array, load: float | None) -> State:
        i, j, r2 = self._pairs
        a2, loads = self.spots.squared_radius(penetrations), self.spots.load(penetrations)
        field, by_radii = field_beyond_point(r2, a2[i] + a2[j])
        misfit = penetrations - self.spots.heights + separation + self._pushed(loads, field)
        short = 0.0 if load is None else 1 - float(loads.sum()) / load
        return State(separation, penetrations, misfit, short, field, by_radii)

    def _solved_for(self, state: State, right: Array) -> Array:
        """Penetrations that change the misfits by these columns, to first order."""
        i, j, _ = self._pairs
        delta, n = state.penetrations, state.penetrations.size
        loads, slope, a2 = self.spots.load(delta), self.spots.slope(delta), self.spots.squared_radius(delta)
        step = _STEP * np.abs(delta)
        growth = (self.spots.squared_radius(delta + step) - a2) / np.maximum(step, 1e-300)
        by_radii = state.by_radii / (math.pi * self.spots.E_star)
        own = growth * self._over_pairs(by_radii, loads) + 1
        if self._matrix is not None:
            matrix = self._matrix.copy()
            matrix[i, j] += state.field
            matrix[j, i] += state.field
            matrix *= slope / (math.pi * self.spots.E_star)
            matrix[i, j] += by_radii * loads[j] * growth[j]
            matrix[j, i] += by_radii * loads[i] * growth[i]
            matrix[np.diag_indices(n)] += own
            on = delta > 0  # what does not touch presses nothing down
            found = right.copy()
            found[on] = np.linalg.solve(matrix[np.ix_(on, on)], right[on])
            found[~on] -= matrix[np.ix_(~on, on)] @ found[on]
            return found

        def changed(x: Array) -> Array:
            wider = np.bincount(i, by_radii * loads[j] * growth[j] * x[j], n)
            wider += np.bincount(j, by_radii * loads[i] * growth[i] * x[i], n)
            return np.asarray(own * x + wider + self._pushed(slope * x, state.field))

        derivative = LinearOperator((n, n), matvec=changed, dtype=float)
        restart = min(_KRYLOV, n)
        columns = (
            gmres(derivative, column, rtol=_KRYLOV_CLOSE, restart=restart, maxiter=_RESTARTS)[0]
            for column in right.T
        )
        return np.column_stack(list(columns))

    def stiffness(self, state: State) -> float:
        """Minus the derivative of the load by the separation, N/m."""
        sinking = self._solved_for(state, np.ones((state.misfit.size, 1)))[:, 0]
        return float(self.spots.slope(state.penetrations) @ sinking)

    def solved(self, separation: float, load: float | None) -> State:
        """Where the steps end, converged or not, from spots that do not feel each other.

        Parameters
        ----------
        separation : float
            m; to begin with if a load is given.
        load : float or None
            N.
        """
        state = self._at(separation, self.spots.heights - separation, load)
        sizes = [state.size]
        for _ in range(_STEPS):
            if state.converged:
                break
            columns = np.column_stack([-state.misfit, np.ones_like(state.misfit)])
            change, sinking = self._solved_for(state, columns).T
            lower = 0.0
            if load is not None:  # the separation changes, too, by as much as the load needs
                slope = self.spots.slope(state.penetrations)
                lower = float((load * state.short - slope @ change) / (slope @ sinking))
                change = change + lower * sinking
            step = 1.0
            while True:
                there = (state.separation - step * lower, state.penetrations + step * change)
                new = self._at(*there, load) if there[1].max() > 0 else None
                if new is not None and new.size < max(sizes[-_MEMORY:]):
                    break
                step /= 2
                if step < _SHORTEST:
                    return state
            state = new
            sizes.append(state.size)
        return state

    def doubtful(self, state: State) -> int:
        """The lower summit of the two that keep a balance from being found.

        Around the largest misfit the pair of touching summits that lie deepest within each other's contact.
        """
        i, j, r2 = self._pairs
        a2 = self.spots.squared_radius(state.penetrations)
        worst = int(np.abs(state.misfit).argmax())
        depth = np.minimum(a2[i], a2[j]) / r2
        depth[(i != worst) & (j != worst)] *= 1e-6  # others only if it has no neighbour
        if not depth.size:
            return worst
        pair = int(depth.argmax())
        return int(min(i[pair], j[pair], key=lambda k: self.spots.heights[k]))
