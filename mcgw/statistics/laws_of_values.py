"""Whether the values of single surfaces follow their exact laws, each by the test of Kolmogorov and Smirnov.

A share of M surfaces is farther than D from its probability, at any value at all, with a probability of at
most ``2 exp(-2 M D^2)``, for laws with jumps too (Massart, Annals of Probability 18 (1990) 1269): a surface
without contact needs no random number in place of its value. Of K laws the least probability counts K-fold
(Bonferroni), however much the laws have in common.
"""

import numpy as np

from analytic import MeasuredHeights, quantity_of
from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.formats.table import evenly
from mcgw.scene.promises import promise_of
from mcgw.scene.scene import Scene
from mcgw.statistics.verdict import Check

_SEPARATIONS, _FEW = 8, 3  # laws per quantity, at most; few where a law takes 60 ms instead of 10
_PLACES = 1000  # values at which shares and probabilities are compared, of more surfaces some of theirs


def laws_of_values(ensemble: Ensemble) -> Check:
    """Test all surfaces against the exact laws of their quantities, all at once."""
    found = distances(ensemble)
    distance, name, h = max(found)
    p = 2 * len(found) * float(np.exp(-2 * ensemble.n_surfaces * distance**2))
    where = f"the distribution of {name} at d/sigma = {h:g}"
    seen = f"{where} differs by {distance:.3g}, the most of {len(found)}"
    return Check("distributions of values", seen, min(p, 1.0))


def distances(ensemble: Ensemble) -> list[tuple[float, str, float]]:
    """Largest difference of the share of the surfaces up to a value and its probability, and of what law.

    Of each quantity at eight separations at most.

    Raises
    ------
    ValueError
        Where values are not kept, are those of listed summits (laws with a step for each of them) or of
        radii of their own under a law that yields, or come from a sampler that spends some of the law.
    """
    scene, one_radius = ensemble.scene, ensemble.scene.summits is None
    if (
        scene.keep == "statistics"
        or isinstance(scene.heights, MeasuredHeights)
        or not promise_of(ensemble.sampler).one_by_one
        or not (scene.hertzian or one_radius)
    ):
        raise ValueError(
            "laws = True: needs kept values of surfaces, from an exact sampler; not "
            "for listed summits, nor for individual radii with a law other than Hertz's"
        )
    h, m = np.unique(scene.separations), ensemble.n_surfaces
    chosen = h[evenly(len(h), _SEPARATIONS if scene.hertzian and one_radius else _FEW)].tolist()
    found = []
    for name in scene.quantities:
        which = [scene.separations.index(x) for x in chosen]
        values = np.sort(ensemble.sums.read(name, 0, m)[:, which].astype(np.float64), axis=0)
        found += [
            (_farthest(scene, name, *pair), name, pair[0]) for pair in zip(chosen, values.T, strict=True)
        ]
    return found


def _farthest(scene: Scene, name: str, h: float, values: Array) -> float:
    """Largest distance of shares from their probabilities; both as they jump at values that repeat."""
    x, law = values[evenly(values.size, _PLACES)], scene.theory.distribution(name, h)
    below, upto = (np.searchsorted(values, x, side) / values.size for side in ("left", "right"))
    most = law.cdf(x)
    least = law.cdf(x - 1) if quantity_of(name).counts else most - np.where(x == 0, law.atom, 0.0)
    return float(max((upto - most).max(), (least - below).max(), 0.0))
