"""Rough surfaces: five parameters, from two bodies or from the spectral moments of a map."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from numbers import Real
from typing import Any

LEAST_ALPHA = 1.5  # of an isotropic surface: all its waves have one length
# Variance of the summit heights is (1 - 0.8968/alpha) m0 (Bush, Gibson and Thomas 1975), exactly:
SUMMIT_SPREAD = 1 + 16 / math.pi - 3 * math.sqrt(3)


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
    """Return the composite modulus of two bodies in contact.

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


def check_positive(unit: str, **values: Any) -> None:
    """Refuse values that are no finite numbers > 0; texts, which only scene files read, are none."""
    for name, value in values.items():
        if value is not None and not (isinstance(value, Real) and 0 < float(value) < math.inf):
            raise ValueError(f"{name} = {value!r}: give a finite number > 0{unit and f', in {unit}'}")


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
        names = ("sigma", "radius", "eta", "nominal_area", "E_star")
        check_positive("", **{name: getattr(self, name) for name in names})

    @property
    def n_asperities(self) -> float:
        """Expected number of asperities, eta A_n."""
        return self.eta * self.nominal_area


@dataclass(frozen=True, slots=True)
class SpectralMoments:
    """Mean squares of height, slope and second derivative of a profile.

    Parameters
    ----------
    m0, m2, m4 : float
        m^2, 1, 1/m^2; positive.

    Raises
    ------
    ValueError
        If one is not a positive finite number.

    Examples
    --------
    >>> moments = SpectralMoments(1e-12, 1e-3, 5e6)
    >>> round(moments.alpha, 9)
    5.0
    >>> moments.surface(1e-6, 1e9).eta == moments.eta
    True
    """

    m0: float
    m2: float
    m4: float

    def __post_init__(self) -> None:
        check_positive("", **asdict(self))

    @classmethod
    def with_alpha(cls, alpha: float, summits: Surface) -> "SpectralMoments":
        """Return those of the Gaussian surface whose summits have this alpha, sigma and radius."""
        m0, m4 = summits.sigma**2 / (1 - SUMMIT_SPREAD / alpha), 9 * math.pi / (64 * summits.radius**2)
        return cls(m0, math.sqrt(m0 * m4 / alpha), m4)

    @property
    def alpha(self) -> float:
        """Bandwidth ``m0 m4/m2^2``: at least 1.5 for an isotropic surface."""
        return self.m0 * self.m4 / self.m2**2

    @property
    def eta(self) -> float:
        """Summits per area, ``m4/(6 sqrt(3) pi m2)``, 1/m^2."""
        return self.m4 / (6 * math.sqrt(3) * math.pi * self.m2)

    @property
    def radius(self) -> float:
        """Inverse of the mean summit curvature, ``3 sqrt(pi)/(8 sqrt(m4))``, m."""
        return 3 * math.sqrt(math.pi) / (8 * math.sqrt(self.m4))

    @property
    def sigma(self) -> float:
        """Standard deviation of the summit heights, ``sqrt((1 - 0.8968/alpha) m0)``, m."""
        return math.sqrt(max(1 - SUMMIT_SPREAD / self.alpha, 0.0) * self.m0)

    @property
    def mean_height(self) -> float:
        """Mean height of the summits above the mean plane, ``4 sqrt(m0/(pi alpha))``, m."""
        return 4 * math.sqrt(self.m0 / (math.pi * self.alpha))

    def surface(self, nominal_area: float, E_star: float) -> Surface:
        """Return the rough surface with these summits.

        Parameters
        ----------
        nominal_area, E_star : float
            m^2, and the composite modulus, Pa.

        Returns
        -------
        Surface
            Its radius is the inverse of the mean summit curvature.

        Raises
        ------
        ValueError
            If no isotropic Gaussian surface has such moments.
        """
        if not self.alpha >= LEAST_ALPHA:
            raise ValueError(
                f"m0, m2, m4: alpha = m0 m4/m2^2 = {self.alpha:.4g}, and an isotropic Gaussian surface has "
                "at least 1.5; give a larger m0 or m4, or a smaller m2"
            )
        return Surface(self.sigma, self.radius, self.eta, nominal_area, E_star)
