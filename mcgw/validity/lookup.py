"""Measured error of the model of a scene against elasticity: its place in the table, and errors there."""

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from analytic import Gaussian, Hertz, Homogeneous, Nayak, RandomCurvature, SpectralMoments, Surface
from analytic.arrays import Array, Marks
from analytic.surface import LEAST_ALPHA, SUMMIT_SPREAD
from mcgw.formats.law_text import law_text
from mcgw.formats.table import evenly
from mcgw.validity.error_table import COLUMNS, Expected, grid_of
from mcgw.validity.model_error import Validity

_MOST_SEPARATIONS = 64
_NONE = 1.0  # contacts per surface; no statement for fewer
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


class Maps(NamedTuple):
    """A kind of maps of the table: names of x and of loads, the maps, and what lighter loads approach."""

    kind: str
    x: str
    axis: str
    words: str
    limit: str


_GAUSSIAN = Maps("gaussian", "alpha", "p/(E* g)", "Gaussian", "the limit of Bush, Gibson and Thomas")
_CAPS = Maps("caps", "eta R sigma", "p/(E* sqrt(sigma/R))", "separate caps", "Hertz's law")


def validity_of(scene: Any, separations: ArrayLike | None = None) -> Validity:
    """Look up the error of a scene's model against elasticity, at each separation once.

    Its geometry counts; a grading, a film and friction do not.
    """
    given = scene.separations if separations is None else separations
    h = np.unique(np.asarray(given, dtype=np.float64))
    h = h[evenly(len(h), _MOST_SEPARATIONS)]
    nan = np.full(len(h), np.nan)
    nothing = Validity(h, nan, dict.fromkeys(COLUMNS, nan), dict.fromkeys(COLUMNS, nan))
    if (reason := not_on_the_map(scene)) is not None:
        return replace(nothing, unknown=f"not measured: {reason}")
    maps, model, x, slope, rms = place_of(scene)
    area_only, fitted = _area_only(scene), scene.fitted
    grid = grid_of(maps.kind, model, "none" if scene.interaction is None or area_only else "summits")
    measured = f"measured: {grid.x[0]:g} to {grid.x[-1]:g}"
    if not grid.holds(x):
        return replace(nothing, unknown=f"outside the measured range ({maps.x} = {x:.4g}; {measured})")
    hertzian = replace(scene.alone, grading=Homogeneous(), unload_from=None, film=None)
    stood_on = scene.n_asperities / scene.surface.eta  # area, m^2
    p = hertzian.mean("load", h) / (scene.surface.E_star * stood_on) / slope
    contacts = scene.n_asperities * scene.heights.sf(h)
    none = contacts < _NONE
    waves = fitted.independent * stood_on / fitted.area if fitted and fitted.area else math.nan
    found = grid.expected(x, p, np.where(none, np.nan, contacts), waves)
    unit = {name: math.nan if area_only and name != "area" else 1.0 for name in COLUMNS}
    unit["separation"] *= rms
    bias = {name: unit[name] * found.bias[name] for name in COLUMNS}
    error = {name: np.abs(bias[name]) + unit[name] * found.off[name] for name in COLUMNS}
    of_density = maps is _GAUSSIAN and model == "one radius"  # alpha, unless it was given or fitted
    by = f" as eta R sigma = {crowding(scene.surface):.3g} says" if of_density else ""
    by = by if fitted is None else " from the fit"
    loads = _loads(maps, p, found)
    many = f"{found.maps} maps" if found.maps > 1 else "one map"
    where = (
        f"boundary elements on homogeneous half-spaces, {many} ({maps.words}) a point: "
        f"{maps.x} = {x:.3g}{by} ({measured}), {loads}"
        f"{f'; nothing else: {area_only}' if area_only else ''}"
    )
    graded = not isinstance(scene.modulus, Homogeneous)
    told = Validity(h, p, error, bias, graded, maps.axis, where, listed=maps is _CAPS)
    return replace(told, unknown=_unknown(told, none, loads))


def _loads(maps: Maps, p: Array, found: Expected) -> str:
    """Return loads in words, and those that were measured."""
    low, high = found.loads
    known = f"{low:.2g} to {high:.2g}" if low <= high else "nothing in common"
    lighter = f"; lighter ones approach {maps.limit}" if p.min() < low and found.lightest < low else ""
    here = " to ".join(dict.fromkeys(f"{x:.2g}" for x in (p.min(), p.max())))
    return f"{maps.axis} = {here} (measured: {known}{lighter})"


