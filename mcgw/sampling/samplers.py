"""The samplers that a scene can name, each put together from the same small parts.

==============  ===========  ===============  ==========  =============================================
name            cells        numbers in them  moments     for
==============  ===========  ===============  ==========  =============================================
``direct``      (all heights, by plain loops)             the witness against the rest
``tail``        none         drawn            none        few contacts: each drawn by itself, exactly
``cells``       split        drawn            one by one  nearly everything, exactly
``aggregate``   not split    drawn            Gaussian    any number of asperities at one price
``stratified``  not split    as expected      in strata   means only
==============  ===========  ===============  ==========  =============================================
"""

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from analytic import QUANTITIES, UNLOADING, Exponential, Hertz, MeasuredHeights, bends, quantity_of
from mcgw.machine.memory import keep_freed_memory
from mcgw.sampling.block import Layout, Sampler
from mcgw.sampling.cells import Mesh, cut, mesh_of, no_cells, series_accuracy
from mcgw.sampling.counted import Counted
from mcgw.sampling.counts import Counts, counts_of, strata_of
from mcgw.sampling.direct import Direct
from mcgw.sampling.drawn_moments import CROWDED, VARYING, Crowds, OneByOne
from mcgw.sampling.outside import table_of
from mcgw.sampling.response.response import Response, parts_of, response_of
from mcgw.sampling.response.tree import Precision
from mcgw.sampling.response.walk import UnresolvedError
from mcgw.sampling.stretches import begins_and_breaks
from mcgw.scene.promises import promise_of
from mcgw.scene.scene import Scene, storable

if TYPE_CHECKING:
    from mcgw.sampling.own_radii import Families

_GAUSSIAN, _WORTH = 300, 1.5  # asperities that a crowded cell takes as long as; times that much faster
_CUTS = 16  # in four, of a cell on which the modulus, and the law of contact under it, are not resolved
_SAME = 1e-10  # a kink so near to an edge was found, not told: no value is off by more


def sampler_of(scene: Scene) -> Sampler:
    """Prepare the sampler a scene asks for.

    Parameters
    ----------
    scene : Scene
        ``sampler = "auto"`` takes the cheapest exact one. A grading that is a Python function is resolved.

    Returns
    -------
    Sampler
        Ready to draw.
    """
    scene = storable(scene)
    keep_freed_memory()
    name = name_of(scene)
    if scene.nominal:
        return _at_nominal(name, scene)
    try:
        if scene.law_error and scene.sampler == "auto" and name == "cells" and scene.curvature is None:
            return _perhaps_crowded(scene)
        return _MAKERS[name](scene)
    except UnresolvedError:
        if scene.sampler != "auto" or scene.keep == "moments":
            raise
        return tail_of(scene)


def name_of(scene: Scene) -> str:
    """The exact sampler that a scene asks for; `law_error` may buy another one than ``cells``.

    For ``auto`` the first that fits: cells, unless most of them would be empty (`runs/bench/auto.py`).
    """
    if scene.sampler != "auto":
        return scene.sampler
    if scene.nominal and scene.located:
        return "direct"
    most = min(5 + len(scene.separations) / 20, 20)
    few = scene.keep != "moments" and not scene.nominal and scene.touching < most
    names = ("tail", "cells", "direct") if few else ("cells", "tail", "direct")
    # Where two of these meet, each summit has breaks of its own.
    breaks = (scene.curvature is not None) + (not scene.hertzian) + scene.nominal
    listed = isinstance(scene.heights, MeasuredHeights)
    promises = ((name, promise_of(name)) for name in names)
    return next(x for x, p in promises if (p.own_laws or breaks < 2) and not (p.needs_density and listed))


def law_error_of(scene: Scene) -> float:
    """Distance of the laws of its values from the exact ones that its sampler was chosen with."""
    return sampler_of(scene).law_error if scene.law_error else 0.0


