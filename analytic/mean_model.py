"""Means of a rough surface in contact: sums over a rule of heights and radii, by the formulas of a law."""

from collections.abc import Callable, Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.curvature import RandomCurvature
from analytic.gradings import Grading, Homogeneous
from analytic.height_rule import Count, Cuts, HeightRule
from analytic.heights import Gaussian, HeightLaw
from analytic.interaction import Interaction, answer_of, asked
from analytic.joint import Gap
from analytic.laws.branch import Branch
from analytic.laws.film import Film
from analytic.laws.law import ContactLaw, Hertz
from analytic.measured_summits import MeasuredHeights, MeasuredRadii
from analytic.quadrature import REACH, fall_of
from analytic.quantities import Quantity, quantity_of
from analytic.roots import last_separations
from analytic.surface import Surface

LOWEST = -40.0  # separation that is looked at


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
    interaction: Interaction | None = None
    filled: Gap | None = None

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
            law.unloading(0.0)
            if not np.isfinite(self.unload_from):
                raise ValueError(f"unload_from = {self.unload_from!r}: give a finite separation d/sigma")

    @property
    def number(self) -> float:
        """Asperities on a surface, or their mean number."""
        return self.surface.n_asperities if self.n_asperities is None else self.n_asperities

    @cached_property
    def alone(self) -> Any:
        """The same asperities without interaction and gas."""
        return replace(self, interaction=None, filled=None) if self.interaction or self.filled else self

    @property
    def compliance(self) -> float:
        """Of the interaction, in units of sigma: d/sigma for each newton."""
        if self.interaction is None:
            return 0.0
        return self.interaction.compliance(self.surface, self.number) / self.surface.sigma

    def mean(self, quantity: str, h: ArrayLike) -> Array:
        """Mean over surfaces: ``N scale F*_n(h)`` under Hertz's law, to 1e-13; under others to 1e-12.

        To second order in what surfaces differ by, where a surface answers by itself.

        Parameters
        ----------
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
        q = asked(self, quantity, h)
        if answer := answer_of(self, q):
            return answer.mean(self.alone, np.asarray(h, dtype=np.float64))[0]
        return self._mean(q, h)

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
        q = asked(self, quantity, h)
        if q.base == "load_slope":
            raise ValueError(f"quantity = {quantity!r}: its slope is not known; give another quantity")
        if answer_of(self, q):
            return fall_of(partial(self.mean, quantity), h)
        if q.unloading and not self.ways.law.elastic:
            if q.base != "load":
                raise ValueError(f"quantity = {quantity!r}: its slope is not known; give 'load_unloading'")
            return self.surface.sigma * self._mean(quantity_of("load_slope_unloading"), h)
        hertz = type(self.ways.law) is Hertz and q.exponent >= 1
        if hertz or isinstance(self.heights, MeasuredHeights):  # no asperity jumps
            return self._mean(q, h, slope=True)
        if q.base == "contacts":
            return self.number * self.heights.pdf(np.asarray(h, dtype=np.float64))
        return fall_of(partial(self._mean, q), h)

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

        def of(h: Array) -> Array:
            rule = self.rule(h, ["contacts"], power=1, exponent=1.0)
            branch, above = self.ways.loading.with_radii(rule.ratios), rule.heights - h[:, None]
            pieces = branch.pieces(h[:, None], above, self.grading(rule.heights)).T
            some, every = (rule.mean(np.where(kind, 1.0, 0.0)) for kind in (pieces == piece, pieces >= 0))
            with np.errstate(invalid="ignore"):
                return some / every

        return self._in_parts(h, of)

    def separation_at(self, quantity: str, value: ArrayLike) -> Array:
        """Separation at which the mean has a given value.

        Parameters
        ----------
        value : array_like
            Of the quantity, in its SI unit, any shape.

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
        q = asked(self, quantity)
        if answer_of(self, q):
            raise ValueError(f"quantity = {quantity!r}: give a load, an area or another sum of asperities")
        target = np.asarray(value, dtype=np.float64)
        if not np.all(np.isfinite(target) & (target > 0)):
            raise ValueError(f"{quantity} = {value!r}: give finite values > 0 {q.unit}")
        grid = self._grid(q)
        rough = self.rule(grid[:1], (), power=1)  # to a percent, but in tails
        with np.errstate(divide="ignore", invalid="ignore"):
            about = np.log(rough.mean(rough.terms([q.name], grid, self.grading, self.ways)))
            about += np.log(self.number * q.scale(self.surface))
            return last_separations(lambda h: np.log(self._mean(q, h)), np.log(target), grid, about, quantity)

    def rule(
        self, separations: ArrayLike, quantities: Sequence[str], cuts: Cuts | None = None, **powers: float
    ) -> HeightRule:
        """Heights and probabilities for integrals of these quantities of an asperity at these separations."""
        branches = self.ways.among(quantities)
        return HeightRule.over(
            separations, self.grading, self.heights, self.curvature, branches=branches, cuts=cuts, **powers
        )

    @cached_property
    def ways(self) -> Branch:
        """Contact law, loading history and film, in reduced units."""
        law = Hertz() if self.law is None else self.law.on(self.surface)
        return Branch(law, self.unload_from, None if self.film is None else self.film.on(self.surface))

    def _mean(self, q: Quantity, h: ArrayLike, *, slope: bool = False) -> Array:
        """Mean of a sum of asperities; or how fast it falls, as long as none jumps."""

        def of_one(h: Array) -> Array:
            rule = self.rule(h, [q.name], power=1, exponent=q.exponent + 1)  # there may be no variance
            return rule.mean(rule.terms([q.name], h, self.grading, self.ways, slope=slope))

        return self.number * q.scale(self.surface) * self._in_parts(h, of_one)

    def _in_parts(self, h: ArrayLike, function: Callable[[Array], Array]) -> Array:
        """Return what a function gives for a few separations at a time, which may share a rule."""
        most = 48 if self.ways.one_piece and self.curvature is None else 12
        most = 1 if isinstance(self.heights, MeasuredHeights) else most
        flat = np.ravel(np.asarray(h, dtype=np.float64))
        if not np.all(np.isfinite(flat)):
            raise ValueError("h: every separation must be finite")
        order, found = np.argsort(flat), []
        left = flat[order]
        while left.size:  # the lowest hardly needs what a rule leaves out
            touching = self.heights.sf(left[:most])
            few = np.count_nonzero(touching >= 1e-12 * touching[0])
            found.append(function(left[:few]))
            left = left[few:]
        rows = np.concatenate(found)[np.argsort(order)] if found else flat
        return np.asarray(rows.reshape(np.shape(h) + rows.shape[1:]))

    def _grid(self, q: Quantity) -> Array:
        """Separations from where all touches, by moduli >= 0, to where probabilities underflow."""
        top, low = min(float(self.heights.isf(np.array(1e-300), 0.0)), 1000.0), LOWEST
        near = min(top, 12.0)
        if not self.ways.law.elastic:
            s = np.linspace(max(self.heights.support[0], -REACH), near, 4001)
            negative = np.flatnonzero(self.grading(s) < 0)
            allowed = s[np.minimum(negative[-1:] + 1, s.size - 1)]
            low = float(max(self.ways.of(q.name).lowest(LOWEST), *allowed, LOWEST))
        far = np.geomspace(near, top, 25)[1:] if top > near else np.empty(0)
        grid = np.concatenate([np.linspace(LOWEST, -4, 10)[:-1], np.linspace(-4, near, 41), far])
        return np.concatenate([[low], grid[grid > low]])
