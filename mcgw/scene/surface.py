"""A surface from numbers or from texts with units."""

from analytic import Surface as Plain
from mcgw.formats.units import quantity

__all__ = ["SURFACE_UNITS", "Surface"]

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
    ValueError
        If a parameter is no positive finite quantity of that kind.

    Examples
    --------
    >>> Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa").nominal_area
    0.0001
    """
    given = {"sigma": sigma, "radius": radius, "eta": eta, "nominal_area": nominal_area, "E_star": E_star}
    return Plain(**{key: quantity(given[key], unit, key) for key, unit in SURFACE_UNITS.items()})