def _perhaps_crowded(scene: Scene) -> Counted:
    """Crowds, if what they may cost in the laws buys enough; else ``cells``."""
    from mcgw.sampling.crowding import crowding  # for those scenes alone

    mesh = mesh_of(scene, split=False)
    found = crowding(scene, mesh)
    inside = scene.n_asperities * float(mesh.probability.sum())
    if found is None or found.alone + _GAUSSIAN * mesh.size > inside / _WORTH:
        return cells_of(scene)
    return aggregate_of(scene, found.threshold, found.distance)


def tail_of(scene: Scene) -> Counted:
    """Prepare ``tail``: cells without any cell."""
    return _counted("tail", scene, no_cells(scene))


def cells_of(scene: Scene) -> Counted:
    """Prepare ``cells``."""
    return _counted("cells", scene, mesh_of(scene))


def stratified_of(scene: Scene) -> Counted:
    """Prepare ``stratified``."""
    mesh = mesh_of(scene, split=False, rare=1e-9)
    return _counted("stratified", scene, mesh, strata_of, strata=True)


def _counted(
    name: str,
    scene: Scene,
    mesh: Mesh,
    counting: Callable[[Scene, Mesh, int, int], Counts] = counts_of,
    *,
    strata: bool = False,
) -> Counted:
    """A sampler on a mesh, with radii where the scene has them."""
    mesh, response = _resolved(scene, mesh)
    if not isinstance(response, Response):
        from mcgw.sampling.weighted_sums import with_radii

        return with_radii(name, scene, mesh, response, counting, strata=strata)
    return Counted(name, scene, mesh, response, counting, OneByOne(strata))


def aggregate_of(scene: Scene, crowded: int = CROWDED, distance: float = np.nan) -> Counted:
    """Prepare ``aggregate``, perhaps with another threshold.

    Parameters
    ----------
    scene : Scene
        What to simulate.
    crowded : int, optional
        Asperities in a cell, from which its moments count as Gaussian.
    distance : float, optional
        What is known of its distance from the exact laws.

    Returns
    -------
    Counted
        If moments are kept all of them vary, for another grading may need them.
    """
    mesh, response = _resolved(scene, mesh_of(scene, split=False))
    varying = response.layout
    if scene.keep != "moments":
        with suppress(UnresolvedError):  # all of them vary where cells are too wide to tell
            needed = parts_of(scene, mesh, _summed(scene.quantities), Precision(VARYING))
            varying = needed.layout.at_most(response.layout)
    return Counted("aggregate", scene, mesh, response, drawing=Crowds(varying, crowded, distance))


_MAKERS: dict[str, Callable[[Scene], Sampler]] = {
    "direct": Direct.of,
    "tail": tail_of,
    "cells": cells_of,
    "aggregate": aggregate_of,
    "stratified": stratified_of,
}


def _at_nominal(name: str, scene: Scene) -> Sampler:
    """The sampler of a scene whose surfaces each find their own balance: imported for those alone."""
    if name == "direct":
        return Direct.of(scene)
    from mcgw.sampling.nominal import CellsAtNominal, TailAtNominal

    if name == "tail":
        return TailAtNominal("tail", scene, no_cells(scene), table_of(scene, scene.lowest))
    return CellsAtNominal.of(scene)


def regraded(scene: Scene, drawn: Scene) -> Counted:
    """Physics of one scene on the cells of another, for the moments that were kept of that.

    Parameters
    ----------
    scene : Scene
        What is asked now.
    drawn : Scene
        What the moments were drawn for.

    Returns
    -------
    Counted
        Its `sums` take the moments.

    Raises
    ------
    ValueError
        If the sampler has no cells, a separation, a break of the grading or a height where a piece of the
        contact law begins is not an edge of them, or the moments do not resolve what is asked.
    """
    sampler = sampler_of(drawn)
    if not isinstance(sampler, Counted):
        raise ValueError(f'sampler = "{sampler.name}" has no cells')
    edges = sampler.mesh.edges
    # Below the first edge every height that was drawn touches: all there are, or those above the lowest.
    least = -np.inf if drawn.lowest <= drawn.heights.support[0] else drawn.lowest
    inside = [h for h in scene.separations if not (edges.size and least <= h <= edges[0])]
    _check_edges("separation", inside, edges)
    if edges.size:
        _check_edges("break of the grading", bends(scene.modulus, edges[0], edges[-1]), edges, _SAME)
        for heights in begins_and_breaks(scene, *sampler.mesh.range):
            begun = heights[(edges[0] <= heights) & (heights <= edges[-1])]
            _check_edges("height where a piece of the contact law begins,", begun.tolist(), edges)
    response = _response(scene, sampler.mesh, sampler.response)
    return replace(sampler, scene=scene, response=response)


