"""Cautions: where a scene goes beyond the assumptions of the model, or of its contact law."""

import math
from bisect import bisect_left
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

import analytic
from analytic import Hertz
from analytic.laws import crowding_factor
from mcgw.scene.scene import Scene
from mcgw.scene.surface import perhaps_other_units
from mcgw.validity.model_error import off_elasticity

_DEEP = 1e-3  # share of the contacts compressed by more than their radius, or beyond the range of a fit
_CROWDED = 0.05  # real over nominal area: Gaussian maps and caps are far beyond 10 % of load there
_STEEP = 0.3  # contact radius over summit radius from which a paraboloid is not a sphere and strain is large
_NEIGHBOURS = 0.05  # constriction of neighbours over that of the spots
_FEW = 30.0  # contacts per surface; with fewer, single surfaces are far from Gaussian
_FITTED, _UNLOADED = 110.0, 170.0  # delta/delta_c up to which Kogut-Etsion, and its unloading, were fitted
_STRAINS, _WIDEST = (1e-3, 1e-2), 0.4  # largest S_y/E* and a/R of Jackson and Green's finite elements
_QUANTILES = 10_000
_REACH = 3e-10  # m, range of attraction: about an atomic distance
_MAUGIS = 2 * 16 / (9 * np.sqrt(3)) * (9 / (16 * np.pi)) ** (1 / 3)  # his number over Tabor's: 1.157
_STICKY, _STIFF = 5.0, 0.1  # JKR holds above the first Tabor number, DMT below the second
_RATIOS = (1 / 3, 3.0)  # ratio of moduli for which the perturbation of a coating holds


def cautions(scene: Scene) -> list[str]:
    """Cautions about the numbers of a scene, one per line."""
    known, law = scene.validity(), scene.law
    checks: list[Callable[[Scene], Iterator[str]]] = [] if known.measured.any() else [_crowd]
    checks += [_depth, _numbers]
    checks += [_conduction] if scene.film is not None or "conductance" in scene.quantities else []
    checks += [_yielding] if law.yields else []
    checks += [_OF_LAWS[law.name]] if law.name in _OF_LAWS else []
    alone, together = "neither interact nor merge", "interact by a mean field, and do not merge"
    why = f"asperities {alone if scene.interaction is None else together}"
    return [
        *perhaps_other_units(scene),
        *scene.ensemble.cautions(scene),
        *([] if scene.fitted is None else scene.fitted.gravest),
        *off_elasticity(known, why),
        *(line for check in checks for line in check(scene)),
    ]


