"""Surfaces from numbers or texts with units, of which others were perhaps meant."""

import math
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

import analytic
from analytic import Body as PlainBody, Nayak, SpectralMoments, Surface as Plain, Table, composite_modulus
from mcgw.formats.units import parse
from mcgw.scene.keys import BODY, SURFACE_UNITS, TABLES
from mcgw.scene.kinds import as_toml
from mcgw.scene.measured import MOMENTS, Uncertainty
from mcgw.scene.section import SceneError, Section

# Values that need no question, what others are, and units that were perhaps meant. Wide: from atoms to faults
# in rock, from gels to diamond.
RANGES = {
    "sigma": (1e-10, 1e-3, "less than an atom", "higher than the summits of any ground surface", "um nm"),
    "radius": (1e-10, 0.1, "less than an atom", "too large for the radius of a summit", "um mm"),
    "eta": (1e4, 1e19, "less than one summit per square centimetre", "more than one per atom", "/mm^2"),
    "nominal_area": (1e-17, 10.0, "less than a hundred atoms", "larger than any contact", "mm^2 um^2"),
    "E_star": (1e3, 2e12, "softer than any gel", "stiffer than diamond", "GPa MPa"),
}
_HARDLY_APART = 1e-3  # d/sigma: separations that all lie so close to 0 are lengths
_SAFELY = 1e4  # factor by which the sum over all asperities stays below the largest number


@dataclass(frozen=True)
class UncertainSurface(Plain):
    """A surface whose parameters have standard errors, those of their logarithms."""

    uncertainty: Uncertainty | None = None


@dataclass(frozen=True)
class Spectral:
    """An isotropic Gaussian surface by its moments, and summits of the radius of their mean curvature."""

    moments: SpectralMoments
    surface: Plain

    @property
    def heights(self) -> Nayak:
        """Height law of its summits."""
        return Nayak(self.moments.alpha)


def Body(E: float | str, nu: float = 0.3) -> PlainBody:  # noqa: N802 - the door to a class of this name
    """Return the elastic constants of one of two bodies, for `mcgw.composite_modulus`.

    Parameters
    ----------
    E : float or str
        Young's modulus, Pa; or text such as "70 GPa"; ``inf`` for a rigid body.
    nu : float, optional
        Poisson's ratio, from -1 to 0.5.

    Returns
    -------
    analytic.Body
        In SI units.

    Raises
    ------
    SceneError
        With one line for each that is out of range.

    Examples
    --------
    >>> import mcgw
    >>> mcgw.Body("70 GPa", 0.33)
    Body(E=70000000000.0, nu=0.33)
    """
    return BODY.read("", as_toml({"E": E, "nu": nu}))  # type: ignore[no-any-return]


def Surface(  # noqa: N802 - the door to a class of this name
    sigma: float | str,
    radius: float | str,
    eta: float | str,
    nominal_area: float | str,
    E_star: float | str,
    uncertainty: Uncertainty | Mapping[str, Any] | None = None,
) -> Plain:
    """Make the equivalent rough surface of Greenwood and Williamson, pressed on a rigid plane.

    Parameters
    ----------
    sigma : float or str
        Standard deviation of the summit heights (not of the surface), m; or a text, as "1.37 um".
    radius : float or str
        Radius R of the summits, m; or text such as "13 um".
    eta : float or str
        Summits per unit nominal area, 1/m^2; or text such as "300/mm^2".
    nominal_area : float or str
        Nominal contact area A_n, m^2; or text such as "1 cm^2".
    E_star : float or str
        Composite modulus E* of the homogeneous surface, Pa; or text such as "78.6 GPa".
    uncertainty : dict, optional
        Relative standard errors of sigma, radius, eta and E_star, such as ``{"sigma": "20 %"}``, with their
        ``correlation`` in this order; `mcgw.solve` includes them in its error.

    Returns
    -------
    analytic.Surface
        In SI units.

    Raises
    ------
    SceneError
        With one line for each parameter that is not a positive finite quantity of that kind, as for
        ``[surface]`` in a file.

    Examples
    --------
    >>> import mcgw
    >>> mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa").nominal_area
    0.0001
    """
    return _read(locals())  # type: ignore[no-any-return]


def SpectralSurface(  # noqa: N802 - as above
    m0: float | str,
    m2: float | str,
    m4: float | str,
    nominal_area: float | str,
    E_star: float | str,
    uncertainty: Uncertainty | Mapping[str, Any] | None = None,
) -> Spectral:
    """Make an isotropic Gaussian surface, given by the moments of its spectrum, pressed on a rigid plane.

    Parameters
    ----------
    m0 : float or str
        Mean square of the heights of the surface, m^2.
    m2 : float
        Mean square of the slope of a profile.
    m4 : float or str
        Mean square of the second derivative of a profile, 1/m^2.
    nominal_area : float or str
        Nominal contact area A_n, m^2; or text such as "1 cm^2".
    E_star : float or str
        Composite modulus E*, Pa; or text such as "78.6 GPa".
    uncertainty : dict, optional
        Relative standard errors of m0, m2, m4 and E_star, as of `mcgw.Surface`.

    Returns
    -------
    Spectral
        The surface of a `mcgw.Scene` with Nayak's heights and individual summit radii.

    Raises
    ------
    SceneError
        With one line for each parameter that is not a positive finite quantity of that kind, or if no
        isotropic surface has such moments.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "78.6 GPa")
    >>> round(surface.moments.alpha, 9)
    5.0
    >>> mcgw.Scene(surface, separations=[0, 1, 2]).heights
    Nayak(alpha=5.0)
    """
    return _read(locals())  # type: ignore[no-any-return]


