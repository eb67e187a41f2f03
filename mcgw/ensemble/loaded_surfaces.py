"""Surfaces of a scene at given loads, each at its own separation: drawn when they are first needed."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from analytic import Hertz, MeasuredHeights, MeasuredRadii, Quantity
from analytic.arrays import Array, hold
from mcgw.ensemble.at_load import NEGATIVE, quantities_at
from mcgw.ensemble.results import joined
from mcgw.ensemble.separation import LOWEST, Asperities
from mcgw.scene.scene import Scene, storable

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
        """The scene, or specimens in place of its one measured surface, with as many of its summits."""
        scene, heights, own = self.scene, self.scene.heights, self.scene.summits
        if not (scene.as_measured and isinstance(heights, MeasuredHeights)):
            return scene
        again = MeasuredHeights(heights.heights, resampled=True)
        ratios = own.ratios if isinstance(own, MeasuredRadii) else np.ones(len(heights.heights))
        return scene.replace(heights=again, summits=MeasuredRadii(again, ratios), n_surfaces=_RESAMPLED)

    @cached_property
    def lows(self) -> list[float]:
        """Separation that nearly every surface is above, or that all heights are, at each value.

        By some standard deviations, to first order. What the modulus is there does not matter yet.
        """
        name = self.given.name if self.sunk is None else "load"  # a nominal separation follows from it
        theory, bottom = self.specimens.theory, float(self.specimens.heights.ppf(np.array(_NOTHING)))
        spreads = [float(theory.std(name, h) / theory.slope(name, h)) for h in self.about]
        return [max(h - _MARGIN * x, min(h, bottom)) for h, x in zip(self.about, spreads, strict=True)]

    @cached_property
    def drawn(self) -> Scene:
        """The scene with which the surfaces are drawn, above the lowest separation of nearly every one."""
        scene = self.specimens.replace(
            sampler="direct" if isinstance(self.specimens.heights, MeasuredHeights) else "tail",
            keep="sums",
            separations=(min(self.lows),),
            quantities=("contacts",),
            law=Hertz(),  # heights are what is drawn, the same under every law
            unload_from=None,
            joint=None,
            negative="clip" if self.scene.negative == "clip" else "allow",
        )
        return storable(scene)

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
        from mcgw.sampling.asperities import listing_sampler, summits_of_many  # compiled loops

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
            some = Asperities(self.scene, *summits_of_many(drawn, sampler, first, n))
            parts.append([self._at(k, some, first) for k in range(len(self.values))])
            if tell is not None:
                tell(first + n, drawn.n_surfaces)
        found = [joined(at) for at in zip(*parts, strict=True)]
        hold(self, sums=found)
        return found

    def _at(self, number: int, some: Asperities, first: int) -> dict[str, Array]:
        """Separation and all quantities of some of the surfaces at one of the values."""
        from mcgw.sampling.asperities import summits

        value, names, q = self.values[number], quantities_at(self.scene), self.given
        h = some.separations(q, value, self.lows[number], self.about[number], self.sunk)
        softest, found = some.softest.copy(), some.sums(names, np.where(np.isfinite(h), h, np.inf))
        lost = np.flatnonzero(np.isnan(h))  # rare: they lie below what was drawn
        if lost.size:
            whole = Asperities.of(self.scene, [summits(self.drawn, first + k) for k in lost.tolist()])
            h[lost], softest[lost] = whole.separations(q, value, LOWEST, sunk=self.sunk), whole.softest
            for k in lost[whole.counts == 0]:
                raise ValueError(f"surface {first + k} has no asperity; increase n_asperities")
            for name, x in whole.sums(names, np.where(np.isnan(h), np.inf, h)[lost]).items():
                found[name][lost] = x
        for k in np.flatnonzero(np.isnan(h) | ((self.scene.negative == "error") & (softest > h))):
            surface = f"surface {first + k}"
            if np.isfinite(softest[k]):
                raise ValueError(NEGATIVE.format(q.name, value, q.unit, surface, softest[k]))
            unit, give = (f" {q.unit}", "less") if self.sunk is None else ("", "more")
            raise ValueError(f"{q.name} = {value:g}{unit}: {surface} does not reach it; give {give}")
        return {"separation": h, **found}

    def contacts(self, surface: int, h: float) -> tuple[Array, Array | None]:
        """Reduced heights above a separation in descending order, and the radii of these summits."""
        from mcgw.sampling.asperities import summits, touching_summits

        s, ratios = (summits if h < self.drawn.lowest else touching_summits)(self.drawn, surface)
        order = np.argsort(-s, kind="stable")[: np.count_nonzero(s > h)]
        return s[order], None if ratios is None else ratios[order]