def _crowd(scene: Scene) -> Iterator[str]:
    """Caution about contacts that interact or merge."""
    h, fraction = np.unique(scene.separations), partial(scene.theory.mean, "area_fraction")
    # The area falls with the separation.
    if crowded := bisect_left(h, True, key=lambda separation: bool(fraction(separation) <= _CROWDED)):
        apart = " (load too large if d is that of a rigid punch, too small if it is the mean gap)"
        yield (
            f"up to d/sigma = {h[crowded - 1]:.3g} more than {_CROWDED:.0%} of the nominal area is in "
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
    yields = '; metals yield much earlier: use contact.law = "kogut-etsion"' if scene.law.elastic else ""
    if steepest > _STEEP:
        yield (
            f"the highest asperities (s = {top:.1f}) have contact radii of {steepest:.2f} R at the smallest "
            f"separation, too large for {law}{yields}"
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


def _conduction(scene: Scene) -> Iterator[str]:
    """Caution about constriction by neighbours, thick films, and a mean plane that is too near."""
    h, theory, film = np.unique(scene.separations), scene.theory, scene.film
    fraction, contacts, area = (float(theory.mean(x, h[0])) for x in ("area_fraction", "contacts", "area"))
    gain = 1 / float(crowding_factor(fraction)) - 1 if 0 < fraction < 1 else 0.0
    if scene.interaction is None and gain > _NEIGHBOURS:
        yield (
            f"conductance: spots are treated as independent; at d/sigma = {h[0]:.3g} neighbours change it by "
            f"about {gain:.0%} (Cooper, Mikic and Yovanovich); include them with [interaction] reference"
        )
    if film is not None and film.thermal and film.film_resistance and contacts > 0:
        radius, thick = math.sqrt(area / contacts / math.pi), film.film_resistance * 2 / film.rho
        if thick > radius / 5:  # electrical films are nanometres thick
            yield (
                f"joint.film_resistance: equals that of {thick:.2g} m of the bodies, and spots have a radius "
                f"of {radius:.2g} m; unless the film is much thinner, use layer = {{thickness, conductivity}}"
            )
    name = "conductance" if film is None else "conductance_si"
    if (other := scene.series(name)) < 0:
        spots = theory.alone.mean(name, h)
        if np.any(none := 1 + other * spots <= 0):
            yield (
                f"up to d/sigma = {h[none].max():.3g} {name} is nan: the correction for the mean plane "
                'exceeds the resistance of the spots; use larger separations, or reference = "body"'
            )


def _yielding(scene: Scene) -> Iterator[str]:
    """State how much comparable laws differ, how many contacts have yielded, and what stiffness is."""
    named, h = f'contact.law = "{scene.law.name}"', scene.lowest
    if (others := other_laws(scene)) is not None:
        ratios = ", ".join(f"{name} {ratio:.3g}" for name, ratio in others.load.items())
        yield (
            f"{named}: laws differ by {others.worth:.0%} in load at d/sigma = {others.separation:.3g}; "
            f"ratios to this one at a critical penetration of {others.critical:.3g} sigma: {ratios}"
        )
    if (share := 1 - float(scene.theory.share(0, h))) > _DEEP:
        yield (
            f"{100 * share:.3g} % of the contacts have yielded at d/sigma = {h:g}; elastic solutions cannot "
            "check their loads and areas"
        )
    line = f"{named}: stiffness is that of initial unloading, 2 E*(s) a per contact"
    if getattr(scene.law, "bridge", "none to build") is None:
        yield f'{line}; load_slope ignores the jumps of the load (bridge = "hermite" smooths them)'
    elif {"stiffness", "load_slope"} & set(scene.quantities):
        yield f"{line}; load_slope is -dP/dd of loading"


def _kogut_etsion(scene: Scene) -> Iterator[str]:
    """State the work gained because the fits of loading and unloading do not quite match, and their ends."""
    law: Any = scene.reduced_law
    s = scene.heights.isf((np.arange(_QUANTILES) + 0.5) / _QUANTILES, scene.lowest)  # share among contacts
    deep = (s - scene.lowest) / law.delta_c(scene.modulus(s))
    back = scene.unload_from is not None
    if back and law.bridge is None and (share := np.mean((deep > 1.0) & (deep <= 1.25))) > 0:
        yield (
            "contact.unload_from: contacts unloaded from 1 to 1.25 critical penetrations return up to 3 "
            "% more work than they took, because the fitted load jumps; this affects "
            f"{100 * share:.2g} % of the contacts"
        )
    for most, what in ((_FITTED, "loading"), (_UNLOADED, "unloading"))[: 1 + back]:
        if (share := np.mean(deep > most)) > _DEEP:
            yield (
                f"contact.law: {100 * share:.2g} % of the contacts are deeper than {most:g} critical "
                f"penetrations, up to which its {what} was fitted"
            )


def _jackson_green(scene: Scene) -> Iterator[str]:
    """Caution about materials outside those of the finite elements, and contacts wider than theirs."""
    law: Any = scene.reduced_law
    h, (low, high) = scene.lowest, _STRAINS
    e = scene.modulus(np.linspace(max(h, scene.least), scene.highest, 101))
    strains = law.yield_strain / e[e > 0] if law.yield_strain else np.empty(0)
    if strains.size and not (low <= strains.min() and strains.max() <= high):
        yield (
            f"contact.law.yield_strength over E*(s) is {strains.min():.2g} to {strains.max():.2g}; the law "
            f"was fitted from {low:g} to {high:g}"
        )
    s = scene.heights.isf(np.array([_DEEP]), h)
    y, e = np.sqrt(np.maximum(s - h, 0)), scene.modulus(s)
    piece = int(np.sum(law.limits(e)[:, 0] <= s - h))
    a = float(law.radius(piece, y, e)[0]) * np.sqrt(scene.surface.sigma / scene.surface.radius)
    if a > _WIDEST:
        yield (
            f"contact.law: the largest 0.1 % of the contacts reach {a:.2g} of the summit radius; the law was "
            f"fitted up to {_WIDEST:g}"
        )


def _coated(scene: Scene) -> Iterator[str]:
    law: Any = scene.law
    if not _RATIOS[0] <= law.ratio <= _RATIOS[1]:
        yield f"contact.law.ratio = {law.ratio:g}: the first-order coating law is valid from 1/3 to 3"


def _adhesion(scene: Scene) -> Iterator[str]:
    """Tabor's number ``(R w^2/(E*^2 z0^3))^(1/3)``; Maugis's (1992) is a multiple of it."""
    law: Any = scene.reduced_law  # in reduced units: it has its pull_off
    tabor = law.pull_off * scene.surface.sigma / (0.75 * np.pi ** (2 / 3) * _REACH)
    sticks = law.name == "johnson-kendall-roberts"
    if tabor < _STICKY if sticks else tabor > _STIFF:
        holds = f"above {_STICKY:g}" if sticks else f"below {_STIFF:g}"
        yield (
            f'contact.law = "{law.name}" is for a Tabor number {holds}; for forces that reach '
            f"z0 = {_REACH * 1e9:g} nm it is {tabor:.3g} (Maugis's: {_MAUGIS * tabor:.3g})"
        )


_OF_LAWS: dict[str, Callable[[Scene], Iterator[str]]] = {
    "kogut-etsion": _kogut_etsion,
    "jackson-green": _jackson_green,
    "coated": _coated,
    "johnson-kendall-roberts": _adhesion,
    "derjaguin-muller-toporov": _adhesion,
}


class OtherLaws(NamedTuple):
    """Means under other laws, Hertz's too, over those under the law of a scene, by name."""

    separation: float  # d/sigma, the middle one of the scene
    critical: float  # penetration over sigma at which asperities of modulus E* yield under each law
    load: dict[str, float]
    area: dict[str, float]

    @property
    def worth(self) -> float:
        """By how much the largest of all loads of plastic laws exceeds the smallest, relative to that."""
        ratios = [1.0, *(ratio for name, ratio in self.load.items() if name != Hertz.name)]
        return max(ratios) / min(ratios) - 1


def other_laws(scene: Scene) -> OtherLaws | None:
    """Compare other laws; None if asperities do not yield or nothing touches."""
    law: Any = scene.reduced_law
    if not law.yields or law.critical is None:
        return None
    h, critical = sorted(scene.separations)[len(scene.separations) // 2], law.critical
    poisson = 0.3 if getattr(law, "poisson", None) is None else law.poisson
    plain = analytic.JacksonGreen(yield_strain=1.0, critical=critical, poisson=poisson)
    strain = 2 * math.sqrt(critical * scene.surface.sigma / scene.surface.radius)
    others = (  # that yield at this penetration, and Hertz's
        analytic.ChangEtsionBogy(critical=critical),
        analytic.ZhaoMaiettaChang(critical=critical),
        analytic.KogutEtsion(critical=critical, poisson=poisson),
        replace(plain, yield_strain=strain / (np.pi * plain.yield_factor)),
        Hertz(),
    )
    theory = replace(scene.theory, unload_from=None, film=None)

    def ratios(name: str) -> dict[str, float]:
        own = float(replace(theory, law=law).mean(name, h))
        alike = [other for other in others if other.name != law.name and own > 0]
        return {other.name: float(replace(theory, law=other).mean(name, h)) / own for other in alike}

    load, area = ratios("load"), ratios("area")
    return OtherLaws(h, critical, load, area) if load and area else None
