"""What a rough surface is: five parameters, and the composite modulus of two bodies."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

__all__ = ["Body", "Surface", "composite_modulus"]


@dataclass(frozen=True, slots=True)
class Body:
    """Elastic constants of one of the two bodies.

    Parameters
    ----------
    E : float
        Young's modulus, Pa; ``inf`` for a rigid body.
    nu : float, optional
        Poisson's ratio, between -1 and 0.5.

    Raises
    ------
    ValueError
        If `E` is not positive or `nu` lies outside its range.

    Examples
    --------
    >>> Body(E=70e9, nu=0.33)
    Body(E=70000000000.0, nu=0.33)
    """

    E: float
    nu: float = 0.3

    def __post_init__(self) -> None:
        if not self.E > 0:
            raise ValueError(f"E = {self.E!r}: give a Young's modulus > 0 Pa (inf for a rigid body)")
        if not -1 <= self.nu <= 0.5:
            raise ValueError(f"nu = {self.nu!r}: give a Poisson's ratio between -1 and 0.5")


def composite_modulus(bodies: Sequence[Body]) -> float:
    """Composite modulus of two bodies in contact.

    Parameters
    ----------
    bodies : sequence of two Body
        The two bodies, in any order.

    Returns
    -------
    float
        ``1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2``, Pa (text after Eq. 1b of the paper).

    Raises
    ------
    ValueError
        If there are not two bodies, or both are rigid.

    Examples
    --------
    >>> rigid = Body(float("inf"))
    >>> round(composite_modulus([Body(70e9, 0.5), rigid]) / 1e9, 6)
    93.333333
    """
    if len(bodies) != 2:
        raise ValueError(f"bodies: give two of them, not {len(bodies)}")
    compliance = sum((1 - b.nu**2) / b.E for b in bodies)
    if compliance == 0:
        raise ValueError("bodies: both are rigid; one of them must be elastic")
    return 1 / compliance


@dataclass(frozen=True, slots=True)
class Surface:
    """The equivalent rough surface of Greenwood and Williamson, pressed on a rigid plane.

    Parameters
    ----------
    sigma : float
        Standard deviation of the summit heights (not of the surface), m.
    radius : float
        Radius R of the summits, m.
    eta : float
        Summits per unit nominal area, 1/m^2.
    nominal_area : float
        Nominal contact area A_n, m^2.
    E_star : float
        Composite modulus E* of the homogeneous surface, Pa.

    Raises
    ------
    ValueError
        If a parameter is not a positive finite number.
    """

    sigma: float
    radius: float
    eta: float
    nominal_area: float
    E_star: float

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not (math.isfinite(value) and value > 0):
                raise ValueError(f"{field.name} = {value!r}: give a finite number > 0")

    @property
    def n_asperities(self) -> float:
        """Expected number of asperities, eta A_n."""
        return self.eta * self.nominal_area
