"""Asperity interaction: all loads together lower the plane that each asperity feels.

The loads of all asperities sink the half-space under them. Mean-field (Ciavarella, Greenwood and Paggi,
Wear 265 (2008) 729; constants derived independently, the paper was not available): each asperity feels the
separation ::

    d_effective = d_nominal + compliance * P

with the load P of this very surface. At a given load, only the separation differs from that of independent
asperities; area, contacts and conductance of the spots are the same. The reference of the separation decides
the sign:

``body``        the undeformed body far away. The load, spread over the nominal area, presses a bowl into
                the half-space: ``compliance = c/(E_b sqrt(A_n))``, c the mean sinking of a square under a
                uniform pressure. The asperities feel less than the nominal approach.
``mean-plane``  the mean of the deformed plane, as in a periodic cell or far inside a large contact. Of the
                sinking only that counts by which it differs from its mean: a summit lies outside the dent of
                every other one, so ``compliance = -M/(E_b sqrt(N A_n))``, M that of a square lattice of
                point loads. The asperities feel more than the nominal approach.

At effective separations x loads, areas and numbers are those of independent asperities, exactly. The others
follow, surface by surface, from its own sum S of stiffnesses or conductances and its load P ::

    y = S/(1 + c S) + g(x - k P),    Q = y/(1 + b y)

with the half-space in series (c), the nominal separation ``x - k P`` itself or what the gas conducts there
(g), and the bodies in series with spots beside gas (b). Film, layer and neighbours are inside S. Means are to
second order in what surfaces differ by, fluctuations to leading order.
"""

import math
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from functools import partial
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.distribution import Law
from analytic.quadrature import fall_of
from analytic.quantities import JOINT, NOT_SUMS, SEPARATIONS, Quantity, quantity_of
from analytic.surface import Surface, check_positive

Reference = Literal["body", "mean-plane"]

# Mean sinking of a square of side L under the pressure p, over p L/E*: (4 asinh 1 - 4/3 (sqrt 2 - 1))/pi.
BOWL = (4 * math.asinh(1) - 4 / 3 * (math.sqrt(2) - 1)) / math.pi
# Potential at a point of a square lattice in a neutral background, over charge/side: -4 zeta(1/2) beta(1/2).
LATTICE = 3.900264920001956


def in_series(value: Any, other: float) -> Any:
    """Stiffness or conductance in series with what resists besides; nan where less than nothing would."""
    rest = 1 + other * value
    return value / np.where(rest > 0, rest, np.nan)


@dataclass(frozen=True, slots=True)
class Interaction:
    """Asperity interaction through the half-space, as a mean field.

    Parameters
    ----------
    reference : {"body", "mean-plane"}
        What the nominal separation is measured from: the undeformed body, or the mean deformed plane.
        Separations given are those that the asperities feel, so that the nominal ones follow without a
        solver.
    bulk_modulus : float, optional
        Composite modulus of the half-space E_b, Pa, where it is not that of the asperities.

    Raises
    ------
    ValueError
        If a word is another one, or the modulus is not a positive finite number.

    Examples
    --------
    >>> import analytic
    >>> surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
    >>> punch = analytic.Interaction("body")
    >>> round(punch.compliance(surface, surface.n_asperities) * 1e6, 4)  # m/N, times N
    0.9464
    """

    reference: Reference
    _: KW_ONLY
    bulk_modulus: float | None = None

    def __post_init__(self) -> None:
        if self.reference not in get_args(Reference):
            raise ValueError(f'reference = {self.reference!r}: give "body" or "mean-plane"')
        check_positive("Pa", bulk_modulus=self.bulk_modulus)

    def compliance(self, surface: Surface, n_asperities: float) -> float:
        """Return how far each newton on the surface lowers the plane that the asperities feel, m/N."""
        modulus = self.bulk_modulus or surface.E_star  # of the half-space
        if self.reference == "body":
            return BOWL / (modulus * math.sqrt(surface.nominal_area))
        return -LATTICE / (math.pi * modulus * math.sqrt(n_asperities * surface.nominal_area))

    def series(self, quantity: str, surface: Surface, n_asperities: float, resistivity: float = 1.0) -> float:
        """Return what the half-space adds to the inverse of a sum over spots, over its unit; 0 to most sums.

        To that of a stiffness the compliance; to that of a conductance ``rho E_b/2`` of it, by which both
        bodies constrict the flux as a whole. For a homogeneous body then ``C rho = 2 K/E*``.

        Parameters
        ----------
        resistivity : float, optional
            rho of both bodies, for a conductance that is not given times it.

        Notes
        -----
        Source: J. R. Barber, Proc. R. Soc. Lond. A 459 (2003) 53: ``C rho = 2 K/E*`` of rough bodies.
        """
        q = quantity_of(quantity)
        name = q.unloading or q.of or q.name
        compliance = self.compliance(surface, n_asperities) * (surface.nominal_area if q.of else 1.0)
        flux = (self.bulk_modulus or surface.E_star) * compliance / 2
        added = {"stiffness": compliance, "load_slope": compliance, "conductance": flux}
        return {**added, "conductance_si": flux * resistivity}.get(name, 0.0)

    def bodies(self, surface: Surface, resistivity: float) -> float:
        """Return how the bodies as a whole resist the flux through a unit area of the joint, m^2 K/W.

        Parameters
        ----------
        resistivity : float
            rho of both bodies, m K/W.

        Returns
        -------
        float
            ``0.4732 rho sqrt(A_n)``, half the mean sinking of a square times rho; 0 from the mean plane, far
            inside a larger contact.
        """
        return BOWL / 2 * resistivity * math.sqrt(surface.nominal_area) if self.reference == "body" else 0.0


