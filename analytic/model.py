"""The exact statistics of one rough surface in contact: means, fluctuations and their inversion."""

from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.curvature import RandomCurvature
from analytic.gradings import Grading, Homogeneous
from analytic.height_rule import Count, Fluctuations, HeightRule
from analytic.heights import Gaussian, HeightLaw
from analytic.laws.branch import Ways
from analytic.laws.film import Film
from analytic.laws.law import ContactLaw
from analytic.laws.tangential import Tangential
from analytic.mean_contact import MeanContact, MeanPowers
from analytic.measured_summits import MeasuredRadii
from analytic.quantities import LAW_QUANTITIES, NOT_SUMS, Quantity, quantity_of
from analytic.summits import Summits, summits_of
from analytic.surface import Surface

if TYPE_CHECKING:
    from analytic.distribution import Law


@dataclass(frozen=True, slots=True)
class Cumulants:
    """Exact statistics of a quantity over surfaces, each an array over the separations.

    Parameters
    ----------
    mean, variance : ndarray
        In the unit of the quantity, and its square.
    skewness, excess_kurtosis : ndarray
        Of the distribution over surfaces; nan where the variance is 0.
    """

    mean: Array
    variance: Array
    skewness: Array
    excess_kurtosis: Array


@dataclass(frozen=True)
class Model:
    """A rough surface with everything that determines its contact.

    Quantities are "load" (N), "area" (m^2), "stiffness" (N/m), "contacts" (1), "conductance" (times the
    resistivity, m), "pressure" (P/A_n, Pa) and "area_fraction" (A/A_n, 1); separations are reduced,
    d/sigma from the mean of the summit heights. What a surface has of a quantity is the sum over its
    asperities, which are independent.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    grading : Grading, optional
        E*(s)/E*; default: homogeneous.
    heights : HeightLaw, optional
        Law of the reduced heights; default: Gaussian.
    curvature : RandomCurvature or MeasuredRadii, optional
        Radii of the summits, given their heights, which must be those of the same alpha, or those measured
        with them. A random curvature needs the radius of the surface to be the inverse of its mean; the
        fourth cumulant of the area is infinite where such radii have no bound. Measured summits count as
        drawn from their list, each as likely as another. Default: one radius.
    law : ContactLaw, optional
        Law of contact of an asperity, of `analytic.laws`; default: Hertz's. Quantities are then also
        "load_slope" (N/m), the slope of the load without the jumps of asperities, and "yielded" (1), the
        number of contacts beyond the first piece of the law.
    unload_from : float, optional
        Lowest separation reached before, d/sigma. Each quantity has a second one, as "load_unloading", on
        the way back from there; where asperities yield it needs this, and a law that says how they unload.
    film : Film, optional
        What spots conduct through: "conductance_si" (S, or W/K) needs it.
    n_asperities : float, optional
        Asperities on the surface; default: eta A_n.
    count : {"fixed", "poisson"}, optional
        Whether their number is the same on every surface, or the mean of a Poisson law (a window on an
        unbounded surface).

    Raises
    ------
    ValueError
        If `n_asperities` is not a positive finite number, `count` another word, or the law lacks a
        constant, or its unloading is asked for and not known.

    Examples
    --------
    >>> import analytic
    >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
    >>> model = analytic.Model(surface, heights=analytic.ExponentialHeights())
    >>> float(model.mean("contacts", 1.0).round(3))
    135.335
    """

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
                f"heights = {self.heights!r:.60}: summits with radii of their own have heights of their own; "
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
            If the way back is asked for and not known, or starts above `h`.
        """
        q = self._asked(quantity, h)
        return self._unit(q) * self._means(q).mean(quantity, h)

    def slope(self, quantity: str, h: ArrayLike) -> Array:
        """How fast the mean falls with the separation, per unit of h.

        Where asperities jump, at first touch or from one piece of the law to the next, this counts: the slope
        of the mean load is not the mean of "load_slope". Of measured heights, which jump one by one,
        it is the slope in between. On the way back no asperity jumps as the separation grows.

        Parameters
        ----------
        quantity : str
            Its name; not "load_slope", and of those on the way back where asperities have yielded
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
            raise ValueError(f"quantity = {quantity!r}: its own slope is not known; give another quantity")
        return self._unit(q) * self._means(q).slope(quantity, h)

    def share(self, piece: int, h: ArrayLike) -> Array:
        """Mean share of the contacts in which a piece of the law holds: who has yielded, and how far.

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

    def cumulants(self, quantity: str, h: ArrayLike) -> Cumulants:
        """Mean, variance, skewness and excess kurtosis over surfaces, in the shape of `h`."""
        h = np.asarray(h, dtype=np.float64)
        step = self._means(self._asked(quantity, h)).together
        parts = np.split(h.ravel(), range(step, h.size, step)) if h.size else []
        rows = np.concatenate([np.empty((0, 4)), *(self._one_asperity(quantity, x) for x in parts)])
        k1, k2, k3, k4 = rows.reshape(*h.shape, 4).transpose(-1, *range(h.ndim))
        n, scale = self.number, quantity_of(quantity).scale(self.surface)
        with np.errstate(divide="ignore", invalid="ignore"):
            return Cumulants(
                n * scale * k1, n * scale**2 * k2, k3 / k2 / np.sqrt(n * k2), k4 / k2 / (n * k2)
            )  # k2 to a power would underflow long before these ratios overflow

    def std(self, quantity: str, h: ArrayLike) -> Array:
        """Standard deviation over surfaces, in the shape of `h`."""
        return np.sqrt(self.cumulants(quantity, h).variance)

    def covariance(self, quantities: Sequence[str], separations: ArrayLike) -> Array:
        """Covariance over surfaces between Q quantities at K separations.

        Returns
        -------
        ndarray
            Shape (Q, K, Q, K), in the product of the units.
        """
        h = np.asarray(separations, dtype=np.float64)
        matrix = self.fluctuations(quantities, h).products()
        scale = np.repeat([quantity_of(name).scale(self.surface) for name in quantities], h.size)
        return np.asarray(self.number * matrix * np.outer(scale, scale)).reshape(
            2 * (len(quantities), h.size)
        )

    def asperities_for(self, quantity: str, h: ArrayLike, std_over_mean: float, *, given: str = "") -> Array:
        """Asperities that a surface must have for surfaces to differ by so little.

        A sum over N independent asperities has a mean and a variance that grow as N. At a given load each
        surface has its own separation: to first order its area A is off by ``dA - A'/P' dP`` there.

        Parameters
        ----------
        quantity : str
            What differs from surface to surface.
        h : array_like
            Reduced separations, any shape.
        std_over_mean : float
            Standard deviation over surfaces, over the mean: 0.01 for one percent.
        given : str, optional
            Another quantity that is the same on all surfaces, its mean at `h`: "load". To leading order.

        Returns
        -------
        ndarray
            In the shape of `h`; not rounded.

        Raises
        ------
        ValueError
            If `std_over_mean` is not a positive finite number.

        Examples
        --------
        >>> import analytic
        >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
        >>> model = analytic.Model(surface, count="poisson")
        >>> float(model.asperities_for("contacts", 0.0, 0.1).round(6))
        200.0
        """
        if not (np.isfinite(std_over_mean) and std_over_mean > 0):
            raise ValueError(f"std_over_mean = {std_over_mean!r}: give a positive finite number, as 0.01")
        variance, h = self.cumulants(quantity, h).variance, np.asarray(h, dtype=np.float64)
        with np.errstate(divide="ignore", invalid="ignore"):
            if given:
                rate = self.slope(quantity, h) / self.slope(given, h)
                both = [self.covariance([quantity, given], [x])[0, 0, 1, 0] for x in h.ravel().tolist()]
                apart = rate * self.cumulants(given, h).variance - 2 * np.reshape(both, h.shape)
                variance = np.maximum(variance + rate * apart, 0.0)
            return np.asarray(self.number * variance / (self.mean(quantity, h) * std_over_mean) ** 2)

    def tangential_load(self, h: ArrayLike, tangential: Tangential) -> Array:
        """Mean tangential load of a surface that is pressed on and then pushed sideways.

        Parameters
        ----------
        h : array_like
            Reduced separations, any shape.
        tangential : Tangential
            Friction, and displacements.

        Returns
        -------
        ndarray
            N, shape ``(*h.shape, displacements)``.

        Raises
        ------
        ValueError
            If the law is not that of elastic half-spaces.
        """
        if not self.ways.law.half_space:
            raise ValueError(
                f"law = {self.ways.law.name!r}: tangential loads need elastic half-spaces; take 'hertz' or "
                "'power-law-graded'"
            )
        h, shifts = np.asarray(h, dtype=np.float64)[..., None], tangential.shifts(self.surface)
        once, where = np.unique([h + 0 * shifts, h + shifts], return_inverse=True)  # u = 0 gives exactly 0
        pressed, shifted = self.mean("load", once)[where].reshape(2, *h.shape[:-1], shifts.size)
        return tangential.load(pressed, shifted)

    def separation_at(self, quantity: str, value: ArrayLike) -> Array:
        """Separation at which the mean has a given value.

        Parameters
        ----------
        quantity : str
            What is known.
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
            If a value is not positive or not reached between h = -40 and 1000 (under other laws than
            Hertz's: up to where the probability of a contact underflows).
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

    def fluctuations(self, quantities: Sequence[str], separations: ArrayLike) -> Fluctuations:
        """What one asperity adds to each quantity at each separation, over its scale.

        Columns are quantity by quantity, at increasing number of the separation.
        """
        asked = [self._asked(name, separations) for name in quantities]
        means, h = self._means(*asked), np.asarray(separations, dtype=np.float64)
        rule = means.rule(h, quantities)
        result = rule.fluctuations(rule.terms(quantities, h, self.grading, means.ways), self.count)
        if not self._summits.unbounded:
            return result
        return replace(result, radius=np.repeat([q.radius for q in asked], h.size))

    def asperities(
        self, quantity: str, h: float, farther: Sequence[float] = ()
    ) -> tuple[HeightRule, Callable[[HeightRule], Array]]:
        """A rule over the asperities at one separation, and what takes rules to what one at each node adds.

        Over the scale. The rule is over radii too, where they differ, and finer with heights `farther` above
        the separation that divide it.
        """
        q = self._asked(quantity, h)
        means = self._means(q) if self.curvature is None else self._contact
        rule = means.rule(h + np.array([0.0, *farther]), [quantity])
        return rule, lambda nodes: nodes.terms([quantity], [h], self.grading, means.ways)[:, 0]

    def distribution(self, quantity: str, h: float) -> "Law":
        """Exact law of a quantity over surfaces, at one separation, in the manner of `scipy.stats`.

        Parameters
        ----------
        quantity : str
            Its name.
        h : float
            Reduced separation.

        Returns
        -------
        Law
            With cdf, sf, pdf (of a number of asperities its probability), ppf, isf, interval, rvs, mean, var,
            std, in the unit of the quantity; `atom`, the probability of nothing; and `error` of cdf.

        Examples
        --------
        >>> import analytic
        >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
        >>> law = analytic.Model(surface).distribution("load", 2.0)
        >>> (law.ppf([0.05, 0.5, 0.95]) / law.mean()).round(4)
        array([0.489 , 0.9659, 1.6275])
        """
        from analytic.distribution import distribution_of  # few ask

        return distribution_of(self, quantity, float(h))

    def separation_law(self, load: float, quantity: str = "load") -> "Law":
        """Exact law of the separation at a given load: P(h* <= h) = P(S(h) <= load).

        Parameters
        ----------
        load : float
            On each surface, N.
        quantity : str, optional
            Another sum that is given instead, in its unit; it falls with the separation.

        Returns
        -------
        Law
            As `distribution`, of d/sigma.

        Raises
        ------
        ValueError
            If asperities pull: then several separations may have one load.
        """
        from analytic.distribution import separation_law_of

        return separation_law_of(self, load, quantity)

    @cached_property
    def ways(self) -> Ways:
        """Law of contact, history and film, in reduced units."""
        law = ContactLaw() if self.law is None else self.law.on(self.surface)
        return Ways(law, self.unload_from, None if self.film is None else self.film.on(self.surface))

    @cached_property
    def _summits(self) -> Summits:
        return summits_of(self.heights, self.curvature)

    @cached_property
    def _contact(self) -> MeanContact:
        return MeanContact(self.ways, self.grading, self._summits)

    def _means(self, *quantities: Quantity) -> MeanContact | MeanPowers:
        """What one asperity adds to all of these in the mean, by powers of its approach if that is true."""
        powers = all(self._by_powers(q) for q in quantities)
        return MeanPowers(self._contact) if powers else self._contact

    def _asked(self, quantity: str, h: ArrayLike = np.inf) -> Quantity:
        """A quantity that is known at these separations."""
        q = quantity_of(quantity)
        if quantity in NOT_SUMS:
            raise KeyError(f"{quantity!r}: the model knows no gas; ask `theory` of a scene with a joint")
        self.ways.of(quantity)
        if q.unloading and self.unload_from is not None and np.any(np.less(h, self.unload_from)):
            raise ValueError(
                f"quantity = {quantity!r}: h = {np.min(h):g} is lower than unload_from = "
                f"{self.unload_from:g}, from where the surface goes back; give higher separations"
            )
        return q

    def _by_powers(self, q: Quantity) -> bool:
        """Whether one asperity carries a power of its approach, whose mean is an integral over heights."""
        return self.ways.law.hertz and q.base not in LAW_QUANTITIES and self._summits.powers

    def _unit(self, q: Quantity) -> float:
        return self.number * q.scale(self.surface)

    def _one_asperity(self, quantity: str, h: Array) -> Array:
        """First four cumulants that one asperity contributes, over the scale: shape (separations, 4)."""
        part = self.fluctuations([quantity], h)
        m2, m3, m4 = (part.moment(k) for k in (2, 3, 4))
        return np.stack([part.mean, m2, m3, m4 - 3 * m2 * m2 * (self.count == "fixed")], axis=1)
