"""A rough surface with everything that determines its contact, and its means."""

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.curvature import RandomCurvature
from analytic.gradings import Grading, Homogeneous
from analytic.height_rule import Count, HeightRule
from analytic.heights import Gaussian, HeightLaw
from analytic.laws.branch import Ways
from analytic.laws.film import Film
from analytic.laws.law import ContactLaw
from analytic.mean_contact import MeanContact, MeanPowers
from analytic.measured_summits import MeasuredRadii
from analytic.quantities import LAW_QUANTITIES, NOT_SUMS, Quantity, quantity_of
from analytic.summits import Summits, summits_of
from analytic.surface import Surface


@dataclass(frozen=True)
class MeanModel:
    """What `analytic.Model` holds, checked, and its means over surfaces."""

    surface: Surface
    _: KW_ONLY
    grading: Grading = field(default_factory=Homogeneous)
    heights: HeightLaw = field(default_factory=Gaussian)
    curvature: RandomCurvature | MeasuredRadii | None = None
    law: ContactLaw | None = None
    unload_from: float | None = None
    film: Film | None = None
    n_asperities: float | None = None
    count: Count = "fixed"

    def __post_init__(self) -> None:
        if not (np.isfinite(self.number) and self.number > 0):
            raise ValueError(f"n_asperities = {self.n_asperities!r}: give a finite number > 0")
        if self.count not in ("fixed", "poisson"):
            raise ValueError(f'count = {self.count!r}: give "fixed" or "poisson"')
        if self.curvature is not None and self.heights != self.curvature.heights:
            raise ValueError(
                f"heights = {self.heights!r:.60}: summits with individual radii come with their own heights; "
                f"give heights = {self.curvature.heights!r:.60}"
            )
        law = self.ways.law  # one that lacks a constant says so now
        if self.unload_from is not None:
            law.unloading()
            if not np.isfinite(self.unload_from):
                raise ValueError(f"unload_from = {self.unload_from!r}: give a finite separation d/sigma")

    @property
    def number(self) -> float:
        """Asperities on a surface, or their mean number."""
        return self.surface.n_asperities if self.n_asperities is None else self.n_asperities

    def mean(self, quantity: str, h: ArrayLike) -> Array:
        """Mean over surfaces: ``N scale F*_n(h)`` under Hertz's law, to 1e-13; under others to 1e-12.

        Parameters
        ----------
        quantity : str
            Its name.
        h : array_like
            Reduced separations, any shape.

        Returns
        -------
        ndarray
            In the unit of the quantity, in the shape of `h`.

        Raises
        ------
        KeyError
            If there is no such quantity.
        ValueError
            If unloading is requested but not known, or starts above `h`.
        """
        q = self._asked(quantity, h)
        return self._unit(q) * self._means(q).mean(quantity, h)

    def slope(self, quantity: str, h: ArrayLike) -> Array:
        """Rate at which the mean falls with the separation, per unit of h.

        It includes the jumps of asperities, at first touch or from one piece of the law to the next: so the
        slope of the mean load is not the mean of "load_slope". For measured heights, which jump one by one,
        it is the slope between jumps. On unloading no asperity jumps as the separation grows.

        Parameters
        ----------
        quantity : str
            Its name; not "load_slope", and of those on unloading where asperities have yielded
            "load_unloading" only.
        h : array_like
            Reduced separations, any shape.

        Returns
        -------
        ndarray
            In the unit of the quantity, in the shape of `h`.

        Raises
        ------
        ValueError
            For others.
        """
        q = self._asked(quantity, h)
        if q.base == "load_slope":
            raise ValueError(f"quantity = {quantity!r}: its slope is not known; give another quantity")
        return self._unit(q) * self._means(q).slope(quantity, h)

    def share(self, piece: int, h: ArrayLike) -> Array:
        """Mean share of the contacts to which a piece of the law applies, such as those that have yielded.

        Parameters
        ----------
        piece : int
            0 for the first, which is elastic.
        h : array_like
            Reduced separations, any shape.

        Returns
        -------
        ndarray
            In the shape of `h`; nan where no contact is to be expected in double precision.
        """
        return self._contact.share(piece, h)

    def separation_at(self, quantity: str, value: ArrayLike) -> Array:
        """Separation at which the mean has a given value.

        Parameters
        ----------
        quantity : str
            The known quantity.
        value : array_like
            Its values, in its SI unit, any shape.

        Returns
        -------
        ndarray
            Reduced separations; the largest one where a strongly negative modulus, or an area that falls
            at yield, makes several.

        Raises
        ------
        ValueError
            If a value is not positive, or not reached between h = -40 and where the probability of a contact
            underflows.
        """
        q = self._asked(quantity)
        target = np.asarray(value, dtype=np.float64)
        if not np.all(np.isfinite(target) & (target > 0)):
            raise ValueError(f"{quantity} = {value!r}: give finite values > 0 {q.unit}")
        return self._means(q).separations_at(quantity, target / self._unit(q))

    def rule(self, separations: ArrayLike, quantities: Sequence[str] = ("load",)) -> HeightRule:
        """Heights and probabilities for integrals of these quantities of an asperity at these separations."""
        return self._means(*(self._asked(name, separations) for name in quantities)).rule(
            separations, quantities
        )

    @cached_property
    def ways(self) -> Ways:
        """Contact law, loading history and film, in reduced units."""
        law = ContactLaw() if self.law is None else self.law.on(self.surface)
        return Ways(law, self.unload_from, None if self.film is None else self.film.on(self.surface))

    @cached_property
    def summits(self) -> Summits:
        """Their heights and radii."""
        return summits_of(self.heights, self.curvature)

    @cached_property
    def _contact(self) -> MeanContact:
        return MeanContact(self.ways, self.grading, self.summits)

    def _means(self, *quantities: Quantity) -> MeanContact | MeanPowers:
        """Return what one asperity adds to all of these in the mean, by powers of its approach if it can."""
        powers = all(self._by_powers(q) for q in quantities)
        return MeanPowers(self._contact) if powers else self._contact

    def _asked(self, quantity: str, h: ArrayLike = np.inf) -> Quantity:
        """Return a quantity that is known at these separations."""
        q = quantity_of(quantity)
        if quantity in NOT_SUMS:
            raise KeyError(f"{quantity!r}: this model has no gas; use `theory` of a scene with a joint")
        self.ways.of(quantity)
        if q.unloading and self.unload_from is not None and np.any(np.less(h, self.unload_from)):
            raise ValueError(
                f"quantity = {quantity!r}: h = {np.min(h):g} is smaller than unload_from = "
                f"{self.unload_from:g}, where unloading begins; give larger separations"
            )
        return q

    def _by_powers(self, q: Quantity) -> bool:
        """Whether one asperity carries a power of its approach, whose mean is an integral over heights."""
        return self.ways.law.hertz and q.base not in LAW_QUANTITIES and self.summits.powers

    def _unit(self, q: Quantity) -> float:
        return self.number * q.scale(self.surface)
