"""A surface from numbers or from texts with units."""

import math
from collections.abc import Mapping
from typing import Any

from analytic import Body, Nayak, SpectralMoments, composite_modulus
from analytic import Surface as Plain
from mcgw.formats.units import quantity
from mcgw.scene.listed_summits import ListedSummits
from mcgw.scene.plausible import surface_in_other_units, warn_of_units
from mcgw.scene.reading import as_toml
from mcgw.scene.section import SceneError, Section
from mcgw.scene.summits_section import Spectral

__all__ = [
    "MOMENTS",
    "SURFACE_UNITS",
    "SpectralSurface",
    "Surface",
    "read_spectral",
    "read_surface",
    "surface_of",
]

MOMENTS = {"m0": "m^2", "m2": "1", "m4": "1/m^2"}
SURFACE_UNITS = {"sigma": "m", "radius": "m", "eta": "1/m^2", "nominal_area": "m^2", "E_star": "Pa"}


def Surface(  # noqa: N802 - the door to a class of this name
    sigma: float | str,
    radius: float | str,
    eta: float | str,
    nominal_area: float | str,
    E_star: float | str,
) -> Plain:
    """The equivalent rough surface of Greenwood and Williamson, pressed on a rigid plane.

    Parameters
    ----------
    sigma : float or str
        Standard deviation of the summit heights (not of the surface), m; or a text, as "1.37 um".
    radius : float or str
        Radius R of the summits, m; or as "13 um".
    eta : float or str
        Summits per unit nominal area, 1/m^2; or as "300/mm^2".
    nominal_area : float or str
        Nominal contact area A_n, m^2; or as "1 cm^2".
    E_star : float or str
        Composite modulus E* of the homogeneous surface, Pa; or as "78.6 GPa".

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
    given = {"sigma": sigma, "radius": radius, "eta": eta, "nominal_area": nominal_area, "E_star": E_star}
    return surface_of(given)


def SpectralSurface(  # noqa: N802 - as above
    m0: float | str,
    m2: float | str,
    m4: float | str,
    nominal_area: float | str,
    E_star: float | str,
) -> Spectral:
    """An isotropic Gaussian surface, told by the moments of its spectrum, pressed on a rigid plane.

    Parameters
    ----------
    m0 : float or str
        Mean square of the heights of the surface, m^2.
    m2 : float
        Mean square of the slope of a profile.
    m4 : float or str
        Mean square of the second derivative of a profile, 1/m^2.
    nominal_area : float or str
        Nominal contact area A_n, m^2; or as "1 cm^2".
    E_star : float or str
        Composite modulus E*, Pa; or as "78.6 GPa".

    Returns
    -------
    Spectral
        To be the surface of a `mcgw.Scene`, whose heights are then Nayak's, and whose summits have radii of
        their own.

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
    given = {"m0": m0, "m2": m2, "m4": m4, "nominal_area": nominal_area, "E_star": E_star}
    section = Section("surface", {key: as_toml(value) for key, value in given.items()}, [])
    spectral = read_spectral(section)
    if spectral is None:
        raise SceneError(section.problems)
    return spectral


def surface_of(given: Mapping[str, Any]) -> Plain:
    """The surface of these five parameters, numbers or texts with units.

    Raises
    ------
    SceneError
        With one line for each mistake.
    """
    section = Section("surface", {key: as_toml(value) for key, value in given.items()}, [])
    surface = read_surface(section)
    if surface is None:
        raise SceneError(section.problems)
    warn_of_units(surface_in_other_units(surface))
    return surface


def read_surface(section: Section, listed: ListedSummits | None = None) -> Plain | None:
    """Read the table [surface]; mistakes are noted in the section, and give None.

    What summits that are `listed` tell can be left out.
    """
    told = {} if listed is None else _told(section, listed)
    values = told | _values(section, {key: unit for key, unit in SURFACE_UNITS.items() if key not in told})
    return None if any(map(math.isnan, values.values())) else Plain(**values)


def _told(section: Section, listed: ListedSummits) -> dict[str, float]:
    """The nominal area, and what summits tell on it that the section leaves out."""
    area = section.number("nominal_area", unit="m^2")
    told = listed.of_surface(area)
    section.known(*told)
    return {"nominal_area": area, **{key: told[key] for key in told if key not in section}}


def read_spectral(section: Section) -> Spectral | None:
    """Read [surface] with m0, m2, m4 for sigma, radius, eta; mistakes are noted, and give None."""
    values = _values(section, {**MOMENTS, "nominal_area": "m^2", "E_star": "Pa"})
    for key in ("sigma", "radius", "eta"):
        if key in section:
            section.fail(key, section.take(key), "give either m0, m2, m4, or sigma, radius, eta")
    if any(map(math.isnan, values.values())):
        return None
    try:
        moments = SpectralMoments(*(values[key] for key in MOMENTS))
        Nayak(moments.alpha)
        return Spectral(moments, moments.surface(values["nominal_area"], values["E_star"]))
    except ValueError as error:
        section.problems.append(f"surface: {error}")
        return None


def _values(section: Section, units: Mapping[str, str]) -> dict[str, float]:
    """Numbers by their keys; E_star may be told by two bodies."""
    return {
        key: _bodies(section) if key == "E_star" and "bodies" in section else section.number(key, unit=unit)
        for key, unit in units.items()
    }


def _bodies(section: Section) -> float:
    given = section.take("bodies")
    if "E_star" in section:
        section.fail("E_star", section.take("E_star"), "give either E_star or bodies, not both")
    try:
        return composite_modulus([_body(**body) for body in given])
    except (TypeError, ValueError) as error:
        reason = str(error) if type(error) is ValueError else "each needs E in Pa and may have nu"
        section.fail("bodies", given, f"give two, as [{{E = 70e9, nu = 0.33}}, {{E = inf}}]; {reason}")
        return math.nan


def _body(E: float | str, **nu: float) -> Body:
    if any(isinstance(value, str | bool) for value in nu.values()) or isinstance(E, bool):
        raise TypeError
    return Body(quantity(E, "Pa", "E"), **nu)
