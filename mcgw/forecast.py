"""What a run will take, before it is made: surfaces from the exact variance, seconds from a short trial."""

from dataclasses import dataclass
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from mcgw.sampling.samplers import Sampler
from mcgw.scene import Scene
from mcgw.simulation import at_a_time, block_size, drawn_blocks
from mcgw.stopping import checkpoints, z_of

__all__ = ["Forecast", "forecast", "relative_spread", "seconds_per_surface"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Forecast:
    """What `rel_err` will need.

    Parameters
    ----------
    needed : dict of str to ndarray
        Surfaces that each mean needs, shape (separations,); infinite where nothing ever touches.
    surfaces : int
        Surfaces that will be drawn, at most the limit.
    out_of_reach : tuple of (str, float)
        Quantities and separations that need more than the limit.
    """

    needed: dict[str, Array]
    surfaces: int
    out_of_reach: tuple[tuple[str, float], ...]


def relative_spread(scene: Scene, quantity: str) -> Array:
    """Exact standard deviation over surfaces relative to the mean, shape (separations,)."""
    h, back = np.unique(scene.separations, return_inverse=True)
    exact = scene.theory.cumulants(quantity, h)
    with np.errstate(divide="ignore", invalid="ignore"):
        spread = np.where(exact.mean != 0, np.sqrt(exact.variance) / np.abs(exact.mean), np.inf)
    return np.asarray(spread[back])


def forecast(scene: Scene) -> Forecast:
    """Number of surfaces that the stop rule will draw.

    Parameters
    ----------
    scene : Scene
        With `rel_err`, or without: then it is `n_surfaces`.

    Returns
    -------
    Forecast
        From the exact variance of a finite surface (`analytic.Model.cumulants`).
    """
    if scene.rel_err is None:
        return Forecast({}, scene.n_surfaces, ())
    factor = (z_of() / scene.rel_err) ** 2
    needed = {name: factor * relative_spread(scene, name) ** 2 for name in scene.quantities}
    most = max(float(n.max()) for n in needed.values())
    surfaces = next((n for n in checkpoints(scene.n_surfaces) if n >= most), scene.n_surfaces)
    beyond = tuple(
        (name, h)
        for name, values in needed.items()
        for h, n in zip(scene.separations, values, strict=True)
        if n > scene.n_surfaces
    )
    return Forecast(needed, surfaces, beyond)


def seconds_per_surface(scene: Scene, sampler: Sampler, *, rounds: int = 3) -> float:
    """Median wall time of drawing one surface in a block, after a warm-up."""
    size = min(block_size(scene, sampler), 256)
    n = at_a_time(size)
    list(drawn_blocks(sampler, 0, n, size))
    times = []
    for _ in range(rounds):
        start = perf_counter()
        list(drawn_blocks(sampler, 0, n, size))
        times.append(perf_counter() - start)
    return float(np.median(times)) / n
