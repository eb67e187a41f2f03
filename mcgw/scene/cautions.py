"""Cautions: where a scene goes beyond the assumptions of the model. One list for every command."""

from bisect import bisect_left
from collections.abc import Iterator

import numpy as np

from analytic import Hertz
from analytic.laws import crowding_factor
from mcgw.scene.plausible import perhaps_other_units, takes_hours
from mcgw.scene.scene import Scene
from mcgw.validity.model_error import off_elasticity

_DEEP = 1e-3  # share of the contacts compressed by more than their radius
_CROWDED = 0.05  # real over nominal area: Gaussian maps and caps are far beyond 10 % of load there
_STEEP = 0.3  # contact radius over summit radius from which a paraboloid is not a sphere and strain is large
_NEIGHBOURS = 0.05  # constriction of neighbours over that of the spots
_FEW = 30.0  # contacts per surface; with fewer, single surfaces are far from Gaussian


def cautions(scene: Scene) -> list[str]:
    """Cautions about the numbers of a scene, one per line."""
    known = scene.validity()
    alone, together = "neither interact nor merge", "interact by a mean field, and do not merge"
    lines = [*off_elasticity(known, f"asperities {alone if scene.interaction is None else together}")]
    unmeasured = [] if known.measured.any() else [_crowd]
    conducts = scene.film is not None or "conductance" in scene.quantities
    conducting = [_neighbours, _thick_film, _no_answer] if conducts else []
    for caution in [*unmeasured, _depth, _numbers, *conducting]:
        lines += caution(scene)
    if type(scene.law) is not Hertz:
        from mcgw.scene.law_cautions import law_cautions  # Hertz is meant

        lines += law_cautions(scene)
    of_fit = [] if scene.fitted is None else scene.fitted.gravest
    return [*perhaps_other_units(scene), *takes_hours(scene), *of_fit, *lines]


def _crowd(scene: Scene) -> Iterator[str]:
    """Caution about contacts that interact or merge."""

    def sparse(separation: float) -> bool:
        return bool(scene.theory.mean("area_fraction", separation) <= _CROWDED)

    h = np.unique(scene.separations)
    if not sparse(h[0]):  # most scenes are throughout; the area falls with the separation
        last = h[bisect_left(h, True, key=sparse) - 1]
        apart = " (load too large if d is that of a rigid punch, too small if it is the mean gap)"
        yield (
            f"up to d/sigma = {last:.3g} more than {_CROWDED:.0%} of the nominal area is in "
            f"contact; asperities interact there{'' if scene.interaction else apart}; the error was not "
            "measured"
        )
    most = h[scene.heights.sf(h) > 0.5]
    if most.size:
        yield (
            f"up to d/sigma = {most.max():.3g} more than half of all asperities touch; contacts merge there, "
            "which the model ignores"
        )


def _depth(scene: Scene) -> Iterator[str]:
    """Caution about contacts too deep or too wide for the law."""
    surface, lowest = scene.surface, scene.lowest
    law = "Hertz" if type(scene.law) is Hertz else f'law = "{scene.law.name}"'
    ends = np.array([lowest, lowest + surface.radius / surface.sigma])
    touching, deep = scene.heights.sf(ends).tolist()
    share = deep / touching if touching > 0 else 0.0
    if share > _DEEP or surface.sigma >= surface.radius:
        many = "all" if share > 0.995 else f"{100 * share:.2g} % of the"
        yield (
            f"surface.radius = {surface.radius:g} m: at d/sigma = {lowest:g}, {many} "
            f"contacts are compressed by more than R, where {law} does not hold"
        )
    top = float(scene.heights.isf(np.array(1 / scene.n_asperities), -40.0))
    steepest = float(np.sqrt(max(top - lowest, 0.0) * surface.sigma / surface.radius))
    yields = '; metals yield much earlier: use contact.law = "kogut-etsion"'
    if steepest > _STEEP:
        yield (
            f"the highest asperities (s = {top:.1f}) have contact radii of {steepest:.2f} R at the smallest "
            f"separation, too large for {law}{yields * scene.law.elastic}"
        )


def _numbers(scene: Scene) -> Iterator[str]:
    """Cautions about few contacts, an unusual number of asperities, and negative moduli."""
    h = np.array(scene.separations)
    few = h[scene.n_asperities * scene.heights.sf(h) < _FEW]
    if few.size:
        yield (
            f"from d/sigma = {few.min():.3g} fewer than {_FEW:.0f} contacts are expected per surface, so "
            "values of single surfaces are skewed; use a larger area"
        )
    expected = scene.surface.n_asperities
    share = scene.n_asperities / expected
    if abs(share - 1) > 0.01:
        yield (
            f"{scene.n_asperities:g} asperities, not eta * nominal_area = {expected:g}: loads are for "
            f"{share:.3g} of the nominal area"
        )
    if scene.negative != "error" and scene.negative_above(scene.lowest) is not None:
        word = "set to zero" if scene.negative == "clip" else "left negative"
        yield f"the modulus is negative at heights that touch ({word}), beyond the range of the grading"


def _neighbours(scene: Scene) -> Iterator[str]:
    """Caution about constriction by neighbours (Cooper, Mikic and Yovanovich), if there is no interaction."""
    h = float(min(scene.separations))
    fraction = float(scene.theory.mean("area_fraction", h))
    if scene.interaction is not None or not 0 < fraction < 1:
        return
    gain = 1 / float(crowding_factor(fraction)) - 1
    if gain > _NEIGHBOURS:
        yield (
            f"conductance: spots are treated as independent; at d/sigma = {h:.3g} neighbours change it by "
            f"about {gain:.0%} (Cooper, Mikic and Yovanovich); include them with [interaction] reference"
        )


def _thick_film(scene: Scene) -> Iterator[str]:
    """Caution about a film that may not be thin beside its spots; electrical films are nanometres thick."""
    h, theory, film = np.array(min(scene.separations)), scene.theory, scene.film
    contacts = float(theory.mean("contacts", h))
    if film is None or not film.thermal or not film.film_resistance or not contacts > 0:
        return
    radius = float(np.sqrt(theory.mean("area", h) / contacts / np.pi))
    if (thick := film.film_resistance * 2 / film.rho) > radius / 5:
        yield (
            f"joint.film_resistance: equals that of {thick:.2g} m of the bodies, and spots have a radius "
            f"of {radius:.2g} m; unless the film is much thinner, use layer = {{thickness, conductivity}}"
        )


def _no_answer(scene: Scene) -> Iterator[str]:
    """Caution where the correction of the mean plane exceeds the resistance of the spots."""
    name = "conductance" if scene.film is None else "conductance_si"
    if (other := scene.series(name)) >= 0:
        return
    h, theory = np.unique(scene.separations), scene.theory
    spots = theory.alone.mean(name, h)  # type: ignore[attr-defined]
    if np.any(none := 1 + other * spots <= 0):
        yield (
            f"up to d/sigma = {h[none].max():.3g} {name} is nan: the correction for the mean plane exceeds "
            'the resistance of the spots; use larger separations, or reference = "body"'
        )
