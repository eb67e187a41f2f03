"""The exact statistics of one rough surface in contact: means, fluctuations and their inversion."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.curvature import RandomCurvature
from analytic.distribution import Law
from analytic.height_rule import Fluctuations
from analytic.interaction import Answer, answer_of, asked
from analytic.mean_model import MeanModel
from analytic.quantities import JOINT, Quantity, quantity_of
from analytic.surface import check_positive


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
class Model(MeanModel):
    """A rough surface with everything that determines its contact.

    Quantities are "load" (N), "area" (m^2), "stiffness" (N/m), "contacts" (1), "conductance" (times the
    resistivity, m), "pressure" (P/A_n, Pa) and "area_fraction" (A/A_n, 1); separations are reduced,
    d/sigma from the mean of the summit heights. The value of a quantity on a surface is the
    sum over its asperities, which are independent.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units.
    grading : Grading, optional
        E*(s)/E*; default: homogeneous.
    heights : HeightLaw, optional
        Law of the reduced heights; default: Gaussian.
    curvature : RandomCurvature or MeasuredRadii, optional
        Radii of the summits given their heights; `heights` must have the same alpha, or be measured together
        with the radii. A random curvature needs the radius of the surface to be the inverse of its mean; the
        fourth cumulant of the area is infinite where such radii have no bound. Measured summits count as
        drawn from their list, each as likely as another. Default: one radius.
    law : ContactLaw, optional
        Law of contact of an asperity, of `analytic.laws`; default: Hertz's. Quantities are then also
        "load_slope" (N/m), the slope of the load without the jumps of asperities, and "yielded" (1), the
        number of contacts beyond the first piece of the law.
    unload_from : float, optional
        Lowest separation reached before, d/sigma. Each quantity has a second one for unloading from there,
        such as "load_unloading"; where asperities yield, it needs this value and a law with known unloading.
    film : Film, optional
        Resistivity or thermal conductivity, and any film; "conductance_si" (S, or W/K) needs it.
    n_asperities : float, optional
        Asperities on the surface; default: eta A_n.
    count : {"fixed", "poisson"}, optional
        Whether their number is the same on every surface, or the mean of a Poisson law (a window on an
        unbounded surface).
    interaction : Interaction, optional
        By which asperities press each other down. Separations are those that the asperities feel; there is
        "nominal_separation", d/sigma, besides, the separation of the bodies.
    filled : Gap, optional
        The gap conductance of a gas: there are "gap_conductance" and "joint_conductance", W/(m^2 K).

    Raises
    ------
    ValueError
        If `n_asperities` is not a positive finite number, `count` another word, the law lacks a constant, or
        its unloading is requested but not known.

    Examples
    --------
    >>> import analytic
    >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
    >>> model = analytic.Model(surface, heights=analytic.ExponentialHeights())
    >>> float(model.mean("contacts", 1.0).round(3))
    135.335

    Asperities that press each other down:

    >>> model = analytic.Model(surface, interaction=analytic.Interaction("body"))
    >>> float(model.mean("load", 1.0).round(4)), float(model.mean("nominal_separation", 1.0).round(4))
    (0.319, 0.6981)

    Steel in air:

    >>> film, air = analytic.Film(conductivities=(16.0, 16.0)), analytic.Joint("air", rms=1.1e-6)
    >>> model = analytic.Model(surface, film=film, filled=air.gap(surface, analytic.Gaussian()))
    >>> [float(model.mean(name, 2.0).round(-2)) for name in ("contact_conductance", "joint_conductance")]
    [1300.0, 10100.0]
    """

    def cumulants(self, quantity: str, h: ArrayLike) -> Cumulants:
        """Return the mean, variance, skewness and excess kurtosis over surfaces, in the shape of `h`."""
        q, h = asked(self, quantity, h), np.asarray(h, dtype=np.float64)

        def of_one(h: Array) -> Array:
            """First four cumulants that one asperity contributes, over the scale: shape (separations, 4)."""
            part = self.fluctuations([quantity], h)
            m2, m3, m4 = (part.moment(k) for k in (2, 3, 4))
            return np.stack([part.mean, m2, m3, m4 - 3 * m2 * m2 * (self.count == "fixed")], axis=1)

        rows = self._in_parts(h, of_one)
        k1, k2, k3, k4 = np.moveaxis(rows, -1, 0) if h.size else np.empty((4, *h.shape))
        n, scale = self.number, q.scale(self.surface)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratios = k3 / k2 / np.sqrt(n * k2), k4 / k2 / (n * k2)  # long before, powers of k2 underflow
            return Cumulants(n * scale * k1, n * scale**2 * k2, *ratios)

    def std(self, quantity: str, h: ArrayLike) -> Array:
        """Return the standard deviation over surfaces, in the shape of `h`."""
        return np.sqrt(self.cumulants(quantity, h).variance)

    def covariance(self, quantities: Sequence[str], separations: ArrayLike) -> Array:
        """Return the covariance over surfaces between Q quantities at K separations.

        Returns
        -------
        ndarray
            Shape (Q, K, Q, K), in the product of the units.
        """
        h = np.asarray(separations, dtype=np.float64)
        scale = np.repeat([quantity_of(name).scale(self.surface) for name in quantities], h.size)
        matrix = self.number * self.fluctuations(quantities, h).products() * np.outer(scale, scale)
        return np.reshape(matrix, 2 * (len(quantities), h.size))

    def asperities_for(self, quantity: str, h: ArrayLike, std_over_mean: float, *, given: str = "") -> Array:
        """Return the number of asperities that a surface needs for surfaces to differ by so little.

        The mean and the variance of a sum over N independent asperities grow as N. At a given load, each
        surface has its own separation: to first order its area A then deviates by ``dA - A'/P' dP``.

        Parameters
        ----------
        quantity : str
            The quantity that differs from surface to surface.
        h : array_like
            Reduced separations, any shape.
        std_over_mean : float
            Standard deviation over surfaces, divided by the mean: 0.01 for one percent.
        given : str, optional
            Another quantity, such as "load", that is the same on all surfaces: its mean at `h`. To leading
            order.

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
        check_positive("", std_over_mean=std_over_mean)
        variance, h = self.cumulants(quantity, h).variance, np.asarray(h, dtype=np.float64)
        with np.errstate(divide="ignore", invalid="ignore"):
            if given:
                rate = self.slope(quantity, h) / self.slope(given, h)
                both = [self.covariance([quantity, given], [x])[0, 0, 1, 0] for x in h.ravel().tolist()]
                apart = rate * self.cumulants(given, h).variance - 2 * np.reshape(both, h.shape)
                variance = np.maximum(variance + rate * apart, 0.0)
            return np.asarray(self.number * variance / (self.mean(quantity, h) * std_over_mean) ** 2)

    def fluctuations(self, quantities: Sequence[str], separations: ArrayLike) -> Fluctuations:
        """Return what one asperity adds to each quantity at each separation, over its scale, in columns.

        To leading order where a surface answers by itself.
        """
        several = [asked(self, name, separations) for name in quantities]
        h = np.asarray(separations, dtype=np.float64)
        if any(answer_of(self, q) for q in several):
            return self._answered(several, h)
        rule = self.rule(h, quantities)
        terms = rule.terms(quantities, h, self.grading, self.ways)
        result = rule.fluctuations(terms, self.count)
        if not isinstance(self.curvature, RandomCurvature) or np.isfinite(self.curvature.largest):
            return result
        return replace(result, radius=np.repeat([q.radius for q in several], h.size))

    def _answered(self, several: Sequence[Quantity], h: Array) -> Fluctuations:
        """Return the fluctuations of what follows from sums of the asperities."""
        answers = [answer_of(self, q) or Answer(q.name, "") for q in several]
        named = [each.spots or each.load for each in answers] + [each.load for each in answers if each.sunk]
        columns, alone = list(dict.fromkeys(named)), self.alone
        rates, means = np.zeros((len(columns), len(answers), h.size)), []
        for k, (q, answer) in enumerate(zip(several, answers, strict=True)):
            unit, (mean, slopes) = q.scale(self.surface), answer.mean(alone, h)
            means.append(mean / (self.number * unit))
            for term, rate in zip((answer.spots, answer.load), slopes, strict=True):
                if term in columns:
                    rates[columns.index(term), k] += rate * quantity_of(term).scale(self.surface) / unit
        axes = np.einsum("sqk,kl->skql", rates, np.eye(h.size)).reshape(len(columns) * h.size, -1)
        one: Fluctuations = alone.fluctuations(columns, h).turned(axes)
        return replace(one, mean=np.concatenate(means))

    def distribution(self, quantity: str, h: float) -> Law:
        """Return the exact distribution over surfaces of a quantity at a separation, as one of `scipy.stats`.

        Parameters
        ----------
        h : float
            Reduced separation.

        Returns
        -------
        Law
            With cdf, sf, pdf (for a number of asperities, its probability), ppf, isf, interval, rvs, mean,
            var and std, in the unit of the quantity; `atom`, the probability of no contact; and `error`, the
            error bound of cdf.

        Examples
        --------
        >>> import analytic
        >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
        >>> law = analytic.Model(surface).distribution("load", 2.0)
        >>> (law.ppf([0.05, 0.5, 0.95]) / law.mean()).round(4)
        array([0.489 , 0.9659, 1.6275])
        """
        from analytic.exact_law import distribution_of  # few ask

        answer = answer_of(self, asked(self, quantity, h))
        if answer is None:
            return distribution_of(self, quantity, float(h))
        if quantity in JOINT and (answer.sunk or not answer.spots):
            raise ValueError(
                f"quantity = {quantity!r}: only 'joint_conductance' is known, for surfaces with one distance "
                "of mean planes"
            )
        return answer.law(self.alone, float(h))

    def separation_law(self, load: float, quantity: str = "load") -> Law:
        """Return the exact distribution of the separation at a given load: P(h* <= h) = P(S(h) <= load).

        Parameters
        ----------
        load : float
            Load on each surface, N.
        quantity : str, optional
            Another sum to be given instead of the load, in its unit; it must fall with the separation.

        Returns
        -------
        Law
            As `distribution`, of d/sigma.

        Raises
        ------
        ValueError
            If asperities adhere: several separations may then have the same load.
        """
        from analytic.exact_law import separation_law_of

        return separation_law_of(self.alone, load, quantity)
