"""The statistics of surfaces whose asperities press each other down: `analytic.Model` with an interaction.

At effective separations x everything but the stiffness is that of independent asperities, exactly. What each
surface answers by itself is not a sum over asperities any more: the stiffness in series with the half-space,
``1/K = 1/K_asp + compliance``, and at nominal separations h every quantity, since the separation that its
asperities feel, ``x = h + compliance P``, has its own balance on each surface. These follow by expansion
about the balance of the mean surface, x0. Fluctuations are to leading order: with s and q the deviations of
load and quantity from their means at x0, ``k = -dP/dx`` and c the compliance, ::

    dP = s/(1 + c k),    dQ = q + (dQ/dx) c dP,    Var P = Var s/(1 + c k)^2

Means are to second order, so what is left out is of the order N^-2 of the mean::

    E P = P(x0) + b,  b (1 + c k) = P'' c^2 Var P/2 + c Cov(s', s)/(1 + c k)
    E Q = Q(x0) + Q' c b + Q'' c^2 Var P/2 + c Cov(q', s)/(1 + c k)

The mean of the balances is not the balance of the means: the load of a finite surface is smaller.
"""

from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic.height_rule import Fluctuations, HeightRule
from analytic.interaction import Interaction
from analytic.model import Cumulants, Model
from analytic.quantities import SEPARATIONS, quantity_of

__all__ = ["InteractingModel", "in_series"]

Array = NDArray[np.float64]

_STEP = 0.01  # of the differences that give derivatives by h, whose error is its fourth power
_WEIGHTS = np.array([[1, -8, 0, 8, -1], [-1, 16, -30, 16, -1]]) / 12.0
_SERIES = ("stiffness", "load_slope")
_MOST_STEPS = 200
_TOGETHER = 8  # separations that share a rule of heights
_CLOSE = 4e-15  # of a separation


def in_series(quantity: str) -> bool:
    """Whether a quantity is a stiffness, which the half-space is in series with."""
    q = quantity_of(quantity)
    return q.base in _SERIES


