"""Summits at their places that press each other down: the balance of all of them.

The summit i sinks by what the loads of all others press the half-space down at its place ::

    delta_i = z_i - d - sum_j G_ij P_j(delta_j)/(pi E*),

with the exact potential of point loads, and near by that of Hertz's pressure over contacts as wide as they
would be alone. So G is one matrix, and Newton's steps need a few products with it.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix, diags_array
from scipy.sparse.linalg import LinearOperator, cg
from scipy.spatial import cKDTree

from analytic.arrays import Array, Ints
from mcgw.elasticity.grid import Grid
from mcgw.elasticity.spots import Spots

# Two summits at one place are in neutral balance, whichever of them carries how much, if their fields are
# those of a contact whose squared radius is this times the sum of theirs.
_NEUTRAL = 1.125
_REACH = 4.0  # contact radii of spots, beyond which they are point loads to each other
_DENSE = 2500  # spots, beyond which Fourier series sum faster than a matrix

Push = Callable[[Array], Array]  # how far loads in N press down each summit, m


@dataclass(frozen=True)
class Balance:
    """Spots in balance under a rigid plane."""

    separation: float  # of the plane from the mean plane of the deformed surface, m
    penetrations: Array  # of each summit, m; not positive where it does not touch
    stiffness: float  # -dP/dd of all of them, which give way to each other, N/m
    share: float  # of the interaction: 1, or less where no balance was found with all of it


def balanced(spots: Spots, places: Ints, grid: Grid, separation: float, load: float | None = None) -> Balance:
    """Find the balance of spots at points of a grid, at a separation in m or under a load in N.

    No two of their `places`, rows and columns of shape (2, n), are alike. The `separation` is below the
    highest summit; with a load it is that of the spots alone.

    Examples
    --------
    >>> spots = Spots.hertz(np.zeros(2), np.full(2, 1e-5), 1e9)
    >>> found = balanced(spots, np.array([[0, 0], [0, 2]]), Grid((100, 100), (1e-3, 1e-3)), -1e-7)
    >>> bool(found.stiffness < spots.slopes(found.penetrations).sum())
    True
    """
    push, start = interaction(spots, places, grid, separation), spots.heights - separation
    found = Balance(separation, start, float(spots.slopes(start).sum()), 0.0)
    for share in (0.5, 1.0):  # from spots alone, a whole interaction is a leap
        nearer = _newton(spots, push, found, load, share)
        if nearer is None:
            break
        found = nearer
    return found


def interaction(spots: Spots, places: Ints, grid: Grid, separation: float) -> Push:
    """Tell how far loads in N press down each spot, m, with contacts as wide as those of spots alone."""
    n, near = spots.heights.size, _near(grid, places, spots.least_radii(separation))
    matrix = grid.between(places) + near.toarray() if n <= _DENSE else None

    def push(loads: Array) -> Array:
        total = grid.summed(places, loads) + near @ loads if matrix is None else matrix @ loads
        return np.asarray(total / (math.pi * spots.E_star))

    return push


def _near(grid: Grid, places: Ints, radii: Array) -> csr_matrix:
    """Return what pairs of spots within reach feel of each other beyond point loads, 1/m."""
    tree = cKDTree(places[::-1].T * np.array(grid.pixel), boxsize=np.array(grid.size))
    farthest = min(_REACH * math.sqrt(2) * float(radii.max()), min(grid.size) / 2)
    pairs = tree.sparse_distance_matrix(tree, farthest, output_type="coo_matrix")
    squared = radii[pairs.row] ** 2 + radii[pairs.col] ** 2
    kept = (pairs.row != pairs.col) & (pairs.data**2 < _REACH**2 * squared)
    field = beyond_point(pairs.data[kept], _NEUTRAL * squared[kept])
    return csr_matrix((field, (pairs.row[kept], pairs.col[kept])), shape=(radii.size, radii.size))


def beyond_point(distance: Array, squared_radius: Array) -> Array:
    """How much more or less a spot presses down a point than its load would from its centre, per load, 1/m.

    Around a Hertz contact of radius a (Johnson, Contact Mechanics, 1985, Eqs. 3.41 and 3.42, recalled and
    checked against the integral)::

        u pi E*/P = 3/4 [(2 a^2 - r^2) asin(min(a/r, 1)) + a sqrt(r^2 - a^2)_+ ] / a^3,

    of which 1/r is taken off. Between two spots a is that of both, so that the potential is mutual:
    ``a^2 = 1.125 (a_i^2 + a_j^2)``; averaged over both contacts, 1 in place of 1.125 is exact to the
    second order in a/r. Both are in m and m^2, above 0.
    """
    x = distance**2 / squared_radius
    beyond = np.maximum(x, 1.0)
    field = 0.75 * ((2 - x) * np.arcsin(beyond**-0.5) + np.sqrt(beyond - 1))
    return np.asarray(field / np.sqrt(squared_radius) - 1 / distance)


def _newton(spots: Spots, push: Push, start: Balance, load: float | None, share: float) -> Balance | None:
    """Balance under a share of the interaction, if steps from another balance lead to one."""
    deepest, d, delta = float(start.penetrations.max()), start.separation, start.penetrations
    for _ in range(40):
        slopes, loads = spots.slopes(delta), spots.loads(delta)
        misfit = delta - spots.heights + d + share * push(loads)
        missing = 0.0 if load is None else load - float(loads.sum())
        size = max(float(np.abs(misfit).max()) / deepest, abs(missing) / load if load else 0.0)
        if not slopes.any() or size > 1e3:  # steps lead nowhere
            return None
        under = _answered(slopes, push, share, np.ones(delta.shape))  # more load as the plane sinks by 1 m
        if size < 1e-11:  # of the deepest penetration and of the load
            return Balance(d, delta, float(under.sum()), share)
        own = _answered(slopes, push, share, -misfit)
        lower = 0.0 if load is None else (missing - float(own.sum())) / float(under.sum())
        d, delta = d - lower, delta + lower - misfit - share * push(own + lower * under)
    return None


def _answered(slopes: Array, push: Push, share: float, sinking: Array) -> Array:
    """Return loads by which spots answer when each is lowered by so much, to first order, N."""
    on = slopes > 0
    loads, shape = np.zeros(slopes.shape), (np.count_nonzero(on),) * 2

    def sunk(x: Array) -> Array:
        loads[on] = x
        return np.asarray(x / slopes[on] + share * push(loads)[on])

    whole = LinearOperator(shape, matvec=sunk, dtype=float)
    alone = diags_array(slopes[on])
    loads[on] = cg(whole, sinking[on], rtol=1e-9, maxiter=200, M=alone)[0]
    return loads
