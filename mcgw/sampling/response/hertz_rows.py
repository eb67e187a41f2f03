"""Rows of Hertz's law: ``scale (s - h)^exponent e(s)^modulus``, one for each quantity and separation."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
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
        modulus = np.where(self.graded[rows], e, 1.0)
        return np.asarray(self.scale[rows] * modulus * _power(above, self.exponent[rows]))

    def at_start(self, rows: Ints, above: Array, e: Array, u: Array) -> list[Start]:
        """With ``s - h = u q(u)`` a row is ``u^n q^n e``, and q^n e is accurate down to u = 0."""
        values = self.values(rows, above / u[:, None], e)
        rooted = self.exponent[rows] % 1 != 0
        return [
            Start(root, which, values[:, which], self.exponent[rows][which] // 1)
            for root in (False, True)
            if (which := np.flatnonzero(rooted == root)).size
        ]


def hertz_rows(scene: Scene, quantities: tuple[str, ...], *, lasting: bool) -> Rows:
    """Rows of some quantities at all separations of a scene, which increase.

    If they are to be lasting, they are resolved as if every surface could have a single contact.
    """
    chosen = [quantity_of(name) for name in quantities]
    h = np.tile(scene.separations, len(chosen))
    exponent = _of_each([q.exponent for q in chosen], scene)
    graded = _of_each([bool(q.modulus) for q in chosen], scene).astype(bool)
    scale = _of_each([q.scale(scene.surface) for q in chosen], scene)
    return Rows(
        h=h,
        low=h,
        high=np.full(len(h), np.inf),
        begins=np.ones(len(h), dtype=bool),
        rooted=exponent % 1 != 0,
        rough=np.zeros(len(h), dtype=bool),
        graded=graded,
        kind=np.repeat(np.arange(len(chosen)), len(scene.separations)),
        answer=np.arange(len(h)),
        total=np.zeros(len(h)) if lasting else _totals(scene, h, exponent, graded, scale),
        formulas=_Powers(exponent, scale, graded),
    )


def _of_each(values: list[float], scene: Scene) -> Array:
    return np.repeat(np.array(values, dtype=np.float64), len(scene.separations))


def _power(base: Array, exponent: Array) -> Array:
    """``base**exponent`` for whole and half-integer exponents, by products and roots."""
    power = np.where(exponent % 1 == 0, 1.0, np.sqrt(base))
    for whole in range(int(exponent.max(initial=0))):
        power = np.where(exponent >= whole + 1, power * base, power)
    return power


def _totals(scene: Scene, h: Array, exponent: Array, graded: NDArray[np.bool_], scale: Array) -> Array:
    """Mean sums from 16 quantiles: the order of magnitude is all it takes."""
    if not h.size:
        return np.empty(0)
    share = (np.arange(16) + 0.5) / 16
    once, row = np.unique(h, return_inverse=True)
    touching = scene.heights.above(once)
    rank = np.maximum(touching[:, None] * share, np.finfo(float).tiny)
    approach = np.maximum(scene.heights.from_above(rank, -np.inf) - once[:, None], 0.0)[row]
    modulus = np.where(graded[:, None], scene.modulus(approach + h[:, None]), 1.0)
    mean = np.mean(modulus * _power(approach, exponent[:, None]), axis=1)
    contacts = scene.n_asperities * touching[row]
    with np.errstate(over="ignore"):
        total = np.minimum(np.abs(scale * mean) * contacts, np.finfo(float).max)
    return np.asarray(np.where(contacts > SURE, total, 0.0))
