"""Surfaces that each find their own balance: sums of asperities that press each other down.

At a nominal separation h the asperities of a surface feel ``x = h + c P(x)``, c being the compliance and P
the load of this very surface. Statistics follow by expansion about the balance of the mean surface, x0.
Fluctuations are to leading order: with s and q the deviations of load and quantity from their means at x0 and
``k = -dP/dx``, ::

    dP = s/(1 + c k),    dQ = q + (dQ/dx) c dP,    Var P = Var s/(1 + c k)^2

Means are to second order, so what is left out is of the order N^-2 of the mean::

    E P = P(x0) + b,  b (1 + c k) = P'' c^2 Var P/2 + c Cov(s', s)/(1 + c k)
    E Q = Q(x0) + Q' c b + Q'' c^2 Var P/2 + c Cov(q', s)/(1 + c k)

The mean of the balances is not the balance of the means: the load of a finite surface is smaller.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.arrays import Array
from analytic.model import Model
from analytic.quantities import quantity_of

_STEP = 0.01  # of the differences that give derivatives by h, whose error is its fourth power
_WEIGHTS = np.array([[1, -8, 0, 8, -1], [-1, 16, -30, 16, -1]]) / 12.0  # first and second derivative
_MOST_STEPS = 200
_TOGETHER = 8  # separations that share a rule of heights
_CLOSE = 4e-15  # of a separation


def derivative(found: Callable[[Array], Array], x: Array, order: int = 1) -> Array:
    """First or second derivative of a function at x, by its values at five points about each."""
    around = np.stack([found(x + k * _STEP) for k in range(-2, 3)])
    return np.asarray(np.tensordot(_WEIGHTS[order - 1], around, 1) / _STEP**order)


@dataclass(frozen=True)
class OwnBalance:
    """Sums over the asperities of surfaces at nominal separations.

    Everything is computed once for each separation, since a comparison asks again.

    Parameters
    ----------
    alone : Model
        The asperities, without interaction.
    compliance : float
        How much farther down they feel the plane, d/sigma for each newton.
    """

    alone: Model
    compliance: float

    def separation(self, h: Array) -> Array:
        """Separation that the asperities of the mean surface feel.

        A ValueError if there is none: where loads pull the mean plane down faster than the body follows.
        """
        return self._once("separation", h, self._balance)

    def rate(self, x: Array) -> Array:
        """How fast the nominal separation changes with the effective one, of the mean surface."""
        return np.asarray(1 + self.compliance * self.alone.slope("load", x))

    def mean(self, quantity: str, h: Array) -> Array:
        """Of a sum, to second order."""
        return self._once(quantity, h, lambda some: self._mean(quantity, some))

    def press(self, quantity: str, x: Array) -> Array:
        """How much a sum deviates for each newton that the asperities at x0 carry more than the mean ones."""
        return self._first(quantity, x) * self.compliance / self.rate(x)

    def variance(self, quantity: str, h: Array) -> Array:
        """Of a sum, to leading order."""
        x = self.separation(h)
        press = self.press(quantity, x)
        of_load = self._load_variance(h) * self.rate(x) ** 2
        own = self.alone.cumulants(quantity, x).variance
        return np.asarray(own + 2 * press * self._covariance(quantity, x) + press**2 * of_load)

    def _mean(self, quantity: str, h: Array) -> Array:
        x, c = self.separation(h), self.compliance
        value, bias = self.alone.mean(quantity, x), self._once("bias", h, self._bias)
        moved = self._first(quantity, x) * c * bias + self._bent(quantity, h)
        return np.asarray(value + moved + c * self._changing(quantity, x) / self.rate(x))

    def _bias(self, h: Array) -> Array:
        """Of the load, by which the mean of the balances is not the balance of the means."""
        x, c = self.separation(h), self.compliance
        changing = c * self._changing("load", x) / self.rate(x)
        return np.asarray((self._bent("load", h) + changing) / self.rate(x))

    def _bent(self, quantity: str, h: Array) -> Array:
        """What the curvature of a mean makes of the scatter of separations."""
        spread = self.compliance**2 * self._load_variance(h)
        return np.asarray(self._second(quantity, self.separation(h)) * spread / 2)

    def _load_variance(self, h: Array) -> Array:
        def found(some: Array) -> Array:
            x = self.separation(some)
            return np.asarray(self.alone.cumulants("load", x).variance / self.rate(x) ** 2)

        return self._once("load variance", h, found)

    def _balance(self, h: Array) -> Array:
        """By Newton from the side of no load, where the balance is monotone and convex or concave."""
        x, c = h.copy(), self.compliance
        moving = np.arange(h.size)
        for _ in range(_MOST_STEPS):
            at = x[moving]
            rate = self.rate(at)
            if np.any(rate <= 0):
                where = float(np.max(h[moving][rate <= 0]))
                raise ValueError(
                    f"interaction: no equilibrium at d/sigma = {where:g} from the mean plane, because the "
                    "plane sinks faster than it is pressed; give larger separations"
                )
            step = (h[moving] - at + c * self.alone.mean("load", at)) / rate
            x[moving] = at + step
            moving = moving[np.abs(step) > _CLOSE * np.maximum(np.abs(at), 1.0)]
            if not moving.size:
                break
        return x

    @cached_property
    def _known(self) -> dict[tuple[str, float], float]:
        return {}

    def _once(self, what: str, h: Array, found: Callable[[Array], Array]) -> Array:
        """Something at separations, of which only those are computed that are not known yet."""
        new = np.array([x for x in np.unique(h).tolist() if (what, x) not in self._known])
        if new.size:
            keys = [(what, x) for x in new.tolist()]
            self._known.update(zip(keys, found(new).tolist(), strict=True))
        return np.array([self._known[what, x] for x in h.ravel().tolist()]).reshape(h.shape)

    def _first(self, quantity: str, x: Array) -> Array:
        """Derivative of the mean of a sum by the separation: its slope, where that is known."""
        if quantity_of(quantity).base != "load_slope":
            return -self.alone.slope(quantity, x)
        return derivative(lambda at: self.alone.mean(quantity, at), x)

    def _second(self, quantity: str, x: Array) -> Array:
        """Second derivative of the mean of a sum by the separation."""
        return derivative(lambda at: self.alone.mean(quantity, at), x, order=2)

    def _changing(self, quantity: str, x: Array) -> Array:
        """Covariance of the derivative of a sum by the separation with the load."""
        around = [self._covariance(quantity, x, k * _STEP) for k in (-2, -1, 1, 2)]
        return np.tensordot(_WEIGHTS[0][[0, 1, 3, 4]], around, 1) / _STEP

    def _covariance(self, quantity: str, x: Array, apart: float = 0.0) -> Array:
        """Covariance of a sum with the load at separations x, the sum's farther up by `apart`."""
        of_sum, of_load = (quantity_of(name).scale(self.alone.surface) for name in (quantity, "load"))
        parts = np.array_split(x.ravel(), -(-x.size // _TOGETHER)) if x.size else []
        found = [np.empty(0)]  # mean products of what one asperity adds to both, over their scales
        for part in parts:
            one = self.alone.fluctuations([quantity, "load"], np.concatenate([part + apart, part]))
            a, b = slice(0, part.size), slice(3 * part.size, 4 * part.size)
            at_heights = one.rule.probabilities @ (one.at_heights[:, a] * one.at_heights[:, b])
            found.append(at_heights + one.rule.below * one.below[a] * one.below[b])
        return self.alone.number * of_sum * of_load * np.reshape(np.concatenate(found), x.shape)