@dataclass(frozen=True)
class InteractingModel(Model):
    """A rough surface whose asperities press each other down; otherwise as `analytic.Model`.

    Besides the quantities of a `Model` it has the other separation, d/sigma: "nominal_separation" where its
    separations are effective ones, "effective_separation" where they are nominal.

    Parameters
    ----------
    interaction : Interaction
        Which; needed.

    Examples
    --------
    >>> import analytic
    >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
    >>> punch = analytic.Interaction("body", at="nominal")
    >>> model = analytic.InteractingModel(surface, interaction=punch)
    >>> float(model.mean("load", 1.0).round(4)), float(analytic.Model(surface).mean("load", 1.0).round(4))
    (0.2087, 0.319)
    """

    _: KW_ONLY
    interaction: Interaction

    @classmethod
    def of(cls, model: Model, interaction: Interaction) -> "InteractingModel":
        """The asperities of a model with an interaction."""
        return cls(**_values(model), interaction=interaction)

    @cached_property
    def alone(self) -> Model:
        """The same asperities without interaction."""
        return Model(**_values(self))

    @property
    def compliance(self) -> float:
        """Of the interaction, in units of sigma: d/sigma for each newton."""
        return self.interaction.compliance(self.surface, self.number) / self.surface.sigma

    def effective(self, h: ArrayLike) -> Array:
        """Separation that the asperities of the mean surface feel, at the separations of the model.

        Raises
        ------
        ValueError
            If there is none: where the mean deformed plane is the reference, loads from some separation on
            pull it down faster than the body follows.
        """
        h = np.asarray(h, dtype=np.float64)
        if not self.interaction.nominal:
            return h
        return self._once("separation", h, self._balance)

    def _balance(self, h: Array) -> Array:
        """By Newton from the side of no load, where the balance is monotone and convex or concave."""
        x, c = h.copy(), self.compliance
        for _ in range(_MOST_STEPS):
            rate = 1 + c * self.alone.slope("load", x)
            if np.any(rate <= 0):
                where = float(np.max(h[rate <= 0]))
                raise ValueError(
                    f"interaction: no balance at d/sigma = {where:g} from the mean plane: the plane sinks "
                    "faster than it is pressed; give higher separations"
                )
            step = (h - x + c * self.alone.mean("load", x)) / rate
            x = x + step
            if np.all(np.abs(step) <= _CLOSE * np.maximum(np.abs(x), 1.0)):
                break
        return x

    def mean(self, quantity: str, h: ArrayLike) -> Array:
        """Mean over surfaces, to second order where a surface answers by itself; as `Model.mean`."""
        h = np.asarray(h, dtype=np.float64)
        if quantity in SEPARATIONS:
            self._check_separation(quantity)
            way = SEPARATIONS[quantity].unloading and "_unloading"
            loads = self.mean(f"load{way}", h)
            return h + (self.compliance if self.interaction.nominal else -self.compliance) * loads
        self._asked(quantity, h)
        if self.interaction.nominal:
            return self._nominal_mean(quantity, h)
        mean = self.alone.mean(quantity, h)
        if not in_series(quantity):
            return mean
        c = self.compliance * self.surface.sigma
        variance = self.alone.cumulants(quantity, h).variance
        return mean / (1 + c * mean) - c * variance / (1 + c * mean) ** 3

    def balanced(self, quantity: str, h: ArrayLike) -> Array:
        """The mean to first order: that of the mean surface at its own balance."""
        h = np.asarray(h, dtype=np.float64)
        mean = self.alone.mean(quantity, self.effective(h))
        return mean / (1 + self.compliance * self.surface.sigma * mean) if in_series(quantity) else mean

    def cumulants(self, quantity: str, h: ArrayLike) -> Cumulants:
        """As `Model.cumulants`; skewness and kurtosis are those of the linear part."""
        self.mean(quantity, h)  # of all separations together, which is faster
        return super().cumulants(quantity, h)

    def slope(self, quantity: str, h: ArrayLike) -> Array:
        """How fast the mean falls with the separation, of the mean surface."""
        h = np.asarray(h, dtype=np.float64)
        if not self.interaction.nominal and not in_series(quantity) and quantity not in SEPARATIONS:
            return self.alone.slope(quantity, h)
        around = [self.mean(quantity, h + k * _STEP) for k in range(-2, 3)]
        return -np.tensordot(_WEIGHTS[0], around, 1) / _STEP

    def share(self, piece: int, h: ArrayLike) -> Array:
        """As `Model.share`, at what the asperities of the mean surface feel."""
        return self.alone.share(piece, self.effective(h))

    def rule(self, separations: ArrayLike, quantities: Sequence[str] = ("load",)) -> HeightRule:
        """As `Model.rule`, at what the asperities of the mean surface feel."""
        return self.alone.rule(self.effective(separations), quantities)

    def separation_at(self, quantity: str, value: ArrayLike) -> Array:
        """As `Model.separation_at`, of the mean surface: at a given load only the separation differs."""
        if quantity in SEPARATIONS or in_series(quantity):
            raise ValueError(
                f"quantity = {quantity!r}: give a load, an area, or another sum of the asperities"
            )
        x = self.alone.separation_at(quantity, value)
        if not self.interaction.nominal:
            return x
        return np.asarray(x - self.compliance * self.alone.mean("load", x))

    def fluctuations(self, quantities: Sequence[str], separations: ArrayLike) -> Fluctuations:
        """As `Model.fluctuations`, to leading order where a surface answers by itself."""
        h = np.asarray(separations, dtype=np.float64)
        sums = [name for name in quantities if name not in SEPARATIONS]
        loads = tuple(dict.fromkeys(_load_of(name) for name in quantities))
        x, columns = self.effective(h), [*sums, *(name for name in loads if name not in sums)]
        one = self.alone.fluctuations(columns, x)
        own, loads_at, pressing, means = [], [], [], []
        for name in quantities:
            q = quantity_of(name)
            load = columns.index(_load_of(name)) * h.size + np.arange(h.size)
            own.append(load if name in SEPARATIONS else columns.index(name) * h.size + np.arange(h.size))
            factor, press = self._linear(name, x)
            loads_at.append(load)
            scale = quantity_of(_load_of(name)).scale(self.surface) / q.scale(self.surface)
            pressing.append((factor, press * scale))
            means.append(self.mean(name, h) / self._unit(q))
        mine, with_load = np.concatenate(own), np.concatenate(loads_at)
        factor, press = (np.concatenate(part) for part in zip(*pressing, strict=True))
        radius = None
        if one.radius is not None:
            radius = np.where(
                press != 0, np.maximum(one.radius[mine], one.radius[with_load]), one.radius[mine]
            )
        return Fluctuations(
            one.rule,
            np.concatenate(means),
            one.at_heights[:, mine] * factor + one.at_heights[:, with_load] * press,
            one.below[mine] * factor + one.below[with_load] * press,
            radius,
        )

    def _linear(self, quantity: str, x: Array) -> tuple[Array, Array]:
        """Deviation of a quantity on one surface by those of its own sum and of the load at x0, SI."""
        c, sign = self.compliance, 1.0 if self.interaction.nominal else -1.0
        rate = 1 + c * self.alone.slope("load", x) if self.interaction.nominal else np.ones_like(x)
        if quantity in SEPARATIONS:
            return np.zeros_like(x), sign * c / rate
        if self.interaction.nominal:
            factor, press = np.ones_like(x), self._first(quantity, x) * c / rate
        else:
            factor, press = np.ones_like(x), np.zeros_like(x)
        if in_series(quantity):
            series = (1 + c * self.surface.sigma * self.alone.mean(quantity, x)) ** -2.0
            factor, press = factor * series, press * series
        return factor, press

    def _nominal_mean(self, quantity: str, h: Array) -> Array:
        """To second order in what surfaces differ by; each computed once, since a comparison asks again."""
        return self._once(quantity, h, lambda some: self._second_order(quantity, some))

    def _second_order(self, quantity: str, h: Array) -> Array:
        """The formulas of the module's text."""
        x, c = self.effective(h), self.compliance
        rate = 1 + c * self.alone.slope("load", x)
        variance = self._once("variance", h, lambda some: self._load_variance(some))
        bias = self._once("bias", h, lambda some: self._load_bias(some))
        value = self.alone.mean(quantity, x)
        if quantity == "load":
            return np.asarray(value + bias)
        first, second = self._first(quantity, x), self._second(quantity, x)
        mean = value + first * c * bias + second * (c**2 * variance / 2)
        mean = mean + c * self._changing(quantity, x) / rate
        if not in_series(quantity):
            return np.asarray(mean)
        stiff, press = c * self.surface.sigma, first * c / rate
        both, own = self._covariance(quantity, x), self.alone.cumulants(quantity, x).variance
        spread = own + 2 * press * both + (press * rate) ** 2 * variance
        return np.asarray(mean / (1 + stiff * mean) - stiff * spread / (1 + stiff * mean) ** 3)

    def _load_variance(self, h: Array) -> Array:
        x = self.effective(h)
        rate = 1 + self.compliance * self.alone.slope("load", x)
        return np.asarray(self.alone.cumulants("load", x).variance / rate**2)

    def _load_bias(self, h: Array) -> Array:
        """Of the load, by which the mean of the balances is not the balance of the means."""
        x, c = self.effective(h), self.compliance
        rate = 1 + c * self.alone.slope("load", x)
        variance = self._once("variance", h, lambda some: self._load_variance(some))
        bent = self._second("load", x) * c**2 * variance / 2
        return np.asarray((bent + c * self._changing("load", x) / rate) / rate)

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
        return np.asarray(np.tensordot(_WEIGHTS[0], self._around(quantity, x), 1) / _STEP)

    def _second(self, quantity: str, x: Array) -> Array:
        """Second derivative of the mean of a sum by the separation."""
        return np.asarray(np.tensordot(_WEIGHTS[1], self._around(quantity, x), 1) / _STEP**2)

    def _around(self, quantity: str, x: Array) -> Array:
        """Means of a sum at five separations about each."""
        return np.stack([self.alone.mean(quantity, x + k * _STEP) for k in range(-2, 3)])

    def _changing(self, quantity: str, x: Array) -> Array:
        """Covariance of the derivative of a sum by the separation with the load."""
        around = [self._covariance(quantity, x, k * _STEP) for k in (-2, -1, 1, 2)]
        return np.tensordot(_WEIGHTS[0][[0, 1, 3, 4]], around, 1) / _STEP

    def _covariance(self, quantity: str, x: Array, apart: float = 0.0) -> Array:
        """Covariance of a sum with the load at separations x, the sum's farther up by `apart`."""
        scale = quantity_of(quantity).scale(self.surface) * quantity_of("load").scale(self.surface)
        parts = np.array_split(x.ravel(), -(-x.size // _TOGETHER)) if x.size else []
        found = [self._product(quantity, part, apart) for part in parts]
        return self.number * scale * np.reshape(np.concatenate(found), x.shape)

    def _product(self, quantity: str, x: Array, apart: float) -> Array:
        """Mean product of what one asperity adds to a sum and to the load, over their scales."""
        one = self.alone.fluctuations([quantity, "load"], np.concatenate([x + apart, x]))
        a, b = slice(0, x.size), slice(3 * x.size, 4 * x.size)
        at_heights = one.rule.probabilities @ (one.at_heights[:, a] * one.at_heights[:, b])
        return np.asarray(at_heights + one.rule.below * one.below[a] * one.below[b])

    def _check_separation(self, name: str) -> None:
        if name.startswith("nominal") == self.interaction.nominal:
            raise KeyError(f"{name!r}: the separations of the model are those; it has the other ones")


def _values(model: Model) -> dict[str, Any]:
    return {each.name: getattr(model, each.name) for each in fields(Model)}


def _load_of(quantity: str) -> str:
    return "load_unloading" if quantity_of(quantity).unloading else "load"