def _read(given: Mapping[str, Any]) -> Any:
    """Read numbers or texts with units; implausible values give a warning."""
    section = Section("surface", as_toml(given), TABLES["surface"].rows)  # without what is None
    surface = read_surface(section)
    if surface is None:
        raise SceneError(section.problems)
    if isinstance(surface, Plain):
        warn_of_units(surface_in_other_units(surface))
    return surface


def read_surface(section: Section, told: Mapping[str, float] | None = None) -> Plain | Spectral | None:
    """Read the table [surface], also from m0, m2 and m4; mistakes are noted in the section and give None.

    Summits that are listed have `told` their number ``eta`` and, unless the table does, sigma and radius.
    """
    others: dict[str, Any] = dict(told or {})
    spectral = [key for key in MOMENTS if key in section.table]
    if spectral and told:
        section.fail(spectral[0], "[summits] already lists the summits; leave it out")
    if "bodies" in section.values:
        others["E_star"] = section.values["bodies"]
    if told and "nominal_area" in section.values:
        others["eta"] /= section.values["nominal_area"]
    return section.make(_spectral if spectral else _surface, **others)  # type: ignore[no-any-return]


def _surface(
    sigma: float, radius: float, eta: float, nominal_area: float, E_star: Any, uncertainty: Any = None
) -> Plain:
    modulus = composite_modulus(E_star) if isinstance(E_star, tuple) else E_star
    values = sigma, radius, eta, nominal_area, modulus
    return Plain(*values) if uncertainty is None else UncertainSurface(*values, uncertainty)


def _spectral(
    m0: float, m2: float, m4: float, nominal_area: float, E_star: Any, uncertainty: Any = None
) -> Spectral:
    found = SpectralMoments(m0, m2, m4)
    try:
        Nayak(found.alpha)
    except ValueError as error:
        raise ValueError(f"m0: {error}") from None
    summits = found.sigma, found.radius, found.eta
    return Spectral(found, _surface(*summits, nominal_area, E_star, uncertainty))


def warn_of_units(doubts: Iterable[str]) -> None:
    """Ask a caller in Python, once for each text; commands tell them as notes."""
    for line in doubts:
        warnings.warn(line, UserWarning, stacklevel=1)


def perhaps_other_units(scene: Any) -> list[str]:
    """Values that are perhaps in another unit, each with what was perhaps meant."""
    found = surface_in_other_units(scene.surface)
    farthest = max(scene.separations, key=abs)
    if 0 < abs(farthest) < _HARDLY_APART:
        found.append(
            f"contact.separations: {farthest:g} sigma is almost 0; did you mean {farthest:g} m = "
            f"{farthest / scene.surface.sigma:.4g} sigma? Separations are d/sigma"
        )
    if isinstance(scene.grading, Table):
        from mcgw.scene.moduli import doubts_of_table  # for those scenes alone

        found += doubts_of_table(scene.grading, scene)
    return found


def surface_in_other_units(surface: Plain) -> list[str]:
    """Return the same of a surface alone."""
    found = []
    for key, (low, high, below, above, units) in RANGES.items():
        value, si = float(getattr(surface, key)), SURFACE_UNITS[key]
        if low <= value <= high:
            continue
        digits = value  # as people write them, from 0.01 to 9999
        while digits < 1e-2:
            digits *= 1e3
        while digits >= 1e4:
            digits /= 1e3
        texts = [f"{digits:.6g}{'' if unit[0] == '/' else ' '}{unit}" for unit in units.split()]
        meant = next(text for text in texts if low <= parse(text, si) <= high)
        found.append(
            f"surface.{key} = {value:g}: {value:g} {si} is {below if value < low else above}; "
            f"did you mean {meant} = {parse(meant, si):g}?"
        )
    return found


def scale_mistakes(scene: Any) -> Iterator[str]:
    """Products of parameters that leave the range of double precision."""
    most = np.finfo(float).max / _SAFELY / float(scene.n_asperities)
    for q in map(analytic.quantity_of, scene.quantities):
        one = math.inf
        with np.errstate(all="ignore"), suppress(OverflowError):
            one = q.scale(scene.surface)
        if not np.finfo(float).tiny * 1e12 < one < most:
            yield (
                f"surface: the {q.name} of an asperity would be {one:.3g} {q.unit}, beyond double precision; "
                "check sigma, radius and E_star"
            )
