"""Two rough bodies as one: the sum of two independent Gaussian surfaces is one whose moments are sums."""

from analytic import SpectralMoments
from mcgw.maps.fit import Fit
from mcgw.maps.profile_fit import ProfileFit
from mcgw.scene.radii import Spectral
from mcgw.scene.section import SceneError
from mcgw.scene.surface import SpectralSurface


def combine(
    a: Spectral | SpectralMoments | Fit | ProfileFit,
    b: Spectral | SpectralMoments | Fit | ProfileFit,
    *,
    nominal_area: float | str | None = None,
    E_star: float | str | None = None,
) -> Spectral:
    """Make the one rough surface, on a rigid plane, that stands for two rough bodies in contact.

    The gap between two independent isotropic Gaussian surfaces is such a surface: m0, m2 and m4 add.

    Parameters
    ----------
    a, b : Spectral, SpectralMoments, Fit or ProfileFit
        Surfaces from `mcgw.SpectralSurface` or `mcgw.surface_from`, fits, or moments.
    nominal_area : float or str, optional
        m^2; or text such as "1 cm^2". Left out: that of both surfaces, if they are equal.
    E_star : float or str, optional
        Composite modulus of the pair, Pa. Left out: ``1/(1/E_a + 1/E_b)`` of two surfaces, each of whose
        E_star is that of its body alone on a rigid plane, E/(1 - nu^2).

    Returns
    -------
    Spectral
        The surface of a `mcgw.Scene`, as from `mcgw.SpectralSurface`.

    Raises
    ------
    SceneError
        If the area or the modulus is neither given nor known of both.
    TypeError
        If something else is given.

    Examples
    --------
    >>> import mcgw
    >>> rough = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "200 GPa")
    >>> fine = mcgw.SpectralSurface(1e-14, 1e-3, 1e9, "1 mm^2", "200 GPa")
    >>> pair = mcgw.combine(rough, fine)
    >>> pair.moments.m2, pair.surface.E_star
    (0.002, 100000000000.0)
    """
    one, other = _moments(a), _moments(b)
    surfaces = [x.surface for x in (a, b) if isinstance(x, Spectral)]
    if nominal_area is None:
        areas = {x.nominal_area for x in surfaces}
        if len(surfaces) < 2 or len(areas) > 1:
            raise SceneError(['nominal_area: is not the same known one of both; give it, such as "1 mm^2"'])
        (nominal_area,) = areas
    if E_star is None:
        if len(surfaces) < 2:
            raise SceneError(['E_star: is not known of both; give that of the pair, such as "100 GPa"'])
        E_star = 1 / sum(1 / x.E_star for x in surfaces)
    sums = (one.m0 + other.m0, one.m2 + other.m2, one.m4 + other.m4)
    return SpectralSurface(*sums, nominal_area, E_star)


def _moments(body: Spectral | SpectralMoments | Fit | ProfileFit) -> SpectralMoments:
    if isinstance(body, SpectralMoments):
        return body
    if isinstance(body, Spectral | Fit | ProfileFit):
        return body.moments
    raise TypeError(
        f"combine: give surfaces from mcgw.SpectralSurface or mcgw.surface_from, fits, or moments, not "
        f"{type(body).__name__}"
    )
