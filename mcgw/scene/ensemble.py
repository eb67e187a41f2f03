"""How many surfaces a scene has, and how they are drawn: a part of it, and what is wrong with it."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from numpy.random import Generator, SeedSequence

import analytic
from mcgw.scene.contact import SUMS
from mcgw.scene.kinds import Either, List, Number, Table, Whole, Word
from mcgw.scene.section import key

EXACT = 1e-13  # relative error of a value that is right to the last digits
_MOST_ASPERITIES = 2**53  # counts are exact in double precision up to here
_A_CONTACT = 4.4e-9  # s: drawing 1e10 asperities, half of which touch, took 22 s


@dataclass(frozen=True)
class Promise:
    """What others may rely on, whichever sampler it is."""

    # It draws single asperities, each with a radius of its own where summits have them, by the exact laws;
    # else sums of crowds, which are a little off: ``auto`` takes it where a scene allows that.
    one_by_one: bool = True
    own_laws: bool = False  # it adds up summit by summit: each can have breaks of its own in the contact law
    needs_density: bool = False  # it draws from that of the heights, which a list of measured ones has not


PROMISES = {
    "auto": Promise(own_laws=True),  # it takes one that promises all
    "direct": Promise(own_laws=True),
    "tail": Promise(own_laws=True, needs_density=True),
    "cells": Promise(needs_density=True),
    "aggregate": Promise(one_by_one=False, needs_density=True),
}
SAMPLERS = tuple(PROMISES)


def promise_of(sampler: str) -> Promise:
    """Return what a sampler promises; one of another name, all."""
    return PROMISES.get(sampler, PROMISES["auto"])


_KNOWN_TO = "give a number > 0 and at most 0.1; beyond that there are too few contacts for an interval"
_SHARE = Number("1", high=0.1, advice=_KNOWN_TO)
_SHARES = List(
    Number("1", high=0.1, infinite=True),
    advice=f"{_KNOWN_TO}, for each separation; or inf, for no requirement",
)
_BY_NAME = Table(item=Either((_SHARES, _SHARE), _KNOWN_TO), names=(*SUMS, *analytic.UNLOADING))
_REL_ERR = Either((_BY_NAME, _SHARE), _KNOWN_TO)
_ACCURACY = Number("1", high=0.1, zero=True, advice="give a number from 0, exact, to 0.1")
_SEED = Whole(0, 2**64 - 1, "give a whole number from 0 to 2^64 - 1")


@dataclass(frozen=True)
class Sampling:
    """How many surfaces there are, of how many asperities, and how they are drawn.

    Parameters
    ----------
    n_surfaces : int, optional
        Number of surfaces M. Default: 1000; with `rel_err` the maximum number, by default 1e9.
    n_asperities : int, optional
        Asperities per surface, or their mean number if `count` is "poisson". Default: eta A_n, rounded.
    count : {"fixed", "poisson"}, optional
        "fixed" number on each surface (default), or "poisson": a window on an unbounded surface.
    seed : int, Generator or SeedSequence, optional
        Seed of the random numbers, 0 to 2^64 - 1. Default: a random one, which is recorded.
    sampler : {"auto", "direct", "tail", "cells", "aggregate"}, optional
        How surfaces are drawn; "auto" (default) uses the fastest exact way of "cells", "tail", "direct".
        Where no cells resolve grading and law, "cells" draws as "tail" does.
    keep : {"sums", "statistics"}, optional
        "sums" (default); "statistics": no surfaces, only mean, deviation and covariance, of any number of
        surfaces in the same memory.
    rel_err : float, str or dict, optional
        Draw until the half width of the 95 % interval of every mean, relative to it, is at most this; or a
        table by quantity, with one number or one for each separation.
    max_seconds : float or str, optional
        Time limit, s; the block being drawn is completed.
    accuracy : float, optional
        How far the law of each value may be from the exact one, as the largest difference of distribution
        functions, 0 (default: exact) to 0.1: "auto" may then use "aggregate" for crowded cells, whose time
        does not grow with the number of asperities.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
    >>> sampling = mcgw.Sampling(50, count="poisson", sampler="tail")
    >>> mcgw.Scene(surface, separations=[0, 2], ensemble=sampling, seed=1).count
    'poisson'
    """

    n_surfaces: int | None = key(Whole(1), "10")
    n_asperities: int | None = key(Whole(1), "100")
    count: Literal["fixed", "poisson"] = key(Word(("fixed", "poisson")), '"poisson"', "fixed")
    seed: int | Generator | SeedSequence | None = key(_SEED, "1")
    sampler: str = key(Word(SAMPLERS), '"cells"', "auto")
    keep: Literal["sums", "statistics"] = key(Word(("sums", "statistics")), '"statistics"', "sums")
    rel_err: float | str | Mapping[str, Any] | None = key(_REL_ERR, "0.01")
    max_seconds: float | str | None = key(Number("s"), "1.0")
    accuracy: float = key(_ACCURACY, "0.0", 0.0)

    def mistakes(self, scene: Any) -> Iterator[str]:
        """Numbers that cannot be counted, samplers that cannot draw the scene, and accuracies of nothing."""
        named = f'ensemble.sampler = "{self.sampler}"'
        if not 1 <= scene.n_asperities <= _MOST_ASPERITIES:
            yield (
                f"ensemble.n_asperities = {scene.n_asperities}: must lie between 1 and 2^53; "
                "change it, or surface.eta and surface.nominal_area"
            )
        if isinstance(scene.heights, analytic.MeasuredHeights):
            if PROMISES[self.sampler].needs_density:
                yield f'{named}: it draws from a density, which measured heights do not have; use "direct"'
            if scene.heights.resampled and scene.summits is None:
                yield "heights: if resampled without radii, they have a smooth law; use mcgw.HeightTable"
            wanted = {"n_asperities": len(scene.heights.heights), "n_surfaces": 1, "count": "fixed"}
            for name, value in wanted.items() if scene.as_measured else ():
                if (given := getattr(self, name)) != value:
                    yield (
                        f"ensemble.{name} = {given!r}: measured heights as they are need {value!r}; "
                        f"or set {'heights' if scene.summits is None else 'summits'}.resample = true"
                    )
        elif scene.summits is not None and not PROMISES[self.sampler].one_by_one:
            yield (
                f"{named}: sums over summits with individual radii are far from Gaussian; use "
                '"cells", or summits.curvature = "mean"'
            )
        elif scene.summits is not None and not (scene.hertzian or PROMISES[self.sampler].own_laws):
            yield (
                f"{named}: summits with individual radii have different breaks of contact.law = "
                f'"{scene.law.name}"; use sampler = "tail", or summits.curvature = "mean"'
            )
        given = self.rel_err if isinstance(self.rel_err, Mapping) else {}
        if self.rel_err == {}:
            yield "ensemble.rel_err = {}: name at least one quantity, or give one number for all"
        for name, value in given.items():
            if name not in scene.quantities:
                listed = ", ".join(scene.quantities)
                yield f"ensemble.rel_err.{name}: is not one of contact.quantities; give one of {listed}"
            if isinstance(value, tuple) and len(value) != len(scene.separations):
                yield (
                    f"ensemble.rel_err.{name}: has {len(value)} values; give one for each of "
                    f"{len(scene.separations)} separations"
                )

    def cautions(self, scene: Any) -> Iterator[str]:
        """Tell if `auto` would draw the scene for more than an hour, and the remedy."""
        soon = self.accuracy or self.max_seconds or self.rel_err is not None
        hours = scene.n_asperities * scene.n_surfaces * _A_CONTACT / 3600  # if all touch
        if hours < 1 or self.sampler != "auto" or soon:
            return
        if (hours := hours * scene.touching / scene.n_asperities) >= 1:
            yield (
                f"ensemble: {scene.n_surfaces:g} surfaces, each of {scene.touching:.3g} asperities that "
                f"touch, take about {hours:.2g} hours; give fewer, as by surface.nominal_area, or sampler = "
                '"aggregate", which takes no longer for many'
            )
