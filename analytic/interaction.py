"""How asperities press each other down: all loads together lower the plane that each of them feels.

The loads of all asperities sink the half-space under them. Mean-field (Ciavarella, Greenwood and Paggi,
Wear 265 (2008) 729; constants derived anew, the paper was not at hand): each asperity feels the separation ::

    d_effective = d_nominal + compliance * P

with the load P of this very surface. At a given load nothing but the separation differs from a surface of
independent asperities: the same area, contacts, conductance. What the separation is measured from decides
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
from typing import Any, Literal

from analytic.surface import Surface

Reference = Literal["body", "mean-plane"]

# Mean sinking of a square of side L under the pressure p, over p L/E*: (4 asinh 1 - 4/3 (sqrt 2 - 1))/pi.
BOWL = (4 * math.asinh(1) - 4 / 3 * (math.sqrt(2) - 1)) / math.pi
# Potential at a point of a square lattice in a neutral background, over charge/side: -4 zeta(1/2) beta(1/2).
LATTICE = 3.900264920001956


def in_series(stiffness: Any, compliance: float) -> Any:
    """Stiffness of asperities, N/m, in series with a compliance, m/N; back again with the opposite one."""
    return stiffness / (1 + compliance * stiffness)


@dataclass(frozen=True, slots=True)
class Interaction:
    """Asperities that feel the load of all others.

    Parameters
    ----------
    reference : {"body", "mean-plane"}
        What the nominal separation is measured from: the undeformed body, or the mean deformed plane.
    at : {"effective", "nominal"}, optional
        Which separations a scene or a model is given: those that its asperities feel, at which the nominal
        one follows without a solver; or nominal ones, at which each surface finds its own balance.
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
    at: Literal["effective", "nominal"] = "effective"
    bulk_modulus: float | None = None

    def __post_init__(self) -> None:
        for key, words in (("reference", ("body", "mean-plane")), ("at", ("effective", "nominal"))):
            if getattr(self, key) not in words:
                raise ValueError(f'{key} = {getattr(self, key)!r}: give "{words[0]}" or "{words[1]}"')
        modulus = self.bulk_modulus
        if modulus is not None and not (math.isfinite(modulus) and modulus > 0):
            raise ValueError(f"bulk_modulus = {modulus!r}: give a finite number > 0, in Pa")

    @property
    def nominal(self) -> bool:
        """Whether separations are given as nominal ones."""
        return self.at == "nominal"

    def compliance(self, surface: Surface, n_asperities: float) -> float:
        """How much farther down asperities feel the plane for each newton on the surface, m/N."""
        modulus = surface.E_star if self.bulk_modulus is None else self.bulk_modulus
        if self.reference == "body":
            return BOWL / (modulus * math.sqrt(surface.nominal_area))
        return -LATTICE / (math.pi * modulus * math.sqrt(n_asperities * surface.nominal_area))
