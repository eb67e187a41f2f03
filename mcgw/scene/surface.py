"""Surfaces from numbers or texts with units."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from analytic import Body as PlainBody, Nayak, SpectralMoments, Surface as Plain, composite_modulus
from mcgw.scene.keys import KEYS, POISSON, SURFACE_UNITS, YOUNG
from mcgw.scene.kinds import arguments, as_toml
from mcgw.scene.measured import MOMENTS, SUMMITS, Uncertainty
from mcgw.scene.plausible import surface_in_other_units, warn_of_units
from mcgw.scene.section import SceneError, Section


@dataclass(frozen=True)
class UncertainSurface(Plain):
    """A surface whose parameters have standard errors, those of their logarithms."""

    uncertainty: Uncertainty | None = None

    def __post_init__(self) -> None:
        Plain(*(getattr(self, key) for key in SURFACE_UNITS))  # whose numbers are checked


@dataclass(frozen=True)
class Spectral:
    """An isotropic Gaussian surface.

    Parameters
    ----------
    moments : SpectralMoments
        Moments of its spectrum.
    surface : Surface
        Its summits, with the inverse of their mean curvature as radius.
    """

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
    return PlainBody(**arguments({"E": E, "nu": nu}, {"E": YOUNG, "nu": POISSON}))


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
    given = {"sigma": sigma, "radius": radius, "eta": eta, "nominal_area": nominal_area, "E_star": E_star}
    return _read(given, uncertainty)  # type: ignore[no-any-return]


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
    given = {"m0": m0, "m2": m2, "m4": m4, "nominal_area": nominal_area, "E_star": E_star}
    return _read(given, uncertainty)  # type: ignore[no-any-return]


def _read(given: Mapping[str, Any], uncertainty: Any) -> Any:
    """Read numbers or texts with units; implausible values give a warning."""
    given = {**given, "uncertainty": uncertainty} if uncertainty is not None else given
    section = Section("surface", as_toml(given), KEYS["surface"])
    surface = read_surface(section)
    section.finish()
    if section.problems:
        raise SceneError(section.problems)
    if isinstance(surface, Plain):
        warn_of_units(surface_in_other_units(surface))
    return surface


def read_surface(section: Section, listed: Mapping[str, float] | None = None) -> Plain | Spectral | None:
    """Read the table [surface], also from m0, m2 and m4; mistakes are noted in the section and give None.

    Summits that are `listed` tell their number ``eta`` and, unless the table does, sigma and radius.
    """
    told, spectral = dict(listed or {}), [key for key in MOMENTS if key in section]
    if spectral and told:
        advice = "[summits] already lists the summits; leave it out"
        section.fail(spectral[0], section.table[spectral[0]], advice)
    modulus = "bodies" if "bodies" in section else "E_star"
    names = (*(MOMENTS if spectral else SUMMITS), "nominal_area", modulus)
    values = told | section.read_all(name for name in names if name in section or name not in told)
    uncertainty = section.read("uncertainty")
    if section.problems:
        return None
    if told and "eta" not in section:
        values["eta"] /= values["nominal_area"]
    try:
        if modulus == "bodies":
            values["E_star"] = composite_modulus(values.pop("bodies"))
        moments = SpectralMoments(*(values.pop(key) for key in MOMENTS)) if spectral else None
        if moments is not None:
            Nayak(moments.alpha)
        surface = moments.surface(**values) if moments else Plain(**values)
    except ValueError as error:
        section.problems.append(f"surface: {error}")
        return None
    if uncertainty is not None:
        surface = UncertainSurface(**asdict(surface), uncertainty=uncertainty)
    return Spectral(moments, surface) if moments else surface