@dataclass(frozen=True)
class Answer:
    """How a quantity of a surface follows from a sum S over its spots and its load P."""

    spots: str  # name of S; none of it counts if that is empty
    load: str  # name of P, on the same way
    per: float = 1.0  # area that S counts for
    series: float = 0.0  # c
    sunk: float = 0.0  # k
    bodies: float = 0.0  # b
    at_plane: Callable[[Array], Array] | None = None  # g of separations

    def mean(self, model: Any, h: Array) -> tuple[Array, Array]:
        """Mean over surfaces, to second order, and derivatives of the value by S and P at their means."""
        y, (slopes, bends) = np.zeros(h.shape), np.zeros((2, 2, *h.shape))
        if self.spots:
            alone = model.mean(self.spots, h)
            y, whole = in_series(alone, self.series) / self.per, 1 + self.series * alone
            slopes[0], bends[0] = whole**-2.0 / self.per, -2 * self.series * whole**-3.0 / self.per
        if self.at_plane:
            x = h - self.sunk * model.mean(self.load, h) if self.sunk else h
            y = y + self.at_plane(x)
            if self.sunk:
                fall = partial(fall_of, self.at_plane)
                slopes[1], bends[1] = self.sunk * fall(x), self.sunk**2 * fall_of(fall, x)
        whole = 1 + self.bodies * y
        bends = (bends - 2 * self.bodies * slopes**2 / whole) / whole**2
        mean = in_series(y, self.bodies)
        if self.series or self.bodies:
            mean = mean + bends[0] * model.cumulants(self.spots, h).variance / 2
        if self.sunk and self.at_plane is not np.positive:  # which is straight
            mean = mean + bends[1] * model.cumulants(self.load, h).variance / 2
        return mean, slopes / whole**2

    def law(self, model: Any, h: float) -> Law:
        """Return the distribution over surfaces, of what follows from S or P alone."""
        law: Law = model.distribution(self.spots or self.load, h)
        if not self.spots:
            return law.mapped(lambda p: h - self.sunk * p, falls=self.sunk > 0)
        gas = self.at_plane(np.asarray(h)) if self.at_plane else 0.0

        def together(spots: Array) -> Array:
            y = in_series(in_series(spots, self.series) / self.per + gas, self.bodies)
            return np.where(np.isnan(y), np.inf, y)  # from the pole on, which no surface reaches

        return law.mapped(together)


def answer_of(model: Any, q: Quantity) -> Answer | None:
    """Return how a quantity follows from sums; None if it is one itself."""
    way, how, surface = "_unloading" if q.unloading else "", model.interaction, model.surface
    load, rho = f"load{way}", 1.0 if model.film is None else model.film.rho
    if q.name in SEPARATIONS:
        return Answer("", load, sunk=model.compliance, at_plane=np.positive)
    spots = q.name
    if q.name in JOINT:
        spots = f"conductance_si{way}" if q.name.startswith("joint") else ""
    series = how.series(spots, surface, model.number, rho) if how and spots else 0.0
    if q.name not in JOINT:
        return Answer(spots, load, series=series) if series else None
    bodies = how.bodies(surface, rho) if how and spots else 0.0
    series, sunk = (0.0, 0.0) if how and how.reference == "body" else (series, model.compliance)
    return Answer(spots, load, surface.nominal_area, series, sunk, bodies, at_plane=model.filled)


def asked(model: Any, quantity: str, h: ArrayLike = np.inf) -> Quantity:
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
