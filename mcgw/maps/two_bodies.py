"""Two rough bodies as one: the sum of two independent Gaussian surfaces is one whose moments are sums."""

from dataclasses import dataclass

from analytic import SpectralMoments
from mcgw.maps.fit import Fit
from mcgw.maps.profile_fit import ProfileFit
from mcgw.scene.measured import RoughBody, body_of
from mcgw.scene.scene import Scene
from mcgw.scene.section import SceneError
from mcgw.scene.surface import Spectral, SpectralSurface

Described = Scene | Spectral | SpectralMoments | Fit | ProfileFit


@dataclass(frozen=True)
class Pair(Spectral):
    """Two rough bodies as one rough surface on a rigid plane: the surface of a `mcgw.Scene`.

    Parameters
    ----------
    moments : SpectralMoments
        Moments of the gap.
    surface : Surface
        Its summits, with the composite modulus of the pair.
    hardness : float or None
        Hardness of the softer body, Pa; None unless it is known of both.
    conductivities : (float, float) or None
        Thermal conductivities of both bodies, W/(m K); None unless they are known.
    """

    hardness: float | None = None
    conductivities: tuple[float, ...] | None = None

    @property
    def conductivity(self) -> float | None:
        """Harmonic mean of both conductivities, ``2 k1 k2/(k1 + k2)``, W/(m K)."""
        return None if self.conductivities is None else 2 / sum(1 / k for k in self.conductivities)


def combine(
    a: Described, b: Described, *, nominal_area: float | str | None = None, E_star: float | str | None = None
) -> Pair:
    """Make the one rough surface, on a rigid plane, that stands for two rough bodies in contact.

    The gap between two independent isotropic Gaussian surfaces is such a surface: m0, m2 and m4 add.

    Parameters
    ----------
    a, b : Scene, Spectral, SpectralMoments, Fit or ProfileFit
        Scenes of one rough body each on a rigid plane, whose hardness and conductivity count too; surfaces
        from `mcgw.SpectralSurface` or `mcgw.surface_from`; fits; or moments.
    nominal_area : float or str, optional
        m^2; or text such as "1 cm^2". Default: that of both surfaces, if they are equal.
    E_star : float or str, optional
        Composite modulus of the pair, Pa. Default: ``1/(1/E_a + 1/E_b)`` of two scenes or surfaces. Each
        must have the modulus of its own body on a rigid plane, E/(1 - nu^2). Two surfaces that both already
        have the modulus of the pair would give half of it: then give it here once more.

    Returns
    -------
    Pair
        The surface of a `mcgw.Scene`, with the hardness and the conductivities that the scenes tell.

    Raises
    ------
    SceneError
        If the area or the modulus is neither given nor known of both, a scene has no spectrum, or its
        conductivities are two different ones, which a single body has not.
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
    pair = _body(a).beside(_body(b))
    if nominal_area is None:
        areas = [x.surface.nominal_area for x in (a, b) if isinstance(x, Scene | Spectral)]
        if len(areas) < 2 or areas[0] != areas[1]:
            raise SceneError(['nominal_area: is not the same known one of both; give it, such as "1 mm^2"'])
        nominal_area = areas[0]
    E_star = pair.E_star if E_star is None else E_star
    if E_star is None:
        raise SceneError(['E_star: is not known of both; give that of the pair, such as "100 GPa"'])
    m = pair.moments
    found = SpectralSurface(m.m0, m.m2, m.m4, nominal_area, E_star)
    return Pair(found.moments, found.surface, pair.hardness, pair.conductivities or None)


def _body(given: Described) -> RoughBody:
    if isinstance(given, Scene):
        try:
            return body_of(given)
        except ValueError as error:
            raise SceneError([f"combine: the scene {error}"]) from None
    if isinstance(given, Spectral):
        return RoughBody(given.moments, given.surface.E_star)
    if isinstance(given, Fit | ProfileFit | SpectralMoments):
        return RoughBody(given if isinstance(given, SpectralMoments) else given.moments)
    raise TypeError(
        "combine: give scenes, surfaces from mcgw.SpectralSurface or mcgw.surface_from, fits, or moments, "
        f"not {type(given).__name__}"
    )
