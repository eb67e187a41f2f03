"""The separation at a given load, real area or nominal one: by theory, and on every surface for itself.

Those surfaces are drawn when they are first needed.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from analytic import PER_AREA, Hertz, MeasuredHeights, MeasuredRadii, Quantity, quantity_of
from analytic.arrays import Array, hold
from mcgw.ensemble.at_load import NEGATIVE, mean_surface, quantities_at
from mcgw.ensemble.forecast import surfaces_at_loads
from mcgw.ensemble.results import joined
from mcgw.ensemble.separation import LOWEST, Asperities
from mcgw.ensemble.solved import Solution
from mcgw.machine.process import Progress, told
from mcgw.scene.kinds import argument, as_toml, check_object
from mcgw.scene.scene import Scene, storable
from mcgw.scene.section import nearest

_LAST_DIGITS = 64 * float(np.finfo(float).eps)  # of a reduced height
_MARGIN = 6.0  # standard deviations of a surface's separation that are drawn at once
_RESAMPLED = 200  # specimens in place of one measured surface
_MOST_HEIGHTS = 3e9
_AT_ONCE = 1e5  # asperities whose surfaces are solved together
_NOTHING = 1e-16  # share of the heights below all that are drawn


def solve(
    scene: Scene,
    *unnamed: Any,
    load: Any = None,
    pressure: Any = None,
    area: Any = None,
    area_fraction: Any = None,
    nominal_separation: Any = None,
    progress: Progress = None,
    **changes: Any,
) -> "Solution | list[Solution]":
    """Find the separation at which each surface has a given load, pressure, real area or nominal separation.

    Parameters
    ----------
    scene : Scene
        Its surface, grading, heights, contact law, number of surfaces and asperities, and seed are used.
    *unnamed
        Refused: a number alone may be a load or a pressure.
    load, pressure, area, area_fraction : float, str or sequence of them
        One of these: P (N), P/A_n (Pa), A (m^2) or A/A_n; or texts with units, as "1 MPa".
    nominal_separation : float or sequence of float
        Or, with an interaction, the separation of the bodies, d/sigma: each surface finds the separation that
        its asperities feel by its own load, the largest one that fits.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) surfaces.
    **changes
        Fields of the scene to change: see `mcgw.Scene.replace`. With `rel_err` as many surfaces are drawn as
        keep 1.96 standard errors of every answer within it.

    Returns
    -------
    Solution or list of Solution
        One, or for a sequence one for each of its values.

    Raises
    ------
    SceneError, TypeError
        If a value is no such quantity or has no name; and as from `mcgw.Scene.replace`.
    ValueError
        If not one of these is given, or if surfaces cannot reach the value.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=0.0, n_surfaces=20, seed=1)
    >>> found = mcgw.solve(scene, pressure="1 MPa")
    >>> round(found.theory["separation"], 4), found.surfaces["area"].shape
    (2.0666, (20,))
    """
    asked = {"load": load, "pressure": pressure, "area": area, "area_fraction": area_fraction}
    asked["nominal_separation"] = nominal_separation
    known = {key: value for key, value in asked.items() if value is not None}
    check_object("solve", scene, Scene)
    if unnamed:
        raise TypeError(f"solve: {unnamed[0]!r} has no name: give one of {', '.join(f'{x}=' for x in asked)}")
    for key in changes:
        meant = nearest(key, [*asked, *Scene.__dataclass_fields__]).rstrip()
        there = hasattr(scene, key) or hasattr(scene.surface, key)
        if not there and meant.endswith(tuple(f" {x}?" for x in asked)):
            raise TypeError(f"solve: there is no {key!r}; {meant}")
    if len(known) != 1:
        raise ValueError(f"solve: give one of {', '.join(asked)}, not {' and '.join(known) or 'none'}")
    ((key, value),) = known.items()
    scene, plain = scene.replace(**changes), as_toml(value)
    several = plain if isinstance(plain, list) else [plain]
    given, factor = key, 1.0
    if key in PER_AREA:
        given, factor = PER_AREA[key].of, scene.surface.nominal_area
    if key != "nominal_separation":
        values = [factor * argument(key, x, quantity_of(key).unit) for x in several]
    elif scene.interaction is None:
        raise ValueError(f'{key}: it needs [interaction] reference = "body" or "mean-plane"')
    else:
        if wrong := [x for x in several if not isinstance(x, int | float) or not np.isfinite(x)]:
            raise ValueError(f"nominal_separation = {wrong[0]!r}: give a finite number, d/sigma")
        values = [float(x) for x in several]
    with told(progress, "surfaces") as tell:
        found = solutions(scene, given, values, tell)
    return found if isinstance(plain, list) else found[0]


def solutions(
    scene: Scene,
    given: str,
    values: Sequence[float],
    tell: Callable[[float, float], Any] | None = None,
    draw: bool = False,
) -> list[Solution]:
    """As `solve`, for loads ("load", N), real areas ("area", m^2) or nominal separations of a scene.

    Where means and scatter of specimens are known exactly, surfaces are drawn when `Solution.surfaces` is
    first asked for, or at once with `draw`; elsewhere at once. Their asperities are drawn one by one (sampler
    ``tail``), once for all values. So any separation is possible, and the mean differs from that of an
    infinite surface by an effect of the finite number of asperities, of order 1/N.

    For summits used as measured, the answer is that of the list itself. Beside it stand specimens with as
    many summits, drawn from the list independently: correlations between neighbours are ignored.

    Surfaces approach from far away: if several separations fit, the largest one counts. Under a contact law
    with jumps, the load of a surface jumps at each asperity that yields, and may skip a value; the solution
    is then the separation of the jump, with the load just after it.
    """
    whole, q = scene, quantity_of(given)
    if scene.interaction is not None or scene.gas is not None:  # these change the separation alone
        scene = scene.replace(interaction=None, gas=None, rms=None, temperature=None, gas_pressure=None)
    if scene.n_surfaces < 2 and not scene.as_measured:
        raise ValueError(f"n_surfaces = {scene.n_surfaces}: an interval needs at least 2 surfaces")
    least = q.scale(scene.surface) * _LAST_DIGITS**q.exponent
    if given == q.name and (small := [value for value in values if 0 <= value < least]):
        raise ValueError(
            f"{q.name} = {small[0]:g} {q.unit}: too small for double precision of the heights; "
            f"give {2 * least:.1g} {q.unit} or more"
        )
    theory = [mean_surface(whole, given, value) for value in values]
    about = [at["separation"] for at in theory]
    if scene.rel_err is not None:
        n = surfaces_at_loads(scene, about, given)
        whole, scene = (x.replace(n_surfaces=n, rel_err=None, max_seconds=None) for x in (whole, scene))
    sunk = whole.theory.compliance if given == "nominal_separation" else None
    loaded = LoadedSurfaces(scene, q, values, about, sunk)
    found = [
        Solution(whole, given, float(value), at, loaded, k)
        for k, (value, at) in enumerate(zip(values, theory, strict=True))
    ]
    if draw or not all(each.exact for each in found):
        loaded.draw(tell)
    return found


@dataclass(frozen=True, eq=False)
class LoadedSurfaces:
    """Surfaces drawn from a scene, each at its own separation at given values of a sum."""

    scene: Scene  # its asperities alone, without interaction
    given: Quantity  # load, area or nominal separation
    values: Sequence[float]  # SI; d/sigma
    about: Sequence[float]  # separation of an infinite surface at each
    sunk: float | None  # at nominal separations: by how much the bodies sink for each newton, over sigma

    @cached_property
    def _begin(self) -> tuple[Scene, list[float]]:
        """The scene with which surfaces are drawn, and what nearly all separations at each value are above.

        By some standard deviations, to first order, or all heights are above that. One measured surface is
        replaced by specimens with as many of its summits.
        """
        scene, heights, own = self.scene, self.scene.heights, self.scene.summits
        if scene.as_measured and isinstance(heights, MeasuredHeights):
            again = MeasuredHeights(heights.heights, resampled=True)
            ratios = own.ratios if isinstance(own, MeasuredRadii) else np.ones(len(heights.heights))
            scene = scene.replace(heights=again, summits=MeasuredRadii(again, ratios), n_surfaces=_RESAMPLED)
        name = self.given.name if self.sunk is None else "load"  # a nominal separation follows from it
        theory, bottom = scene.theory, float(scene.heights.ppf(np.array(_NOTHING)))
        spreads = [float(theory.std(name, h) / theory.slope(name, h)) for h in self.about]
        lows = [max(h - _MARGIN * x, min(h, bottom)) for h, x in zip(self.about, spreads, strict=True)]
        drawn = scene.replace(
            sampler="direct" if isinstance(scene.heights, MeasuredHeights) else "tail",
            keep="sums",
            separations=(min(lows),),
            quantities=("contacts",),
            law=Hertz(),  # heights are what is drawn, the same under every law
            unload_from=None,
            joint=None,
            negative="clip" if scene.negative == "clip" else "allow",  # what moduli are there comes later
        )
        return storable(drawn), lows

    @property
    def drawn(self) -> Scene:
        """The scene with which the surfaces are drawn, above the lowest separation of nearly every one."""
        return self._begin[0]

    @cached_property
    def sums(self) -> list[dict[str, Array]]:
        """Separation and all quantities of the asperities of each surface, for each value."""
        return self.draw(None)

    def draw(self, tell: Callable[[float, float], Any] | None) -> list[dict[str, Array]]:
        """Return `sums`, telling of each part of the surfaces that is drawn."""
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
            some = Asperities.of(self.scene, *summits_of_many(drawn, sampler, first, n))
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
        h = some.separations(q, value, self._begin[1][number], self.about[number], self.sunk)
        softest, found = some.softest, some.sums(names, np.where(np.isfinite(h), h, np.inf))
        lost = np.flatnonzero(np.isnan(h))  # rare: they lie below what was drawn
        if lost.size:
            heights, own = zip(*(summits(self.drawn, first + k) for k in lost.tolist()), strict=True)
            ratios = None if own[0] is None else np.concatenate(own)
            counts = np.array([each.size for each in heights])
            whole = Asperities.of(self.scene, counts, np.concatenate(heights), ratios)
            h[lost], softest[lost] = whole.separations(q, value, LOWEST, sunk=self.sunk), whole.softest
            for k in lost[counts == 0]:
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

    def contacts(self, number: int, surface: int) -> tuple[Array, Array | None]:
        """Reduced heights in contact on a surface at one of the values, in descending order, and radii."""
        from mcgw.sampling.asperities import summits, touching_summits

        found = self.sums[number]["separation"]
        if not 0 <= surface < found.size:
            raise ValueError(f"surface = {surface}: give a number from 0 to {found.size - 1}")
        h = float(found[surface])
        s, ratios = (summits if h < self.drawn.lowest else touching_summits)(self.drawn, surface)
        order = np.argsort(-s, kind="stable")[: np.count_nonzero(s > h)]
        return s[order], None if ratios is None else ratios[order]
