"""What a surface answers that is no sum over its asperities: with an interaction, or gas in its gap.

At effective separations x loads, areas and numbers are those of independent asperities, exactly. The others
follow, surface by surface, from its own sum S of stiffnesses or conductances and its load P ::

    y = S/(1 + c S) + g(x - k P),    Q = y/(1 + b y)

with the half-space in series (c), the nominal separation ``x - k P`` itself or what the gas conducts there
(g), and the bodies in series with spots beside gas (b). Film, layer and neighbours are inside S. Means are to
second order in what surfaces differ by, fluctuations to leading order.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.interaction import in_series
from analytic.quantities import JOINT, NOT_SUMS, SEPARATIONS, Quantity, quantity_of

if TYPE_CHECKING:
    from analytic.distribution import Law
    from analytic.mean_model import MeanModel
    from analytic.model import Model


def _itself(x: Array, order: int = 0) -> Array:
    """Return the separation, or a derivative of it by itself."""
    return x if order == 0 else np.full_like(x, float(order == 1))


@dataclass(frozen=True)
class Answer:
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

    def mean(self, model: "Model", h: Array) -> Array:
        """Mean over surfaces, to second order."""
        y, _, (bend_spots, bend_load) = self.at_means(model, h)
        if self.series or self.bodies:
            y = y + bend_spots * model.cumulants(self.spots, h).variance / 2
        if self.sunk and self.at_plane is not _itself:
            y = y + bend_load * model.cumulants(self.load, h).variance / 2
        return y

    def at_means(self, model: "Model", h: Array) -> tuple[Array, Array, Array]:
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

    def law(self, model: "Model", h: float) -> "Law":
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

        return law.mapped(together)


def answer_of(model: "MeanModel", q: Quantity) -> Answer | None:
    """Return how a quantity follows from sums; None if it is one itself."""
    way = "_unloading" if q.unloading else ""
    load, sunk, how = f"load{way}", model.compliance, model.interaction
    if q.name in SEPARATIONS:
        return Answer("", load, sunk=sunk, at_plane=_itself)
    if q.name not in JOINT:
        series = _series(model, q.name)
        return Answer(q.name, load, series=series) if series else None
    spots = f"conductance_si{way}" if q.name.startswith("joint") else ""
    from_body = how is not None and how.reference == "body"
    bodies = how.bodies(model.surface, model.film.rho) if spots and how and model.film else 0.0
    return Answer(
        spots,
        load,
        per=model.surface.nominal_area,
        series=_series(model, spots) if spots and not from_body else 0.0,
        sunk=0.0 if from_body else sunk,
        bodies=bodies,
        at_plane=model.filled,
    )


def _series(model: "MeanModel", quantity: str) -> float:
    """Return what the half-space adds to the inverse of a sum: `analytic.Interaction.series`."""
    if model.interaction is None:
        return 0.0
    rho = 1.0 if model.film is None else model.film.rho
    return model.interaction.series(quantity, model.surface, model.number, rho)


def asked(model: "MeanModel", quantity: str, h: ArrayLike = np.inf) -> Quantity:
    """Return a quantity that is known at these separations."""
    q = quantity_of(quantity)
    if (quantity in JOINT and model.filled) or (quantity in SEPARATIONS and model.interaction):
        return q
    if quantity in NOT_SUMS:
        raise KeyError(f"{quantity!r}: this model has no gas; use `theory` of a scene with a joint")
    if quantity in SEPARATIONS:
        raise KeyError(f"{quantity!r}: this model has no interaction; use `theory` of a scene with one")
    model.ways.of(quantity)
    if q.unloading and model.unload_from is not None and np.any(np.less(h, model.unload_from)):
        raise ValueError(
            f"quantity = {quantity!r}: h = {np.min(h):g} is smaller than unload_from = "
            f"{model.unload_from:g}, where unloading begins; give larger separations"
        )
    return q
