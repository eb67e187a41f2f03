"""What a surface answers that is no sum over its asperities: `analytic.Model` with an interaction, or gas.

At effective separations x loads, areas and numbers are those of independent asperities, exactly. The others
follow, surface by surface, from its own sum S of stiffnesses or conductances and its load P ::

    y = S/(1 + c S) + g(x - k P),    Q = y/(1 + b y)

with the half-space in series (c), the nominal separation ``x - k P`` itself or what the gas conducts there
(g), and the bodies in series with spots beside gas (b). Film, layer and neighbours are inside S. Means are to
second order in what surfaces differ by, fluctuations to leading order.
"""

from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass, fields
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.height_rule import Fluctuations
from analytic.interaction import Interaction, in_series
from analytic.mean_model import fall_of
from analytic.model import Model
from analytic.quantities import JOINT, SEPARATIONS, Quantity, quantity_of

if TYPE_CHECKING:
    from analytic.distribution import Law
    from analytic.joint import Gap


def _itself(x: Array, order: int = 0) -> Array:
    """Return the separation, or a derivative of it by itself."""
    return x if order == 0 else np.full_like(x, float(order == 1))


@dataclass(frozen=True)
class _Answer:
    """How a quantity of a surface follows from a sum S over its spots and its load P.

    Parameters
    ----------
    spots : str
        Name of S; none of it counts if that is empty.
    load : str
        Name of P, on the same way.
    per : float
        Area that S counts for.
    series, sunk, bodies : float
        The constants c, k and b.
    at_plane : callable, optional
        g of separations and the order of a derivative.
    """

    spots: str
    load: str
    per: float = 1.0
    series: float = 0.0
    sunk: float = 0.0
    bodies: float = 0.0
    at_plane: Callable[[Array, int], Array] | None = None

    @property
    def is_sum(self) -> bool:
        """Whether it is S itself."""
        return not (self.series or self.at_plane)

    def mean(self, model: Model, h: Array) -> Array:
        """Mean over surfaces, to second order."""
        y, _, (bend_spots, bend_load) = self.at_means(model, h)
        if self.series or self.bodies:
            y = y + bend_spots * model.cumulants(self.spots, h).variance / 2
        if self.sunk and self.at_plane is not _itself:
            y = y + bend_load * model.cumulants(self.load, h).variance / 2
        return y

    def at_means(self, model: Model, h: Array) -> tuple[Array, Array, Array]:
        """Value at the means of S and P, and its first and second derivatives by both."""
        y, (slopes, bends) = np.zeros(h.shape), np.zeros((2, 2, *h.shape))
        if self.spots:
            alone = model.mean(self.spots, h)
            y, whole = in_series(alone, self.series) / self.per, 1 + self.series * alone
            slopes[0], bends[0] = whole**-2.0 / self.per, -2 * self.series * whole**-3.0 / self.per
        if self.at_plane:
            x = h - self.sunk * model.mean(self.load, h) if self.sunk else h
            y = y + self.at_plane(x, 0)
            if self.sunk:
                slopes[1], bends[1] = -self.sunk * self.at_plane(x, 1), self.sunk**2 * self.at_plane(x, 2)
        whole = 1 + self.bodies * y
        bends = (bends - 2 * self.bodies * slopes**2 / whole) / whole**2
        return in_series(y, self.bodies), slopes / whole**2, bends

    def law(self, model: Model, h: float) -> "Law":
        """Return the distribution over surfaces, of what follows from S or P alone."""
        if not self.spots:
            return model.distribution(self.load, h).mapped(lambda p: h - self.sunk * p, falls=self.sunk > 0)
        law = model.distribution(self.spots, h)
        gas = 0.0 if self.at_plane is None else float(self.at_plane(np.asarray(h), 0))

        def together(spots: Array) -> Array:
            """Infinite from the pole on, which no surface reaches."""
            with np.errstate(divide="ignore"):
                y = np.divide(spots, np.maximum(1 + self.series * spots, 0.0)) / self.per + gas
            return np.asarray(y / (1 + self.bodies * y) if self.bodies else y)

        return law if self.is_sum else law.mapped(together)


