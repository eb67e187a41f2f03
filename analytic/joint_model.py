"""Statistics of surfaces with gas in the gap: a model that also has the conductances of the joint.

What the gas conducts is a number wherever all surfaces have the same distance of mean planes. Where each
has its own (the nominal separation from the mean plane at given effective ones, or the effective separation
at given nominal ones), means are to second order in what surfaces differ by, fluctuations to leading order.
"""

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.height_rule import Fluctuations
from analytic.interacting import InteractingModel
from analytic.joint import Gap
from analytic.model import Cumulants, Model
from analytic.own_balance import derivative
from analytic.quantities import JOINT, Quantity, quantity_of

if TYPE_CHECKING:
    from analytic.distribution import Law


@dataclass(frozen=True)
class JointModel(Model):
    """A rough surface with gas in its gap; otherwise as `analytic.Model`.

    It also has "gap_conductance" and "joint_conductance", W/(m^2 K), on loading and unloading.

    Parameters
    ----------
    filled : Gap
        The gap conductance.

    Examples
    --------
    >>> import analytic
    >>> surface = analytic.Surface(sigma=0.9e-6, radius=1e-5, eta=1e10, nominal_area=1e-4, E_star=1e11)
    >>> spots = analytic.Model(surface, film=analytic.Film(conductivities=(16.0, 16.0)))
    >>> model = with_gap(spots, analytic.Joint("air", rms=1e-6).gap(surface, spots.heights))
    >>> [float(model.mean(name, 2.0).round(-1)) for name in ("contact_conductance", "joint_conductance")]
    [11980.0, 21450.0]
    """

    _: KW_ONLY
    filled: Gap

    def mean(self, quantity: str, h: ArrayLike) -> Array:
        """As of the spots; of a joint to second order where each surface has its own mean plane."""
        if quantity not in JOINT:
            return super().mean(quantity, h)
        h = np.asarray(h, dtype=np.float64)
        if plane := self._own_plane(quantity):
            at = super().mean(plane, h)
            gas = self.filled(at) + self.filled(at, 2) * super().cumulants(plane, h).variance / 2
        else:
            gas = self.filled(h)
        spots = _spots(quantity)
        return gas if spots is None else gas + super().mean(spots, h) / self.surface.nominal_area

    def slope(self, quantity: str, h: ArrayLike) -> Array:
        """As of the spots."""
        if quantity not in JOINT:
            return super().slope(quantity, h)
        return -derivative(lambda at: self.mean(quantity, at), np.asarray(h, dtype=np.float64))

    def cumulants(self, quantity: str, h: ArrayLike) -> Cumulants:
        """As of the spots; the mean of a joint is exact where that of its spots is."""
        found = super().cumulants(quantity, h)
        return replace(found, mean=self.mean(quantity, h)) if quantity in JOINT else found

    def separation_at(self, quantity: str, value: ArrayLike) -> Array:
        """As of the spots, at their loads and areas."""
        if quantity in JOINT:
            raise ValueError(
                f"quantity = {quantity!r}: give a load, an area, or another sum of the asperities"
            )
        return super().separation_at(quantity, value)

    def distribution(self, quantity: str, h: float) -> "Law":
        """As of the spots: that of their conductance, moved by what the gas conducts."""
        if quantity not in JOINT:
            return super().distribution(quantity, h)
        spots = _spots(quantity)
        if spots is None or self._own_plane(quantity):
            raise ValueError(
                f"quantity = {quantity!r}: only 'joint_conductance' is known, for surfaces with one distance "
                "of mean planes"
            )
        from analytic.distribution import Mapped

        area, gas = self.surface.nominal_area, float(self.filled(h))
        return Mapped(super().distribution(spots, h), lambda x: x / area + gas, lambda y: (y - gas) * area)

    def fluctuations(self, quantities: Sequence[str], separations: ArrayLike) -> Fluctuations:
        """As of the spots, and of the mean planes of the surfaces where each has its own."""
        if JOINT.keys().isdisjoint(quantities):
            return super().fluctuations(quantities, separations)
        h = np.asarray(separations, dtype=np.float64)
        planes = {name: (name in JOINT and self._own_plane(name)) or "load" for name in quantities}
        mine = {name: _spots(name) or "load" if name in JOINT else name for name in quantities}
        names = list(dict.fromkeys((*mine.values(), *planes.values())))
        one = super().fluctuations(names, h)
        own, other, factor, by_plane = [], [], [], []
        for name in quantities:
            own.append(names.index(mine[name]) * h.size + np.arange(h.size))
            other.append(names.index(planes[name]) * h.size + np.arange(h.size))
            factor.append(np.full(h.size, float(name not in JOINT or _spots(name) is not None)))
            press = np.zeros(h.size)
            if planes[name] != "load":
                unit = quantity_of(name).scale(self.surface)
                press = self.filled(super().mean(planes[name], h), 1) / unit
            by_plane.append(press)
        means = [self.mean(name, h) / self._unit(quantity_of(name)) for name in quantities]
        return one.combined(*(np.concatenate(part) for part in (means, own, factor, other, by_plane)))

    def _asked(self, quantity: str, h: ArrayLike = np.inf) -> Quantity:
        return JOINT[quantity] if quantity in JOINT else super()._asked(quantity, h)

    def _own_plane(self, quantity: str) -> str:  # noqa: ARG002
        """The separation that tells the distance of mean planes where each surface has its own; or none."""
        return ""


@dataclass(frozen=True)
class InteractingJointModel(JointModel, InteractingModel):
    """The same of asperities that press each other down."""

    def _own_plane(self, quantity: str) -> str:
        body = self.interaction.reference == "body"
        if body != self.interaction.nominal:
            return ""
        return "effective_separation" if body else f"nominal_separation{_way(quantity)}"


def with_gap(model: Model, filled: Gap) -> JointModel:
    """Add gas in the gap to a model."""
    kind: Any = InteractingJointModel if isinstance(model, InteractingModel) else JointModel
    joined: JointModel = kind(
        **{each.name: getattr(model, each.name) for each in fields(model)}, filled=filled
    )
    return joined


def _way(quantity: str) -> str:
    return "_unloading" if quantity.endswith("_unloading") else ""


def _spots(quantity: str) -> str | None:
    """What of it the spots conduct."""
    return f"conductance_si{_way(quantity)}" if quantity.startswith("joint") else None
