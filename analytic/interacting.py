"""The statistics of surfaces whose asperities press each other down: `analytic.Model` with an interaction.

At effective separations x everything but stiffness and conductance is that of independent asperities,
exactly. What each surface answers by itself is not a sum over asperities any more: stiffness and conductance
in series with the half-space, ``1/K = 1/K_asp + compliance`` and ``1/C = 1/C_spots + rho E_b compliance/2``,
and at nominal separations every quantity (`analytic.own_balance`). Means are then to second order in what
surfaces differ by, fluctuations to leading order.
"""

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.height_rule import Fluctuations, HeightRule
from analytic.interaction import Interaction, in_series
from analytic.model import Cumulants, Model
from analytic.own_balance import OwnBalance, derivative
from analytic.quantities import SEPARATIONS, quantity_of

if TYPE_CHECKING:
    from analytic.distribution import Law


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

    @cached_property
    def _own(self) -> OwnBalance:
        return OwnBalance(self.alone, self.compliance)

    @property
    def compliance(self) -> float:
        """Of the interaction, in units of sigma: d/sigma for each newton."""
        return self.interaction.compliance(self.surface, self.number) / self.surface.sigma

    def series(self, quantity: str) -> float:
        """What the half-space adds to the inverse of a sum: `analytic.Interaction.series`."""
        rho = 1.0 if self.film is None else self.film.rho
        return self.interaction.series(quantity, self.surface, self.number, rho)

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
        return self._own.separation(h)

    def mean(self, quantity: str, h: ArrayLike) -> Array:
        """Mean over surfaces, to second order where a surface answers by itself; as `Model.mean`."""
        h = np.asarray(h, dtype=np.float64)
        if quantity in SEPARATIONS:
            self._check_separation(quantity)
            way = SEPARATIONS[quantity].unloading and "_unloading"
            loads = self.mean(f"load{way}", h)
            return h + (self.compliance if self.interaction.nominal else -self.compliance) * loads
        self._asked(quantity, h)
        nominal = self.interaction.nominal
        mean = self._own.mean(quantity, h) if nominal else self.alone.mean(quantity, h)
        if not (c := self.series(quantity)):
            return mean
        exact = self._own.variance if nominal else lambda name, at: self.alone.cumulants(name, at).variance
        return np.asarray(in_series(mean, c)) - c * exact(quantity, h) / (1 + c * mean) ** 3

    def balanced(self, quantity: str, h: ArrayLike) -> Array:
        """The mean to first order: that of the mean surface at its own balance."""
        h = np.asarray(h, dtype=np.float64)
        mean = self.alone.mean(quantity, self.effective(h))
        return np.asarray(in_series(mean, self.series(quantity)))

    def cumulants(self, quantity: str, h: ArrayLike) -> Cumulants:
        """As `Model.cumulants`; skewness and kurtosis are those of the linear part."""
        self.mean(quantity, h)  # of all separations together, which is faster
        return super().cumulants(quantity, h)

    def slope(self, quantity: str, h: ArrayLike) -> Array:
        """How fast the mean falls with the separation, of the mean surface."""
        h = np.asarray(h, dtype=np.float64)
        if not (self.interaction.nominal or quantity in SEPARATIONS or self.series(quantity)):
            return self.alone.slope(quantity, h)
        return -derivative(lambda at: self.mean(quantity, at), h)

    def share(self, piece: int, h: ArrayLike) -> Array:
        """As `Model.share`, at what the asperities of the mean surface feel."""
        return self.alone.share(piece, self.effective(h))

    def prepare(self, separations: ArrayLike, quantities: Sequence[str]) -> None:
        """As `Model.prepare`, at what the asperities of the mean surface feel."""
        self.alone.prepare(self.effective(separations), [_load_of(name) for name in quantities])

    def rule(self, separations: ArrayLike, quantities: Sequence[str] = ("load",)) -> HeightRule:
        """As `Model.rule`, at what the asperities of the mean surface feel."""
        return self.alone.rule(self.effective(separations), quantities)

    def separation_at(self, quantity: str, value: ArrayLike) -> Array:
        """As `Model.separation_at`, of the mean surface: at a given load only the separation differs."""
        if quantity in SEPARATIONS or self.series(quantity):
            raise ValueError(
                f"quantity = {quantity!r}: give a load, an area, or another sum of the asperities"
            )
        x = self.alone.separation_at(quantity, value)
        if not self.interaction.nominal:
            return x
        return np.asarray(x - self.compliance * self.alone.mean("load", x))

    def distribution(self, quantity: str, h: float) -> "Law":
        """As `Model.distribution`, also of the other separation.

        At nominal separations from the body of the load, P(P <= p | h) = P(S(h + c p) <= p), and of what
        rises with it; what else a surface has there depends on two sums at once.
        """
        from analytic.distribution import interacting_distribution  # few ask

        if quantity in SEPARATIONS:
            self._check_separation(quantity)
        else:
            self._asked(quantity, h)
        return interacting_distribution(self, quantity, float(h))

    def separation_law(self, load: float, quantity: str = "load") -> "Law":
        """As `Model.separation_law`: at a given load only the separation differs, by the same on all."""
        felt = self.alone.separation_law(load, quantity)
        if not self.interaction.nominal:
            return felt
        if quantity != "load":
            raise ValueError(f"quantity = {quantity!r}: at nominal separations give a load")
        shift = self.compliance * load
        return felt.mapped(lambda x: x - shift)

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
        factor, press = (np.concatenate(part) for part in zip(*pressing, strict=True))
        return one.combined(
            np.concatenate(means), np.concatenate(own), factor, np.concatenate(loads_at), press
        )

    def _linear(self, quantity: str, x: Array) -> tuple[Array, Array]:
        """Deviation of a quantity on one surface by those of its own sum and of the load at x0, SI."""
        c, nominal = self.compliance, self.interaction.nominal
        if quantity in SEPARATIONS:
            return np.zeros_like(x), c / self._own.rate(x) if nominal else np.full_like(x, -c)
        factor, press = np.ones_like(x), self._own.press(quantity, x) if nominal else np.zeros_like(x)
        if other := self.series(quantity):
            series = (1 + other * self.alone.mean(quantity, x)) ** -2.0
            factor, press = factor * series, press * series
        return factor, press

    def _check_separation(self, name: str) -> None:
        if name.startswith("nominal") == self.interaction.nominal:
            raise KeyError(f"{name!r}: the model is given at these separations; it finds only the other ones")


def _values(model: Model) -> dict[str, Any]:
    return {each.name: getattr(model, each.name) for each in fields(Model)}


def _load_of(quantity: str) -> str:
    return "load_unloading" if quantity_of(quantity).unloading else "load"
