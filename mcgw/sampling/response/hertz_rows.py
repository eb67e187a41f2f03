"""Rows of Hertz's law: ``scale (s - h)^exponent e(s)^modulus``, one for each quantity and separation."""

from typing import Any

import numpy as np

from analytic import HeightLaw, Quantity, quantity_of
from analytic.arrays import Array
from mcgw.machine.compiling import njit
from mcgw.machine.memory import kept
from mcgw.sampling.response.rows import Powers, Rows
from mcgw.sampling.spacing import SURE
from mcgw.scene.scene import Scene


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
        lost=np.zeros(len(h), dtype=bool),
        graded=graded,
        kind=np.repeat(np.arange(len(chosen)), len(once)),
        answer=np.arange(len(h)),
        total=np.zeros(len(h)) if lasting else _totals(scene, chosen, once),
        formulas=Powers(exponent, scale),
    )


def _of_each(values: list[float], separations: Array) -> Array:
    return np.repeat(np.array(values, dtype=np.float64), len(separations))


@njit(nogil=True, cache=True)
def raise_to(exponent: Any, x: Any, result: Any) -> None:
    """Write ``x^exponent`` for a whole or half-integer exponent, by products and roots."""
    half = exponent % 1 != 0
    for i in range(x.size):
        result[i] = np.sqrt(x[i]) if half else 1.0
    for _ in range(int(exponent)):
        for i in range(x.size):
            result[i] *= x[i]


@kept(8)
def _quantiles(law: HeightLaw, separations: bytes) -> tuple[Array, Array]:
    """Share of heights above each separation, and 16 equally likely distances of those from it."""
    h, share = np.frombuffer(separations), (np.arange(16) + 0.5) / 16
    touching = law.sf(h)
    rank = np.maximum(touching[:, None] * share, np.finfo(float).tiny)
    return touching, np.maximum(law.isf(rank) - h[:, None], 0.0)


def _totals(scene: Scene, chosen: list[Quantity], h: Array) -> Array:
    """Mean sums from 16 quantiles, quantity by quantity: the order of magnitude is all it takes."""
    touching, approach = _quantiles(scene.heights, h.tobytes())
    modulus, contacts = scene.modulus(approach + h[:, None]), scene.n_asperities * touching
    totals = [np.empty(0)]
    for q in chosen:
        terms = np.empty(approach.shape)
        raise_to(float(q.exponent), approach.ravel(), terms.reshape(-1))
        if q.modulus:
            terms *= modulus
        with np.errstate(over="ignore"):
            total = np.minimum(
                np.abs(q.scale(scene.surface) * terms.mean(axis=1)) * contacts, np.finfo(float).max
            )
        totals.append(np.where(contacts > SURE, total, 0.0))
    return np.concatenate(totals)
