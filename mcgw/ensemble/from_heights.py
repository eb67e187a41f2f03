"""What any contact law makes of the surfaces of an ensemble, from the very heights, contact by contact."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.drawing import answered
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.same_surfaces import check_same
from mcgw.sampling.asperities import listing_sampler, summits_drawn
from mcgw.sampling.law_sums import asperity_sums
from mcgw.scene.drawn_by import drawn_by
from mcgw.scene.scene import Scene

__all__ = ["sums_of_heights"]

_HEIGHTS = 2**18  # at a time, or one surface


def sums_of_heights(ensemble: Ensemble, scene: Scene) -> Iterator[dict[str, NDArray[np.float64]]]:
    """Sums that a scene asks for over the asperities of an ensemble, some surfaces at a time.

    At the lowest separation, sums under the ensemble's own law are compared with those that it holds.

    Raises
    ------
    ValueError
        If the sampler keeps no heights, a separation is lower than all for which they were drawn, or they
        are not those of the ensemble.
    """
    origin = replace(drawn_by(ensemble.surfaces_of, ensemble.sampler), n_surfaces=ensemble.n_surfaces)
    sampler, old = listing_sampler(origin), ensemble.scene
    if scene.lowest < origin.lowest:
        raise ValueError(
            f"separation {scene.lowest:g} is lower than {origin.lowest:g}, down to which the asperities of "
            "these surfaces were drawn; give higher ones, or simulate the scene anew"
        )
    lowest = replace(old, separations=(old.lowest,), tangential=None)
    where = old.separations.index(old.lowest)
    step = max(int(_HEIGHTS / max(origin.touching, 1.0)), 1)
    for first in range(0, ensemble.n_surfaces, step):
        surfaces = range(first, min(first + step, ensemble.n_surfaces))
        listed = [summits_drawn(origin, sampler, number) for number in surfaces]
        numbers = np.array([s.size for s, _ in listed])
        heights, own = np.concatenate([s for s, _ in listed]), [c for _, c in listed if c is not None]
        drawn = numbers, heights, np.ones(heights.size), np.concatenate(own) if own else None
        again = asperity_sums(lowest, *drawn)
        check_same(ensemble, first, answered(lowest, again), slice(where, where + 1))
        yield asperity_sums(scene, *drawn)
