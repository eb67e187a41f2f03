"""The laws of contact on a cell, as Chebyshev series in the cell's uniform."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic import QUANTITIES, Grading, Surface
from mcgw.cells import NODES, TO_COEFFICIENTS

__all__ = ["Laws", "orders"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_ACCURACY = 1e-13  # relative to the largest value of a law on the cell
_U = (1 + NODES) / 2


def _times_u(order: int) -> Array:
    """Matrix that multiplies a Chebyshev series by u = (1 + x)/2, leaving zeros where they are."""
    matrix = np.eye(order) / 2 + np.eye(order, k=1) / 4 + np.eye(order, k=-1) / 4
    matrix[1, 0] = 0.5
    return matrix


def orders(coefficients: Array, accuracy: float) -> Ints:
    """Number of leading coefficients that describe each law (a column) to a relative accuracy."""
    tail = np.cumsum(np.abs(coefficients)[::-1], axis=0)[::-1]
    return np.asarray((tail > accuracy * tail[0]).sum(axis=0), dtype=np.int64)


@dataclass(frozen=True)
class Laws:
    """All laws that are asked for, one an array element: ``scale (s - h)^exponent e(s)^modulus``.

    Parameters
    ----------
    h, exponent, modulus, scale : ndarray
        Of each law.
    grading : Grading
        The e(s) of all.
    """

    h: Array
    exponent: Array
    modulus: NDArray[np.bool_]
    scale: Array
    grading: Grading

    @classmethod
    def of(
        cls, surface: Surface, grading: Grading, quantities: tuple[str, ...], separations: tuple[float, ...]
    ) -> "Laws":
        """The laws of all quantities at all separations, quantity by quantity."""
        chosen = [QUANTITIES[name] for name in quantities]
        repeat = len(separations)
        return cls(
            h=np.tile(separations, len(chosen)),
            exponent=np.repeat([q.exponent for q in chosen], repeat),
            modulus=np.repeat([bool(q.modulus) for q in chosen], repeat),
            scale=np.repeat([q.scale(surface) for q in chosen], repeat),
            grading=grading,
        )

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

    def plain(self, which: Ints, a: float, t: Array) -> tuple[Array, Ints]:
        """Coefficients of laws that are smooth at the heights ``a + t``, and how many count.

        Shape (order, laws) and (laws,).
        """
        c = self._coefficients(which, a, t, (a - self.h[which]) + t[:, None])
        needed = orders(c, self.accuracy(a, t))
        edge = self.h[which] == a
        if edge.any():
            c[:, edge], needed[edge] = self.from_edge(which[edge], a, t)
        return c, needed

    def from_edge(self, which: Ints, a: float, t: Array) -> tuple[Array, Ints]:
        """Coefficients of laws whose separation is `a` itself, divided by sqrt(u) if half-integer.

        With t = u q(u) such a law is ``u^n q^n e``. The series is cut before the whole power of u is
        put in, so that the law stays relatively accurate down to u = 0.
        """
        c = self._coefficients(which, a, t, (t / _U)[:, None])
        needed = orders(c, self.accuracy(a, t))
        c[np.arange(len(c))[:, None] >= needed] = 0.0
        for power in range(int(self.exponent[which].max(initial=0))):
            more = self.exponent[which] >= power + 1
            c[:, more] = _times_u(len(c)) @ c[:, more]
            needed = needed + more
        return c, needed

    def accuracy(self, a: float, t: Array) -> float:
        """What can be had: a height is known to its last digit, and a steep grading turns that into noise."""
        if not self.modulus.any():
            return _ACCURACY
        e = self.grading(a + t)
        slope = np.ptp(e) / (t.max() * max(np.abs(e).max(), np.finfo(float).tiny))
        return max(_ACCURACY, 64 * float(np.spacing(abs(a) + t.max())) * float(slope))

    def _coefficients(self, which: Ints, a: float, t: Array, base: Array) -> Array:
        graded = np.where(self.modulus[which], self.grading(a + t)[:, None], 1.0)
        return np.asarray(TO_COEFFICIENTS @ (self.scale[which] * graded * base ** self.exponent[which]))