def _unknown(found: Validity, none: Marks, loads: str) -> str:
    """Why numbers are missing, if some are, as at separations where there is less than a contact."""
    if found.measured.all():
        return ""
    if none.all():
        return "not stated, with fewer than one contact per surface"
    why = ["outside the measured range"] * bool(np.any(~none & ~found.measured))
    why += ["fewer than one contact per surface"] * bool(none.any())
    return " or ".join(why) + ("" if found.measured.any() else f": {loads}")


def crowding(surface: Surface) -> float:
    """Return eta R sigma."""
    return surface.eta * surface.radius * surface.sigma


def moments_of(surface: Surface) -> SpectralMoments | None:
    """Return the Gaussian surface with this density, curvature and spread of summits; None if there is none.

    ``eta R sigma = sqrt((alpha - 0.8968)/(3 pi))/16``, as `analytic.SpectralMoments` has it.
    """
    if crowding(surface) < LEAST_CROWDING:
        return None
    return SpectralMoments.with_alpha(SUMMIT_SPREAD + (crowding(surface) / _CROWDING) ** 2, surface)


def not_on_the_map(scene: Any) -> str | None:
    """Why the model of a scene was never compared with elasticity; None if it was."""
    if type(scene.law) is not Hertz:
        return f'only for Hertz\'s law, not for contact.law = "{scene.law.name}"'
    if type(scene.heights) not in (Gaussian, Nayak):
        return f"only for Gaussian and Nayak's heights, not for {law_text(scene.heights)}"
    if scene.fitted is not None and (reason := _not_gaussian(scene.fitted, scene.surface)) is not None:
        return reason
    if isinstance(scene.heights, Nayak):
        of_alpha = SpectralMoments.with_alpha(scene.heights.alpha, scene.surface).surface(1.0, 1.0)
        found, told = crowding(of_alpha), crowding(scene.surface)
        if abs(told / found - 1) > _SAME:
            return (
                f"Gaussian surfaces of alpha = {scene.heights.alpha:.4g} have eta R sigma = {found:.3g}, but "
                f"this one has {told:.3g}"
            )
    if isinstance(scene.summits, RandomCurvature) and scene.summits.largest < _ROUND:
        return f"only for unlimited radii; here they are limited to {scene.summits.largest:.3g} R"
    return None


def _not_gaussian(fitted: Any, surface: Surface) -> str | None:
    """Why a map is unlike those that were solved, or a surface unlike its map."""
    chance = _BY_CHANCE / math.sqrt(fitted.independent)
    if fitted.lay is not None and fitted.lay > _LAID:
        why = f"lay, mean square slopes {fitted.lay:.3g} : 1"
    elif abs(fitted.skewness) > min(max(_SKEWED, chance * math.sqrt(6)), _EVER_SKEWED):
        why = f"skewness {fitted.skewness:.2f}"
    elif abs(fitted.kurtosis - 3) > max(_BULGED, chance * math.sqrt(24)):
        why = f"kurtosis {fitted.kurtosis:.2f}"
    elif fitted.agreement is None:
        why = "too few summits"
    elif fitted.agreement > _APART:
        why = f"moments and counts differ by a factor of {fitted.agreement:.3g}"
    else:
        told = fitted.moments
        pairs = ((surface.eta, told.eta), (surface.radius, told.radius), (surface.sigma, told.sigma))
        off = max(max(pair) / min(pair) if min(pair) > 0 else math.inf for pair in pairs)
        differs = f"eta, R or sigma differs from that of the map by a factor of {off:.3g}"
        return differs if off > _APART else None
    return f"the map is not isotropic and Gaussian ({why})"


def place_of(scene: Any) -> tuple[Maps, str, float, float, float]:
    """Place in the table of a scene for which `not_on_the_map` has no reason.

    The maps, and the model of its summits; Nayak's alpha, or eta R sigma of caps; by what pressures over E*
    are taken, the rms slope g or sqrt(sigma/R) of caps; and gaps of the table over sigma, sqrt(m0) or 1.
    """
    surface, fitted = scene.surface, scene.fitted
    if isinstance(scene.heights, Nayak):
        moments: SpectralMoments | None = SpectralMoments.with_alpha(scene.heights.alpha, surface)
        model = "nayak" if scene.summits is None else "own radii"
    else:
        moments, model = moments_of(surface) if fitted is None else fitted.moments, "one radius"
    if moments is None:
        return _CAPS, model, crowding(surface), math.sqrt(surface.sigma / surface.radius), 1.0
    rms = math.sqrt(moments.m0) / surface.sigma
    return _GAUSSIAN, model, moments.alpha, math.sqrt(2 * moments.m2), rms


def _area_only(scene: Any) -> str:
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
