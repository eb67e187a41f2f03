"""Pairs of a sampler and an accuracy for one scene: what values of surfaces cost, and how good they are."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any, cast

import numpy as np

from mcgw.ensemble.drawing import seconds_per_surface
from mcgw.sampling.asperities import Listing, summits_drawn
from mcgw.sampling.block import Sampler
from mcgw.sampling.law_sums import asperity_sums
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.fields import EXACT
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene, SceneError

__all__ = ["Way", "ways_for"]

# What matters most first: there may not be time for all.
_ACCURACIES = (EXACT, 1e-6, 1e-3, 1e-2, 1e-4, 1e-5, 1e-10, 1e-8)
_LAW_ERRORS = (1e-3, 1e-4, 1e-2)
_MOST_DRAWS, _MOST_LISTED = 1e5, 3e6  # asperities of a surface that are still drawn, or listed, by themselves
_ENOUGH = 5e6  # asperities of a surface that show what more of them would cost
_SHIFTED = 1 + 1e-9  # separations of a scene that costs the same, but is another one
_LISTED = 4  # surfaces whose values are held against sums over their heights


@dataclass(frozen=True)
class Way:
    """A scene that draws the same surfaces' law, and what it costs.

    Parameters
    ----------
    scene : Scene
        With its sampler, accuracy and law_error.
    sampler : str
        The one that draws: "auto" takes one.
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
        """Expected wall time of so many surfaces."""
        return self.set_up + surfaces * self.each


def ways_for(scene: Scene) -> Iterator[Way]:
    """Measure every pair that serves a scene, one after the other, what matters most first."""
    asked = replace(scene, keep="sums", accuracy=EXACT, law_error=0.0)
    tried: list[dict[str, Any]] = [{"sampler": "cells", "accuracy": accuracy} for accuracy in _ACCURACIES]
    crowds = [{"sampler": "auto", "law_error": error} for error in _LAW_ERRORS]
    tail = [{"sampler": "tail"}] if scene.touching < _MOST_DRAWS else []
    for changes in (tried[0], *tail, *tried[1:3], *crowds, *tried[3:]):
        found = _measured(asked, **changes)
        if found and (changes["sampler"] == "auto") == promise_of(found.sampler).spends:
            yield found


def _measured(scene: Scene, **changes: Any) -> Way | None:
    """One of them; None if it does not go with the scene."""
    try:
        asked = scene.replace(**changes)
    except SceneError:
        return None
    sampler = sampler_of(asked)  # and its loops are compiled
    start = perf_counter()
    sampler_of(asked.replace(separations=_SHIFTED * np.array(asked.separations)))  # nothing kept helps
    set_up = perf_counter() - start
    return Way(asked, sampler.name, _worst(asked, sampler), set_up, _each(asked, sampler))


def _each(scene: Scene, sampler: Sampler) -> float:
    """Seconds of a surface; of one with very many asperities, from one with fewer."""
    promise = promise_of(sampler.name)
    if not promise.one_by_one or scene.touching <= _ENOUGH:
        return seconds_per_surface(scene, sampler)
    fewer = scene.replace(n_asperities=int(scene.n_asperities * _ENOUGH / scene.touching))
    return seconds_per_surface(fewer, sampler_of(fewer)) * scene.touching / fewer.touching


def _worst(scene: Scene, sampler: Sampler) -> float:
    """Largest relative error of a value of a few surfaces."""
    if (
        not promise_of(sampler.name).one_by_one
        or scene.touching > _MOST_LISTED
        or not hasattr(sampler, "mesh")
    ):
        return np.nan
    worst = 0.0
    for number in range(_LISTED):
        s, ratios = summits_drawn(scene, cast(Listing, sampler), number)
        plain = asperity_sums(scene, np.array([s.size]), s, np.ones(s.size), ratios)
        for name, values in sampler.block(number, 1).sums.items():
            if name in plain:
                with np.errstate(divide="ignore", invalid="ignore"):  # no contact there: no relative error
                    worst = max(worst, float(np.nanmax(np.abs(values / plain[name] - 1), initial=0.0)))
    return worst
