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
from functools import cached_property, wraps
from typing import Any

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


def _once(found: Callable[..., Array]) -> Callable[..., Array]:
    """Compute only at those separations, the last argument, that have not been asked for before."""

    @wraps(found)
    def known_or_found(self: "OwnBalance", *asked: Any) -> Array:
        *what, h = asked
        known = self._known.setdefault((found, *what), {})
        new = np.array([x for x in np.unique(h).tolist() if x not in known])
        if new.size:
            known.update(zip(new.tolist(), found(self, *what, new).tolist(), strict=True))
        return np.array([known[x] for x in h.ravel().tolist()]).reshape(h.shape)

    return known_or_found


@dataclass(frozen=True)
class OwnBalance:
    """Sums over the asperities of surfaces at nominal separations.

    Everything dear is computed once for each separation, since a comparison asks again, and one statistic
    what others have asked.

    Parameters
    ----------
    alone : Model
        The asperities, without interaction.
    compliance : float
        How much farther down they feel the plane, d/sigma for each newton.
    """

    alone: Model
    compliance: float

    def rate(self, x: Array) -> Array:
        """How fast the nominal separation changes with the effective one, of the mean surface."""
        return np.asarray(1 - self.compliance * self._first("load", x))

    def mean(self, quantity: str, h: Array) -> Array:
        """Of a sum, to second order."""
        x, c = self.separation(h), self.compliance
        value, bias = self._alone(quantity, x), self._bias(h)
        moved = self._first(quantity, x) * c * bias + self._bent(quantity, h)
        return np.asarray(value + moved + c * self._changing(quantity, x) / self.rate(x))

    def press(self, quantity: str, x: Array) -> Array:
        """How much a sum deviates for each newton that the asperities at x0 carry more than the mean ones."""
        return self._first(quantity, x) * self.compliance / self.rate(x)

    def variance(self, quantity: str, h: Array) -> Array:
        """Of a sum, to leading order."""
        x = self.separation(h)
        press = self.press(quantity, x)
        of_load = self._load_variance(h) * self.rate(x) ** 2
        own = self._variance(quantity, x)
        return np.asarray(own + 2 * press * self._covariance(quantity, 0.0, x) + press**2 * of_load)

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
        x = self.separation(h)
        return np.asarray(self._variance("load", x) / self.rate(x) ** 2)

    @_once
    def separation(self, h: Array) -> Array:
        """Separation that the asperities of the mean surface feel.

        By Newton from the side of no load, where the balance is monotone and convex or concave. A ValueError
        if there is none: where loads pull the mean plane down faster than the body follows.
        """
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
            step = (h[moving] - at + c * self._alone("load", at)) / rate
            x[moving] = at + step
            moving = moving[np.abs(step) > _CLOSE * np.maximum(np.abs(at), 1.0)]
            if not moving.size:
                break
        return x

    @cached_property
    def _known(self) -> dict[tuple[Any, ...], dict[float, float]]:
        return {}

    @_once
    def _alone(self, quantity: str, x: Array) -> Array:
        """Mean of a sum over the asperities at what they feel."""
        return self.alone.mean(quantity, x)

    @_once
    def _variance(self, quantity: str, x: Array) -> Array:
        """Variance of the same."""
        return np.asarray(self.alone.cumulants(quantity, x).variance)

    @_once
    def _first(self, quantity: str, x: Array) -> Array:
        """Derivative of the mean of a sum by the separation: its slope, where that is known."""
        if quantity_of(quantity).base != "load_slope":
            return -self.alone.slope(quantity, x)
        return derivative(lambda at: self._alone(quantity, at), x)

    def _second(self, quantity: str, x: Array) -> Array:
        """Second derivative of the mean of a sum by the separation."""
        return derivative(lambda at: self._alone(quantity, at), x, order=2)

    def _changing(self, quantity: str, x: Array) -> Array:
        """Covariance of the derivative of a sum by the separation with the load."""
        around = [self._covariance(quantity, k * _STEP, x) for k in (-2, -1, 1, 2)]
        return np.tensordot(_WEIGHTS[0][[0, 1, 3, 4]], around, 1) / _STEP

    @_once
    def _covariance(self, quantity: str, apart: float, x: Array) -> Array:
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
