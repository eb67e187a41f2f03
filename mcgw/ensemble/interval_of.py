"""Which confidence interval a quantity of an ensemble has."""

import numpy as np
from numpy.typing import NDArray

from analytic import TANGENTIAL, quantity_of
from mcgw.ensemble.intervals import count_interval, mean_interval, spread_of
from mcgw.ensemble.results import Held
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene

__all__ = ["interval_of"]

Array = NDArray[np.float64]


def interval_of(scene: Scene, sampler: str, sums: Held, name: str, level: float) -> tuple[Array, Array]:
    """Ends of the interval of a mean, as `Ensemble.interval` says.

    Raises
    ------
    ValueError
        If there is none.
    """
    mean, m = sums.mean_and_std(name)[0], sums.rows()
    if not promise_of(sampler).real_surfaces:
        raise ValueError("stratified surfaces have no interval: their fluctuations are not those of any")
    if scene.as_measured:
        return mean, mean
    if name in scene.other_separations:
        return _of_separation(scene, sampler, sums, name, level)
    balanced = scene.interaction is not None and scene.interaction.nominal
    if quantity_of(name).counts and not balanced:
        contacts, asperities = sums.total_number(name), float(scene.n_asperities) * m
        ends = count_interval(contacts, asperities, poisson=scene.count == "poisson", level=level)
        return ends[0] / m, ends[1] / m
    if name == TANGENTIAL.name:
        raise ValueError(f"{name} has no interval, as a difference of normal loads; ask for its stderr")
    low, high = mean_interval(mean, spread_of(scene, name), m, level)
    # What values may be off by, all of them in one direction.
    off = 0.0 if scene.exact else scene.accuracy * np.abs(mean)
    return low - off, high + off


def _of_separation(scene: Scene, sampler: str, sums: Held, name: str, level: float) -> tuple[Array, Array]:
    """Of the other separation, which differs from the scene's by a multiple of the load."""
    load = "load_unloading" if quantity_of(name).unloading else "load"
    low, high = interval_of(scene, sampler, sums, load, level)
    mean, here = (sums.mean_and_std(each)[0] for each in (load, name))
    separations = np.array(scene.separations)
    with np.errstate(divide="ignore", invalid="ignore"):
        sunk = (here - separations) / mean  # d/sigma for a newton; nan where nothing touches
    ends = separations + sunk * low, separations + sunk * high
    return np.fmin(*ends), np.fmax(*ends)