@dataclass(frozen=True)
class InteractingModel(Model):
    """A rough surface whose asperities press each other down, or with gas in its gap; otherwise a `Model`.

    Its separations are those that the asperities feel. Besides the quantities of a `Model` it has, with an
    interaction, "nominal_separation", d/sigma, the separation of the bodies; with gas "gap_conductance" and
    "joint_conductance", W/(m^2 K); each on loading and unloading.

    Parameters
    ----------
    interaction : Interaction, optional
        Which.
    filled : Gap, optional
        The gap conductance.

    Examples
    --------
    >>> import analytic
    >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
    >>> model = analytic.InteractingModel(surface, interaction=analytic.Interaction("body"))
    >>> float(model.mean("load", 1.0).round(4)), float(model.mean("nominal_separation", 1.0).round(4))
    (0.319, 0.6981)

    Steel in air:

    >>> film, air = analytic.Film(conductivities=(16.0, 16.0)), analytic.Joint("air", rms=1.1e-6)
    >>> filled = air.gap(surface, analytic.Gaussian())
    >>> model = analytic.InteractingModel(surface, film=film, filled=filled)
    >>> [float(model.mean(name, 2.0).round(-2)) for name in ("contact_conductance", "joint_conductance")]
    [1300.0, 10100.0]
    """

    _: KW_ONLY
    interaction: Interaction | None = None
    filled: "Gap | None" = None

    @classmethod
    def of(
        cls, model: Model, interaction: Interaction | None = None, filled: "Gap | None" = None
    ) -> "InteractingModel":
        """Return the asperities of a model with an interaction, or gas."""
        return cls(**_values(model), interaction=interaction, filled=filled)

    @cached_property
    def alone(self) -> Model:
        """The same asperities without interaction and gas."""
        return Model(**_values(self))

    @property
    def compliance(self) -> float:
        """Of the interaction, in units of sigma: d/sigma for each newton."""
        if self.interaction is None:
            return 0.0
        return self.interaction.compliance(self.surface, self.number) / self.surface.sigma

    def series(self, quantity: str) -> float:
        """Return what the half-space adds to the inverse of a sum: `analytic.Interaction.series`."""
        if self.interaction is None:
            return 0.0
        rho = 1.0 if self.film is None else self.film.rho
        return self.interaction.series(quantity, self.surface, self.number, rho)

    def mean(self, quantity: str, h: ArrayLike) -> Array:
        """Return `Model.mean`, to second order where a surface answers by itself."""
        return self._answer(quantity, h).mean(self.alone, np.asarray(h, dtype=np.float64))

    def slope(self, quantity: str, h: ArrayLike) -> Array:
        """Return how fast the mean falls with the separation, of the mean surface."""
        if self._answer(quantity).is_sum:
            return self.alone.slope(quantity, h)
        return fall_of(partial(self.mean, quantity), h)

    def separation_at(self, quantity: str, value: ArrayLike) -> Array:
        """Return the separation of the mean surface, as `Model.separation_at`."""
        if not self._answer(quantity).is_sum:
            raise ValueError(
                f"quantity = {quantity!r}: give a load, an area, or another sum of the asperities"
            )
        return self.alone.separation_at(quantity, value)

    def distribution(self, quantity: str, h: float) -> "Law":
        """Return the same as `Model.distribution`, also of the nominal separation and the joint."""
        answer = self._answer(quantity, h)
        if quantity in JOINT and (answer.sunk or not answer.spots):
            raise ValueError(
                f"quantity = {quantity!r}: only 'joint_conductance' is known, for surfaces with one distance "
                "of mean planes"
            )
        return answer.law(self.alone, float(h))

    def separation_law(self, load: float, quantity: str = "load") -> "Law":
        """Return the same as `Model.separation_law`, of the separation that the asperities feel."""
        return self.alone.separation_law(load, quantity)

    def fluctuations(self, quantities: Sequence[str], separations: ArrayLike) -> Fluctuations:
        """Return the same as `Model.fluctuations`, to leading order where a surface answers by itself."""
        h = np.asarray(separations, dtype=np.float64)
        answers = [self._answer(name, h) for name in quantities]
        named = [each.spots or each.load for each in answers] + [each.load for each in answers if each.sunk]
        columns = list(dict.fromkeys(named))
        one = self.alone.fluctuations(columns, h)
        rates, means = np.zeros((len(columns), len(answers), h.size)), []
        for k, (name, answer) in enumerate(zip(quantities, answers, strict=True)):
            unit = quantity_of(name).scale(self.surface)
            means.append(self.mean(name, h) / (self.number * unit))
            for term, rate in zip(
                (answer.spots, answer.load), answer.at_means(self.alone, h)[1], strict=True
            ):
                if term in columns:
                    rates[columns.index(term), k] += rate * quantity_of(term).scale(self.surface) / unit
        return one.combined(rates, np.concatenate(means))

    def _asked(self, quantity: str, h: ArrayLike = np.inf) -> Quantity:
        known = (JOINT if self.filled else {}) | (SEPARATIONS if self.interaction else {})
        return known[quantity] if quantity in known else super()._asked(quantity, h)

    def _answer(self, quantity: str, h: ArrayLike = np.inf) -> _Answer:
        q = self._asked(quantity, h)
        way = "_unloading" if q.unloading else ""
        load, sunk = f"load{way}", self.compliance
        if quantity in SEPARATIONS:
            return _Answer("", load, sunk=sunk, at_plane=_itself)
        if quantity not in JOINT:
            return _Answer(quantity, load, series=self.series(quantity))
        spots = f"conductance_si{way}" if quantity.startswith("joint") else ""
        from_body = self.interaction is not None and self.interaction.reference == "body"
        series, bodies = self.series(spots) if spots and not from_body else 0.0, 0.0
        if spots and self.film is not None and self.interaction is not None:
            bodies = self.interaction.bodies(self.surface, self.film.rho)
        return _Answer(
            spots,
            load,
            per=self.surface.nominal_area,
            series=series,
            sunk=0.0 if from_body else sunk,
            bodies=bodies,
            at_plane=self.filled,
        )


def _values(model: Model) -> dict[str, Any]:
    return {each.name: getattr(model, each.name) for each in fields(Model)}
