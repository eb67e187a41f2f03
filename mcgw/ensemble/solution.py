"""The separation at a given load, real area or nominal one: by theory, and on every surface for itself."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from analytic import Hertz, MeasuredHeights, MeasuredRadii, Quantity, quantity_of
from analytic.arrays import Array
from mcgw.ensemble.at_load import NEGATIVE, answers_at, asperities_of, quantities_at, theory_at
from mcgw.ensemble.forecast import surfaces_at_loads
from mcgw.ensemble.many_surfaces import ManySurfaces
from mcgw.ensemble.separation import LOWEST, Summits
from mcgw.ensemble.solved import Solution
from mcgw.machine.progress import Progress, told
from mcgw.sampling.asperities import listing_sampler, summits, summits_of_many
from mcgw.sampling.block import Sampler
from mcgw.scene.arguments import argument, as_toml, check_object
from mcgw.scene.scene import Scene, storable
from mcgw.scene.section import nearest

_MARGIN = 6.0  # standard deviations of a surface's separation that are drawn at once
_RESAMPLED = 200  # specimens in place of one measured surface
_MOST_HEIGHTS = 3e9
_AT_ONCE = 1e5  # asperities whose surfaces are solved together
_LAST_DIGITS = 64 * float(np.finfo(float).eps)  # of a reduced height
_NOTHING = 1e-16  # share of the heights below all that are drawn
# What may be given: its unit, the quantity that it is, and whether per nominal area.
_GIVEN = {
    "load": ("N", "load", False),
    "pressure": ("Pa", "load", True),
    "area": ("m^2", "area", False),
    "area_fraction": ("1", "area", True),
    "nominal_separation": ("", "nominal_separation", False),
}
UNIT_OF = {key: unit for key, (unit, *_) in _GIVEN.items()}


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
    given, values = given_values(scene, key, several, lambda x, unit: argument(key, x, unit))
    with told(progress, "surfaces") as tell:
        found = solutions(scene, given, values, tell)
    return found if isinstance(plain, list) else found[0]


def given_values(
    scene: Scene, key: str, values: Sequence[Any], read: Callable[[Any, str], float]
) -> tuple[str, list[float]]:
    """Loads ("load", N) or real areas ("area", m^2) of what is given, each read as a number in a unit.

    Nominal separations are numbers (d/sigma).
    """
    unit, given, per_area = _GIVEN[key]
    if key == "nominal_separation":
        if scene.interaction is None:
            raise ValueError(f'{key}: it needs [interaction] reference = "body" or "mean-plane"')
        return given, [_reduced(value) for value in values]
    factor = scene.surface.nominal_area if per_area else 1.0
    return given, [factor * read(value, unit) for value in values]


def _reduced(value: Any) -> float:
    try:
        found = float(value)
    except (TypeError, ValueError):
        found = np.nan
    if not np.isfinite(found):
        raise ValueError(f"nominal_separation = {value!r}: give a finite number, d/sigma")
    return found


def solutions(
    scene: Scene, given: str, values: Sequence[float], tell: Callable[[float, float], Any] | None = None
) -> list[Solution]:
    """As `solve`, for loads ("load", N), real areas ("area", m^2) or nominal separations of a scene.

    The asperities of a surface are drawn one by one (sampler ``tail``), once for all values. So any
    separation is possible, and the mean differs from theory by an effect of the finite number of asperities,
    of order 1/N.

    For summits used as measured, the answer is that of the list itself. Beside it stand specimens with as
    many summits, drawn from the list independently: correlations between neighbours are ignored.

    Surfaces approach from far away: if several separations fit, the largest one counts. Under a contact law
    with jumps, the load of a surface jumps at each asperity that yields, and may skip a value; the solution
    is then the separation of the jump, with the load just after it.

    Raises
    ------
    ValueError
        If a value is not reached, is too small for double precision, or is reached only with contacts of
        negative modulus where the scene does not allow them, if there are too many asperities to draw, or if
        a surface has none.
    """
    whole, scene, q = scene, asperities_of(scene), quantity_of(given)
    if scene.n_surfaces < 2 and not scene.as_measured:
        raise ValueError(f"n_surfaces = {scene.n_surfaces}: an interval needs at least 2 surfaces")
    least = q.scale(scene.surface) * _LAST_DIGITS**q.exponent
    if given == q.name and (small := [value for value in values if 0 <= value < least]):
        raise ValueError(
            f"{q.name} = {small[0]:g} {q.unit}: too small for double precision of the heights; "
            f"give {2 * least:.1g} {q.unit} or more"
        )
    theory = [theory_at(whole, given, value) for value in values]
    if scene.rel_err is not None:
        n = surfaces_at_loads(scene, [at["separation"] for at in theory], given)
        whole, scene = (replace(x, n_surfaces=n, rel_err=None, max_seconds=None) for x in (whole, scene))
    specimens = _resampled(scene) if scene.as_measured else scene
    about = [at["separation"] for at in theory]
    lows = [_lowest(specimens, q, h) for h in about]
    drawn = storable(_drawn(specimens, min(lows)))
    if drawn.touching * drawn.n_surfaces > _MOST_HEIGHTS:
        raise ValueError(
            f"{drawn.n_surfaces} surfaces with {drawn.touching:.3g} contacts each are too many to solve "
            f"singly; give fewer than {_MOST_HEIGHTS / drawn.touching:.0f} surfaces"
        )
    sampler, found = listing_sampler(drawn), []
    sunk = whole.compliance / whole.surface.sigma if given == "nominal_separation" else None
    step = max(int(_AT_ONCE / (drawn.touching + 1)), 1)
    for first in range(0, drawn.n_surfaces, step):
        n = min(step, drawn.n_surfaces - first)
        found.append(
            _surfaces(scene, sampler, first, n, q, values, list(zip(lows, about, strict=True)), sunk)
        )
        if tell is not None:
            tell(first + n, drawn.n_surfaces)
    surfaces = [
        {name: np.concatenate([part[k][name] for part in found]) for name in theory[k]}
        for k in range(len(values))
    ]
    return [
        Solution(whole, given, float(value), answers_at(whole, at), answers_at(whole, on), drawn)
        for value, at, on in zip(values, theory, surfaces, strict=True)
    ]


def _resampled(scene: Scene) -> Scene:
    """Specimens of the one surface whose summits were measured: each has as many, drawn from these."""
    heights = scene.heights
    assert isinstance(heights, MeasuredHeights)
    again = MeasuredHeights(heights.heights, resampled=True)
    own = scene.curvature
    ratios = own.ratios if isinstance(own, MeasuredRadii) else np.ones(len(heights.heights))
    return replace(scene, heights=again, curvature=MeasuredRadii(again, ratios), n_surfaces=_RESAMPLED)


def _lowest(scene: Scene, q: Quantity, h: float) -> float:
    """Below the solution h of the mean surface: lower than that of nearly every surface, or than all heights.

    That is some standard deviations, to first order. What the modulus is there does not matter yet.
    """
    spread = float(scene.theory.std(q.name, h) / scene.theory.slope(q.name, h))
    return max(h - _MARGIN * spread, min(h, float(scene.heights.ppf(np.array(_NOTHING)))))


def _drawn(scene: Scene, lowest: float) -> Scene:
    """The scene whose contacts are drawn: those above the lowest separation of nearly every surface."""
    return replace(
        scene,
        sampler="direct" if isinstance(scene.heights, MeasuredHeights) else "tail",
        keep="sums",
        separations=(lowest,),
        quantities=("contacts",),
        law=Hertz(),  # heights are what is drawn, the same under every law
        unload_from=None,
        film=None,
        negative="clip" if scene.negative == "clip" else "allow",
    )


def _surfaces(
    scene: Scene,
    sampler: Sampler,
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
