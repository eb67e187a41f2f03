"""Cautions about contact laws: use beyond their range, and what other plastic laws would give."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple, cast

import numpy as np

import analytic
from analytic.laws.elastic_plastic import ElasticPlastic
from mcgw.scene.scene import Scene

_DEEP = 1e-3  # share of the contacts beyond the range of a fit
_FITTED, _UNLOADED = 110.0, 170.0  # delta/delta_c up to which Kogut-Etsion, and its unloading, were fitted
_STRAINS, _WIDEST = (1e-3, 1e-2), 0.4  # largest S_y/E* and a/R of Jackson and Green's finite elements
_QUANTILES = 10_000
_REACH = 3e-10  # m, range of attraction: about an atomic distance
_MAUGIS = 2 * 16 / (9 * np.sqrt(3)) * (9 / (16 * np.pi)) ** (1 / 3)  # his number over Tabor's: 1.157
_STICKY, _STIFF = 5.0, 0.1  # JKR holds above the first Tabor number, DMT below the second
_POISSON = 0.3  # if the law of the scene has none
_RATIOS = (1 / 3, 3.0)  # ratio of moduli for which the perturbation of a coating holds


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
    law: Any = scene.law
    back = scene.unload_from is not None
    if back and law.bridge is None and (share := _share(scene, 1.0) - _share(scene, 1.25)) > 0:
        yield (
            "contact.unload_from: contacts unloaded from 1 to 1.25 critical penetrations return up to 3 "
            f"% more work than they took, because the fitted load jumps; this affects "
            f"{100 * share:.2g} % of the contacts"
        )
    for most, what, applies in ((_FITTED, "loading", True), (_UNLOADED, "unloading", back)):
        share = _share(scene, most) if applies else 0.0
        if share > _DEEP:
            yield (
                f"contact.law: {100 * share:.2g} % of the contacts are deeper than {most:g} critical "
                f"penetrations, up to which its {what} was fitted"
            )


def _share(scene: Scene, multiple: float) -> float:
    """Share of contacts deeper than a multiple of the critical penetration, at the smallest separation."""
    h, law = scene.lowest, cast(ElasticPlastic, scene.reduced_law)
    s = scene.heights.isf((np.arange(_QUANTILES) + 0.5) / _QUANTILES, h)  # share among contacts
    return float(np.mean(s - h > multiple * law.delta_c(scene.modulus(s))))


def _jackson_green(scene: Scene) -> Iterator[str]:
    """Caution about materials outside those of the finite elements, and contacts wider than theirs."""
    law: Any = scene.reduced_law
    h = scene.lowest
    e = scene.modulus(np.linspace(max(h, scene.least), scene.highest, 101))
    strains = law.yield_strain / e[e > 0] if law.yield_strain else np.empty(0)
    if strains.size and not (_STRAINS[0] <= strains.min() and strains.max() <= _STRAINS[1]):
        yield (
            f"contact.law.yield_strength over E*(s) is {strains.min():.2g} to {strains.max():.2g}; the law "
            f"was fitted from {_STRAINS[0]:g} to {_STRAINS[1]:g}"
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


def _coating(scene: Scene) -> Iterator[str]:
    law: Any = scene.law
    if not _RATIOS[0] <= law.ratio <= _RATIOS[1]:
        yield f"contact.law.ratio = {law.ratio:g}: the first-order coating law is valid from 1/3 to 3"


def _adhesion(scene: Scene) -> Iterator[str]:
    """Tabor's number ``(R w^2/(E*^2 z0^3))^(1/3)``; Maugis's (1992) is a multiple of it."""
    law: Any = scene.reduced_law  # in reduced units: it has its pull_off
    tabor = law.pull_off * scene.surface.sigma / (0.75 * np.pi ** (2 / 3) * _REACH)
    sticks = isinstance(law, analytic.JohnsonKendallRoberts)
    if tabor < _STICKY if sticks else tabor > _STIFF:
        holds = f"above {_STICKY:g}" if sticks else f"below {_STIFF:g}"
        yield (
            f'contact.law = "{law.name}" is for a Tabor number {holds}; for forces that reach '
            f"z0 = {_REACH * 1e9:g} nm it is {tabor:.3g} (Maugis's: {_MAUGIS * tabor:.3g})"
        )


_OF_LAWS: dict[Any, Callable[[Scene], Iterator[str]]] = {
    ElasticPlastic: _yielding,
    analytic.KogutEtsion: _kogut_etsion,
    analytic.JacksonGreen: _jackson_green,
    analytic.Coated: _coating,
    analytic.JohnsonKendallRoberts | analytic.DerjaguinMullerToporov: _adhesion,
}


def law_cautions(scene: Scene) -> list[str]:
    """Cautions about the contact law, one per line; none for Hertz's."""
    return [line for kind, of in _OF_LAWS.items() if isinstance(scene.law, kind) for line in of(scene)]


class OtherLaws(NamedTuple):
    """Means under other laws, Hertz's too, over those under the law of a scene, by name, at one separation.

    The separation is the middle one of the scene, d/sigma; at the critical penetration over sigma asperities
    of modulus E* yield under each law.
    """

    separation: float
    critical: float
    load: dict[str, float]
    area: dict[str, float]

    @property
    def worth(self) -> float:
        """By how much the largest of all loads of plastic laws exceeds the smallest, relative to that."""
        ratios = [1.0, *(ratio for name, ratio in self.load.items() if name != analytic.Hertz.name)]
        return max(ratios) / min(ratios) - 1


def other_laws(scene: Scene) -> OtherLaws | None:
    """Compare other laws; None if asperities do not yield or nothing touches."""
    law = scene.reduced_law
    if not isinstance(law, ElasticPlastic) or law.critical is None:
        return None
    h = sorted(scene.separations)[len(scene.separations) // 2]
    theory = replace(scene.theory, unload_from=None, film=None)
    laws = (law, *(other for other in _alike(scene, law.critical) if other.name != law.name))
    load, area = (
        {each.name: float(replace(theory, law=each).mean(name, h)) for each in laws}
        for name in ("load", "area")
    )
    own = load.pop(law.name), area.pop(law.name)
    if not min(own) > 0:
        return None
    ratios = (
        {name: x / one for name, x in each.items()} for each, one in zip((load, area), own, strict=True)
    )
    return OtherLaws(h, law.critical, *ratios)


def _alike(scene: Scene, critical: float) -> tuple[analytic.ContactLaw, ...]:
    """Plastic laws that yield at this penetration, and Hertz's."""
    poisson = getattr(scene.law, "poisson", None)
    poisson = _POISSON if poisson is None else poisson
    plain = analytic.JacksonGreen(yield_strain=1.0, critical=critical, poisson=poisson)
    strain = 2 * math.sqrt(critical * scene.surface.sigma / scene.surface.radius)
    return (
        analytic.ChangEtsionBogy(critical=critical),
        analytic.ZhaoMaiettaChang(critical=critical),
        analytic.KogutEtsion(critical=critical, poisson=poisson),
        replace(plain, yield_strain=strain / (np.pi * plain.yield_factor)),
        analytic.Hertz(),
    )
