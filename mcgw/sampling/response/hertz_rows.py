"""Rows of Hertz's law: ``scale (s - h)^exponent e(s)^modulus``, one for each quantity and separation."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import HeightLaw, Quantity, quantity_of
from mcgw.machine.compiling import njit
from mcgw.machine.kept import kept
from mcgw.sampling.response.rows import Rows, Start
from mcgw.sampling.spacing import SURE
from mcgw.scene.scene import Scene

__all__ = ["hertz_rows"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class _Powers:
    """Formulas of Hertz's law.

    Parameters
    ----------
    exponent, scale : ndarray
        Of each row.
    graded : ndarray of bool
        Whether the modulus counts.
    """

    exponent: Array
    scale: Array
    graded: NDArray[np.bool_]

    def values(self, rows: Ints, above: Array, e: Array) -> Array:
        """As `Formulas.values`."""
        return np.asarray(_values(self.exponent[rows], self.scale[rows], self.graded[rows], above, e))

    def at_start(self, rows: Ints, above: Array, e: Array, u: Array) -> list[Start]:
        """With ``s - h = u q(u)`` a row is ``u^n q^n e``, and q^n e is accurate down to u = 0."""
        values = self.values(rows, above / u[:, None], e)
        rooted = self.exponent[rows] % 1 != 0
        starts = []
        for root in (False, True):
            which = np.flatnonzero(rooted == root)
            if which.size:
                starts.append(Start(root, which, values[:, which], self.exponent[rows][which] // 1))
        return starts


def hertz_rows(scene: Scene, quantities: tuple[str, ...], *, lasting: bool) -> Rows:
    """Rows of some quantities at all separations of a scene, which increase.

    If they are to be lasting, they are resolved as if every surface could have a single contact.
    """
    chosen, once = [quantity_of(name) for name in quantities], np.array(scene.all_separations)
    h = np.tile(once, len(chosen))
    exponent = _of_each([q.exponent for q in chosen], once)
    graded = _of_each([bool(q.modulus) for q in chosen], once).astype(bool)
    scale = _of_each([q.scale(scene.surface) for q in chosen], once)
    return Rows(
        h=h,
        low=h,
        high=np.full(len(h), np.inf),
        begins=np.ones(len(h), dtype=bool),
        rooted=exponent % 1 != 0,
        rough=np.zeros(len(h), dtype=bool),
        graded=graded,
        kind=np.repeat(np.arange(len(chosen)), len(once)),
        answer=np.arange(len(h)),
        total=np.zeros(len(h)) if lasting else _totals(scene, chosen, once),
        formulas=_Powers(exponent, scale, graded),
    )


def _of_each(values: list[float], separations: Array) -> Array:
    return np.repeat(np.array(values, dtype=np.float64), len(separations))


@njit(nogil=True, cache=True)
def _values(exponent: Any, scale: Any, graded: Any, above: Any, e: Any) -> Any:
    """``scale e above^exponent`` for whole and half-integer exponents, by products and roots."""
    values, power = np.empty(above.shape), np.empty(exponent.size)
    whole, half = np.floor(exponent), exponent % 1 != 0
    most = 0
    for j in range(exponent.size):  # a reduction by NumPy's name imports half of SciPy
        most = max(most, int(whole[j]))
    for i in range(above.shape[0]):
        for j in range(exponent.size):
            root = np.sqrt(above[i, j])
            power[j] = root if half[j] else 1.0
        for times in range(most):
            for j in range(exponent.size):
                power[j] = power[j] * above[i, j] if whole[j] > times else power[j]
        for j in range(exponent.size):
            values[i, j] = scale[j] * (e[i, j] if graded[j] else 1.0) * power[j]
    return values


@kept(8)
def _quantiles(law: HeightLaw, separations: bytes) -> tuple[Array, Array]:
    """Share of heights above each separation, and 16 equally likely distances of those from it."""
    h, share = np.frombuffer(separations), (np.arange(16) + 0.5) / 16
    touching = law.above(h)
    rank = np.maximum(touching[:, None] * share, np.finfo(float).tiny)
    return touching, np.maximum(law.from_above(rank, -np.inf) - h[:, None], 0.0)


def _totals(scene: Scene, chosen: list[Quantity], h: Array) -> Array:
    """Mean sums from 16 quantiles, quantity by quantity: the order of magnitude is all it takes."""
    touching, approach = _quantiles(scene.heights, h.tobytes())
    modulus, contacts = scene.modulus(approach + h[:, None]), scene.n_asperities * touching
    totals = [np.empty(0)]
    for q in chosen:
        exponent, one = np.full(16, q.exponent), np.ones(16)
        terms = _values(exponent, one, np.full(16, bool(q.modulus)), approach, modulus)
        with np.errstate(over="ignore"):
            total = np.minimum(
                np.abs(q.scale(scene.surface) * terms.mean(axis=1)) * contacts, np.finfo(float).max
            )
        totals.append(np.where(contacts > SURE, total, 0.0))
    return np.concatenate(totals)
