"""The laws of contact on a cell or a node, as Chebyshev series in its variable."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from analytic import QUANTITIES, Grading, resolved_breaks
from mcgw.sampling.cells import NODES, TO_COEFFICIENTS, evenness, height_noise
from mcgw.sampling.rules import product
from mcgw.sampling.spacing import SURE
from mcgw.scene.scene import Scene

__all__ = ["ACCURACY", "ContactLaws"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

ACCURACY = 1e-13  # relative to the largest value of a law on the cell
_SCATTER = 8  # asperities more than expected
_NODES = 32  # that add to one sum, with errors of their own
_U = (1 + NODES) / 2


def _times_u(order: int) -> Array:
    """Matrix that multiplies a Chebyshev series by u = (1 + x)/2, leaving zeros where they are."""
    matrix = np.eye(order) / 2 + np.eye(order, k=1) / 4 + np.eye(order, k=-1) / 4
    matrix[1, 0] = 0.5
    return matrix


def _power(base: Array, exponent: Array) -> Array:
    """``base**exponent`` for whole and half-integer exponents, by products and roots."""
    power = np.where(exponent % 1 == 0, 1.0, np.sqrt(base))
    for whole in range(int(exponent.max(initial=0))):
        power = np.where(exponent >= whole + 1, power * base, power)
    return power


class _Needed(NamedTuple):
    """How many coefficients of a series count.

    Attributes
    ----------
    alone : ndarray of int
        For this node: so many moments it must have.
    of_many : ndarray of int
        In a sum over many nodes, whose errors add up: what lies beyond is zero. The moments in between are
        used if others need them.
    """

    alone: Ints
    of_many: Ints


@dataclass(frozen=True)
class ContactLaws:
    """All laws that are asked for, one an array element: ``scale (s - h)^exponent e(s)^modulus``.

    Quantity by quantity, at increasing separations.

    Parameters
    ----------
    h, exponent, modulus, scale : ndarray
        Of each law.
    total : ndarray
        Mean sum over a surface, where so many touch that it is sure to be of that size; else 0.
    separations : int
        ContactLaws of each quantity.
    n_asperities : int
        Of a surface.
    grading : Grading
        The e(s) of all.
    breaks : ndarray
        Where its pieces meet, each of which is known to be a smooth curve.
    accuracy : float, optional
        Relative to the largest value of a law on a cell, or to the sum of a surface.
    """

    h: Array
    exponent: Array
    modulus: NDArray[np.bool_]
    scale: Array
    total: Array
    separations: int
    n_asperities: int
    grading: Grading
    breaks: Array
    accuracy: float = ACCURACY

    @classmethod
    def of(
        cls,
        scene: Scene,
        quantities: tuple[str, ...],
        between: tuple[float, float],
        *,
        lasting: bool,
        accuracy: float = ACCURACY,
    ) -> "ContactLaws":
        """The laws of some quantities at all separations, which increase, for heights in between.

        If they are to be lasting, they are resolved as if every surface could have a single contact.
        """
        chosen = [QUANTITIES[name] for name in quantities]
        repeat = len(scene.separations)
        laws = cls(
            h=np.tile(scene.separations, len(chosen)),
            exponent=np.repeat([q.exponent for q in chosen], repeat),
            modulus=np.repeat(np.array([q.modulus for q in chosen], dtype=bool), repeat),
            scale=np.repeat([q.scale(scene.surface) for q in chosen], repeat),
            total=np.zeros(len(chosen) * repeat),
            separations=repeat,
            n_asperities=scene.n_asperities,
            grading=scene.modulus,
            breaks=np.array(resolved_breaks(scene.modulus, *between)),
            accuracy=accuracy,
        )
        return laws if lasting else replace(laws, total=laws._totals(scene))

    def _totals(self, scene: Scene) -> Array:
        """Mean sums from 16 quantiles: the order of magnitude is all it takes."""
        if not self.h.size:
            return np.empty(0)
        share = (np.arange(16) + 0.5) / 16
        h, law = np.unique(self.h, return_inverse=True)
        touching = scene.heights.above(h)
        rank = np.maximum(touching[:, None] * share, np.finfo(float).tiny)
        approach = np.maximum(scene.heights.from_above(rank, -np.inf) - h[:, None], 0.0)[law]
        graded = np.where(self.modulus[:, None], self.grading(approach + self.h[:, None]), 1.0)
        mean = np.mean(graded * _power(approach, self.exponent[:, None]), axis=1)
        contacts = scene.n_asperities * touching[law]
        with np.errstate(over="ignore"):
            total = np.minimum(np.abs(self.scale * mean) * contacts, np.finfo(float).max)
        return np.asarray(np.where(contacts > SURE, total, 0.0))

    def smooth_from(self, which: Ints, a: float) -> NDArray[np.bool_]:
        """Which laws are smooth on a cell or a node that starts at `a`."""
        h = self.h[which]
        return np.asarray((h < a) | ((h == a) & (self.exponent[which] % 1 == 0)))

    def broken_between(self, which: Ints, a: float, b: float) -> NDArray[np.bool_]:
        """Which laws may have a feature between `a` and `b` that 20 heights do not show."""
        return self.modulus[which] & np.any((a < self.breaks) & (self.breaks < b))

    def nearest(self, a: float) -> Ints:
        """Of each quantity the smooth law with the highest separation: the hardest to resolve."""
        first = np.arange(0, len(self.h), self.separations)
        below = np.searchsorted(self.h[: self.separations], a)
        upto = np.searchsorted(self.h[: self.separations], a, side="right")
        smooth = np.where(self.exponent[first] % 1 == 0, upto, below)
        return np.asarray((first + smooth - 1)[smooth > 0])

    def plain(self, which: Ints, a: float, t: Array, e: Array, probability: float) -> tuple[Array, Ints]:
        """Coefficients of laws that are smooth at the heights ``a + t``, of modulus `e`, and how many count.

        Shape (order, laws) and (laws,). What no sum over many nodes can show is zero.
        """
        c = self._coefficients(which, e, (a - self.h[which]) + t[:, None])
        needed, of_many = self._needed(c, which, a, t, e, probability)
        c[np.arange(len(c))[:, None] >= of_many] = 0.0
        edge = self.h[which] == a
        if edge.any():
            c[:, edge], needed[edge] = self.from_edge(which[edge], a, t, e, probability)
        return c, needed

    def from_edge(self, which: Ints, a: float, t: Array, e: Array, probability: float) -> tuple[Array, Ints]:
        """Coefficients of laws whose separation is `a` itself, divided by sqrt(u) if half-integer.

        With t = u q(u) such a law is ``u^n q^n e``. The series is cut before the whole power of u is
        put in, so that the law stays relatively accurate down to u = 0.
        """
        c = self._coefficients(which, e, (t / _U)[:, None])
        needed = self._needed(c, which, a, t, e, probability).alone
        c[np.arange(len(c))[:, None] >= needed] = 0.0
        for power in range(int(self.exponent[which].max(initial=0))):
            more = self.exponent[which] >= power + 1
            c[:, more] = product(_times_u(len(c)), c[:, more])
            needed = needed + more
        return c, needed

    def _needed(self, c: Array, which: Ints, a: float, t: Array, e: Array, probability: float) -> "_Needed":
        """Number of leading coefficients that describe each law (a column) accurately.

        Relative to the largest value on the cell; or, where it is sure, to the whole sum of a surface.
        """
        tail = np.cumsum(np.abs(c)[::-1], axis=0)[::-1]
        crowd = self.n_asperities * probability + _SCATTER
        least = np.where(self.modulus[which], evenness(self.grading, e), 1.0) * tail[0]
        enough = np.maximum(least, self.total[which] / crowd)
        relative = height_noise(a, t, e) / max(np.abs(e).max(), np.finfo(float).tiny)
        noise = np.where(self.modulus[which], relative, 0.0) * tail[0]
        limits = (
            np.maximum(accuracy * enough, noise) for accuracy in (self.accuracy, self.accuracy / _NODES)
        )
        return _Needed(*(np.asarray((tail > limit).sum(axis=0), dtype=np.int64) for limit in limits))

    def _coefficients(self, which: Ints, e: Array, base: Array) -> Array:
        graded = np.where(self.modulus[which], e[:, None], 1.0)
        return product(TO_COEFFICIENTS, self.scale[which] * graded * _power(base, self.exponent[which]))
