"""Between which values most surfaces lie: by the exact law of each, without a draw."""

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.intervals import laws_are_quick
from mcgw.scene.scene import Scene


def exact_ends(scene: Scene, name: str, share: float) -> Array | None:
    """Ends between which this share of all surfaces lies at each separation, shape (2, separations).

    None where no law is known, or where laws take a while.
    """
    if not laws_are_quick(scene):
        return None
    try:
        laws = [scene.theory.distribution(name, h) for h in scene.separations]
        return np.array([law.interval(share) for law in laws]).T
    except (KeyError, ValueError):
        return None
