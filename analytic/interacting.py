"""The statistics of surfaces whose asperities press each other down: `analytic.Model` with an interaction.

At effective separations x everything but stiffness and conductance is that of independent asperities,
exactly. What each surface answers by itself is not a sum over asperities any more: stiffness and conductance
in series with the half-space, ``1/K = 1/K_asp + compliance`` and ``1/C = 1/C_spots + rho E_b compliance/2``.
Means are then to second order in what surfaces differ by, fluctuations to leading order.
"""

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, fields
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.height_rule import Fluctuations
from analytic.interaction import Interaction, in_series
from analytic.mean_contact import fall_of
from analytic.model import Model
from analytic.quantities import SEPARATIONS, quantity_of

if TYPE_CHECKING:
    from analytic.distribution import Law


@dataclass(frozen=True)
class InteractingModel(Model):
    """A rough surface whose asperities press each other down; otherwise as `analytic.Model`.

    Its separations are those that the asperities feel. Besides the quantities of a `Model` it has
    "nominal_separation", d/sigma, the separation of the bodies.

    Parameters
    ----------
    interaction : Interaction
        Which; needed.

    Examples
    --------
    >>> import analytic
    >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
    >>> model = analytic.InteractingModel(surface, interaction=analytic.Interaction("body"))
    >>> float(model.mean("load", 1.0).round(4)), float(model.mean("nominal_separation", 1.0).round(4))
    (0.319, 0.6981)
    """

    _: KW_ONLY
    interaction: Interaction

    @classmethod
    def of(cls, model: Model, interaction: Interaction) -> "InteractingModel":
        """Return the asperities of a model with an interaction."""
        return cls(**_values(model), interaction=interaction)

    @cached_property
    def alone(self) -> Model:
        """The same asperities without interaction."""
        return Model(**_values(self))

    @property
    def compliance(self) -> float:
        """Of the interaction, in units of sigma: d/sigma for each newton."""
        return self.interaction.compliance(self.surface, self.number) / self.surface.sigma

    def series(self, quantity: str) -> float:
        """Return what the half-space adds to the inverse of a sum: `analytic.Interaction.series`."""
        rho = 1.0 if self.film is None else self.film.rho
        return self.interaction.series(quantity, self.surface, self.number, rho)

    def mean(self, quantity: str, h: ArrayLike) -> Array:
        """Return `Model.mean`, to second order where a surface answers by itself."""
        h = np.asarray(h, dtype=np.float64)
        if quantity in SEPARATIONS:
            return h - self.compliance * self.mean(_load_of(quantity), h)
        self._asked(quantity, h)
        mean = self.alone.mean(quantity, h)
        if not (c := self.series(quantity)):
            return mean
        variance = self.alone.cumulants(quantity, h).variance
        return np.asarray(in_series(mean, c)) - c * variance / (1 + c * mean) ** 3

    def slope(self, quantity: str, h: ArrayLike) -> Array:
        """Return how fast the mean falls with the separation, of the mean surface."""
        h = np.asarray(h, dtype=np.float64)
        if not (quantity in SEPARATIONS or self.series(quantity)):
            return self.alone.slope(quantity, h)
        return fall_of(partial(self.mean, quantity), h)

    def separation_at(self, quantity: str, value: ArrayLike) -> Array:
        """Return the separation of the mean surface, as `Model.separation_at`."""
        if quantity in SEPARATIONS or self.series(quantity):
            raise ValueError(
                f"quantity = {quantity!r}: give a load, an area, or another sum of the asperities"
            )
        return self.alone.separation_at(quantity, value)

    def distribution(self, quantity: str, h: float) -> "Law":
        """Return the same as `Model.distribution`, also of the nominal separation."""
        from analytic.distribution import interacting_distribution  # few ask

        if quantity not in SEPARATIONS:
            self._asked(quantity, h)
        return interacting_distribution(self, quantity, float(h))

    def separation_law(self, load: float, quantity: str = "load") -> "Law":
        """Return the same as `Model.separation_law`, of the separation that the asperities feel."""
        return self.alone.separation_law(load, quantity)

    def fluctuations(self, quantities: Sequence[str], separations: ArrayLike) -> Fluctuations:
        """Return the same as `Model.fluctuations`, to leading order where a surface answers by itself."""
        h = np.asarray(separations, dtype=np.float64)
        sums = [name for name in quantities if name not in SEPARATIONS]
        loads = tuple(dict.fromkeys(_load_of(name) for name in quantities))
        columns = [*sums, *(name for name in loads if name not in sums)]
        one = self.alone.fluctuations(columns, h)
        own, loads_at, pressing, means = [], [], [], []
        for name in quantities:
            q = quantity_of(name)
            load = columns.index(_load_of(name)) * h.size + np.arange(h.size)
            own.append(load if name in SEPARATIONS else columns.index(name) * h.size + np.arange(h.size))
            factor, press = self._linear(name, h)
            loads_at.append(load)
            scale = quantity_of(_load_of(name)).scale(self.surface) / q.scale(self.surface)
            pressing.append((factor, press * scale))
            means.append(self.mean(name, h) / self._unit(q))
        factor, press = (np.concatenate(part) for part in zip(*pressing, strict=True))
        return one.combined(
            np.concatenate(means), np.concatenate(own), factor, np.concatenate(loads_at), press
        )

    def _linear(self, quantity: str, h: Array) -> tuple[Array, Array]:
        """Deviation of a quantity on one surface by those of its own sum and of the load, SI."""
        if quantity in SEPARATIONS:
            return np.zeros_like(h), np.full_like(h, -self.compliance)
        if not (other := self.series(quantity)):
            return np.ones_like(h), np.zeros_like(h)
        return (1 + other * self.alone.mean(quantity, h)) ** -2.0, np.zeros_like(h)


def _values(model: Model) -> dict[str, Any]:
    return {each.name: getattr(model, each.name) for each in fields(Model)}


def _load_of(quantity: str) -> str:
    return "load_unloading" if quantity_of(quantity).unloading else "load"
