"""The samplers: one family, from all heights and plain loops to a few numbers a cell.

``direct``      all heights, by NumPy's generator, and plain loops: the witness against the rest
``tail``        only heights that touch, summed one by one: cells without any cell
``cells``       moments of the uniforms in each cell, times the response: exact in law
``aggregate``   the moments of crowded cells drawn from their Gaussian limit: any N at one price
``stratified``  one jittered uniform in each of about N strata: for means only
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from analytic import QUANTITIES, Exponential
from mcgw.machine.memory import keep_freed_memory
from mcgw.sampling.aggregate import CROWDED, VARYING, Crowds, add_gaussian_moments
from mcgw.sampling.cells import Mesh, mesh_of, no_cells
from mcgw.sampling.counts import Counts, contacts_above, counts_of, generator, strata_of
from mcgw.sampling.hertz import hertz_sums
from mcgw.sampling.layout import Layout
from mcgw.sampling.moments import cell_moments
from mcgw.sampling.outside import extra_heights
from mcgw.sampling.response.response import Response, layout_of, response_of
from mcgw.scene.scene import Scene

__all__ = ["Block", "Cells", "Direct", "Sampler", "aggregate_of", "response_to", "sampler_of"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_DIRECT = 1  # purpose of NumPy's generator; the counts have 0
_PIECE = 2**20  # heights at a time


@dataclass(frozen=True)
class Block:
    """Results of some consecutive surfaces.

    Parameters
    ----------
    sums : dict of str to ndarray
        Each quantity in SI units, shape (surfaces, separations).
    moments : ndarray or None
        Of all cells, shape (surfaces, moments), where the sampler has cells.
    counts : ndarray or None
        Asperities in each cell, shape (surfaces, cells).
    extras : ndarray or None
        Rows (surface, height, weight) of the asperities outside the cells.
    """

    sums: dict[str, Array]
    moments: Array | None = None
    counts: Array | None = None
    extras: Array | None = None


class Sampler(Protocol):
    """Draws surfaces by their numbers."""

    @property
    def name(self) -> str:
        """One of `mcgw.scene.scene.SAMPLERS`, never "auto"."""
        ...

    def block(self, first: int, n: int) -> Block:
        """Results of surfaces `first` ... `first + n - 1`: the same in any block."""
        ...


def sampler_of(scene: Scene) -> "Sampler":
    """Prepare the sampler a scene asks for.

    Parameters
    ----------
    scene : Scene
        ``sampler = "auto"`` takes the cheapest exact one.

    Returns
    -------
    Sampler
        Ready to draw.
    """
    name = _cheapest(scene) if scene.sampler == "auto" else scene.sampler
    if name == "direct":
        return Direct(scene)
    keep_freed_memory()
    if name == "aggregate":
        return aggregate_of(scene)
    meshes: dict[str, Callable[[Scene], Mesh]] = {
        "tail": no_cells,
        "cells": mesh_of,
        "stratified": partial(mesh_of, split=False, rare=1e-9),
    }
    mesh = meshes[name](scene)
    return Cells(scene, mesh, response_to(scene, mesh), name)


def aggregate_of(scene: Scene, crowded: int = CROWDED) -> "Cells":
    """Prepare ``aggregate`` with a threshold of one's own.

    Parameters
    ----------
    scene : Scene
        What is asked.
    crowded : int, optional
        Asperities in a cell, from which its moments count as Gaussian.

    Returns
    -------
    Cells
        If moments are kept all of them vary, for another grading may need them.
    """
    mesh = mesh_of(scene, split=False)
    response = response_to(scene, mesh)
    varying = response.layout
    if scene.keep == "sums":
        varying = layout_of(scene, mesh, _summed(scene.quantities), accuracy=VARYING)
    return Cells(scene, mesh, response, "aggregate", Crowds(varying, crowded))


def response_to(scene: Scene, mesh: Mesh, kept: Layout | None = None) -> Response:
    """Response for all that moments can tell; contacts are counted."""
    if scene.keep == "moments" and kept is None:
        kept = _lasting_layout(scene, mesh)
    return response_of(scene, mesh, _summed(scene.quantities), kept=kept)


def _summed(quantities: Iterable[str]) -> tuple[str, ...]:
    return tuple(name for name in quantities if QUANTITIES[name].exponent > 0)


def _lasting_layout(scene: Scene, mesh: Mesh) -> Layout:
    """Moments that serve every quantity, this grading, and another exponential one."""
    others = [replace(scene, grading=Exponential(gamma), negative="allow") for gamma in (2.0, 0.5, 0.0)]
    layouts = [layout_of(x, mesh, _summed(QUANTITIES), lasting=True) for x in (scene, *others)]
    plain = np.max([layout.plain for layout in layouts], axis=0)
    return Layout(plain + 1, np.max([layout.rooted for layout in layouts], axis=0) + 1)  # one in reserve


def _cheapest(scene: Scene) -> str:
    """Cells, unless most of them would be empty (`runs/bench/auto.py`)."""
    touching = scene.touching
    few = touching < min(5 + len(scene.separations) / 20, 20)
    return "tail" if few and scene.keep == "sums" else "cells"


@dataclass(frozen=True)
class Direct:
    """All heights, by NumPy's generator, and plain loops."""

    scene: Scene
    name: str = "direct"

    def block(self, first: int, n: int) -> Block:
        """Results of surfaces `first` ... `first + n - 1`."""
        rows = [self._surface(number) for number in range(first, first + n)]
        return Block({name: np.concatenate([row[name] for row in rows]) for name in rows[0]})

    def _surface(self, number: int) -> dict[str, Array]:
        scene = self.scene
        rng = generator(scene.seed, _DIRECT, number)
        left = scene.n_asperities if scene.count == "fixed" else int(rng.poisson(scene.n_asperities))
        total = hertz_sums(scene, np.array([0]), np.empty(0), np.empty(0))
        while left:
            now = min(left, _PIECE)
            heights = scene.heights.sample(rng, now)
            left -= now
            for name, value in hertz_sums(scene, np.array([now]), heights, np.ones(now)).items():
                total[name] += value
        return total


