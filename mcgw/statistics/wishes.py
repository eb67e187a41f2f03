"""Advice: the fastest sampler and accuracy for a wanted error, and the number of surfaces.

A wish is kept in 95 of 100 ensembles: by the exact spread of a surface for a mean, by the exact density at it
for a quantile. For values of single surfaces it is kept in all of them.

Pairs of a sampler and an accuracy for one scene: what values of surfaces cost, and how good they are.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import ceil, inf
from time import perf_counter
from typing import Any

import numpy as np
from scipy.special import ndtri

from mcgw.ensemble.drawing import seconds_per_surface
from mcgw.ensemble.intervals import spread_of
from mcgw.sampling.asperities import summits_drawn
from mcgw.sampling.block import Sampler
from mcgw.sampling.direct import asperity_sums
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.promises import promise_of
from mcgw.scene.scene import Scene
from mcgw.scene.section import SceneError
from mcgw.scene.values import EXACT

_SHARE = 0.1  # share of a wish left to the accuracy of values
_PROBABILITY = 0.99  # probability of the wanted quantile
_FEWEST = 2000  # surfaces needed for a quantile: 20 lie beyond it
_MOST_SURFACES = 1e12
# In order of importance: there may not be time for all.
_ACCURACIES = (EXACT, 1e-6, 1e-3, 1e-2, 1e-4, 1e-5, 1e-10, 1e-8)
_LAW_ERRORS = (1e-3, 1e-4, 1e-2)
_MOST_DRAWS, _MOST_LISTED = 1e5, 3e6  # asperities of a surface that are still drawn, or listed, by themselves
_ENOUGH = 5e6  # asperities of a surface that show what more of them would cost
_SHIFTED = 1 + 1e-9  # separations of a scene that costs the same, but is another one
_LISTED = 4  # surfaces whose values are held against sums over their heights


@dataclass(frozen=True)
class Way:
    """A scene with the same law of surfaces, and its cost.

    Parameters
    ----------
    scene : Scene
        With its sampler, accuracy and law_error.
    sampler : str
        The sampler that draws.
    error : float
        Largest relative error of a value of some surfaces against the sum over their heights; nan if they
        have none, or too many to list.
    set_up, each : float
        Seconds by the clock: to prepare it, and of a surface.
    """

    scene: Scene
    sampler: str
    error: float
    set_up: float
    each: float

    def seconds(self, surfaces: float) -> float:
        """Expected wall time of some surfaces."""
        return self.set_up + surfaces * self.each


def ways_for(scene: Scene) -> Iterator[Way]:
    """Measure every usable pair for a scene, the most important first."""
    asked = replace(scene, keep="sums", accuracy=EXACT, law_error=0.0)
    tried: list[dict[str, Any]] = [{"sampler": "cells", "accuracy": accuracy} for accuracy in _ACCURACIES]
    crowds = [{"sampler": "auto", "law_error": error} for error in _LAW_ERRORS]
    tail = [{"sampler": "tail"}] if scene.touching < _MOST_DRAWS else []
    for changes in (tried[0], *tail, *tried[1:3], *crowds, *tried[3:]):
        found = _measured(asked, **changes)
        if found and (changes["sampler"] == "auto") == promise_of(found.sampler).spends:
            yield found


def _measured(scene: Scene, **changes: Any) -> Way | None:
    """Measure one pair; None if it does not suit the scene."""
    try:
        asked = scene.replace(**changes)
    except SceneError:
        return None
    sampler = sampler_of(asked)  # and its loops are compiled
    start = perf_counter()
    sampler_of(asked.replace(separations=_SHIFTED * np.array(asked.separations)))  # no cached result is used
    set_up = perf_counter() - start
    return Way(asked, sampler.name, _worst(asked, sampler), set_up, _each(asked, sampler))


def _each(scene: Scene, sampler: Sampler) -> float:
    """Seconds per surface; extrapolated for very many asperities."""
    promise = promise_of(sampler.name)
    if not promise.one_by_one or scene.touching <= _ENOUGH:
        return seconds_per_surface(scene, sampler)
    fewer = scene.replace(n_asperities=int(scene.n_asperities * _ENOUGH / scene.touching))
    return seconds_per_surface(fewer, sampler_of(fewer)) * scene.touching / fewer.touching


def _worst(scene: Scene, sampler: Sampler) -> float:
    """Largest relative error of a value of a few surfaces."""
    if not promise_of(sampler.name).one_by_one or scene.touching > _MOST_LISTED:
        return np.nan
    worst = 0.0
    for number in range(_LISTED):
        s, ratios = summits_drawn(scene, sampler, number)
        plain = asperity_sums(scene, np.array([s.size]), s, np.ones(s.size), ratios)
        for name, values in sampler.block(number, 1).sums.items():
            if name in plain:
                with np.errstate(divide="ignore", invalid="ignore"):  # no contact there: no relative error
                    worst = max(worst, float(np.nanmax(np.abs(values / plain[name] - 1), initial=0.0)))
    return worst


@dataclass(frozen=True)
class Wish:
    """A wanted accuracy.

    Parameters
    ----------
    of : {"mean", "quantile", "surfaces"}
        A mean, a quantile of 99 %, or the values of single surfaces.
    within : float
        Relative error.
    """

    of: str
    within: float

    @property
    def text(self) -> str:
        """The wish in words."""
        what = {"mean": "a mean", "quantile": "the 99 % quantile", "surfaces": "every value of a surface"}
        return f"{what[self.of]} to {self.within:g}"


WISHES = (
    *(Wish("mean", within) for within in (1e-1, 1e-2, 1e-3, 1e-4)),
    *(Wish("quantile", within) for within in (1e-1, 1e-2)),
    *(Wish("surfaces", within) for within in (1e-3, 1e-6, 1e-9)),
)


@dataclass(frozen=True)
class Advice:
    """What to run.

    Parameters
    ----------
    wish : Wish
        The wish it fulfils.
    scene : Scene
        The one to run: its sampler, accuracy, law_error and number of surfaces are the advice.
    sampler : str
        The one that draws.
    seconds : float
        Wall time on this machine.
    """

    wish: Wish
    scene: Scene
    sampler: str
    seconds: float


def advise(
    scene: Scene, h: float, ways: Sequence[Way], wishes: Iterable[Wish] = WISHES
) -> tuple[Advice, ...]:
    """The fastest way to each wish that can be fulfilled.

    Parameters
    ----------
    scene : Scene
        What to simulate.
    h : float
        Separation at which means and quantiles of its first quantity are wished for.
    ways : sequence of Way
        Those that were measured for the scene.
    wishes : iterable of Wish, optional
        Default: some of each kind.

    Returns
    -------
    tuple of Advice
        In the order of the wishes; those that no way fulfils are left out.
    """
    if not ways:
        return ()
    spread = float(spread_of(replace(scene, separations=(h,)), scene.quantities[0]).relative[0])
    of_quantile = cache(lambda: _of_quantile(scene, h))
    found = []
    for wish in wishes:
        needed, law_error = _needed(wish, scene, spread, of_quantile)
        share = 1.0 if wish.of == "surfaces" else _SHARE
        good = [
            way
            for way in ways
            if way.scene.accuracy <= share * wish.within and way.scene.law_error <= law_error
        ]
        if good and needed <= _MOST_SURFACES:
            way = min(good, key=lambda way: way.seconds(needed))
            asked = replace(way.scene, n_surfaces=ceil(needed))
            found.append(Advice(wish, asked, way.sampler, way.seconds(needed)))
    return tuple(found)


def _needed(
    wish: Wish, scene: Scene, spread: float, of_quantile: Callable[[], tuple[float, float]]
) -> tuple[float, float]:
    """Number of surfaces, and their allowed distance from the exact law."""
    if wish.of == "mean":  # which is exact whatever the law
        return max((float(ndtri(0.975)) * spread / wish.within) ** 2, 1.0), inf
    if wish.of == "quantile":
        half, density = of_quantile()
        return max((half / wish.within) ** 2, _FEWEST), _SHARE * wish.within * density
    return float(scene.n_surfaces), 0.0


def _of_quantile(scene: Scene, h: float) -> tuple[float, float]:
    """Error of a quantile from one surface, by the exact law at one separation.

    Half of its 95 % interval over the quantile, which falls with the root of the number of surfaces: order
    statistics have a normal law with its density. And the probability for a relative change of its value.
    """
    law = scene.theory.distribution(scene.quantities[0], h)
    value = float(law.ppf(_PROBABILITY))
    density = value * float(law.pdf(value))
    half = float(ndtri(0.975)) * np.sqrt(_PROBABILITY * (1 - _PROBABILITY))
    return (half / density, density) if density > 0 else (inf, 0.0)
