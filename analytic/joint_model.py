"""Statistics of surfaces with gas in the gap: a model that also has the conductances of the joint.

A joint is one network, surface by surface: gas beside the spots, both in series with the bodies as a whole,
``1/h_j = 1/(h_spots + h_gas) + R_bodies A_n``. Film, layer and neighbours are inside h_spots.

What the gas conducts is a number wherever all surfaces have the same distance of mean planes. Where each
has its own (the nominal separation, from the mean plane), means are to second order in what surfaces
differ by, fluctuations to leading order; so they are in series with the bodies.
"""

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, fields, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.height_rule import Fluctuations
from analytic.interacting import InteractingModel
from analytic.interaction import in_series
from analytic.joint import Gap
from analytic.mean_contact import fall_of
from analytic.model import Cumulants, Model
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
        return fall_of(partial(self.mean, quantity), h)

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
        area, gas = self.surface.nominal_area, float(self.filled(h))
        return super().distribution(spots, h).mapped(lambda x: x / area + gas)

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
            by_spots, by_gas = self._parts(name, h)
            conducts = name not in JOINT or _spots(name) is not None
            factor.append(by_spots if conducts else np.zeros(h.size))
            press = np.zeros(h.size)
            if planes[name] != "load":
                unit = quantity_of(name).scale(self.surface)
                press = by_gas * self.filled(super().mean(planes[name], h), 1) / unit
            by_plane.append(press)
        means = [self.mean(name, h) / self._unit(quantity_of(name)) for name in quantities]
        join = np.concatenate
        return one.combined(join(means), join(own), join(factor), join(other), join(by_plane))

    def _asked(self, quantity: str, h: ArrayLike = np.inf) -> Quantity:
        return JOINT[quantity] if quantity in JOINT else super()._asked(quantity, h)

    def _own_plane(self, quantity: str) -> str:  # noqa: ARG002
        """Return the separation that tells the distance of mean planes, if surfaces have their own."""
        return ""

    def _parts(self, quantity: str, h: Array) -> tuple[Array, Array]:  # noqa: ARG002
        """How much a quantity deviates with the conductance of the spots, and with that of the gas."""
        return np.ones(h.size), np.ones(h.size)


@dataclass(frozen=True)
class InteractingJointModel(JointModel, InteractingModel):
    """The same of asperities that press each other down, on bodies that may constrict the flux as a whole."""

    def mean(self, quantity: str, h: ArrayLike) -> Array:
        """As of the spots; in series with the bodies to second order."""
        if not (bodies := self._bodies(quantity)):
            return super().mean(quantity, h)
        x = self._beside.cumulants(quantity, h)
        return np.asarray(in_series(x.mean, bodies) - bodies * x.variance / (1 + bodies * x.mean) ** 3)

    def distribution(self, quantity: str, h: float) -> "Law":
        """As of the spots: of spots and gas, in series with the bodies."""
        if not (bodies := self._bodies(quantity)):
            return super().distribution(quantity, h)
        return self._beside.distribution(quantity, h).mapped(lambda x: x / (1 + bodies * x))

    @cached_property
    def _beside(self) -> "_WithoutBodies":
        return _WithoutBodies(**{each.name: getattr(self, each.name) for each in fields(self)})

    def _bodies(self, quantity: str) -> float:
        """Their resistance times the nominal area, to what passes them."""
        if quantity not in JOINT or _spots(quantity) is None or self.film is None:
            return 0.0
        return self.interaction.bodies(self.surface, self.film.rho)

    def _parts(self, quantity: str, h: Array) -> tuple[Array, Array]:
        if not (bodies := self._bodies(quantity)):
            return super()._parts(quantity, h)
        spots = self.alone.mean(f"conductance_si{_way(quantity)}", h) / self.surface.nominal_area
        by_gas = (1 + bodies * (spots + self.filled(h))) ** -2.0
        return (1 + bodies * spots) ** 2 * by_gas, by_gas  # spots deviate in series with the bodies alone

    def _own_plane(self, quantity: str) -> str:
        return "" if self.interaction.reference == "body" else f"nominal_separation{_way(quantity)}"


class _WithoutBodies(InteractingJointModel):
    """The joint without the bodies that it is in series with."""

    def series(self, quantity: str) -> float:  # noqa: ARG002
        return 0.0

    def _bodies(self, quantity: str) -> float:  # noqa: ARG002
        return 0.0


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
    """Return what of it the spots conduct."""
    return f"conductance_si{_way(quantity)}" if quantity.startswith("joint") else None