@dataclass(frozen=True)
class Cells:
    """All samplers that count before they draw.

    Parameters
    ----------
    scene : Scene
        What is asked.
    mesh : Mesh
        Its cells; none for ``tail``.
    response : Response
        Physics on this mesh.
    name : str
        Which of the family.
    crowds : Crowds, optional
        How ``aggregate`` draws crowded cells; left out: asperity by asperity.
    """

    scene: Scene
    mesh: Mesh
    response: Response
    name: str
    crowds: Crowds | None = None

    def block(self, first: int, n: int) -> Block:
        """Results of surfaces `first` ... `first + n - 1`."""
        if self.name == "stratified":
            counts = strata_of(self.scene, self.mesh, n)
        else:
            counts = counts_of(self.scene, self.mesh, first, n)
        moments = self._moments(first, counts)
        extras = extra_heights(self.scene, self.mesh, first, counts)
        numbers = counts.cells * counts.weights[1:-1, None]
        return Block(self.sums(first, moments, numbers, extras), moments.T, numbers.T, extras)

    def _moments(self, first: int, counts: Counts) -> Array:
        seed, layout = self.scene.seed, self.response.layout
        if self.crowds:
            crowded = np.where(counts.cells >= self.crowds.threshold, counts.cells, 0)
            moments = cell_moments(seed, first, counts.cells - crowded, layout)
            add_gaussian_moments(seed, first, crowded, layout, self.crowds.varying, moments)
            return moments
        stratified = self.name == "stratified"
        moments = cell_moments(seed, first, counts.cells, layout, stratified=stratified)
        if stratified:
            moments *= np.repeat(counts.weights[1:-1], layout.sizes)[:, None]
        return moments

    def sums(self, first: int, moments: Array, counts: Array, extras: Array) -> dict[str, Array]:
        """Quantities of surfaces `first` ... from what was drawn.

        Parameters
        ----------
        first : int
            Number of the first surface.
        moments, counts : ndarray
            Shape (moments, surfaces) and (cells, surfaces).
        extras : ndarray
            Rows (surface, height, weight).

        Returns
        -------
        dict of str to ndarray
            Each quantity in SI units, shape (surfaces, separations).
        """
        scene = self.scene
        once, column = np.unique(scene.separations, return_inverse=True)
        columns = slice(None) if np.array_equal(once, scene.separations) else column
        answers = iter(self.response @ moments)
        sums = {}
        for name in scene.quantities:
            sums[name] = (
                contacts_above(counts, self._places()) if name == "contacts" else next(answers)[:, columns]
            )
        where, numbers = np.unique(extras[:, 0].astype(np.int64) - first, return_counts=True)
        heights, weights = np.ascontiguousarray(extras[:, 1:].T)
        with np.errstate(over="ignore"):  # as in the product: what is too large is infinite
            for name, values in hertz_sums(scene, numbers, heights, weights).items():
                sums[name][where] += values
        return sums

    def _places(self) -> Ints:
        """First cell above each separation."""
        return np.searchsorted(self.mesh.edges[:-1], self.scene.separations)
