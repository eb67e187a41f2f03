"""What is asked of the heights, row by row: a formula that holds from one height to another.

A quantity at a separation is one row under Hertz's law, ``scale (s - h)^exponent e(s)^modulus``, and a few
where a law of contact has breaks: one for each piece, on the heights at which that piece holds.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from analytic import HeightLaw, quantity_of
from analytic.arrays import Array, Ints
from mcgw.machine.compiling import njit
from mcgw.machine.process import kept
from mcgw.sampling.spacing import SURE
from mcgw.scene.scene import Scene


class Powers(NamedTuple):
    """Formulas of Hertz's law: ``scale (s - h)^exponent e(s)``, the modulus only where the row is graded."""

    exponent: Array  # of each row: whole or half-integer
    scale: Array
    graded: NDArray[np.bool_]  # as `Rows.graded`

    def values(self, rows: Ints, above: Array, e: Array) -> Array:
        """Values at heights `above` the separation of each row, of modulus `e`: shape (rows, points)."""
        result = np.empty(above.shape)
        _powers(self.exponent[rows], self.scale[rows], self.graded[rows], above, e, result)
        return result

    def at_start(self, rows: Ints, above: Array, e: Array, u: Array) -> list[tuple[bool, Ints, Array, Array]]:
        """Return the same where each row begins, on the cell or node of variable u, `above` its start.

        As ``s - h = u q(u)``, they are ``u^n q^n e`` with q^n e smooth: whether they are still to be
        multiplied by sqrt(u), of which of the rows they are, q^n e, and the whole powers of u.
        """
        values, whole = self.values(rows, above / u, e), np.floor(self.exponent[rows])
        half = self.exponent[rows] > whole
        parts = [(root, np.flatnonzero(half == root)) for root in (False, True)]
        return [(root, which, values[which], whole[which]) for root, which in parts]


@njit(cache=True)
def _powers(exponent: Any, scale: Any, graded: Any, x: Any, e: Any, result: Any) -> None:
    """Write `Powers.values` of heights `x`, by products and roots."""
    for k in range(len(x)):
        whole = int(np.floor(exponent[k]))
        for i in range(x.shape[1]):
            power = np.sqrt(x[k, i]) if exponent[k] > whole else 1.0
            for _ in range(whole):
                power *= x[k, i]
            result[k, i] = scale[k] * (e[k, i] if graded[k] else 1.0) * power


@dataclass(frozen=True)
class Rows:
    """What is asked, one row an array element."""

    h: Array  # reduced separation of the row
    low: Array  # height from which its formula holds
    high: Array  # and up to which
    # whether contact begins at `low`: there `at_start` of the formulas tells what it is made of
    begins: NDArray[np.bool_]
    rooted: NDArray[np.bool_]  # whether it has a root there, as a part of it or as a factor
    # whether it begins with a power that no series resolves: on the smallest of cells it is taken as it is
    rough: NDArray[np.bool_]
    lost: NDArray[np.bool_]  # whether it ends with such a power at `high`, on the smallest of cells alike
    graded: NDArray[np.bool_]  # whether it depends on the modulus
    kind: Ints  # which formula: those of one kind differ in their separation alone
    answer: Ints  # which answer it adds to: quantity by quantity, at increasing separations
    # mean sum over a surface of the answer, where so many touch that it is sure to be of that size; else 0
    total: Array
    formulas: Any  # what holds

    def nearest(self, starts: Array) -> tuple[Ints, Ints]:
        """Of each kind the row of the highest separation that is smooth on each cell: the hardest to resolve.

        Cells, which begin at `starts`, and rows, pair by pair.
        """
        found = [(np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64))]
        for kind in np.unique(self.kind):
            rows = np.flatnonzero(self.kind == kind)
            rows = rows[np.argsort(self.h[rows], kind="stable")]
            sides = (np.searchsorted(starts, self.low[rows], side) for side in ("right", "left"))
            first = np.where(self.rooted[rows], *sides)  # on the cell where a root begins it is in parts
            end = np.searchsorted(starts, self.high[rows])
            endless = np.flatnonzero(end == starts.size)
            highest = np.full(starts.size + 1, -1)
            np.maximum.at(highest, first[endless], endless)
            highest = np.maximum.accumulate(highest[:-1])
            for k in np.flatnonzero(end < starts.size).tolist():
                here = highest[first[k] : end[k]]
                np.maximum(here, k, out=here)
            cell = np.flatnonzero(highest >= 0)
            found.append((cell, rows[highest[cell]]))
        cell, row = (np.concatenate(part) for part in zip(*found, strict=True))
        return cell, row


def hertz_rows(scene: Scene, quantities: tuple[str, ...]) -> Rows:
    """Rows of some quantities at all separations of a scene, which increase."""
    chosen, once = [quantity_of(name) for name in quantities], np.array(scene.all_separations)
    h = np.tile(once, len(chosen))
    values = np.array([(q.exponent, q.modulus, q.scale(scene.surface)) for q in chosen]).reshape(-1, 3)
    exponent, modulus, scale = np.repeat(values, len(once), axis=0).T.copy()
    graded, every = modulus.astype(bool), np.arange(len(h))
    touching, approach = sixteen(scene.heights, once.tobytes())
    sums = scene.n_asperities * touching, approach, scene.modulus(approach + once[:, None])
    contacts, approach, e = (np.concatenate([part] * len(chosen) or [part[:0]]) for part in sums)
    unscaled = Powers(exponent, np.ones(len(h)), graded).values(every, approach, e)
    return Rows(
        h=h,
        low=h,
        high=np.full(len(h), np.inf),
        begins=np.ones(len(h), dtype=bool),
        rooted=exponent % 1 != 0,
        rough=np.zeros(len(h), dtype=bool),
        lost=np.zeros(len(h), dtype=bool),
        graded=graded,
        kind=every // len(once),
        answer=every,
        total=sure_sums(contacts, scale, unscaled),
        formulas=Powers(exponent, scale, graded),
    )


@kept
def sixteen(law: HeightLaw, separations: bytes) -> tuple[Array, Array]:
    """Return the share of heights above each separation, and 16 equally likely distances of those from it.

    For the order of magnitude of a sum.
    """
    h, share = np.frombuffer(separations), (np.arange(16) + 0.5) / 16
    touching = law.sf(h)
    rank = np.maximum(touching[:, None] * share, np.finfo(float).tiny)
    return touching, np.maximum(law.isf(rank) - h[:, None], 0.0)


def sure_sums(contacts: Array, scale: Array | float, terms: Array) -> Array:
    """Mean sums of what so many contacts add of `sixteen` kinds, where so many are sure to touch; else 0."""
    with np.errstate(over="ignore"):
        total = np.minimum(np.abs(scale * terms.mean(axis=1)) * contacts, np.finfo(float).max)
    return np.asarray(np.where(contacts > SURE, total, 0.0))
