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
"""

import math
from dataclasses import KW_ONLY, dataclass
from typing import Any, Literal, get_args

import numpy as np

from analytic.quantities import quantity_of
from analytic.surface import Surface

Reference = Literal["body", "mean-plane"]

# Mean sinking of a square of side L under the pressure p, over p L/E*: (4 asinh 1 - 4/3 (sqrt 2 - 1))/pi.
BOWL = (4 * math.asinh(1) - 4 / 3 * (math.sqrt(2) - 1)) / math.pi
# Potential at a point of a square lattice in a neutral background, over charge/side: -4 zeta(1/2) beta(1/2).
LATTICE = 3.900264920001956


def in_series(value: Any, other: float) -> Any:
    """Stiffness or conductance of the spots in series with what resists besides, over its unit.

    Back again with the opposite one; nan where less than nothing would resist in all.
    """
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
        modulus = self.bulk_modulus
        if modulus is not None and not (math.isfinite(modulus) and modulus > 0):
            raise ValueError(f"bulk_modulus = {modulus!r}: give a finite number > 0, in Pa")

    def compliance(self, surface: Surface, n_asperities: float) -> float:
        """Return how far each newton on the surface lowers the plane that the asperities feel, m/N."""
        modulus = surface.E_star if self.bulk_modulus is None else self.bulk_modulus
        if self.reference == "body":
            return BOWL / (modulus * math.sqrt(surface.nominal_area))
        return -LATTICE / (math.pi * modulus * math.sqrt(n_asperities * surface.nominal_area))

    def series(self, quantity: str, surface: Surface, n_asperities: float, resistivity: float = 1.0) -> float:
        """Return what the half-space adds to the inverse of a sum over spots, over its unit; 0 to most sums.

        To that of a stiffness the compliance; to that of a conductance ``rho E_b/2`` of it, by which both
        bodies constrict the flux as a whole. For a homogeneous body then ``C rho = 2 K/E*``.

        Parameters
        ----------
        quantity : str
            Its name.
        surface : Surface
            Its `E_star` is that of the half-space unless `bulk_modulus` is given.
        n_asperities : float
            On the surface.
        resistivity : float, optional
            rho of both bodies, for a conductance that is not given times it.

        Notes
        -----
        Source: J. R. Barber, Proc. R. Soc. Lond. A 459 (2003) 53: ``C rho = 2 K/E*`` of rough bodies.
        """
        q = quantity_of(quantity)
        name = q.unloading or q.of or q.name
        compliance = self.compliance(surface, n_asperities) * (surface.nominal_area if q.of else 1.0)
        if name in ("stiffness", "load_slope"):
            return compliance
        if name not in ("conductance", "conductance_si"):
            return 0.0
        modulus = surface.E_star if self.bulk_modulus is None else self.bulk_modulus
        return modulus * compliance / 2 * (resistivity if name == "conductance_si" else 1.0)

    def bodies(self, surface: Surface, resistivity: float) -> float:
        """Return how the bodies as a whole resist the flux through a unit area of the joint, m^2 K/W.

        Parameters
        ----------
        surface : Surface
            Whose nominal area the flux is constricted to.
        resistivity : float
            rho of both bodies, m K/W.

        Returns
        -------
        float
            ``0.4732 rho sqrt(A_n)``, half the mean sinking of a square times rho; 0 from the mean plane, far
            inside a larger contact.
        """
        return BOWL / 2 * resistivity * math.sqrt(surface.nominal_area) if self.reference == "body" else 0.0
