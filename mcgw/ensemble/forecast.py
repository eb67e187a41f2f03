"""How many surfaces a scene needs, and how long these take.

That many follow from the exact theory of finite surfaces before any is drawn: an interval of a mean reaches
the same share of the mean in every ensemble of a scene (`mcgw.ensemble.intervals`). So the stop rule
`rel_err` needs no look at what was drawn, and cannot stop by chance before rare, stiff summits have come: the
number of surfaces is a function of the scene alone.
"""

import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import ndtri

from analytic.arrays import Array
from mcgw.ensemble.intervals import CONFIDENCE, MANY, TOO_FEW, Spread, chebyshev, spread_of
from mcgw.machine.threads import THREADS
from mcgw.sampling.block import GROUP
from mcgw.sampling.expected import expected
from mcgw.scene.scene import Scene

if TYPE_CHECKING:
    from mcgw.ensemble.ensemble import Ensemble

MOST_SURFACES = 10**9
_STEP = 16  # numbers of surfaces lie 1/16 apart
_ANY = 0.1  # stands for a share without a wish
_ROUNDS = 8  # skewness over the root of the number of contacts: at most 0.1 remains
_PER_COUNT, _PER_PRODUCT = 4e-8, 2.5e-10  # rough seconds per number and per pair, for statistics
_SHORT = 0.01  # s; times below are given in milliseconds


@dataclass(frozen=True)
class Forecast:
    """What `rel_err` needs."""

    # surfaces by quantity, shape (separations,); infinite where nothing ever touches
    needed: dict[str, Array]
    surfaces: int  # that will be drawn, at most the limit
    out_of_reach: tuple[tuple[str, float], ...]  # quantities and separations that need more than the limit

    @property
    def shortfall(self) -> str:
        """Which means miss the wanted accuracy, in words; empty if none."""
        if not self.out_of_reach:
            return ""
        name, h = self.out_of_reach[-1]
        return (
            f"{len(self.out_of_reach)} means need more surfaces than n_surfaces allows; {name} at d/sigma "
            f"= {h:g} needs {max(self.needed[name]):.2g}"
        )


def forecast(scene: Scene, spreads: Mapping[str, Spread] | None = None) -> Forecast:
    """Return the number of surfaces of a scene, a function of the scene alone.

    With `rel_err` it is the smallest of `checkpoints` with which the 95 % interval of every mean that is
    asked for reaches no farther than that share of it, but at most `n_surfaces`. A mean that would not be
    known to a factor of two with that many is not waited for. Without, it is `n_surfaces`. Its quantities
    may have known `spreads`.
    """
    if scene.rel_err is None:
        return Forecast({}, scene.n_surfaces, ())
    asked = wanted_of(scene)
    limit, spreads = scene.n_surfaces, spreads or {name: spread_of(scene, name) for name in asked}
    needed = {name: _needed(spread, asked[name]) for name, spread in spreads.items()}
    waited = [needed[name][spread.relative**2 <= limit] for name, spread in spreads.items()]
    most = max(float(n.max(initial=0.0)) for n in waited)
    surfaces = next((n for n in checkpoints(limit) if n >= most), limit)
    beyond = tuple(
        (name, h)
        for name, values in needed.items()
        for h, n in zip(scene.separations, values, strict=True)
        if n > limit
    )
    return Forecast(needed, surfaces, beyond)


def wanted_of(scene: Scene) -> dict[str, Array]:
    """Wanted relative error of each mean, shape (separations,), for quantities with a wish."""
    given: Any = {} if scene.rel_err is None else scene.rel_err
    given = given if isinstance(given, Mapping) else dict.fromkeys(scene.quantities, given)
    h = len(scene.separations)
    return {name: np.broadcast_to(np.array(x, dtype=np.float64), h) for name, x in given.items()}


def _needed(spread: Spread, asked: Array) -> Array:
    """Surfaces for which both ends of the interval lie within a share of the mean.

    None for an infinite share.
    """
    wanted = np.where(np.isinf(asked), _ANY, asked)
    with np.errstate(divide="ignore"):
        enough = np.maximum(MANY * (1 + 1e-12) / spread.effective(1), 1.0)
    n = np.maximum(enough, (spread.relative / wanted) ** 2)
    reached = np.isfinite(n)
    for _ in range(_ROUNDS):
        low, high = spread.ratio(np.where(reached, n, 1.0))
        # wanted over actual end: its distance from 1 falls with the root of n
        more = np.maximum((1 - low) / (1 - 1 / (1 + wanted)), (high - 1) / (1 / (1 - wanted) - 1))
        n = np.where(reached, np.maximum(enough, n * more**2), n)
    return np.where(
        np.isinf(asked), 0.0, np.minimum(n, (spread.relative * chebyshev() * (1 + wanted) / wanted) ** 2)
    )


