"""The separation at a given load, real area or nominal one: by theory, and on every surface for itself."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from analytic import quantity_of
from mcgw.ensemble.at_load import answers_at, theory_at
from mcgw.ensemble.loaded_surfaces import LoadedSurfaces
from mcgw.ensemble.solved import Solution
from mcgw.machine.progress import Progress, told
from mcgw.scene.kinds import argument, as_toml, check_object
from mcgw.scene.scene import Scene
from mcgw.scene.section import nearest

_LAST_DIGITS = 64 * float(np.finfo(float).eps)  # of a reduced height
# What may be given: its unit, the quantity that it is, and whether per nominal area.
_GIVEN = {
    "load": ("N", "load", False),
    "pressure": ("Pa", "load", True),
    "area": ("m^2", "area", False),
    "area_fraction": ("1", "area", True),
    "nominal_separation": ("", "nominal_separation", False),
}


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
    unit, given, per_area = _GIVEN[key]
    if key != "nominal_separation":
        factor = scene.surface.nominal_area if per_area else 1.0
        values = [factor * argument(key, x, unit) for x in several]
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

    Raises
    ------
    ValueError
        If a value is not reached, is too small for double precision, or is reached only with contacts of
        negative modulus where the scene does not allow them, if there are too many asperities to draw, or if
        a surface has none.
    """
    whole, q = scene, quantity_of(given)
    if scene.interaction is not None or scene.gas is not None:  # these change the separation alone
        scene = scene.replace(interaction=None, joint=scene.joint.without_gas)
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
        from mcgw.ensemble.forecast import surfaces_at_loads  # draws a pilot

        n = surfaces_at_loads(scene, [at["separation"] for at in theory], given)
        whole, scene = (x.replace(n_surfaces=n, rel_err=None, max_seconds=None) for x in (whole, scene))
    sunk = whole.compliance / whole.surface.sigma if given == "nominal_separation" else None
    loaded = LoadedSurfaces(scene, q, values, [at["separation"] for at in theory], sunk)
    found = [
        Solution(whole, given, float(value), answers_at(whole, at), loaded, k)
        for k, (value, at) in enumerate(zip(values, theory, strict=True))
    ]
    if draw or not all(each.exact for each in found):
        loaded.draw(tell)
    return found
