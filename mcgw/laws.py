"""The laws of contact on a cell, as Chebyshev series in the cell's uniform."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analytic import QUANTITIES, Grading
from mcgw.cells import NODES, TO_COEFFICIENTS
from mcgw.scene import Scene

__all__ = ["ACCURACY", "Laws"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

ACCURACY = 1e-13  # relative to the largest value of a law on the cell
_SURE = 400  # so many expected contacts are never fewer than half
_U = (1 + NODES) / 2


def _times_u(order: int) -> Array:
    """Matrix that multiplies a Chebyshev series by u = (1 + x)/2, leaving zeros where they are."""
    matrix = np.eye(order) / 2 + np.eye(order, k=1) / 4 + np.eye(order, k=-1) / 4
    matrix[1, 0] = 0.5
    return matrix


@dataclass(frozen=True)
class Laws:
    """All laws that are asked for, one an array element: ``scale (s - h)^exponent e(s)^modulus``.

    Parameters
    ----------
    h, exponent, modulus, scale : ndarray
        Of each law.
    total : ndarray
        What an asperity contributes in the mean, where so many touch that the sum of a surface is sure
        to be of the size of its mean; else 0.
    grading : Grading
        The e(s) of all.
    accuracy : float, optional
        Relative to the largest value of a law on a cell, or to the sum of a surface.
    """

    h: Array
    exponent: Array
    modulus: NDArray[np.bool_]
    scale: Array
    total: Array
    grading: Grading
    accuracy: float = ACCURACY

    @classmethod
    def of(
        cls, scene: Scene, quantities: tuple[str, ...], *, lasting: bool, accuracy: float = ACCURACY
    ) -> "Laws":
        """The laws of some quantities at all separations, quantity by quantity.

        If they are to be lasting, they are resolved as if every surface could have a single contact.
        """
        chosen = [QUANTITIES[name] for name in quantities]
        repeat = len(scene.separations)
        laws = cls(
            h=np.tile(scene.separations, len(chosen)),
            exponent=np.repeat([q.exponent for q in chosen], repeat),
            modulus=np.repeat([bool(q.modulus) for q in chosen], repeat),
            scale=np.repeat([q.scale(scene.surface) for q in chosen], repeat),
            total=np.zeros(len(chosen) * repeat),
            grading=scene.modulus,
            accuracy=accuracy,
        )
        return laws if lasting else replace(laws, total=laws._totals(scene))

    def _totals(self, scene: Scene) -> Array:
        """Mean contribution of an asperity from 16 quantiles: the order of magnitude is all it takes."""
        if not self.h.size:
            return np.empty(0)
        share = (np.arange(16) + 0.5) / 16
        h, law = np.unique(self.h, return_inverse=True)
        touching = scene.heights.above(h)
        approach = np.array([scene.heights.from_above(share, x) - x for x in h])[law]
        graded = np.where(self.modulus[:, None], self.grading(approach + self.h[:, None]), 1.0)
        mean = np.mean(graded * approach ** self.exponent[:, None], axis=1)
        sure = scene.n_asperities * touching[law] > _SURE
        return np.asarray(np.where(sure, np.abs(self.scale * mean) * touching[law], 0.0))

    def smooth_from(self, which: Ints, a: float) -> NDArray[np.bool_]:
        """Which laws are smooth functions of the uniform on a cell that starts at `a`."""
        h = self.h[which]
        return np.asarray((h < a) | ((h == a) & (self.exponent[which] % 1 == 0)))

    def nearest(self, a: float) -> Ints:
        """For each exponent the smooth law with the highest separation: the hardest to resolve."""
        smooth = np.flatnonzero(self.smooth_from(np.arange(len(self.h)), a))
        order = smooth[np.lexsort((self.h[smooth], self.exponent[smooth]))]
        last = np.diff(self.exponent[order], append=np.nan) != 0
        return np.asarray(order[last])

    def plain(self, which: Ints, a: float, t: Array, probability: float) -> tuple[Array, Ints]:
        """Coefficients of laws that are smooth at the heights ``a + t``, and how many count.

        Shape (order, laws) and (laws,).
        """
        c = self._coefficients(which, a, t, (a - self.h[which]) + t[:, None])
        needed = self._needed(c, which, a, t, probability)
        edge = self.h[which] == a
        if edge.any():
            c[:, edge], needed[edge] = self.from_edge(which[edge], a, t, probability)
        return c, needed

    def from_edge(self, which: Ints, a: float, t: Array, probability: float) -> tuple[Array, Ints]:
        """Coefficients of laws whose separation is `a` itself, divided by sqrt(u) if half-integer.

        With t = u q(u) such a law is ``u^n q^n e``. The series is cut before the whole power of u is
        put in, so that the law stays relatively accurate down to u = 0.
        """
        c = self._coefficients(which, a, t, (t / _U)[:, None])
        needed = self._needed(c, which, a, t, probability)
        c[np.arange(len(c))[:, None] >= needed] = 0.0
        for power in range(int(self.exponent[which].max(initial=0))):
            more = self.exponent[which] >= power + 1
            c[:, more] = _times_u(len(c)) @ c[:, more]
            needed = needed + more
        return c, needed

    def _needed(self, c: Array, which: Ints, a: float, t: Array, probability: float) -> Ints:
        """Number of leading coefficients that describe each law (a column) accurately.

        Relative to the largest value on the cell; or, where it is sure, to the whole sum of a surface.
        """
        tail = np.cumsum(np.abs(c)[::-1], axis=0)[::-1]
        with np.errstate(over="ignore"):  # infinite: such a cell adds nothing that could be seen
            enough = np.maximum(tail[0], self.total[which] / max(probability, np.finfo(float).tiny))
        return np.asarray((tail > self._accuracy(a, t) * enough).sum(axis=0), dtype=np.int64)

    def _accuracy(self, a: float, t: Array) -> float:
        """What can be had: a height is known to its last digit, and a steep grading turns that into noise."""
        if not self.modulus.any():
            return self.accuracy
        e = self.grading(a + t)
        slope = np.ptp(e) / (t.max() * max(np.abs(e).max(), np.finfo(float).tiny))
        return max(self.accuracy, 64 * float(np.spacing(abs(a) + t.max())) * float(slope))

    def _coefficients(self, which: Ints, a: float, t: Array, base: Array) -> Array:
        graded = np.where(self.modulus[which], self.grading(a + t)[:, None], 1.0)
        return np.asarray(TO_COEFFICIENTS @ (self.scale[which] * graded * base ** self.exponent[which]))
