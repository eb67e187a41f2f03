"""Surfaces of a scene at given loads, each at its own separation: drawn when they are first needed."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from analytic import SEPARATIONS, Hertz, MeasuredHeights, MeasuredRadii, Quantity
from analytic.arrays import Array, hold
from mcgw.ensemble.at_load import NEGATIVE, quantities_at
from mcgw.ensemble.separation import LOWEST, ManySurfaces, Summits
from mcgw.scene.scene import Scene, storable

if TYPE_CHECKING:  # its loops are loaded where surfaces are drawn, in half of the time of a short command
    from mcgw.sampling.block import Sampler

_MARGIN = 6.0  # standard deviations of a surface's separation that are drawn at once
_RESAMPLED = 200  # specimens in place of one measured surface
_MOST_HEIGHTS = 3e9
_AT_ONCE = 1e5  # asperities whose surfaces are solved together
_NOTHING = 1e-16  # share of the heights below all that are drawn


@dataclass(frozen=True, eq=False)
class LoadedSurfaces:
    """Surfaces drawn from a scene, each at its own separation at given values of a sum.

    Parameters
    ----------
    scene : Scene
        Its asperities alone, without interaction.
    given : Quantity
        Load, area or nominal separation.
    values : sequence of float
        SI; d/sigma.
    about : sequence of float
        Separation of an infinite surface at each.
    sunk : float or None
        At nominal separations: by how much the bodies sink for each newton, over sigma.
    """

    scene: Scene
    given: Quantity
    values: Sequence[float]
    about: Sequence[float]
    sunk: float | None

    @cached_property
    def specimens(self) -> Scene:
        """The scene, or specimens in place of its one measured surface."""
        return _resampled(self.scene) if self.scene.as_measured else self.scene

    @cached_property
    def lows(self) -> list[float]:
        """Separation that nearly every surface is above, at each value."""
        return [_lowest(self.specimens, self.given, h) for h in self.about]

    @cached_property
    def drawn(self) -> Scene:
        """The scene with which the surfaces are drawn."""
        return storable(_drawn(self.specimens, min(self.lows)))

    @cached_property
    def sums(self) -> list[dict[str, Array]]:
        """Separation and all quantities of the asperities of each surface, for each value."""
        return self.draw(None)

    def draw(self, tell: Callable[[float, float], Any] | None) -> list[dict[str, Array]]:
        """Return `sums`, telling of each part of the surfaces that is drawn.

        Raises
        ------
        ValueError
            If surfaces cannot reach a value, or if there are too many asperities to draw.
        """
        from mcgw.sampling.asperities import listing_sampler

        drawn = self.drawn
        if drawn.touching * drawn.n_surfaces > _MOST_HEIGHTS:
            raise ValueError(
                f"{drawn.n_surfaces} surfaces with {drawn.touching:.3g} contacts each are too many to solve "
                f"singly; give fewer than {_MOST_HEIGHTS / drawn.touching:.0f} surfaces"
            )
        sampler, parts = listing_sampler(drawn), []
        step = max(int(_AT_ONCE / (drawn.touching + 1)), 1)
        for first in range(0, drawn.n_surfaces, step):
            n = min(step, drawn.n_surfaces - first)
            starts = list(zip(self.lows, self.about, strict=True))
            parts.append(_surfaces(self.scene, sampler, first, n, self.given, self.values, starts, self.sunk))
            if tell is not None:
                tell(first + n, drawn.n_surfaces)
        found = [
            {name: np.concatenate([part[k][name] for part in parts]) for name in parts[0][k]}
            for k in range(len(self.values))
        ]
        hold(self, sums=found)
        return found

    def contacts(self, surface: int, h: float) -> tuple[Array, Array | None]:
        """Reduced heights above a separation in descending order, and the radii of these summits."""
        from mcgw.sampling.asperities import summits, touching_summits

        s, ratios = (summits if h < self.drawn.lowest else touching_summits)(self.drawn, surface)
        order = np.argsort(-s, kind="stable")[: np.count_nonzero(s > h)]
        return s[order], None if ratios is None else ratios[order]


def _resampled(scene: Scene) -> Scene:
    """Specimens of the one surface whose summits were measured: each has as many, drawn from these."""
    heights = scene.heights
    assert isinstance(heights, MeasuredHeights)
    again = MeasuredHeights(heights.heights, resampled=True)
    own = scene.summits
    ratios = own.ratios if isinstance(own, MeasuredRadii) else np.ones(len(heights.heights))
    return scene.replace(heights=again, summits=MeasuredRadii(again, ratios), n_surfaces=_RESAMPLED)


def _lowest(scene: Scene, q: Quantity, h: float) -> float:
    """Below the solution h of the mean surface: lower than that of nearly every surface, or than all heights.

    That is some standard deviations, to first order. What the modulus is there does not matter yet.
    """
    name = "load" if q.name in SEPARATIONS else q.name  # that of a nominal separation follows from the load
    spread = float(scene.theory.std(name, h) / scene.theory.slope(name, h))
    return max(h - _MARGIN * spread, min(h, float(scene.heights.ppf(np.array(_NOTHING)))))


def _drawn(scene: Scene, lowest: float) -> Scene:
    """Return the scene whose contacts are drawn: above the lowest separation of nearly every surface."""
    return scene.replace(
        sampler="direct" if isinstance(scene.heights, MeasuredHeights) else "tail",
        keep="sums",
        separations=(lowest,),
        quantities=("contacts",),
        law=Hertz(),  # heights are what is drawn, the same under every law
        unload_from=None,
        joint=None,
        negative="clip" if scene.negative == "clip" else "allow",
    )


def _surfaces(
    scene: Scene,
    sampler: "Sampler",
    first: int,
    n: int,
    q: Quantity,
    values: Sequence[float],
    starts: Sequence[tuple[float, float]],
    sunk: float | None,
) -> list[dict[str, Array]]:
    """All quantities of some surfaces at each value: together where sums fall, else one by one.

    Each value has a separation that nearly none of them is below, and one that they are about.
    """
    from mcgw.sampling.asperities import summits_of_many

    drawn, found, names = sampler.scene, [], quantities_at(scene)
    many = ManySurfaces(scene, *summits_of_many(drawn, sampler, first, n))
    surface = cache(many.surface)  # once for all values
    for value, (low, about) in zip(values, starts, strict=True):
        h, sums = np.full(n, np.nan), {name: np.zeros(n) for name in ("separation", *names)}
        if sunk is None and value > 0:
            near = many.above(low)
            h = near.separations(q, value, low, about)
            sums = {"separation": h, **near.sums(names, np.where(np.isfinite(h), h, np.inf))}
        for k in np.flatnonzero(np.isnan(h)).tolist():
            for name, x in _singly(surface(k), drawn, first + k, q, value, sunk).items():
                sums[name][k] = x
        found.append(sums)
    return found


def _singly(
    on: Summits, drawn: Scene, number: int, q: Quantity, value: float, sunk: float | None
) -> dict[str, float]:
    """All quantities of one surface at a value; with `sunk`, 1/N, at a nominal separation."""
    from mcgw.sampling.asperities import summits

    scene = on.scene
    target = value / q.scale(scene.surface)
    if sunk is None:
        h = on.largest_separation(q, target, drawn.lowest)
    else:
        h = on.nominal(value, sunk, drawn.lowest)
    if h is None:  # rare: it lies below what was drawn
        on = Summits.of(scene, *summits(drawn, number))
        if not on.s.size:
            raise ValueError(f"surface {number} has no asperity; increase n_asperities")
        if sunk is None:
            h = on.separation_anywhere(q, target, drawn.lowest)
        else:
            h = on.nominal(value, sunk, LOWEST)
    negative = on.s[on.modulus < 0]
    if h is None and not negative.size:
        told, give = f"{q.name} = {value:g} {q.unit}", "less"
        if sunk is not None:
            told, give = f"nominal_separation = {value:g}", "more"
        raise ValueError(f"{told}: surface {number} does not reach it; give {give}")
    if h is None or (scene.negative == "error" and np.any(negative > h)):
        raise ValueError(NEGATIVE.format(q.name, value, q.unit, f"surface {number}", negative.max()))
    return {"separation": h, **on.sums(quantities_at(scene), h)}
