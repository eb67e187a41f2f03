"""The samplers that a scene can name, each put together from the same small parts.

==============  ===========  ===============  ==========  =============================================
name            cells        numbers in them  moments     for
==============  ===========  ===============  ==========  =============================================
``direct``      (all heights, by plain loops)             the witness against the rest
``tail``        none         drawn            none        few contacts: each drawn by itself, exactly
``cells``       split        drawn            one by one  nearly everything, exactly
``aggregate``   not split    drawn            Gaussian    any number of asperities at one price
==============  ===========  ===============  ==========  =============================================
"""

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial

import numpy as np

from analytic import quantity_of
from mcgw.sampling.block import Sampler
from mcgw.sampling.cells import Mesh, cut, mesh_of, no_cells
from mcgw.sampling.counted import Counted, table_of
from mcgw.sampling.direct import Direct
from mcgw.sampling.expected import name_of
from mcgw.sampling.response.response import parts_of, response_of
from mcgw.sampling.response.walk import UnresolvedError
from mcgw.scene.ensemble import PROMISES
from mcgw.scene.scene import Scene, storable

_GAUSSIAN, _WORTH = 300, 1.5  # asperities that a crowded cell takes as long as; times that much faster
_CUTS = 16  # in four, of a cell on which the modulus, and the law of contact under it, are not resolved
_TIMES = 256  # more cells than at first: of a law that changes as fast there is no end
_SAME = 1e-10  # a kink so near to an edge was found, not told: no value is off by more


def sampler_of(scene: Scene) -> Sampler:
    """Prepare the sampler a scene asks for.

    Parameters
    ----------
    scene : Scene
        ``sampler = "auto"`` takes the cheapest exact one; ``tail`` serves where no cells resolve the laws. A
        grading that is a Python function is resolved.

    Returns
    -------
    Sampler
        Ready to draw.
    """
    scene = storable(scene)
    name = name_of(scene)
    try:
        if scene.accuracy and scene.sampler == "auto" and name == "cells" and scene.summits is None:
            return _perhaps_crowded(scene)
        return _MAKERS[name](scene)
    except UnresolvedError:
        if not PROMISES[name].one_by_one:
            raise
        return tail_of(scene)


def distance_of(scene: Scene) -> float:
    """Distance of the laws of its values from the exact ones that its sampler was chosen with."""
    return sampler_of(scene).distance if scene.accuracy else 0.0


def _perhaps_crowded(scene: Scene) -> Counted:
    """Crowds, if what they may cost in the laws buys enough; else ``cells``."""
    from mcgw.sampling.crowds import crowding  # for those scenes alone

    mesh = mesh_of(scene, split=False)
    found = crowding(scene, mesh)
    inside = scene.n_asperities * float(mesh.probability.sum())
    if found is None or found.alone + _GAUSSIAN * mesh.size > inside / _WORTH:
        return cells_of(scene)
    return aggregate_of(scene, found.threshold, found.distance)


def tail_of(scene: Scene) -> Counted:
    """Prepare ``tail``: cells without any cell."""
    return _counted("tail", scene, no_cells(scene))


def cells_of(scene: Scene, given: Sequence[float] = ()) -> Counted:
    """Prepare ``cells``, with the edges of other scenes if they are given."""
    return _counted("cells", scene, mesh_of(scene, given))


def _counted(name: str, scene: Scene, mesh: Mesh) -> Counted:
    """Return a sampler on a mesh, cut where the law of contact bends with the modulus.

    Its response is for all that moments can tell; contacts are counted.
    """
    names, cuts, most = _summed(scene.quantities), 0, _TIMES * mesh.size
    while True:
        try:
            if scene.summits is None or not names:
                return Counted(name, scene, mesh, response_of(scene, mesh, names))
            from mcgw.sampling.own_radii import Families
            from mcgw.sampling.weighted_sums import WithRadii

            response = Families.of(names, partial(response_of, scene, mesh))
            table = table_of(scene, scene.lowest)
            assert table is not None
            return Counted(name, scene, mesh, response, WithRadii(mesh, table, response), table)
        except UnresolvedError as error:
            if cuts == _CUTS or mesh.size > most:
                raise
            mesh, cuts = cut(scene, mesh, error.starts), cuts + 1


def aggregate_of(scene: Scene, crowded: int | None = None, distance: float = np.nan) -> Counted:
    """Return ``aggregate``: only the moments that the laws of its sums need vary.

    Moments of a cell count as Gaussian from `crowded` asperities on, 256 by default; `distance` is what is
    known of its distance from the exact laws.
    """
    from mcgw.sampling.crowds import CROWDED, VARYING, Crowds  # as above

    every = _counted("aggregate", scene, mesh_of(scene, split=False))
    varying = every.response.layout
    with suppress(UnresolvedError):  # all of them vary where cells are too wide to tell
        needed = parts_of(scene, every.mesh, _summed(scene.quantities), VARYING)
        varying = needed.layout.at_most(varying)
    return replace(every, drawing=Crowds(varying, crowded or CROWDED, distance))


_MAKERS: dict[str, Callable[[Scene], Sampler]] = {
    "direct": lambda scene: Direct("direct", scene, no_cells(scene)),
    "tail": tail_of,
    "cells": cells_of,
    "aggregate": aggregate_of,
}


def _summed(quantities: Iterable[str]) -> tuple[str, ...]:
    return tuple(name for name in quantities if not quantity_of(name).counts)
