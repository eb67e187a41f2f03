"""The heights themselves: the very asperities whose sums the samplers give that draw them one by one."""

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array, Ints
from mcgw.machine.process import check_memory
from mcgw.sampling.block import Sampler
from mcgw.sampling.counted import counts_of, extra_heights, table_of
from mcgw.sampling.direct import Direct, asperity_sums, generator
from mcgw.sampling.philox import CELLS, RADII, RADII_LOW, REST, uniforms
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.ensemble import PROMISES
from mcgw.scene.scene import Scene, storable

Listed = tuple[Array, Array | None]  # reduced heights; radii over the surface's, where summits have their own


def heights(scene: Scene, surface: int, *, untouched: bool = False) -> NDArray[np.float64]:
    """Return the reduced heights of one surface of an ensemble.

    Parameters
    ----------
    scene : Scene
        With a sampler that draws asperities one by one: ``cells``, ``tail``, ``direct`` or ``auto``.
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
    return (summits if untouched else touching_summits)(scene, surface)[0]


def radii(scene: Scene, surface: int) -> NDArray[np.float64]:
    """Return the radii of the summits of one surface of an ensemble that touch, in the order of `heights`.

    Parameters
    ----------
    scene : Scene
        With a sampler that draws asperities one by one: ``cells``, ``tail``, ``direct`` or ``auto``.
    surface : int
        Its number, from 0.

    Returns
    -------
    ndarray
        m; all alike where summits have one radius.

    Raises
    ------
    ValueError
        If the sampler does not draw asperities one by one.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=20, seed=1)
    >>> mcgw.radii(scene, 3).size == mcgw.heights(scene, 3).size
    True
    """
    s, ratios = touching_summits(scene, surface)
    return np.asarray(scene.surface.radius * (np.ones_like(s) if ratios is None else ratios))


def listing_sampler(scene: Scene) -> Sampler:
    """Return the sampler of a scene, if it can tell the heights.

    Raises
    ------
    ValueError
        If it does not draw asperities one by one.
    """
    sampler = sampler_of(scene)
    if not PROMISES[sampler.name].one_by_one:
        raise ValueError(f'sampler = "{sampler.name}" keeps no heights; use "cells", "tail" or "direct"')
    return sampler


def same_heights(one: Scene, other: Scene) -> bool:
    """Whether surfaces of two scenes of one seed, height law and sampler have the same asperities.

    Cells are edged by the breaks of contact laws, and each cell has uniforms of its own.
    """
    first, second = (sampler_of(scene).mesh for scene in (one, other))
    return np.array_equal(first.edges, second.edges)


def touching_summits(scene: Scene, surface: int) -> Listed:
    """Return the asperities of one surface that touch."""
    scene = storable(scene)
    return summits_drawn(scene, listing_sampler(scene), surface)


def summits(scene: Scene, surface: int) -> Listed:
    """All asperities of one surface, those that touch first."""
    scene = storable(scene)
    sampler = listing_sampler(scene)
    if isinstance(sampler, Direct):
        return _listed(sampler, surface, -np.inf)
    touching, ratios = summits_drawn(scene, sampler, surface)
    rest = _below(scene, surface, len(touching))
    s, table = np.concatenate([touching, rest]), table_of(scene, -np.inf)
    if table is None or ratios is None:
        return s, None
    words = (2 * uniforms(scene.seed, REST, surface, stream, rest.size) - 1 for stream in (1, 2))
    return s, np.concatenate([ratios, table.root_ratios(rest, *words) ** 2])


def summits_drawn(scene: Scene, sampler: Sampler, surface: int) -> Listed:
    """Return the asperities of one surface that touch, by a sampler that is made once for many surfaces."""
    if isinstance(sampler, Direct):
        return _listed(sampler, surface, scene.lowest)
    mesh, table = sampler.mesh, table_of(scene, scene.lowest)
    counts = counts_of(scene, mesh, surface, 1)
    check_memory("the heights of one surface", 24 * int(counts.cells.sum()))
    outside = extra_heights(scene, mesh, surface, counts, table)
    heights, ratios = [], []
    for cell in np.flatnonzero(counts.cells[:, 0]).tolist():
        n = int(counts.cells[cell, 0])
        u = uniforms(scene.seed, CELLS, surface, cell, n)
        heights.append(mesh.edges[cell] + mesh.offsets(cell, u))
        if table:
            words = (2 * uniforms(scene.seed, stream, surface, cell, n) - 1 for stream in (RADII, RADII_LOW))
            ratios.append(table.root_ratios(heights[-1], *words) ** 2)
    s = np.concatenate([*heights, outside[:, 1]])
    return s, np.concatenate([*ratios, outside[:, 3]]) if table else None


def summits_of_many(scene: Scene, sampler: Sampler, first: int, n: int) -> tuple[Ints, Array, Array | None]:
    """As `summits_drawn`, of surfaces `first` ... `first + n - 1`: how many each has, and those of all."""
    if not isinstance(sampler, Direct) and not sampler.mesh.size:
        counts, table = counts_of(scene, sampler.mesh, first, n), table_of(scene, scene.lowest)
        rows = extra_heights(scene, sampler.mesh, first, counts, table)
        return counts.low_extras + counts.high_extras, rows[:, 1], rows[:, 3] if table else None
    every = [summits_drawn(scene, sampler, number) for number in range(first, first + n)]
    own = [ratios for _, ratios in every if ratios is not None]
    s = np.concatenate([s for s, _ in every])
    return np.array([s.size for s, _ in every]), s, np.concatenate(own) if own else None


def worst_of_values(scene: Scene, surfaces: int) -> float:
    """Largest relative error of values of the first surfaces against plain sums over their asperities."""
    sampler, worst = sampler_of(scene), 0.0
    for number in range(surfaces):
        s, ratios = summits_drawn(scene, sampler, number)
        plain = asperity_sums(scene, np.array([s.size]), s, np.ones(s.size), ratios)
        for quantity, values in sampler.block(number, 1).items():
            if quantity in plain and plain[quantity].any():
                worst = max(worst, float(np.abs(values / plain[quantity] - 1).max()))
    return worst


def _listed(sampler: Direct, surface: int, above: float) -> Listed:
    """Return the asperities above a separation, of all that are drawn; those that touch first."""
    check_memory("the heights of one surface", 24 * sampler.scene.n_asperities)
    pieces = list(sampler.asperities(surface))
    s = np.concatenate([np.empty(0), *(heights for heights, _ in pieces)])
    order = np.argsort(s <= sampler.scene.lowest, kind="stable")[: np.count_nonzero(s > above)]
    own = [ratios for _, ratios in pieces if ratios is not None]
    return s[order], np.concatenate(own)[order] if own else None


def _below(scene: Scene, surface: int, touching: int) -> Array:
    """Heights of the asperities that no separation reaches."""
    if scene.count == "fixed":
        rest = scene.n_asperities - touching
    else:
        expected = scene.n_asperities * float(scene.heights.cdf(np.array(scene.lowest)))
        rest = int(generator(scene.seed, REST, surface).poisson(expected))
    check_memory("the heights of one surface", 24 * rest)
    u = uniforms(scene.seed, REST, surface, 0, rest)
    return np.asarray(scene.heights.ppf(u, scene.lowest))
