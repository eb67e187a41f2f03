"""The scene of most benches, S1, how its surfaces are drawn, and the script that a user writes instead.

S1: 10^6 asperities, gamma = 2, separations 0 ... 4, load, area, stiffness and contacts.
"""

from collections.abc import Callable
from functools import cache
from itertools import count

import numpy as np
from timing import Job, job, seconds

import analytic
from mcgw.ensemble.drawing import block_size, drawn_blocks
from mcgw.machine.threads import THREADS
from mcgw.sampling.block import Sums
from mcgw.sampling.samplers import cells_of, sampler_of
from mcgw.scene.scene import Scene

SURFACE = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3.0e8, nominal_area=1e-4, E_star=78.6e9)
S1 = Scene(
    surface=SURFACE,
    separations=tuple(np.linspace(0, 4, 41)),
    grading=analytic.Exponential(2.0),
    ensemble={"n_asperities": 10**6, "sampler": "cells"},
    seed=1,
)
_turn = count(1)


def fresh(scene: Scene) -> Scene:
    """The scene with another seed and slightly other separations: nothing kept of an earlier one helps."""
    turn = next(_turn)
    return scene.replace(separations=np.array(scene.separations) * (1 - 1e-6 * turn), seed=turn)


def block(
    scene: Scene,
    then: Callable[[Sums], object] = lambda drawn: drawn,
) -> Job:
    """Blocks as a run draws them, and what is done with each; prepared when first called."""
    prepared = cache(lambda: sampler_of(scene))

    def draw() -> float:
        sampler = prepared()
        size = block_size(scene, sampler)
        surfaces = size * THREADS.get() if size > 1 else 1
        return seconds(lambda: [then(drawn) for drawn in drawn_blocks(sampler, 0, surfaces, size)], surfaces)

    return draw


def set_up(scene: Scene, forget: Callable[[], object] = lambda: None) -> Job:
    """Mesh and response of a scene that nothing is known of, once what is kept of any scene is forgotten."""

    def prepare() -> float:
        asked = fresh(scene)
        forget()
        return seconds(lambda: cells_of(asked))

    return prepare


def drawing(scene: Scene, surfaces: int) -> Job:
    """So many surfaces in one call; prepared when first called."""
    prepared = cache(lambda: cells_of(scene))

    def draw() -> float:
        sampler = prepared()
        return seconds(lambda: sampler.block(0, surfaces), surfaces)

    return draw


def numpy_script(n: int, separations: tuple[float, ...], surfaces: int) -> np.ndarray:
    """What a user writes first: all normals, then a vector expression for each separation."""
    rng = np.random.default_rng(1)
    result = np.empty((surfaces, len(separations), 4))
    for i in range(surfaces):
        s = rng.standard_normal(n)
        e = 2.0 - np.exp(-s)
        for k, h in enumerate(separations):
            d = np.maximum(s - h, 0.0)
            result[i, k] = (e * d**1.5).sum(), d.sum(), (e * d**0.5).sum(), (d > 0).sum()
    return result


def script(n: int = 10**6) -> Job:
    """That script at the separations of S1."""
    surfaces = max(1, 200_000 // n)
    return job(lambda: numpy_script(n, S1.separations, surfaces), surfaces)