def checkpoints(limit: int) -> Iterator[int]:
    """Yield allowed numbers of surfaces: multiples of 64, and `limit`."""
    n = GROUP
    while n < limit:
        yield n
        n += max(n // (_STEP * GROUP), 1) * GROUP
    yield limit


def without_rule(scene: Scene) -> Scene:
    """Return the scene with a number of surfaces in place of its stop rules, warning if they are too few."""
    found = forecast(scene)
    if found.shortfall:
        warnings.warn(found.shortfall, stacklevel=3)
    return scene.replace(n_surfaces=found.surfaces, rel_err=None, max_seconds=None)


def surfaces_at_load(scene: Scene, h: float, targets: Mapping[str, float], given: str = "load") -> float:
    """Surfaces for which 1.96 standard errors of means at a load, or area, are such shares of the means.

    Of a scene whose asperities act alone, and whose mean surface has the separation `h` there. To leading
    order in the number of asperities; one of `checkpoints`, infinite beyond 1e9.
    """
    model, needed = scene.theory, 1.0
    for name, target in targets.items():
        of_one = float(model.asperities_for(name, h, 1.0, given=given)) / scene.n_asperities
        needed = max(needed, of_one * (ndtri((1 + CONFIDENCE) / 2) / target) ** 2)
    return next((float(n) for n in checkpoints(MOST_SURFACES) if n >= needed), np.inf)


def surfaces_at_loads(scene: Scene, separations: Sequence[float], given: str) -> int:
    """Surfaces that `rel_err` asks for at the loads of the mean surface at these separations.

    One number for all is kept by load, area, stiffness and conductance, whatever the scene's quantities are.
    It warns if `n_surfaces` is too small.
    """
    asked = {name: float(share.min()) for name, share in wanted_of(scene).items()}
    if not isinstance(scene.rel_err, Mapping):
        asked = dict.fromkeys(("load", "area", "stiffness", "conductance"), min(asked.values()))
    asked = {name: share for name, share in asked.items() if name != given}
    most = max(surfaces_at_load(scene, h, asked, given) for h in separations)
    if most > scene.n_surfaces:
        warnings.warn(f"rel_err needs {most:.2g} surfaces, and n_surfaces = {scene.n_surfaces}", stacklevel=4)
    return int(min(most, scene.n_surfaces))


def before(forecast: Forecast, seconds_each: float) -> str:
    """One line: number of surfaces, time, and means that miss the wanted accuracy."""
    line = f"about {forecast.surfaces:.2g} surfaces, {in_words(forecast.surfaces * seconds_each)}"
    return f"{line}; {forecast.shortfall}" if forecast.shortfall else line


def after(ensemble: "Ensemble", scene: Scene) -> list[str]:
    """One line for each separation without contact and each mean that misses the wanted accuracy."""
    m, n = ensemble.n_surfaces, ensemble.scene.n_asperities
    silent = np.all([ensemble.mean(name) == 0 for name in ensemble.scene.quantities], axis=0)
    limit = upper_contacts(m)
    lines = [
        f"d/sigma = {h:g}: no contact in {m} surfaces, mean below {limit:.3g} contacts per surface, "
        f"{limit / n:.3g} per asperity ({CONFIDENCE:.0%} confidence)"
        for h in np.unique(ensemble.separations[silent])
    ]
    asked = wanted_of(scene) or dict.fromkeys(scene.quantities, np.ones(len(scene.separations)))
    for name, most in asked.items():
        reach = spread_of(ensemble.scene, name).reach(m)
        for h, w, rel_err in zip(ensemble.separations[~silent], reach[~silent], most[~silent], strict=True):
            if rel_err < np.inf and not w <= rel_err * (1 + 1e-9):
                known = TOO_FEW if np.isnan(w) else f"has a relative error of {w:.2g}, not {rel_err:g}"
                lines.append(f"{name} at d/sigma = {h:g}{': ' if np.isnan(w) else ' '}{known}")
    return lines


def upper_contacts(n: int) -> float:
    """Upper limit (95 %) of the mean number of contacts per surface if `n` surfaces had none: 3.0/n.

    Exact for a Poisson number of contacts, ``exp(-n limit) = 0.05``; for a fixed number of asperities it
    is the safe side by a share 1.5/(n N).
    """
    return float(-np.log(1 - CONFIDENCE) / n)


def rough_seconds(scene: Scene, surfaces: int) -> float:
    """Estimate the wall time of drawing some surfaces by arithmetic alone, s, within a factor of two."""
    kept = scene.width * _PER_COUNT + scene.width**2 / 2 * _PER_PRODUCT if scene.keep == "statistics" else 0.0
    return surfaces * (expected(scene).seconds / THREADS.get() + kept)


def in_words(seconds: float) -> str:
    """Return a time as people say it.

    Examples
    --------
    >>> in_words(3e-4), in_words(200), in_words(90_000), in_words(1e9)
    ('0.3 ms', '3.3 min', '25 h', '32 years')
    """
    for size, name in ((3.15576e7, "years"), (86_400 * 3, "days"), (3600.0, "h"), (60.0, "min")):
        if seconds >= size:
            return f"{seconds / (86_400 if name == 'days' else size):.2g} {name}"
    return f"{1e3 * seconds:.2g} ms" if seconds < _SHORT else f"{seconds:.2g} s"