def _check_edges(what: str, wanted: Sequence[float], edges: NDArray[np.float64], apart: float = 0.0) -> None:
    """Every one of these heights must be an edge, or no farther from one."""
    for s in wanted:
        near = edges[np.argmin(np.abs(edges - s))]
        if abs(s - near) > apart:
            raise ValueError(f"{what} {s:.6g} is not an edge of the cells (the nearest is {near:.6g})")


def _resolved(scene: Scene, mesh: Mesh) -> "tuple[Mesh, Response | Families]":
    """The mesh, cut further where the law of contact bends with the modulus; and the response on it."""
    for _ in range(_CUTS):
        try:
            return mesh, _response(scene, mesh)
        except UnresolvedError as error:
            mesh = cut(scene, mesh, error.starts)
    return mesh, _response(scene, mesh)


def _response(scene: Scene, mesh: Mesh, drawn: "Response | Families | None" = None) -> "Response | Families":
    """Response for all that moments can tell, by those that were `drawn`; contacts are counted."""
    precision = Precision(series_accuracy(scene.accuracy), not scene.exact)

    def response_to(power: float | None, names: tuple[str, ...]) -> Response:
        kept = None
        if drawn:
            kept = drawn.layout if isinstance(drawn, Response) else drawn.layout_of(power)
        elif scene.keep == "moments":
            kept = _lasting_layout(scene, mesh, power)
        return response_of(scene, mesh, names, kept=kept, precision=precision)

    names = _summed(scene.quantities)
    if scene.curvature is None or (not names and scene.keep != "moments"):
        return response_to(None, names)
    from mcgw.sampling.own_radii import Families

    return Families.of(names, response_to, every=bool(drawn) or scene.keep == "moments")


def _summed(quantities: Iterable[str]) -> tuple[str, ...]:
    return tuple(name for name in quantities if not quantity_of(name).counts)


def _lasting_layout(scene: Scene, mesh: Mesh, power: float | None) -> Layout:
    """Moments that serve this grading, another exponential one under Hertz's law, and every quantity.

    With a power, every quantity that has this power of the radius.
    """
    plainly = replace(
        scene,
        law=Hertz(),
        unload_from=None,
        film=None,
        joint=None,
        quantities=tuple(QUANTITIES),
        negative="allow",
    )
    others = [replace(plainly, grading=Exponential(gamma)) for gamma in (2.0, 0.5, 0.0)]
    precision = Precision(series_accuracy(scene.accuracy), not scene.exact)
    needed = (parts_of(x, mesh, _every_sum(x, power), precision, lasting=True) for x in (scene, *others))
    most = Layout.covering([parts.layout for parts in needed])
    return Layout(most.plain + 1, most.rooted + 1)  # one in reserve


def _every_sum(scene: Scene, power: float | None) -> tuple[str, ...]:
    """Quantities that the surfaces of a scene have, but those that are counted or have another power."""
    names = [*QUANTITIES]
    if not scene.hertzian:
        names += ["load_slope"] if scene.film is None else ["load_slope", "conductance_si"]
    if scene.unload_from is not None:
        names += [q.name for q in UNLOADING.values() if q.unloading in names]
    return tuple(name for name in _summed(names) if power in (None, quantity_of(name).radius))
