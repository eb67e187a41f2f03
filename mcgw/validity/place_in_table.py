"""Place of a scene in the table of validity: kind of surface, model, load."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from analytic import Gaussian, Hertz, Homogeneous, Nayak, RandomCurvature, SpectralMoments, Surface
from analytic.arrays import Array
from analytic.surface import LEAST_ALPHA, SUMMIT_SPREAD
from mcgw.formats.law_text import law_text
from mcgw.validity.fitted_map import Fitted, moments_of_nayak

_CROWDING = 1 / (16 * math.sqrt(3 * math.pi))  # eta R sigma over sqrt(alpha - SUMMIT_SPREAD)
LEAST_CROWDING = _CROWDING * math.sqrt(LEAST_ALPHA - SUMMIT_SPREAD)  # 0.0158: all waves have one length
_SAME = 0.05  # by which eta R sigma may differ from that of alpha
# Of 48 isotropic Gaussian maps 46 are within all of these. Lognormal and Weibull heights of a skewness of 0.2
# are not, where half of the figures were false: it moves the highest summits (runs/validation/README.md).
_SKEWED, _BULGED = 0.05, 0.1  # skewness and kurtosis - 3 that no map is too large for
_BY_CHANCE = 2.0  # of their standard deviations over maps of so many independent heights, at most
_EVER_SKEWED = 0.15  # whatever the chance: four of 24 figures were false on a Gaussian map of -0.18
_LAID, _APART = 1.5, 1.1
_ROUND = 10.0  # bound on the ratio of radii from which on it changes areas by less than 1 %


@dataclass(frozen=True)
class Place:
    """Place of a scene in the table.

    Parameters
    ----------
    kind : {"gaussian", "caps"}
        Kind of the maps: isotropic Gaussian surfaces, or separate spherical caps.
    model : {"one radius", "nayak", "own radii"}
        Model of its summits.
    interaction : {"none", "summits", "contacts"}
        How asperities interact.
    x : float
        Nayak's alpha of Gaussian surfaces, eta R sigma of caps.
    slope : float
        By which pressures over E* are taken: the rms slope g, or sqrt(sigma/R) of caps.
    rms : float
        By which gaps of the table are taken, over sigma: sqrt(m0), or 1 for caps.
    area_only : str
        Why only the area at a given load is known, in words; else empty.
    correlation_area : float
        Nominal area for each independent height, m^2; nan where no fit saw it.
    """

    kind: str
    model: str
    interaction: str
    x: float
    slope: float
    rms: float
    area_only: str = ""
    correlation_area: float = math.nan


def moments_of(surface: Surface) -> SpectralMoments | None:
    """Return the Gaussian surface with this density, curvature and spread of summits; None if there is none.

    ``eta R sigma = sqrt((alpha - 0.8968)/(3 pi))/16``, as `analytic.SpectralMoments` has it.
    """
    crowding = surface.eta * surface.radius * surface.sigma
    if crowding < LEAST_CROWDING:
        return None
    return moments_of_nayak(surface, SUMMIT_SPREAD + (crowding / _CROWDING) ** 2)


def not_on_the_map(scene: Any) -> str | None:
    """Why the model of a scene was never compared with elasticity; None if it was."""
    if type(scene.law) is not Hertz:
        return f'only for Hertz\'s law, not for contact.law = "{scene.law.name}"'
    if type(scene.heights) not in (Gaussian, Nayak):
        return f"only for Gaussian and Nayak's heights, not for {law_text(scene.heights)}"
    if scene.fitted is not None and (reason := _not_gaussian(scene.fitted, scene.surface)) is not None:
        return reason
    if isinstance(scene.heights, Nayak):
        found, told = (s.eta * s.radius * s.sigma for s in (_of_alpha(scene), scene.surface))
        if abs(told / found - 1) > _SAME:
            return (
                f"Gaussian surfaces of alpha = {scene.heights.alpha:.4g} have eta R sigma = {found:.3g}, but "
                f"this one has {told:.3g}"
            )
    if isinstance(scene.summits, RandomCurvature) and scene.summits.largest < _ROUND:
        return f"only for unlimited radii; here they are limited to {scene.summits.largest:.3g} R"
    return None


def _not_gaussian(fitted: Fitted, surface: Surface) -> str | None:
    """Why a map is unlike those that were solved, or a surface unlike its map."""
    if fitted.lay is not None and fitted.lay > _LAID:
        why = f"lay, mean square slopes {fitted.lay:.3g} : 1"
    elif abs(fitted.skewness) > min(
        max(_SKEWED, _BY_CHANCE * math.sqrt(6 / fitted.independent)), _EVER_SKEWED
    ):
        why = f"skewness {fitted.skewness:.2f}"
    elif abs(fitted.kurtosis - 3) > max(_BULGED, _BY_CHANCE * math.sqrt(24 / fitted.independent)):
        why = f"kurtosis {fitted.kurtosis:.2f}"
    elif fitted.agreement is None:
        why = "too few summits"
    elif fitted.agreement > _APART:
        why = f"moments and counts differ by a factor of {fitted.agreement:.3g}"
    elif (off := fitted.off(surface)) > _APART:
        return f"eta, R or sigma differs from that of the map by a factor of {off:.3g}"
    else:
        return None
    return f"the map is not isotropic and Gaussian ({why})"


def _of_alpha(scene: Any) -> Surface:
    assert isinstance(scene.heights, Nayak)
    return moments_of_nayak(scene.surface, scene.heights.alpha).surface(1.0, 1.0)


def place_of(scene: Any) -> Place:
    """Place of a scene for which `not_on_the_map` has no reason."""
    surface, fitted = scene.surface, scene.fitted
    if isinstance(scene.heights, Nayak):
        moments: SpectralMoments | None = moments_of_nayak(surface, scene.heights.alpha)
        model = "nayak" if scene.summits is None else "own radii"
    else:
        moments, model = moments_of(surface) if fitted is None else fitted.moments, "one radius"
    area_only = _apart(scene)
    interaction = "none" if scene.interaction is None or area_only else "summits"
    if moments is None:
        crowding = surface.eta * surface.radius * surface.sigma
        slope = math.sqrt(surface.sigma / surface.radius)
        return Place("caps", model, interaction, crowding, slope, 1.0, area_only)
    g, rms = math.sqrt(2 * moments.m2), math.sqrt(moments.m0) / surface.sigma
    alike = math.nan if fitted is None or fitted.area is None else fitted.area / fitted.independent
    return Place("gaussian", model, interaction, moments.alpha, g, rms, area_only, alike)


def _apart(scene: Any) -> str:
    """Why an interaction differs from that of the periodic cells, or empty; areas do not depend on it."""
    found, surface = scene.interaction, scene.surface
    if found is None:
        return ""
    if found.reference == "body":
        return "periodic cells have no undeformed body"
    if found.bulk_modulus not in (None, surface.E_star):
        return "only for a bulk with the modulus of the asperities"
    if abs(scene.n_asperities / surface.n_asperities - 1) > _SAME:
        return "only for eta nominal_area asperities"
    return ""


def reduced_pressure(scene: Any, h: Array) -> Array:
    """Load over E* and the area that the asperities stand on, without a grading, shape of `h`."""
    model = replace(scene.alone, grading=Homogeneous(), unload_from=None, film=None)
    area = scene.n_asperities / scene.surface.eta
    return np.asarray(model.mean("load", h) / (scene.surface.E_star * area))
