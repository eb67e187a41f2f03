"""The heights themselves: the very asperities whose sums the samplers ``tail`` and ``cells`` give."""

import numpy as np
from numpy.typing import NDArray

from mcgw.machine.memory import check_memory
from mcgw.sampling.counted import Counted
from mcgw.sampling.counts import counts_of, generator
from mcgw.sampling.outside import extra_heights
from mcgw.sampling.philox import CELLS, REST, uniforms
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene
from mcgw.scene.storable import storable

__all__ = ["heights", "heights_drawn", "listing_sampler", "same_heights"]


def heights(scene: Scene, surface: int, *, untouched: bool = False) -> NDArray[np.float64]:
    """Reduced heights of one surface of an ensemble.

    Parameters
    ----------
    scene : Scene
        With sampler ``cells``, ``tail`` or ``auto``.
    surface : int
        Its number, from 0.
    untouched : bool, optional
        Add the asperities that no separation of the scene reaches (for a Poisson number of
        asperities, their number is drawn too).

    Returns
    -------
    ndarray
        Heights in units of sigma, those that touch first.

    Raises
    ------
    ValueError
        If the sampler does not draw asperities one by one.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> s = mcgw.heights(scene, 3)
    >>> s.size == int(mcgw.simulate(scene).contacts[3, 0])
    True
    """
    scene = storable(scene)
    return heights_drawn(scene, listing_sampler(scene), surface, untouched=untouched)


def listing_sampler(scene: Scene) -> Counted:
    """The sampler of a scene, if it can tell the heights.

    Raises
    ------
    ValueError
        If it does not draw asperities one by one.
    """
    sampler = sampler_of(scene)
    if not isinstance(sampler, Counted) or not promise_of(sampler.name).one_by_one:
        raise ValueError(f'sampler = "{sampler.name}" keeps no heights; "cells" and "tail" do')
    return sampler


def same_heights(one: Scene, other: Scene) -> bool:
    """Whether surfaces of two scenes of one seed, height law and sampler have the same asperities.

    Cells are edged by the breaks of contact laws, and each cell has uniforms of its own.
    """
    first, second = sampler_of(one), sampler_of(other)
    if not (isinstance(first, Counted) and isinstance(second, Counted)):
        return True
    return np.array_equal(first.mesh.edges, second.mesh.edges)


def heights_drawn(
    scene: Scene, sampler: Counted, surface: int, *, untouched: bool = False
) -> NDArray[np.float64]:
    """As `heights`, for many surfaces of one sampler, which takes longer to make than they do."""
    mesh = sampler.mesh
    counts = counts_of(scene, mesh, surface, 1)
    drawn = scene.n_asperities if untouched else int(counts.cells.sum())
    check_memory("the heights of one surface", 24 * drawn)
    parts = [extra_heights(scene, mesh, surface, counts)[:, 1]]
    for cell in np.flatnonzero(counts.cells[:, 0]):
        u = uniforms(scene.seed, CELLS, surface, int(cell), int(counts.cells[cell, 0]))
        parts.append(mesh.edges[cell] + mesh.offsets(int(cell), u))
    touching = np.concatenate(parts[1:] + parts[:1])
    if not untouched:
        return touching
    u = uniforms(scene.seed, REST, surface, 0, _untouched(scene, surface, len(touching)))
    return np.concatenate([touching, scene.heights.from_below(u, scene.lowest)])


def _untouched(scene: Scene, surface: int, touching: int) -> int:
    """Number of asperities below every separation."""
    if scene.count == "fixed":
        return scene.n_asperities - touching
    expected = scene.n_asperities * float(scene.heights.below(np.array(scene.lowest)))
    return int(generator(scene.seed, REST, surface).poisson(expected))
